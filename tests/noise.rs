//! The recipe's seed: what draws random numbers depends on it, and nothing else does.

#![allow(clippy::unwrap_used)]

use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Settings, load_text};
use yosegi::nodes::kind;
use yosegi::world::Memory;

const RECIPE: &str = r##"(
    nodes: {
        "fibre": solid_noise(size: (0.5, 0.5, 25)),
        "drawn": material(base_color: "#c8a06e", height: "= 0.1 * fibre.value"),
        "even": material(base_color: "#c8a06e"),
        "rough": slice_cut(of: "drawn", cut: quarter_sawn, origin: (0, 0, 0), size: (10, 10)),
        "smooth": slice_cut(of: "even", cut: quarter_sawn, origin: (0, 0, 0), size: (10, 10)),
    },
    outputs: {
        "rough": maps(of: "rough", pixels_per_mm: 2, channels: [height], ranges: [(channel: "height", low: -0.1, high: 0.1)]),
        "smooth": maps(of: "smooth", pixels_per_mm: 2, channels: [base_color]),
    },
)"##;

/// The outputs that an engine in `world` writes, and not only looks at.
fn written(world: &Memory, seed: u64) -> Vec<String> {
    let settings = Settings {
        seed: Some(seed),
        ..Settings::default()
    };
    let loaded = load_text("recipe.ron", RECIPE, &settings).unwrap();
    let options = Options {
        store: Some(PathBuf::from("store")),
        ..Options::default()
    };
    let engine = Engine::new(Arc::new(world.clone()), options).unwrap();
    let heard = Mutex::new(vec![]);
    let listener = |event| {
        if let Event::MapWritten { output, .. } = event {
            heard.lock().unwrap().push(output);
        }
    };
    let request = Render {
        graph: &loaded.graph,
        folder: PathBuf::from("out"),
        only: vec![],
        pixels: None,
        listener: &listener,
        cancel: Cancel::new(),
    };
    engine.render(&request).unwrap();
    let mut outputs = heard.into_inner().unwrap();
    outputs.sort();
    outputs
}

#[test]
fn another_seed_makes_only_what_draws_anew() {
    let world = Memory::default();
    assert_eq!(written(&world, 0), ["rough", "smooth"]);
    assert_eq!(written(&world, 0), [""; 0]);
    assert_eq!(written(&world, 1), ["rough"]);
}

#[test]
fn the_kinds_with_a_seed_draw() {
    let draws = |name| kind(name).unwrap().draws();
    assert!(draws("solid_noise") && draws("plane_noise"));
    assert!(!draws("distort") && !draws("growth_field"));
}
