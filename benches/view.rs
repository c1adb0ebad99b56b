//! Views of relief against those of the same setts without, and on a block with heights that only bend the light.
//!
//! `cargo bench --bench view` prints medians of five pairs in processor time, 960 x 640 pixels of 2 m x 2 m.

#[path = "support/clock.rs"]
mod clock;

use clock::{median, seconds};
use std::path::PathBuf;
use std::sync::Arc;
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Graph, Settings, load_text};
use yosegi::world::Memory;

const PAIRS: usize = 5;

/// Setts in rows; `HEIGHT` and `VIEW` are put in.
const SETTS: &str = r##"(
    nodes: {
        "place": position(),
        "wide": plane_noise(size: (300, 300, 300), octaves: 3, seed: 3),
        "grain": plane_noise(size: (24, 24, 24), octaves: 6, seed: 5),
        "big": plane_noise(size: (190, 190, 190), octaves: 2, seed: 9),
        "row": math(operation: floor, a: "= place.v / 100 mm + 0.1 * wide"),
        "v": math(operation: modulo, a: "= place.v / 100 mm + 0.1 * wide"),
        "odd": math(operation: modulo, a: "row", b: 2),
        "u": math(operation: modulo, a: "= place.u / 130 mm + 0.1 * wide + 0.5 * odd"),
        "du": math(operation: power, a: "= (2 * u - 1) * (2 * u - 1)", b: 4),
        "dv": math(operation: power, a: "= (2 * v - 1) * (2 * v - 1)", b: 3),
        "top": remap(value: "= 1 - du - dv + 0.3 * grain.value", from: (0, 0.9), curve: smooth),
        "tone": ramp(value: "= big + 0.6 * grain", stops: [(at: -0.5, colour: "#5d5a57"), (at: 0.5, colour: "#a09a92")]),
        "colour": mix(a: "#8d8168", b: "tone", amount: "top"),
        "street": material(base_color: "colour", roughness: 0.8, HEIGHT),
        "slab": block(across: (1, 0, 0), along: (0, 1, 0), size: (2000, 2000), thickness: 40, rounding: 0),
    },
    outputs: { "street": view(of: "street", size: (2000, 2000), VIEW) },
)"##;

const HEIGHT: &str = r#"height: "= 14 * top + 2 * grain + 6 * big""#;

fn graph(height: &str, view: &str) -> Graph {
    let text = SETTS.replace("HEIGHT", height).replace("VIEW", view);
    match load_text("street.ron", &text, &Settings::default()) {
        Ok(loaded) => loaded.graph,
        Err(wrong) => panic!("{}", yosegi::diagnostics::render_all(&wrong)),
    }
}

fn render(engine: &Engine, graph: &Graph) {
    let listener = |_: Event| {};
    let request = Render {
        graph,
        folder: PathBuf::from("out"),
        only: vec![],
        pixels: None,
        listener: &listener,
        cancel: Cancel::new(),
    };
    engine.render(&request).expect("the street can be rendered");
}

fn main() {
    let relief = graph(HEIGHT, "thickness: 40");
    let sun =
        "lights: [(direction: (-0.9, 0.55, 0.5), angle: 1.5)], camera: (side: (0.4, -1, 0.62))";
    let cases = [
        ("without its heights", graph("", "thickness: 40")),
        ("on a block", graph(HEIGHT, &format!("on: \"slab\", {sun}"))),
    ];
    let options = Options {
        threads: Some(2),
        memory: 0,
        ..Options::default()
    };
    let engine = Engine::new(Arc::new(Memory::default()), options).expect("there are threads");
    for (name, other) in cases {
        let time = |graph: &Graph| seconds(&mut || render(&engine, graph));
        let pairs: Vec<[f64; 2]> = (0..PAIRS).map(|_| [time(&relief), time(&other)]).collect();
        let ratio = median(pairs.iter().map(|[a, b]| a / b).collect());
        let [with, without] =
            [0, 1].map(|side| median(pairs.iter().map(|pair| pair[side]).collect()));
        println!("relief {with:.2} s, {name} {without:.2} s of processor: {ratio:.2}");
    }
}
