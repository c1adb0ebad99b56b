//! Stones: the paper's case, 512 x 512 pixels with 400 stones, and up to 100,000 stones of as many pixels each.
//!
//! `cargo bench --bench pavement` prints wall time and processor time of the whole texture (height in float, colour and
//! the index of the optical table) on two threads, and processor time for each stone of 8 x 8 pixels.

#[path = "support/clock.rs"]
mod clock;
#[path = "../tests/support/quads.rs"]
mod quads;

use clock::{median, seconds};
use std::hint::black_box;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Graph, Settings, load_text_with};
use yosegi::node::Kind;
use yosegi::nodes::KINDS;
use yosegi::world::Memory;

const ROUNDS: usize = 7;

/// A texture of `side` x `side` stones in a picture of `pixels` x `pixels`.
fn recipe(stone: &str, side: u32, pixels: u32) -> Graph {
    let size = 100 * side;
    let text = format!(
        r##"(
        nodes: {{
            "cells": quads(columns: {side}, rows: {side}),
            "stones": stones(cells: "cells", stone: {stone}, deformation: 4, swell: 1, bed: 60, optics: [
                (colour: "#91968f"), (colour: "#878b86", exponent: 8), (colour: "#7a7e78", exponent: 2),
            ]),
            "texture": material(
                base_color: "stones.colour", height: "stones.height", extras: {{ "optics": "stones.optical_index" }},
            ),
        }},
        outputs: {{ "texture": maps(
            of: "texture", size: ({size}, {size}), pixels: ({pixels}, {pixels}), format: tiff_float, channels: [base_color, height, optics],
        ) }},
    )"##
    );
    let kinds: Vec<&'static Kind> = KINDS.iter().copied().chain([&quads::QUADS]).collect();
    match load_text_with(&kinds, "pavement.ron", &text, &Settings::default()) {
        Ok(loaded) => loaded.graph,
        Err(wrong) => panic!("{}", yosegi::diagnostics::render_all(&wrong)),
    }
}

fn engine() -> Engine {
    let options = Options {
        threads: Some(2),
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
    black_box(
        engine
            .render(&request)
            .expect("the texture can be rendered"),
    );
}

/// Milliseconds of wall time and of processor time.
fn milliseconds(graph: &Graph, rounds: usize) -> [f64; 2] {
    let (mut wall, mut busy) = (vec![], vec![]);
    let engine = engine();
    render(&engine, graph);
    for _ in 0..rounds {
        let start = Instant::now();
        busy.push(1e3 * seconds(&mut || render(&engine, graph)));
        wall.push(1e3 * start.elapsed().as_secs_f64());
    }
    [median(wall), median(busy)]
}

fn main() {
    for stone in ["sett", "prism", "round", "corner"] {
        let [wall, busy] = milliseconds(&recipe(stone, 20, 512), ROUNDS);
        println!(
            "{stone}: 400 stones at 512 x 512: {wall:.1} ms on two threads, {busy:.1} ms of processor"
        );
    }
    for side in [32, 100, 316] {
        let rounds = if side > 300 { 1 } else { 3 };
        let [_, busy] = milliseconds(&recipe("round", side, 8 * side), rounds);
        let stones = side * side;
        println!(
            "{stones} stones: {:.1} us of processor a stone",
            1e3 * busy / f64::from(stones)
        );
    }
}
