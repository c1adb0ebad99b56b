//! Runs that are cancelled: what they still do, what they leave, and how soon they end.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod loops;
mod placing;
mod reading;
mod recipes;
mod soon;

#[path = "../support/workshop.rs"]
mod workshop;

use std::path::{Path, PathBuf};
use workshop::Workshop;
use yosegi::engine::{Cancel, Event, Options, RunError};
use yosegi::world::World;

/// Two outputs that share the tree and nothing else, in 48 x 40 pixels: nine tiles of 16.
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
        "deep": maps(of: "right", pixels: (48, 40), format: exr_half),
        "pale": maps(of: "left", pixels: (48, 40)),
    },
)"##;

const MAPS: [&str; 2] = ["deep_base_color.exr", "pale_base_color.png"];

/// One thread, so that operations have an order.
fn alone() -> Options {
    Options {
        threads: Some(1),
        tile: 16,
        memory: 0,
        store: Some(PathBuf::from("store")),
        ..Options::default()
    }
}
