//! Stones on cells made by hand: the figures of the paper, and what stones must do wherever they lie.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "../support/quads.rs"]
mod quads;

use std::sync::Arc;
use yosegi::engine::{Engine, Options};
use yosegi::graph::{Settings, load_text_with};
use yosegi::node::Kind;
use yosegi::nodes::KINDS;
use yosegi::world::Memory;

/// The values of an output of stones on 6 x 6 quads of 100 mm at points in mm.
fn sampled(cells: &str, stones: &str, output: &str, points: &[[f64; 3]]) -> Vec<f32> {
    let nodes = format!(r#""cells": quads({cells}), "stones": stones(cells: "cells", {stones})"#);
    sampled_of(&nodes, output, points)
}

/// The values of an output of the node `stones` among some nodes.
fn sampled_of(nodes: &str, output: &str, points: &[[f64; 3]]) -> Vec<f32> {
    let kinds: Vec<&'static Kind> = KINDS.iter().copied().chain([&quads::QUADS]).collect();
    let recipe = format!("(nodes: {{ {nodes} }})");
    let graph = load_text_with(&kinds, "stones.ron", &recipe, &Settings::default())
        .unwrap_or_else(|wrong| panic!("{}", yosegi::diagnostics::render_all(&wrong)))
        .graph;
    let engine = Engine::new(Arc::new(Memory::default()), Options::default()).unwrap();
    let name = format!("stones.{output}");
    let fields = engine.fields(&graph, &name, &|_| {}).unwrap();
    engine.sample(&fields, points)[0][0].clone()
}

const CELLS: &str = "columns: 6, rows: 6, jitter: 0.1";

/// A point each 4 mm of the square that the cells cover.
fn lattice() -> Vec<[f64; 3]> {
    let points = (0..150).flat_map(|y| (0..150).map(move |x| (x, y)));
    points
        .map(|(x, y)| [4.0 * f64::from(x) + 1.3, 4.0 * f64::from(y) + 0.7, 0.0])
        .collect()
}

/// The share of the square that stones cover.
fn covered(stones: &str) -> f64 {
    let mask = sampled(CELLS, stones, "mask", &lattice());
    mask.iter().map(|value| f64::from(*value)).sum::<f64>() / mask.len() as f64
}

#[test]
fn round_stones_are_smaller_than_those_with_corners_and_these_than_prisms() {
    let [round, corner, prism] =
        ["round", "corner", "prism"].map(|stone| covered(&format!("stone: {stone}")));
    assert!(
        0.3 < round && round < corner && corner < prism && prism < 0.95,
        "{round} {corner} {prism}"
    );
    // The nearer the vertices are to the corners, the squarer is the stone.
    let [blunt, sharp] =
        [0.4, 0.1].map(|ratio| covered(&format!("stone: corner, corner_ratio: {ratio}")));
    assert!(blunt < sharp, "{blunt} {sharp}");
    // Swollen ones fill their cells better.
    assert!(covered("stone: round, swell: 1") > round + 0.1);
}

/// Shares of the corners of a triangle add up to 1 but for rounding.
fn are_100(heights: &[f32]) {
    for height in heights {
        assert!((height - 100.0).abs() < 1e-4, "{height}");
    }
}

#[test]
fn stones_that_are_not_deformed_are_flat() {
    let dressed = "stone: prism, deformation: 0, unevenness: 0, tilt: 0, height: 100";
    for height in sampled(CELLS, dressed, "height", &lattice()) {
        assert!(
            height == 0.0 || (height - 100.0).abs() < 1e-4 || height < 100.0,
            "{height}"
        );
    }
    let middle = [[50.0, 50.0, 0.0], [350.0, 250.0, 0.0]];
    are_100(&sampled(CELLS, dressed, "height", &middle));
    let deformed = "stone: prism, deformation: 20, unevenness: 0, tilt: 0, height: 100";
    let heights = sampled(CELLS, deformed, "height", &lattice());
    let highest = heights.iter().copied().fold(0.0, f32::max);
    assert!((105.0..=120.0).contains(&highest), "{highest}");
}

#[test]
fn joints_are_as_wide_as_they_are_said_to_be() {
    let straight = "columns: 6, rows: 6, jitter: 0";
    let stones = "joint: 10, joint_variation: 0, deformation: 0, unevenness: 0, tilt: 0, crown: 0, rounding: 2, corner_radius: 0";
    // Across the joint at x = 200.
    let points = [194.9, 195.1, 200.0, 204.9, 205.1].map(|x| [x, 150.0, 0.0]);
    assert_eq!(
        sampled(straight, stones, "mask", &points),
        [1.0, 0.0, 0.0, 0.0, 1.0]
    );
    let edges = sampled(straight, stones, "edge", &points);
    for (edge, expected) in edges.iter().zip([0.1, -0.1, -5.0, -0.1, 0.1]) {
        assert!((edge - expected).abs() < 1e-3, "{edge}, not {expected}");
    }
}

#[test]
fn the_higher_of_stone_and_bed_is_seen() {
    let stones = "unevenness: 0, tilt: 0, height: 100";
    let heights = sampled(CELLS, &format!("{stones}, bed: 90"), "height", &lattice());
    assert!(heights.iter().all(|height| *height >= 90.0));
    let buried = sampled(CELLS, &format!("{stones}, bed: 120"), "stone", &lattice());
    assert!(buried.iter().all(|id| *id == 0.0));
    let ids = sampled(
        CELLS,
        stones,
        "stone",
        &[[50.0, 50.0, 0.0], [550.0, 550.0, 0.0]],
    );
    assert_eq!(ids, [1.0, 36.0]);
}

#[test]
fn ground_that_rises_lifts_and_leans_stones() {
    let nodes = r#""cells": quads(jitter: 0), "place": position(),
        "stones": stones(cells: "cells", deformation: 0, unevenness: 0, tilt: 0, crown: 0, settle: "= 0.1 * place.u")"#;
    let found = sampled_of(nodes, "height", &[[150.0, 50.0, 0.0], [160.0, 50.0, 0.0]]);
    assert!(
        (found[0] - 115.0).abs() < 0.01 && (found[1] - 116.0).abs() < 0.01,
        "{found:?}"
    );
}

#[test]
fn worn_stones_are_flatter_and_chips_take_from_the_rim() {
    let stones = "stone: round, deformation: 0, unevenness: 0, tilt: 0, swell: 1";
    let highest = |more: &str| {
        let heights = sampled(CELLS, &format!("{stones}{more}"), "height", &lattice());
        heights.into_iter().fold(0.0, f32::max)
    };
    assert!(highest(", wear: 1") < highest("") - 5.0);
    let whole = sampled(CELLS, "bed: 95", "mask", &lattice());
    let chipped = sampled(CELLS, "bed: 95, chips: 12", "mask", &lattice());
    let lost = whole
        .iter()
        .zip(&chipped)
        .filter(|(whole, chipped)| whole > chipped)
        .count();
    assert!(lost > 500, "{lost}");
    assert!(
        whole
            .iter()
            .zip(&chipped)
            .all(|(whole, chipped)| chipped <= whole)
    );
}

#[test]
fn repeating_cells_give_repeating_stones() {
    let cells = "columns: 6, rows: 6, jitter: 0.2, repeats: true";
    for stone in ["sett", "corner"] {
        let stones = format!("stone: {stone}, deformation: 5");
        let points: Vec<[f64; 3]> = lattice()
            .iter()
            .map(|[x, y, _]| [x.floor() + 0.25, y.floor() + 0.5, 0.0])
            .collect();
        let moved: Vec<[f64; 3]> = points
            .iter()
            .map(|[x, y, _]| [x + 600.0, y - 1200.0, 0.0])
            .collect();
        let here = sampled(cells, &stones, "height", &points);
        assert!(here == sampled(cells, &stones, "height", &moved), "{stone}");
    }
}

/// Bricks have corners of their neighbours in the middle of their edges; these are no corners of stones.
#[test]
fn corners_of_neighbours_make_no_corners() {
    let bricks = "columns: 6, rows: 6, bricks: true, size: (200, 100)";
    let stones =
        "stone: prism, deformation: 0, unevenness: 0, tilt: 0, joint: 10, joint_variation: 0";
    let points = [[100.0, 50.0, 0.0], [100.0, 5.5, 0.0], [194.0, 94.0, 0.0]];
    are_100(&sampled(bricks, stones, "height", &points));
}

#[test]
fn every_stone_has_one_record_of_the_table() {
    let optics = r##"optics: [(colour: "#ffffff"), (colour: "#000000", weight: 3), (colour: "#808080", weight: 0)]"##;
    let middles: Vec<[f64; 3]> = (0..36)
        .map(|cell| {
            [
                f64::from(cell % 6) * 100.0 + 50.0,
                f64::from(cell / 6) * 100.0 + 50.0,
                0.0,
            ]
        })
        .collect();
    let records = sampled(CELLS, optics, "optical_index", &middles);
    let black = records.iter().filter(|record| **record == 1.0).count();
    assert!((18..36).contains(&black), "{black}");
    assert!(records.iter().all(|record| *record < 2.0));
    let colours = sampled(CELLS, optics, "colour", &middles);
    assert!(
        colours
            .iter()
            .zip(&records)
            .all(|(colour, record)| *colour == 1.0 - record)
    );
}

#[test]
fn no_stone_stands_on_its_side_and_no_rim_takes_all_of_it() {
    let steep = sampled(
        "columns: 6, rows: 6",
        "height: 60, tilt: 30, joint: 4, unevenness: 0, seed: 3",
        "height",
        &lattice(),
    );
    // A quad of 100 mm that leans by 45 degrees both ways has corners 50 and 50 higher than its middle.
    assert!(steep.iter().all(|height| *height < 60.0 + 115.0));
    let round = sampled(
        "columns: 6, rows: 6",
        "height: 60, rounding: 500, tilt: 0, unevenness: 0",
        "height",
        &lattice(),
    );
    assert!(round.iter().any(|height| *height > 55.0));
}
