//! Offsets from the axis of a trunk, for columns of positions.

use super::Axis;
use super::axis::reach;
use super::kernel::add_numbers;
use crate::geometry::spline::Piece;
use crate::key::KeyHasher;
use crate::nodes::wood::growth::Heights;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use glam::DVec3;

/// The axis, laid out for columns.
#[derive(Debug)]
pub(super) enum AxisTable {
    Curved(CurveTable),
    Straight(Vec<Line>),
}

/// The pieces of a curve, found by height.
#[derive(Debug)]
pub(super) struct CurveTable {
    heights: Heights,
    pieces: Vec<CurvePiece>,
}

/// `(x, y) = c0 + h (c1 + h (c2 + h c3))` with `h = z - start`.
#[derive(Clone, Copy, Debug)]
struct CurvePiece {
    start: f32,
    x: [f32; 4],
    y: [f32; 4],
}

/// A straight piece from node to node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    start: [f32; 3],
    whole: [f32; 3],
    /// 1 / the square of the length.
    inverse_square: f32,
    /// Between which shares of the length feet are.
    reach: [f32; 2],
}

impl Axis {
    /// Adds what tells it from others to a key.
    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        match self {
            Axis::Curved(curve) => {
                key.text("curved");
                for piece in curve.pieces() {
                    key.number(piece.start);
                    piece
                        .coefficients
                        .iter()
                        .for_each(|part| add_numbers(key, &part.to_array()));
                }
            }
            Axis::Straight(nodes) => {
                key.text("straight");
                nodes
                    .iter()
                    .for_each(|node| add_numbers(key, &node.to_array()));
            }
        }
    }
}

impl AxisTable {
    pub(super) fn new(axis: &Axis) -> AxisTable {
        match axis {
            Axis::Straight(nodes) => {
                let ends = nodes.windows(2).enumerate();
                let line = |(index, ends)| Line::new(ends, reach(index, nodes.len() - 1));
                AxisTable::Straight(ends.map(line).collect())
            }
            Axis::Curved(curve) => {
                let nodes: Vec<f32> = curve.nodes().iter().map(|node| node.z as f32).collect();
                let starts = std::iter::once(&nodes[0]).chain(&nodes);
                let pieces = curve.pieces();
                AxisTable::Curved(CurveTable {
                    pieces: pieces
                        .iter()
                        .zip(starts)
                        .map(|(p, z)| CurvePiece::new(p, *z))
                        .collect(),
                    heights: Heights::new(&nodes),
                })
            }
        }
    }

    /// Writes the offsets from the feet in x and y, and the distances from them.
    #[simd]
    pub(super) fn write_offsets<S: Simd>(
        &self,
        simd: S,
        position: [&[f32]; 3],
        offsets: [&mut [f32]; 3],
    ) {
        match self {
            AxisTable::Curved(table) => table.write_offsets(simd, position, offsets),
            AxisTable::Straight(lines) => nearest(simd, lines, position, offsets),
        }
    }
}

impl CurveTable {
    #[simd]
    fn write_offsets<S: Simd>(
        &self,
        simd: S,
        [x, y, z]: [&[f32]; 3],
        [dx, dy, distance]: [&mut [f32]; 3],
    ) {
        for (index, z) in z.iter().enumerate() {
            let piece = &self.pieces[self.heights.piece(*z)];
            let h = *z - piece.start;
            let along =
                |[c0, c1, c2, c3]: [f32; 4], from: f32| (from - c0) - h * (h * (h * c3 + c2) + c1);
            dx[index] = along(piece.x, x[index]);
            dy[index] = along(piece.y, y[index]);
        }
        let lanes = S::f32s::LEN;
        let offsets = dx.chunks_exact(lanes).zip(dy.chunks_exact(lanes));
        for ((dx, dy), distance) in offsets.zip(distance.chunks_exact_mut(lanes)) {
            let (dx, dy) = (S::f32s::from_slice(simd, dx), S::f32s::from_slice(simd, dy));
            (dx * dx + dy * dy).sqrt().store_slice(distance);
        }
    }
}

impl CurvePiece {
    /// Counted from the rounded height `start`, a piece is not moved by the rounding.
    fn new(piece: &Piece, start: f32) -> CurvePiece {
        let [c0, c1, c2, c3] = piece.counted_from(f64::from(start)).coefficients;
        CurvePiece {
            start,
            x: [c0.x, c1.x, c2.x, c3.x].map(|c| c as f32),
            y: [c0.y, c1.y, c2.y, c3.y].map(|c| c as f32),
        }
    }
}

impl Line {
    fn new(ends: &[DVec3], reach: [f32; 2]) -> Line {
        let whole = ends[1] - ends[0];
        Line {
            start: ends[0].as_vec3().to_array(),
            whole: whole.as_vec3().to_array(),
            inverse_square: (1.0 / whole.length_squared()) as f32,
            reach,
        }
    }
}

/// The offsets from the nearest points of all lines.
#[simd]
fn nearest<S: Simd>(
    simd: S,
    lines: &[Line],
    [x, y, z]: [&[f32]; 3],
    [dx, dy, distance]: [&mut [f32]; 3],
) {
    let lanes = S::f32s::LEN;
    let positions = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    let offsets = dx.chunks_exact_mut(lanes).zip(dy.chunks_exact_mut(lanes));
    let columns = positions.zip(offsets.zip(distance.chunks_exact_mut(lanes)));
    for (((x, y), z), ((dx, dy), distance)) in columns {
        let position = [x, y, z].map(|part| S::f32s::from_slice(simd, part));
        let mut least = S::f32s::splat(simd, f32::INFINITY);
        let mut offset = [least; 2];
        for line in lines {
            let [px, py, pz] = line.offset::<S>(position);
            let square = px * px + py * py + pz * pz;
            let is_nearer = square.simd_lt(least);
            offset = [
                is_nearer.select(px, offset[0]),
                is_nearer.select(py, offset[1]),
            ];
            least = is_nearer.select(square, least);
        }
        offset[0].store_slice(dx);
        offset[1].store_slice(dy);
        least.sqrt().store_slice(distance);
    }
}

impl Line {
    /// From the nearest point of the line to the position.
    #[inline(always)]
    fn offset<S: Simd>(&self, position: [S::f32s; 3]) -> [S::f32s; 3] {
        let [ux, uy, uz] = self.whole;
        let ([low, high], [x, y, z]) = (self.reach, position);
        let (x, y, z) = (x - self.start[0], y - self.start[1], z - self.start[2]);
        let share = ((x * ux + y * uy + z * uz) * self.inverse_square)
            .max(low)
            .min(high);
        [x - share * ux, y - share * uy, z - share * uz]
    }
}
