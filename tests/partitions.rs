//! Partitions: Voronoi cells and patterns against known values, and the laws that all of them obey.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "partitions/bent.rs"]
mod bent;
#[path = "partitions/degenerate.rs"]
mod degenerate;
#[path = "support/node.rs"]
mod node;
#[path = "partitions/patterns.rs"]
mod patterns;
#[path = "partitions/vectors.rs"]
mod vectors;
#[path = "partitions/voronoi.rs"]
mod voronoi;

use glam::DVec2;
use std::collections::BTreeMap;
use std::sync::Arc;
use yosegi::node::{Failure, Kind};
use yosegi::nodes::partition::{split_cells, voronoi_split};
use yosegi::value::{Partition, Value};

type Given = Vec<(&'static str, Value)>;

/// What a node of a kind gives.
fn built(kind: &'static Kind, given: Given) -> Result<Arc<Partition>, Failure> {
    match node::built(kind, &node::inputs(kind, &given), 0, None)?.remove(0) {
        Value::Partition(cells) => {
            assert!(cells.is_sound());
            Ok(cells)
        }
        other => panic!("found a {}", other.type_name()),
    }
}

/// The cells of `voronoi_split`.
fn split(given: Given) -> Result<Arc<Partition>, Failure> {
    let mut all: Given = vec![
        ("seeds", Value::Choice("random")),
        ("relax", Value::Whole(0)),
        ("merge_below", Value::Number(0.0)),
        ("seed", Value::Whole(0)),
    ];
    all.extend(given);
    built(&voronoi_split::KIND, all)
}

/// The cells of `split_cells`.
fn laid(pattern: &'static str, given: Given) -> Result<Arc<Partition>, Failure> {
    let mut all: Given = vec![
        ("pattern", Value::Choice(pattern)),
        ("lengths", Value::Pair([1.0, 1.0])),
        ("widths", Value::Pair([1.0, 1.0])),
        ("bond", Value::Choice("running")),
        ("slope", Value::Number(45.0)),
        ("rise", Value::Number(0.2)),
        ("position", Value::Pair([0.35, 0.65])),
        ("turn", Value::Number(0.0)),
        ("angle", Value::Number(0.0)),
        ("offset", Value::Pair([0.0, 0.0])),
        ("merge_below", Value::Number(0.0)),
        ("seed", Value::Whole(0)),
    ];
    all.extend(given);
    built(&split_cells::KIND, all)
}

/// Given seeds in a rectangle.
fn given(points: Value, size: (f64, f64)) -> Given {
    vec![
        ("seeds", Value::Choice("given")),
        ("points", points),
        ("size", Value::Pair([size.0, size.1])),
    ]
}

fn points(points: &[(f64, f64)]) -> Value {
    Value::List(points.iter().map(|(x, y)| Value::Pair([*x, *y])).collect())
}

fn outline_of(cells: &Partition, cell: usize) -> &[DVec2] {
    cells.outline(cell)
}

/// Numbers from 0 to 1 without order.
fn shuffled(index: usize) -> f64 {
    let bits = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let bits = (bits ^ (bits >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((bits ^ (bits >> 29)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Seeds without order in a rectangle.
fn anywhere(count: usize, (width, height): (f64, f64)) -> Vec<(f64, f64)> {
    let point = |index: usize| {
        (
            width * shuffled(2 * index),
            height * shuffled(2 * index + 1),
        )
    };
    (0..count).map(point).collect()
}

/// The areas add up, each edge within has one neighbour that has the same edge the other way round, bit by bit; in a plane that
/// repeats but for whole periods.
fn assert_tiles(cells: &Partition, area: f64) {
    let sum: f64 = cells.areas.iter().sum();
    assert!((sum / area - 1.0).abs() < 1e-6, "{sum} instead of {area}");
    assert!(cells.areas.iter().all(|area| *area > 0.0));
    let place = |at: DVec2| match cells.period {
        None => [at.x.to_bits(), at.y.to_bits()],
        Some(period) => {
            let within = at / period + 1e-9;
            let whole = (within - within.floor()) * 1e8;
            [whole.x.round() as u64, whole.y.round() as u64]
        }
    };
    let mut edges = BTreeMap::new();
    for cell in 0..cells.len() {
        for ring in cells.rings_of(cell) {
            for corner in ring.clone() {
                let next = if corner + 1 == ring.end {
                    ring.start
                } else {
                    corner + 1
                };
                let ends = [cells.corners[corner], cells.corners[next]].map(place);
                let before = edges.insert((ends, cell), cells.neighbours[corner]);
                assert_eq!(before, None, "cell {cell} has an edge twice");
            }
        }
    }
    for ((ends, cell), neighbour) in &edges {
        if *neighbour == Partition::NONE {
            assert!(
                cells.period.is_none(),
                "an edge without neighbour of cell {cell}"
            );
            continue;
        }
        let back = edges.get(&([ends[1], ends[0]], *neighbour as usize));
        assert_eq!(back, Some(&(*cell as u32)), "cells {cell} and {neighbour}");
    }
}
