//! Renders a recipe from Rust: load, make an engine, render, and see where the maps are.
//!
//! `cargo run --release --example render_from_rust [RECIPE]` takes `graphs/straight_trunk.ron` unless
//! told otherwise, and writes into a temporary folder that is gone afterwards.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use yosegi::diagnostics::render_all;
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Settings, load};
use yosegi::world::Disk;

fn main() -> Result<(), Box<dyn Error>> {
    let recipe = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("graphs/straight_trunk.ron"), PathBuf::from);

    // What `--set ring_width=2` does on the command line.
    let settings = Settings {
        set: vec![("ring_width".to_owned(), "2".to_owned())],
        ..Settings::default()
    };
    // Everything that is wrong comes at once, and prints as the command line prints it.
    let loaded = load(&Disk, &recipe, &settings).map_err(|errors| render_all(&errors))?;
    println!("{}: {}", recipe.display(), loaded.graph.about);

    // An engine is made once and kept: it holds the threads and what was computed before.
    let engine = Engine::new(Arc::new(Disk), Options::default())?;
    let folder = tempfile::tempdir()?;
    let listener = |event: Event| {
        if let Event::OutputDone { output, .. } = event {
            println!("output `{output}` is done");
        }
    };
    let maps = engine
        .render(&Render {
            graph: &loaded.graph,
            folder: folder.path().to_owned(),
            only: vec![],
            pixels: Some([160, 480]),
            listener: &listener,
            cancel: Cancel::new(),
        })
        .map_err(|error| render_all(error.diagnostics()))?;

    for map in maps {
        let bytes = std::fs::metadata(&map.path)?.len();
        println!("{}: {} ({bytes} bytes)", map.output, map.channel);
    }
    Ok(())
}
