//! Rotary veneer of 3 m x 1 m at 4 pixels a millimetre into memory: two threads against one.
//!
//! `cargo bench --bench veneer` prints the ratio of wall times of each pair beside what a loop that shares nothing gains from
//! two threads at that moment, and processor time a pixel. How much memory a process needs is seen by
//! `/usr/bin/time -v yosegi render` of the same recipe.

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

const PAIRS: usize = 7;

const VENEER: &str = r##"(
    nodes: {
        "log": skeleton(
            trunk: [(0, 0, 0), (9, 4, 420), (-7, -3, 900), (4, 2, 1400)],
            branches: [
                (at: 300, direction: (1, 0.3, 0.6), thickening: 1.1),
                (at: 520, direction: (-0.7, 0.8, 0.5), thickening: 0.9),
                (at: 800, direction: (-0.2, -0.9, 0.5), thickening: 0.8),
            ],
        ),
        "time": growth_field(skeleton: "log", elongation: 900, thickening: 3.4),
        "year": colour_pattern(stops: [
            (at: 0, colour: "#ecd0a4"), (at: 0.5, colour: "#dfba88"), (at: 0.9, colour: "#b98552"), (at: 1, colour: "#a06c3c"),
        ]),
        "look": pattern_lookup(time: "time.time", pattern: "year"),
        "wood": material(base_color: "look.colour"),
        "veneer": rotary_cut(of: "wood", origin: (0, 0, 100), radius: 180, pitch: 1, height: 1000, length: 3000),
    },
    outputs: { "veneer": maps(of: "veneer", pixels_per_mm: 4, channels: [base_color]) },
)"##;

fn engine(threads: usize) -> Engine {
    let options = Options {
        threads: Some(threads),
        memory: 0,
        ..Options::default()
    };
    Engine::new(Arc::new(Memory::default()), options).expect("there are threads")
}

fn render(engine: &Engine, graph: &Graph) {
    let request = Render {
        graph,
        folder: PathBuf::from("out"),
        only: vec![],
        pixels: None,
        listener: &|_: Event| {},
        cancel: Cancel::new(),
    };
    black_box(engine.render(&request).expect("the veneer can be rendered"));
}

fn main() {
    let graph = match load_text("veneer.ron", VENEER, &Settings::default()) {
        Ok(loaded) => loaded.graph,
        Err(wrong) => panic!("{}", yosegi::diagnostics::render_all(&wrong)),
    };
    let (one, two) = (engine(1), engine(2));
    render(&two, &graph);
    let (mut quiet, mut processor) = (vec![], vec![]);
    for _ in 0..PAIRS {
        let controls = [1, 2].map(|threads| wall(|| control(threads)));
        let alone = wall(|| processor.push(seconds(&mut || render(&one, &graph))));
        let together = wall(|| render(&two, &graph));
        let [gain, most] = [alone / together, 2.0 * controls[0] / controls[1]];
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
    println!(
        "{:.1} ns of processor a pixel",
        median(processor) * 1e9 / 48e6
    );
}
