//! Growth time by the trunk alone, for columns of positions.

use super::clock::Clock;
use super::heights::Heights;
use crate::field::transposed;
use crate::geometry::spline::{Piece, TrunkCurve};
use fearless_simd::f32x4;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use std::ops::RangeInclusive;

/// A vector of heights in so many pieces is evaluated piece by piece, others lane by lane.
const MOST_AT_ONCE: usize = 4;

/// The trunk's curve, laid out to be looked up by height.
#[derive(Debug)]
pub(super) struct TrunkTable {
    heights: Heights,
    pieces: Vec<PieceConstants>,
    clock: Clock,
}

/// `(x, y) = c0 + h (c1 + h (c2 + h c3))` with `h = z - start`.
#[derive(Clone, Copy, Debug)]
struct PieceConstants {
    start: f32,
    x: [f32; 4],
    y: [f32; 4],
}

impl TrunkTable {
    pub(super) fn nanoseconds(&self) -> f32 {
        5.0 + self.clock.nanoseconds()
    }

    pub(super) fn new(curve: &TrunkCurve, clock: Clock) -> TrunkTable {
        let nodes: Vec<f32> = curve.nodes().iter().map(|node| node.z as f32).collect();
        let starts = std::iter::once(&nodes[0]).chain(&nodes);
        let pieces = curve.pieces();
        TrunkTable {
            heights: Heights::new(&nodes),
            pieces: pieces
                .iter()
                .zip(starts)
                .map(|(p, z)| PieceConstants::new(p, *z))
                .collect(),
            clock,
        }
    }
}

impl PieceConstants {
    /// Counted from the rounded height `start`, a piece is not moved by the rounding.
    fn new(piece: &Piece, start: f32) -> PieceConstants {
        let [c0, c1, c2, c3] = piece.counted_from(f64::from(start)).coefficients;
        PieceConstants {
            start,
            x: [c0.x, c1.x, c2.x, c3.x].map(|c| c as f32),
            y: [c0.y, c1.y, c2.y, c3.y].map(|c| c as f32),
        }
    }
}

/// Writes T_1 in years, eqs. (9)-(13) or by rings.
#[simd]
pub(super) fn trunk_times<S: Simd>(
    simd: S,
    table: &TrunkTable,
    position: [&[f32]; 3],
    times: &mut [f32],
) {
    // In two passes: what one lane at a time has stored cannot be loaded as a vector at once.
    squares_across(simd, table, position, times);
    table.clock.write_times(simd, position[2], times);
}

/// Writes the squares of the distances from the curve.
#[simd]
fn squares_across<S: Simd>(
    simd: S,
    table: &TrunkTable,
    [x, y, z]: [&[f32]; 3],
    squares: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let first = table.heights.piece(z[0]);
    let mut pieces = first..=first;
    let columns = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    for (((x, y), z), squares) in columns.zip(squares.chunks_exact_mut(lanes)) {
        let height = S::f32s::from_slice(simd, z);
        if !table.heights.hold(simd, &pieces, height) {
            let ends = [table.heights.piece(z[0]), table.heights.piece(z[lanes - 1])];
            pieces = ends[0].min(ends[1])..=ends[0].max(ends[1]);
        }
        if pieces.end() - pieces.start() < MOST_AT_ONCE && table.heights.hold(simd, &pieces, height)
        {
            squares_in_pieces(simd, table, &pieces, [x, y], height).store_slice(squares);
        } else {
            squares_by_lane(simd, table, [x, y, z], height, squares);
        }
    }
}

/// The squares where all heights are in these few pieces.
#[inline(always)]
fn squares_in_pieces<S: Simd>(
    simd: S,
    table: &TrunkTable,
    pieces: &RangeInclusive<usize>,
    [x, y]: [&[f32]; 2],
    height: S::f32s,
) -> S::f32s {
    let [start, end] = [*pieces.start(), *pieces.end()];
    let mut squares = square_in_piece(simd, &table.pieces[start], x, y, height);
    for piece in start + 1..=end {
        let inside = height.simd_ge(table.heights.start(piece));
        let upper = square_in_piece(simd, &table.pieces[piece], x, y, height);
        squares = inside.select(upper, squares);
    }
    squares
}

#[inline(always)]
fn square_in_piece<S: Simd>(
    simd: S,
    piece: &PieceConstants,
    x: &[f32],
    y: &[f32],
    height: S::f32s,
) -> S::f32s {
    let h = height - piece.start;
    let [x0, x1, x2, x3] = piece.x;
    let [y0, y1, y2, y3] = piece.y;
    let dx = (S::f32s::from_slice(simd, x) - x0) - h * (h * (h * x3 + x2) + x1);
    let dy = (S::f32s::from_slice(simd, y) - y0) - h * (h * (h * y3 + y2) + y1);
    dx * dx + dy * dy
}

/// The same where every lane may be in another piece.
#[inline(always)]
fn squares_by_lane<S: Simd>(
    simd: S,
    table: &TrunkTable,
    [x, y, z]: [&[f32]; 3],
    height: S::f32s,
    squares: &mut [f32],
) {
    let buckets = table.heights.buckets(simd, height);
    for first in (0..S::f32s::LEN).step_by(4) {
        let four = first..first + 4;
        let mut pieces = [&table.pieces[0]; 4];
        for (lane, piece) in pieces.iter_mut().enumerate() {
            let index = table
                .heights
                .piece_of_lane(z[first + lane], buckets[first + lane]);
            *piece = &table.pieces[index];
        }
        let position = [&x[four.clone()], &y[four.clone()], &z[four.clone()]];
        squares_of_four(simd, pieces, position).store_slice(&mut squares[four]);
    }
}

#[inline(always)]
fn squares_of_four<S: Simd>(
    simd: S,
    [a, b, c, d]: [&PieceConstants; 4],
    [x, y, z]: [&[f32]; 3],
) -> f32x4<S> {
    let start = f32x4::load_array(simd, [a.start, b.start, c.start, d.start]);
    let h = f32x4::from_slice(simd, z) - start;
    let [x0, x1, x2, x3] = transposed(simd, [&a.x, &b.x, &c.x, &d.x]);
    let [y0, y1, y2, y3] = transposed(simd, [&a.y, &b.y, &c.y, &d.y]);
    let dx = (f32x4::from_slice(simd, x) - x0) - h * (h * (h * x3 + x2) + x1);
    let dy = (f32x4::from_slice(simd, y) - y0) - h * (h * (h * y3 + y2) + y1);
    dx * dx + dy * dy
}
