//! Drives one engine through edits of a recipe and prints what ran for each of them.
//!
//! `cargo run --release --example drive_edits` renders a board five times: as it is, unchanged, with
//! another colour, with a comment, and with other rings. Nothing runs that the edit did not touch.

use std::error::Error;
use std::sync::Arc;
use yosegi::diagnostics::render_all;
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Settings, load_text};
use yosegi::world::Disk;

const RECIPE: &str = r##"(
    nodes: {
        "trunk": skeleton(trunk: [(0, 0, 0), (0, 0, 3000)]),
        "time": growth_field(skeleton: "trunk", elongation: 300, thickening: 4),
        "year": colour_pattern(stops: [(at: 0, colour: "#e3c08c"), (at: 1, colour: "#8f5a30")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "wood": material(base_color: "look.colour"),
        "plank": slice_cut(of: "wood", cut: plain_sawn, origin: (0, 0, 1200), offset: 30, size: (160, 480)),
    },
    outputs: { "plank": maps(of: "plank", pixels_per_mm: 2) },
)"##;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    // The store recognises maps that are in place; the memory keeps structures and columns.
    let options = Options {
        store: Some(folder.path().join("store")),
        ..Options::default()
    };
    let engine = Engine::new(Arc::new(Disk), options)?;
    let edits = [
        ("as it is", "", ""),
        ("saved again", "", ""),
        ("late wood darker", "#8f5a30", "#6f4020"),
        ("a comment", "nodes: {", "nodes: { // a plank"),
        ("wider rings", "thickening: 4", "thickening: 5"),
    ];
    let mut text = RECIPE.to_owned();
    for (name, from, to) in edits {
        if !from.is_empty() {
            text = text.replace(from, to);
        }
        println!("{name}:");
        let loaded = load_text("plank.ron", text.clone(), &Settings::default())
            .map_err(|errors| render_all(&errors))?;
        engine
            .render(&Render {
                graph: &loaded.graph,
                folder: folder.path().join("out"),
                only: vec![],
                pixels: None,
                listener: &print,
                cancel: Cancel::new(),
            })
            .map_err(|error| render_all(error.diagnostics()))?;
    }
    Ok(())
}

/// Prints an event in words; may be called from several threads at once.
fn print(event: Event) {
    match event {
        Event::StructureBuilt { node, .. } => println!("    built {node}"),
        Event::StructureReused { node, from } => println!("    had {node} in {from:?}"),
        Event::FieldTiles {
            node,
            computed,
            reused,
            ..
        } => {
            println!("    {node}: {computed} tiles computed, {reused} from memory");
        }
        Event::MapWritten {
            output, channel, ..
        } => println!("    wrote {output}, {channel}"),
        Event::MapUpToDate {
            output, channel, ..
        } => println!("    {output}, {channel}: up to date"),
        _ => {}
    }
}
