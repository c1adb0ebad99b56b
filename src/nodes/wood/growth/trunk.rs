//! Growth time by the trunk alone, for columns of positions.

use super::GrowthModel;
use fearless_simd::f32x4;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use std::ops::RangeInclusive;

/// A vector of heights in so many pieces is evaluated piece by piece, others lane by lane.
const MOST_AT_ONCE: usize = 4;

/// Most entries of the table that finds pieces by height.
const MOST_BUCKETS: usize = 1 << 16;

/// The trunk's curve, laid out to be looked up by height.
///
/// Piece i of the curve holds the heights from `bounds[i]` up to, not including, `bounds[i + 1]`.
#[derive(Debug)]
pub(super) struct TrunkTable {
    bounds: Vec<f32>,
    pieces: Vec<PieceConstants>,
    buckets: Vec<Bucket>,
    lowest: f32,
    buckets_per_millimetre: f32,
    /// Steps of the search inside a bucket.
    rounds: u32,
    years_along: f32,
    years_across: f32,
}

/// A range of heights. All buckets are equally high, and most hold one node at most.
#[derive(Clone, Copy, Debug)]
struct Bucket {
    /// The piece at its lower end.
    first: u32,
    /// Height of the next node, in this bucket or above.
    next: f32,
}

/// `(x, y) = c0 + h (c1 + h (c2 + h c3))` with `h = z - start`.
#[derive(Clone, Copy, Debug)]
struct PieceConstants {
    start: f32,
    x: [f32; 4],
    y: [f32; 4],
}

impl TrunkTable {
    pub(super) fn new(model: &GrowthModel) -> TrunkTable {
        let nodes: Vec<f32> = model
            .curve
            .nodes()
            .iter()
            .map(|node| node.z as f32)
            .collect();
        let starts = std::iter::once(&nodes[0]).chain(&nodes);
        let pieces = model.curve.pieces();
        let pieces =
            // Counted from the rounded height, no piece is moved by rounding its start.
            pieces.iter().zip(starts).map(|(piece, start)| {
                let [c0, c1, c2, c3] = piece.counted_from(f64::from(*start)).coefficients;
                PieceConstants {
                    start: *start,
                    x: [c0.x, c1.x, c2.x, c3.x].map(|c| c as f32),
                    y: [c0.y, c1.y, c2.y, c3.y].map(|c| c as f32),
                }
            });
        let pieces = pieces.collect();
        let mut table = TrunkTable {
            bounds: vec![],
            pieces,
            buckets: vec![],
            lowest: nodes[0],
            buckets_per_millimetre: 0.0,
            rounds: 0,
            years_along: (1.0 / model.settings.elongation) as f32,
            years_across: (1.0 / model.settings.thickening) as f32,
        };
        table.sort_into_buckets(&nodes);
        table
    }

    fn sort_into_buckets(&mut self, nodes: &[f32]) {
        let count = (2 * nodes.len()).min(MOST_BUCKETS);
        let length = nodes[nodes.len() - 1] - nodes[0];
        self.buckets = vec![
            Bucket {
                first: 0,
                next: f32::INFINITY
            };
            count
        ];
        self.buckets_per_millimetre = if length > 0.0 {
            (count - 1) as f32 / length
        } else {
            0.0
        };
        let mut fullest = 0;
        let (mut first, mut end) = (0, 0);
        for bucket in 0..count {
            while end < nodes.len() && self.bucket(nodes[end]) == bucket {
                end += 1;
            }
            let next = nodes.get(first).copied().unwrap_or(f32::INFINITY);
            self.buckets[bucket] = Bucket {
                first: first as u32,
                next,
            };
            fullest = fullest.max(end - first);
            first = end;
        }
        self.rounds = fullest.checked_ilog2().map_or(0, |log| log + 1);
        // The search may look this far beyond the last node.
        let beyond = std::iter::repeat_n(f32::INFINITY, 1 << self.rounds);
        self.bounds = std::iter::once(f32::NEG_INFINITY)
            .chain(nodes.iter().copied())
            .chain(beyond)
            .collect();
    }

    /// Never falls with z, whatever the rounding: that makes the search exact.
    fn bucket(&self, z: f32) -> usize {
        (((z - self.lowest) * self.buckets_per_millimetre) as usize).min(self.buckets.len() - 1)
    }

    /// The piece that holds height `z`.
    fn piece(&self, z: f32) -> usize {
        self.piece_in_bucket(z, self.bucket(z))
    }

    #[inline(always)]
    fn piece_in_bucket(&self, z: f32, bucket: usize) -> usize {
        let Bucket { first, next } = self.buckets[bucket];
        let mut piece = first as usize;
        if self.rounds <= 1 {
            return piece + usize::from(next <= z);
        }
        for round in (0..self.rounds).rev() {
            let step = 1 << round;
            piece += if self.bounds[piece + step] <= z {
                step
            } else {
                0
            };
        }
        piece
    }
}

/// Writes T_1 in years, eqs. (9)-(13).
#[simd]
pub(super) fn trunk_times<S: Simd>(
    simd: S,
    table: &TrunkTable,
    position: [&[f32]; 3],
    times: &mut [f32],
) {
    // In two passes: what one lane at a time has stored cannot be loaded as a vector at once.
    squares_across(simd, table, position, times);
    let lanes = S::f32s::LEN;
    for (z, times) in position[2]
        .chunks_exact(lanes)
        .zip(times.chunks_exact_mut(lanes))
    {
        let across = S::f32s::from_slice(simd, times).sqrt();
        let along = S::f32s::from_slice(simd, z);
        (along * table.years_along + across * table.years_across).store_slice(times);
    }
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
    let first = table.piece(z[0]);
    let mut pieces = first..=first;
    let columns = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    for (((x, y), z), squares) in columns.zip(squares.chunks_exact_mut(lanes)) {
        let height = S::f32s::from_slice(simd, z);
        if !hold(simd, table, &pieces, height) {
            let ends = [table.piece(z[0]), table.piece(z[lanes - 1])];
            pieces = ends[0].min(ends[1])..=ends[0].max(ends[1]);
        }
        if pieces.end() - pieces.start() < MOST_AT_ONCE && hold(simd, table, &pieces, height) {
            squares_in_pieces(simd, table, &pieces, [x, y], height).store_slice(squares);
        } else {
            squares_by_lane(simd, table, [x, y, z], height, squares);
        }
    }
}

/// Whether all heights are in these pieces.
#[inline(always)]
fn hold<S: Simd>(
    simd: S,
    table: &TrunkTable,
    pieces: &RangeInclusive<usize>,
    height: S::f32s,
) -> bool {
    let _ = simd;
    let above = height.simd_ge(table.bounds[*pieces.start()]);
    let below = height.simd_lt(table.bounds[*pieces.end() + 1]);
    (above & below).all_true()
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
        let inside = height.simd_ge(table.bounds[piece]);
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
    let bucket = (height - table.lowest) * table.buckets_per_millimetre;
    let last = table.buckets.len() - 1;
    let buckets: S::i32s = bucket.max(0.0).min(last as f32).to_int();
    for first in (0..S::f32s::LEN).step_by(4) {
        let four = first..first + 4;
        let mut pieces = [&table.pieces[0]; 4];
        for (lane, piece) in pieces.iter_mut().enumerate() {
            let bucket = (buckets[first + lane] as usize).min(last);
            *piece = &table.pieces[table.piece_in_bucket(z[first + lane], bucket)];
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

/// Columns from rows.
#[inline(always)]
fn transposed<S: Simd>(simd: S, [a, b, c, d]: [&[f32; 4]; 4]) -> [f32x4<S>; 4] {
    let (a, b) = (
        f32x4::load_array_ref(simd, a),
        f32x4::load_array_ref(simd, b),
    );
    let (c, d) = (
        f32x4::load_array_ref(simd, c),
        f32x4::load_array_ref(simd, d),
    );
    let (low_ac, high_ac) = (a.zip_low(c), a.zip_high(c));
    let (low_bd, high_bd) = (b.zip_low(d), b.zip_high(d));
    [
        low_ac.zip_low(low_bd),
        low_ac.zip_high(low_bd),
        high_ac.zip_low(high_bd),
        high_ac.zip_high(high_bd),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::GrowthSettings;
    use super::*;
    use crate::value::{Skeleton, Tangents};
    use glam::DVec3;

    fn table(heights: &[f64]) -> TrunkTable {
        let trunk = heights.iter().map(|z| DVec3::new(0.0, 0.0, *z)).collect();
        let skeleton = Skeleton {
            trunk,
            tangents: Tangents::Natural,
            branches: vec![],
        };
        let settings = GrowthSettings {
            elongation: 1.0,
            thickening: 1.0,
            sharpness: 2.0,
            reach: None,
        };
        TrunkTable::new(&GrowthModel::new(&skeleton, settings).unwrap())
    }

    #[test]
    fn every_height_is_found_in_its_piece_whatever_the_spacing() {
        let even: Vec<f64> = (0..1000).map(f64::from).collect();
        let crowded: Vec<f64> = (0..500)
            .map(|i| 1e-4 * f64::from(i))
            .chain([1e3, 4e3])
            .collect();
        let growing: Vec<f64> = (0..60).map(|i| libm::exp2(0.3 * f64::from(i))).collect();
        for heights in [even, crowded, growing, vec![-5.0, 5.0]] {
            let table = table(&heights);
            for node in heights.iter().map(|z| *z as f32) {
                for z in [
                    node.next_down(),
                    node,
                    node.next_up(),
                    node + 0.3,
                    node - 0.3,
                ] {
                    let expected = heights.iter().filter(|node| **node as f32 <= z).count();
                    assert_eq!(table.piece(z), expected, "z = {z}");
                }
            }
            assert_eq!(table.piece(-1e30), 0);
            assert_eq!(table.piece(1e30), heights.len());
        }
    }

    #[test]
    fn even_spacing_needs_one_step_in_a_bucket() {
        assert_eq!(
            table(&(0..10_000).map(|i| 0.4 * f64::from(i)).collect::<Vec<_>>()).rounds,
            1
        );
    }
}
