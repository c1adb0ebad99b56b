//! Edits in one process: what runs again after each, and what is left of runs that end early.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod edits;
mod ends;
mod faults;
mod files;
mod look;
mod progress;
mod store;
mod warnings;
mod why;

#[path = "../support/workshop.rs"]
mod workshop;

use insta::assert_snapshot;
use std::path::{Path, PathBuf};
use workshop::Workshop;
use yosegi::diagnostics::Code;
use yosegi::engine::{Cancel, Event, Options, RunError};
use yosegi::world::World;

/// 48 x 40 pixels in tiles of 16: nine tiles.
const BOARD: &str = r##"(
    nodes: {
        "tree": skeleton(
            trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)],
            branches: [(at: 590, direction: (1, 0, 0.5), thickening: 0.8)],
        ),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3, sharpness: 3),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "knots": mix(a: "look.colour", b: "#7a4524", amount: "= 0.5 * time.branch"),
        "wood": material(base_color: "knots", height: "= 0.05 * look.position"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    },
    outputs: {
        "board": maps(of: "plank", pixels: (48, 40), channels: [base_color]),
    },
)"##;

/// Two outputs that share the tree and nothing else.
const PAIR: &str = r##"(
    nodes: {
        "tree": skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3),
        "light": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "dark": colour_pattern(stops: [(at: 0, colour: "#805030"), (at: 1, colour: "#402010")]),
        "light_look": pattern_lookup(time: "time", pattern: "light"),
        "dark_look": pattern_lookup(time: "time", pattern: "dark"),
        "light_wood": material(base_color: "light_look"),
        "dark_wood": material(base_color: "dark_look"),
        "left": slice_cut(of: "light_wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
        "right": slice_cut(of: "dark_wood", cut: plain_sawn, origin: (0, 0, 600), offset: 20, size: (120, 100)),
    },
    outputs: {
        "pale": maps(of: "left", pixels: (48, 40)),
        "deep": maps(of: "right", pixels: (48, 40)),
    },
)"##;

fn options() -> Options {
    Options {
        threads: Some(2),
        tile: 16,
        memory: 64 << 20,
        ..Options::default()
    }
}

fn without_store() -> Workshop {
    Workshop::new("recipes", options())
}

fn with_store() -> Workshop {
    Workshop::new("recipes", stored())
}

fn stored() -> Options {
    Options {
        store: Some(PathBuf::from("store")),
        ..options()
    }
}

/// The recipe with one piece of its text replaced.
fn edit(recipe: &str, from: &str, to: &str) -> String {
    assert_eq!(
        recipe.matches(from).count(),
        1,
        "`{from}` is not there once"
    );
    recipe.replace(from, to)
}
