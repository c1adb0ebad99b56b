//! Voronoi cells of a million seeds against a plain walk over the triangulation of `spade`, and seeds in awkward places
//! against random ones.
//!
//! `cargo bench --bench partition` prints seconds of processor time over all threads, and ratios, which are medians of
//! pairs measured one right after the other.

#[path = "support/clock.rs"]
mod clock;
#[path = "../tests/support/node.rs"]
mod node;

use clock::{median, seconds};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};
use std::hint::black_box;
use yosegi::nodes::partition::voronoi_split::KIND;
use yosegi::value::Value;

const SEEDS: usize = 1_000_000;
const PAIRS: usize = 7;

fn main() {
    let random = anywhere();
    let inputs = inputs(&random, "size");
    println!(
        "cells of {SEEDS} seeds, a plain walk that stores their vertices and neighbours, and the ratio (< 1.3)"
    );
    let (ours, plain, ratio) = compare(&mut || cells(&inputs), &mut || walk(&random));
    println!("{ours:>8.3} s {plain:>8.3} s {ratio:>8.2}");
    for ground in ["size", "period"] {
        println!("\nagainst random seeds, in a {ground} (< 2)");
        let inputs = self::inputs(&random, ground);
        for (name, place) in PLACES {
            let seeds: Vec<[f64; 2]> = (0..SEEDS).map(|seed| place(seed, &random)).collect();
            let awkward = self::inputs(&seeds, ground);
            let (first, _, ratio) = compare(&mut || cells(&awkward), &mut || cells(&inputs));
            println!("{name:<28} {first:>8.3} s {ratio:>8.2}");
        }
    }
}

/// Where awkward seeds are.
type Place = fn(usize, &[[f64; 2]]) -> [f64; 2];

const PLACES: [(&str, Place); 9] = [
    ("on a line", |seed, _| [share(seed), 0.3]),
    ("on a slanting line", |seed, _| {
        [share(seed), 0.37 * share(seed)]
    }),
    ("on a line, one beside it", |seed, _| {
        [share(seed), if seed == 0 { 0.9 } else { 0.3 }]
    }),
    ("on two lines", |seed, _| {
        [share(seed), 0.5 * (seed % 2) as f64]
    }),
    ("on a circle", |seed, _| circle(seed)),
    ("on a circle, one inside", |seed, _| {
        if seed == 0 { [0.5; 2] } else { circle(seed) }
    }),
    ("on a grid", |seed, _| {
        [seed % 1000, seed / 1000].map(|it| (it as f64 + 0.5) / 1000.0)
    }),
    ("all equal", |_, _| [0.3, 0.4]),
    ("each twice", |seed, random| random[seed / 2]),
];

fn share(seed: usize) -> f64 {
    (seed as f64 + 0.5) / SEEDS as f64
}

fn circle(seed: usize) -> [f64; 2] {
    let (sin, cos) = (std::f64::consts::TAU * share(seed)).sin_cos();
    [0.5 + 0.4 * cos, 0.5 + 0.4 * sin]
}

/// Random seeds (splitmix64).
fn anywhere() -> Vec<[f64; 2]> {
    let mut state = 1_u64;
    let mut number = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..SEEDS).map(|_| [number(), number()]).collect()
}

fn inputs(seeds: &[[f64; 2]], ground: &'static str) -> Vec<Option<Value>> {
    let points = seeds.iter().map(|seed| Value::Pair(*seed)).collect();
    let given = [
        ("seeds", Value::Choice("given")),
        ("points", Value::List(points)),
        (ground, Value::Pair([1.0, 1.0])),
        ("relax", Value::Whole(0)),
        ("merge_below", Value::Number(0.0)),
        ("seed", Value::Whole(0)),
    ];
    node::inputs(&KIND, &given)
}

/// The whole node: corners, neighbours, areas, centres, attribute.
fn cells(values: &[Option<Value>]) {
    let cells = node::built(&KIND, values, 0, None);
    black_box(cells.expect("all seeds are in the rectangle"));
}

struct Seed {
    at: Point2<f64>,
    number: u32,
}

impl HasPosition for Seed {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// What a user of `spade` would write down.
fn walk(seeds: &[[f64; 2]]) {
    let seed = |(number, [x, y]): (u32, &[f64; 2])| Seed {
        at: Point2::new(*x, *y),
        number,
    };
    let triangulation: DelaunayTriangulation<Seed> =
        DelaunayTriangulation::bulk_load((0..).zip(seeds).map(seed).collect())
            .expect("all numbers are finite");
    let (mut starts, mut corners, mut neighbours) = (vec![], vec![], vec![]);
    for face in triangulation.voronoi_faces() {
        starts.push(corners.len() as u32);
        for edge in face.adjacent_edges() {
            let position = edge.from().position();
            corners.push(position.map_or([f64::NAN; 2], |at| [at.x, at.y]));
            neighbours.push(edge.as_delaunay_edge().to().data().number);
        }
    }
    black_box((starts, corners, neighbours));
}

/// Medians of the times of both, and of their ratio.
fn compare(first: &mut dyn FnMut(), second: &mut dyn FnMut()) -> (f64, f64, f64) {
    let pairs: Vec<[f64; 2]> = (0..PAIRS)
        .map(|_| [seconds(first), seconds(second)])
        .collect();
    (
        median(pairs.iter().map(|pair| pair[0]).collect()),
        median(pairs.iter().map(|pair| pair[1]).collect()),
        median(pairs.iter().map(|[first, second]| first / second).collect()),
    )
}
