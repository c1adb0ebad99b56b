//! Whole renders into memory: two threads against one, and large pictures against small ones.
//!
//! `cargo bench --bench render` prints medians of five pairs. Two processors are not always two whole
//! cores: a loop of additions and multiplications that shares nothing shows what they give.

#[path = "support/clock.rs"]
mod clock;
#[path = "support/control.rs"]
mod control;

use clock::{median, seconds};
use control::{control, wall};
use std::hint::black_box;
use std::path::PathBuf;
use std::sync::Arc;
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Graph, Settings, load_text};
use yosegi::world::Memory;

const PAIRS: usize = 5;

/// Pixels along each side of the picture.
const SIDE: u32 = 4096;

/// A bent trunk with three branches.
const TRUNK: &str = r##"(
    nodes: {
        "tree": skeleton(
            trunk: [(0, 0, 0), (22, 6, 500), (-10, -8, 1100), (14, 4, 1700), (0, 0, 2400)],
            branches: [
                (at: 620, direction: (1, 0.1, 0.5), thickening: 0.5),
                (at: 900, direction: (-0.8, -0.7, 0.6), thickening: 0.7),
                (at: 1180, direction: (-0.6, 0.9, 0.4), thickening: 0.6),
            ],
        ),
        "time": growth_field(skeleton: "tree", elongation: 350, thickening: 3),
        "year": colour_pattern(stops: [
            (at: 0, colour: "#e8c99b"), (at: 0.55, colour: "#dcb785"), (at: 0.92, colour: "#b27b48"), (at: 1, colour: "#9a6438"),
        ]),
        "look": pattern_lookup(time: "time.time", pattern: "year"),
        "wood": material(base_color: "look.colour"),
        "board": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 900), size: (640, 640)),
    },
    outputs: { "board": maps(of: "board", pixels: (4096, 4096), channels: [base_color]) },
)"##;

fn engine(threads: usize) -> Engine {
    let options = Options {
        threads: Some(threads),
        memory: 0,
        ..Options::default()
    };
    Engine::new(Arc::new(Memory::default()), options).expect("there are threads")
}

fn render(engine: &Engine, graph: &Graph, side: u32) {
    let listener = |_: Event| {};
    let request = Render {
        graph,
        folder: PathBuf::from("out"),
        only: vec![],
        pixels: Some([side; 2]),
        listener: &listener,
        cancel: Cancel::new(),
    };
    black_box(engine.render(&request).expect("the board can be rendered"));
}

fn main() {
    let graph = match load_text("board.ron", TRUNK, &Settings::default()) {
        Ok(loaded) => loaded.graph,
        Err(wrong) => panic!("{}", yosegi::diagnostics::render_all(&wrong)),
    };
    let (one, two) = (engine(1), engine(2));
    render(&two, &graph, SIDE);
    let mut quiet = vec![];
    for _ in 0..4 * PAIRS {
        let controls = [1, 2].map(|threads| wall(|| control(threads)));
        let renders = [&one, &two].map(|engine| wall(|| render(engine, &graph, SIDE)));
        let [gain, most] = [renders[0] / renders[1], 2.0 * controls[0] / controls[1]];
        print!("{gain:.2}/{most:.2} ");
        if most >= 1.8 {
            quiet.push(gain);
        }
    }
    println!("\ntwo threads against one, wall time: render/control");
    match quiet.len() {
        0 => println!("no pair had two processors to itself"),
        pairs => println!(
            "render {:.2} in {pairs} pairs with two processors",
            median(quiet)
        ),
    }
    let pixel = |side: u32| {
        seconds(&mut || render(&one, &graph, side)) * 1e9 / f64::from(side) / f64::from(side)
    };
    let pairs: Vec<[f64; 2]> = (0..PAIRS).map(|_| [pixel(4 * SIDE), pixel(SIDE)]).collect();
    let of = |part: fn(&[f64; 2]) -> f64| median(pairs.iter().map(part).collect());
    let [large, small, ratio] = [of(|p| p[0]), of(|p| p[1]), of(|p| p[0] / p[1])];
    println!("ns/pixel of CPU: {large:.1} at 16384 pixels, {small:.1} at 4096, {ratio:.2}");
}
