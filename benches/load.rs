//! Long recipes: reading and checking them, planning them with all keys, and rendering them.
//!
//! `cargo bench --bench load` prints milliseconds of CPU, medians of five runs.

#[path = "support/clock.rs"]
mod clock;

use clock::{median, seconds};
use std::fmt::Write;
use std::hint::black_box;
use std::path::PathBuf;
use std::sync::Arc;
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Graph, Settings, load_text};
use yosegi::world::Memory;

/// A chain of mixes, each of which reads the one before, and a picture of the last.
fn chain(length: usize) -> String {
    let mut text =
        "(nodes: { \"n0\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: 0.5),\n".to_owned();
    for index in 1..length {
        let before = index - 1;
        writeln!(
            text,
            "\"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: 0.5),"
        )
        .expect("a string takes everything");
    }
    let last = length - 1;
    text + &format!(
        "\"wood\": material(base_color: \"n{last}\"),
        \"board\": slice_cut(of: \"wood\", cut: quarter_sawn, origin: (0, 0, 0), size: (10, 10)), }},
        outputs: {{ \"picture\": maps(of: \"board\", pixels: (8, 8), channels: [base_color]) }})"
    )
}

fn load(text: &str) -> Graph {
    match load_text("recipe.ron", text, &Settings::default()) {
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
    black_box(engine.render(&request).expect("the chain can be rendered"));
}

fn engine(files: &Memory) -> Engine {
    let options = Options {
        threads: Some(1),
        memory: 0,
        store: Some(PathBuf::from("store")),
        ..Options::default()
    };
    Engine::new(Arc::new(files.clone()), options).expect("there is a thread")
}

/// Prints the median of five runs in milliseconds, each on an engine of its own.
fn report(name: &str, engine: impl Fn() -> Engine, work: impl Fn(&Engine)) {
    let run = |_| {
        let engine = engine();
        1e3 * seconds(&mut || work(&engine))
    };
    let runs = (0..5).map(run).collect();
    println!("{name:<64} {:>9.1}", median(runs));
}

fn main() {
    println!("milliseconds of CPU, medians of 5\n");
    for length in [10_000, 100_000] {
        let text = chain(length);
        let empty = || engine(&Memory::default());
        let name = |what: &str| format!("{length} nodes: {what}");
        report(&name("parse and check"), empty, |_| {
            black_box(load(&text));
        });
        let files = Memory::default();
        render(&engine(&files), &load(&text));
        // The plan's keys say that the map is in place, so nothing else runs.
        let full = || engine(&files);
        let edit = |engine: &Engine| render(engine, &load(&text));
        report(&name("parse, check, plan and keys"), full, edit);
        report(&name("parse, check and render 8 x 8 pixels"), empty, edit);
    }
}
