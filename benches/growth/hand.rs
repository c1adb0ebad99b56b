//! The same pictures by loops written by hand: row by row, nothing recomputed, nothing around them.

use super::scene::{Plane, SIZE};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};
use fearless_simd_macros::simd;
use std::hint::black_box;
use yosegi::field::Target;
use yosegi::nodes::wood::growth::{GrowingBranch, GrowthModel};

/// Samples worked off together.
const RUN: usize = 128;

/// A row with a neighbour at each side, filled up to whole runs.
pub(crate) const ROW: usize = SIZE as usize + RUN;

/// A tree laid out for columns of positions.
pub(crate) struct Tree {
    pieces: Vec<Piece>,
    /// The piece that holds the lower end of each of many equal intervals of height.
    buckets: Vec<usize>,
    buckets_per_mm: f32,
    /// Years per mm along and across the trunk.
    years: [f32; 2],
    branches: Vec<Branch>,
}

/// `(x, y) = c0 + h (c1 + h (c2 + h c3))` with `h = z - start`.
struct Piece {
    start: f32,
    end: f32,
    x: [f32; 4],
    y: [f32; 4],
}

struct Branch {
    start: [f32; 3],
    rest: [f32; 3],
    direction: [f32; 3],
    speed: f32,
    speed_time: f32,
    speed_ratio: f32,
}

impl Tree {
    pub(crate) fn new(model: &GrowthModel) -> Tree {
        let all = model
            .trunk
            .curve()
            .expect("the scene's trunk is curved")
            .pieces();
        let ends = all[1..].iter().map(|piece| piece.start as f32);
        let pieces: Vec<Piece> = all
            .iter()
            .zip(ends.chain([f32::INFINITY]))
            .map(|(piece, end)| {
                let [a, b, c, d] = piece.coefficients;
                let start = piece.start as f32;
                let [x, y] =
                    [[a.x, b.x, c.x, d.x], [a.y, b.y, c.y, d.y]].map(|c| c.map(|c| c as f32));
                Piece { start, end, x, y }
            })
            .skip(1)
            .collect();
        let top = pieces.last().map_or(1.0, |piece| piece.start);
        let buckets_per_mm = (2 * pieces.len()) as f32 / top;
        let bucket = |index: usize| {
            let height = index as f32 / buckets_per_mm;
            pieces
                .partition_point(|piece| piece.end <= height)
                .min(pieces.len() - 1)
        };
        let elongation = model.settings.elongation;
        Tree {
            buckets: (0..=2 * pieces.len()).map(bucket).collect(),
            buckets_per_mm,
            years: [elongation, model.settings.thickening].map(|speed| (1.0 / speed) as f32),
            branches: model
                .branches
                .iter()
                .map(|b| Branch::new(b, elongation))
                .collect(),
            pieces,
        }
    }

    fn piece(&self, height: f32) -> &Piece {
        let bucket = (height * self.buckets_per_mm) as usize;
        let mut index = self.buckets[bucket.min(self.buckets.len() - 1)];
        while self.pieces[index].end <= height {
            index += 1;
        }
        &self.pieces[index]
    }

    /// Writes the growth times of the row `y` from the pixel `x` on.
    pub(crate) fn write_row(
        &self,
        level: Level,
        x: f64,
        y: f64,
        rows: &mut Rows,
        times: &mut [f32],
    ) {
        let Rows {
            x: px,
            y: py,
            z: pz,
            shares,
        } = rows;
        Plane.write_row(x, y, 1.0, [px, py, pz]);
        dispatch!(level, simd => grow(simd, self, [px, py, pz], times, shares));
    }
}

impl Branch {
    fn new(branch: &GrowingBranch, elongation: f64) -> Branch {
        let coarse = branch.start.as_vec3();
        Branch {
            start: coarse.to_array(),
            rest: (branch.start - coarse.as_dvec3()).as_vec3().to_array(),
            direction: branch.direction.as_vec3().to_array(),
            speed: branch.thickening as f32,
            speed_time: (branch.thickening * branch.start_time) as f32,
            speed_ratio: (branch.thickening / elongation) as f32,
        }
    }
}

/// Columns of one row.
pub(crate) struct Rows {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    shares: Vec<f32>,
}

impl Rows {
    pub(crate) fn new(length: usize) -> Rows {
        let row = || vec![0.0; length];
        Rows {
            x: row(),
            y: row(),
            z: row(),
            shares: row(),
        }
    }
}

/// Growth times and shares of the branches of the whole picture.
pub(crate) fn times(tree: &Tree, level: Level) {
    let (mut rows, mut times) = (Rows::new(SIZE as usize), vec![0.0; SIZE as usize]);
    for y in 0..SIZE {
        tree.write_row(level, 0.5, f64::from(y) + 0.5, &mut rows, &mut times);
        black_box((&times, &rows.shares));
    }
}

#[simd]
fn grow<S: Simd>(
    simd: S,
    tree: &Tree,
    [x, y, z]: [&[f32]; 3],
    times: &mut [f32],
    shares: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let runs = times.chunks_mut(RUN).zip(shares.chunks_mut(RUN));
    for ((((x, y), z), (times, shares)), _) in x
        .chunks(RUN)
        .zip(y.chunks(RUN))
        .zip(z.chunks(RUN))
        .zip(runs)
        .zip(0..)
    {
        trunk(simd, tree, [x, y, z], times);
        shares.fill(0.0);
        for branch in &tree.branches {
            add_branch(simd, branch, [x, y, z], times, shares);
        }
        for at in (0..times.len()).step_by(lanes) {
            let sum = S::f32s::from_slice(simd, &shares[at..at + lanes]);
            let inverse = S::f32s::splat(simd, 1.0) / (sum + 1.0);
            let time = S::f32s::from_slice(simd, &times[at..at + lanes]);
            (time * inverse.sqrt()).store_slice(&mut times[at..at + lanes]);
            (sum * inverse).store_slice(&mut shares[at..at + lanes]);
        }
    }
}

#[simd]
fn trunk<S: Simd>(simd: S, tree: &Tree, [x, y, z]: [&[f32]; 3], times: &mut [f32]) {
    let lanes = S::f32s::LEN;
    let [along, across] = tree.years;
    let mut piece = tree.piece(z[0]);
    for at in (0..times.len()).step_by(lanes) {
        let height = S::f32s::from_slice(simd, &z[at..at + lanes]);
        let mut inside = height.simd_ge(piece.start) & height.simd_lt(piece.end);
        if !inside.all_true() {
            piece = tree.piece(z[at]);
            inside = height.simd_ge(piece.start) & height.simd_lt(piece.end);
        }
        let square = if inside.all_true() {
            let h = height - piece.start;
            let [c0, c1, c2, c3] = piece.x;
            let dx =
                (S::f32s::from_slice(simd, &x[at..at + lanes]) - c0) - h * (h * (h * c3 + c2) + c1);
            let [c0, c1, c2, c3] = piece.y;
            let dy =
                (S::f32s::from_slice(simd, &y[at..at + lanes]) - c0) - h * (h * (h * c3 + c2) + c1);
            dx * dx + dy * dy
        } else {
            let mut squares = [0.0; 16];
            for (lane, square) in squares[..lanes].iter_mut().enumerate() {
                let piece = tree.piece(z[at + lane]);
                let h = z[at + lane] - piece.start;
                let ([a, b, c, d], [e, f, g, i]) = (piece.x, piece.y);
                let dx = (x[at + lane] - a) - h * (h * (h * d + c) + b);
                let dy = (y[at + lane] - e) - h * (h * (h * i + g) + f);
                *square = dx * dx + dy * dy;
            }
            S::f32s::from_slice(simd, &squares[..lanes])
        };
        (height * along + square.sqrt() * across).store_slice(&mut times[at..at + lanes]);
    }
}

#[simd]
fn add_branch<S: Simd>(
    simd: S,
    branch: &Branch,
    [x, y, z]: [&[f32]; 3],
    trunk: &[f32],
    sums: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let [ux, uy, uz] = branch.direction;
    for at in (0..trunk.len()).step_by(lanes) {
        let x = S::f32s::from_slice(simd, &x[at..at + lanes]) - branch.start[0] - branch.rest[0];
        let y = S::f32s::from_slice(simd, &y[at..at + lanes]) - branch.start[1] - branch.rest[1];
        let z = S::f32s::from_slice(simd, &z[at..at + lanes]) - branch.start[2] - branch.rest[2];
        let s = x * ux + y * uy + z * uz;
        let ahead = s.simd_gt(1e-9);
        if ahead.all_false() {
            continue;
        }
        let (fx, fy, fz) = (x - s * ux, y - s * uy, z - s * uz);
        let across2 = fx * fx + fy * fy + fz * fz;
        let across = (across2 * (across2 + s * s)).sqrt();
        let time = s * (s * branch.speed_ratio + branch.speed_time) + across;
        let trunk = S::f32s::from_slice(simd, &trunk[at..at + lanes]);
        let ratio = ahead.select(trunk * (s * branch.speed) / time, S::f32s::splat(simd, 0.0));
        let sum = S::f32s::from_slice(simd, &sums[at..at + lanes]);
        (sum + ratio * ratio).store_slice(&mut sums[at..at + lanes]);
    }
}
