//! The kernel of noise: octaves of gradient noise, each filtered by the size of a sample.

use super::filter::{DIVISIONS, Division, Steps, weight};
use super::form::{Form, next_strength};
use super::lattice::{BORDER, gradient_noise, variant};
use super::lost::Lost;
use crate::field::{Block, Field, InputColumn, Kernel};
use crate::key::KeyHasher;
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use std::sync::Arc;

/// Raised whenever a result changes.
pub(super) const VERSION: u32 = 2;

/// One octave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Octave {
    /// How many times finer it is than the first.
    pub(super) fineness: f32,
    /// Its share of the sum; all add up to 1.
    pub(super) strength: f32,
    /// Where the lattice begins, in cells: no cut of the solid runs along a plane of lattice points.
    pub(super) offset: [f32; 3],
    /// Cells along x, y and z until it repeats, 0 where it does not.
    pub(super) repeat: [f32; 3],
    pub(super) seed: u32,
    /// When pixels are divided.
    pub(super) steps: Steps,
}

/// From the position in mm to one noise or several.
#[derive(Clone, Debug)]
pub(super) struct NoiseKernel {
    /// Cells of the first octave per mm.
    pub(super) scale: [f32; 3],
    /// Millimetres until the noise repeats, 0 where it does not.
    pub(super) period: [f32; 3],
    pub(super) octaves: Vec<Octave>,
    pub(super) form: Form,
    /// 1, or 3 for a vector.
    pub(super) columns: usize,
}

/// A vector of samples: centres and sides of pixels, in cells of the first octave.
#[derive(Clone, Copy)]
struct Pixels<S: Simd> {
    centre: [S::f32s; 3],
    sides: [[S::f32s; 3]; 2],
    /// The squares of the sides' lengths.
    squares: [S::f32s; 2],
    /// What is added to the seeds.
    variant: S::u32s,
}

impl NoiseKernel {
    /// The sums of N columns' octaves.
    #[inline(always)]
    fn sums<S: Simd, const N: usize>(&self, simd: S, pixels: Pixels<S>) -> [S::f32s; N] {
        let mut sums = [S::f32s::splat(simd, 0.0); N];
        let mut strengths = [S::f32s::splat(simd, 1.0); N];
        for octave in &self.octaves {
            let square = octave.fineness * octave.fineness;
            let squares = [pixels.squares[0] * square, pixels.squares[1] * square];
            let first = octave.steps.0[0];
            let means = if (squares[0].simd_gt(first) | squares[1].simd_gt(first)).any_true() {
                divided::<S, N>(simd, self.form, octave, pixels, squares)
            } else {
                mean::<S, N>(simd, self.form, octave, pixels, squares, [DIVISIONS[0]; 2])
            };
            for ((sum, strength), mean) in sums.iter_mut().zip(&mut strengths).zip(means) {
                if self.form == Form::Ridged {
                    *sum += mean * *strength * octave.strength;
                    *strength = next_strength::<S>(simd, mean, *strength, squares);
                } else {
                    *sum += mean * octave.strength;
                }
            }
        }
        sums
    }

    /// The samples from `start` on, clamped to `border`. Columns: position, and the variant if it varies.
    #[inline(always)]
    fn pixels<S: Simd>(
        &self,
        simd: S,
        columns: &[InputColumn<'_>],
        start: usize,
        border: f32,
    ) -> Pixels<S> {
        let range = start..start + S::f32s::LEN;
        let zero = S::f32s::splat(simd, 0.0);
        let mut pixels = Pixels {
            centre: [zero; 3],
            sides: [[zero; 3]; 2],
            squares: [zero; 2],
            variant: match columns.get(3) {
                Some(column) => {
                    variant::<S>(S::f32s::from_slice(simd, &column.values[range.clone()]))
                }
                None => S::u32s::splat(simd, 0),
            },
        };
        for (axis, column) in columns[..3].iter().enumerate() {
            let (scale, period) = (self.scale[axis], self.period[axis]);
            let mut at = S::f32s::from_slice(simd, &column.values[range.clone()]);
            if period > 0.0 {
                // Before it is scaled, so that a period later the same bits come.
                at -= (at / period).floor() * period;
            }
            pixels.centre[axis] = (at * scale).max_precise(-border).min_precise(border);
            for (index, spread) in column.spread.iter().enumerate() {
                let side = S::f32s::from_slice(simd, &spread[range.clone()]) * scale;
                pixels.sides[index][axis] = side;
                pixels.squares[index] += side * side;
            }
        }
        pixels
    }

    /// The squares of the lengths of pixels' sides from `start` on, in cells of the first octave.
    #[inline(always)]
    pub(super) fn squares<S: Simd>(
        &self,
        simd: S,
        columns: &[InputColumn<'_>],
        start: usize,
    ) -> [S::f32s; 2] {
        let mut squares = [S::f32s::splat(simd, 0.0); 2];
        for (column, scale) in columns.iter().zip(self.scale) {
            for (square, spread) in squares.iter_mut().zip(column.spread) {
                let side = S::f32s::from_slice(simd, &spread[start..start + S::f32s::LEN]) * scale;
                *square += side * side;
            }
        }
        squares
    }

    /// The coordinate of the first octave, in cells, beyond which noise is that of the border.
    fn border(&self) -> f32 {
        let finest = self.octaves.last().map_or(1.0, |octave| octave.fineness);
        BORDER / finest - 1.0
    }
}

/// The means of an octave over pixels that are divided as each of them needs it.
#[simd]
fn divided<S: Simd, const N: usize>(
    simd: S,
    form: Form,
    octave: &Octave,
    pixels: Pixels<S>,
    squares: [S::f32s; 2],
) -> [S::f32s; N] {
    let rows = octave.steps.count::<S>(simd, squares[0]);
    let columns = octave.steps.count::<S>(simd, squares[1]);
    let mut means = [S::f32s::splat(simd, form.mean()); N];
    for division in DIVISIONS {
        let of_rows = rows.simd_eq(f32::from(division.count));
        for other in DIVISIONS {
            let chosen = of_rows & columns.simd_eq(f32::from(other.count));
            if chosen.any_true() {
                let found = mean::<S, N>(simd, form, octave, pixels, squares, [division, other]);
                for (mean, found) in means.iter_mut().zip(found) {
                    *mean = chosen.select(found, *mean);
                }
            }
        }
    }
    means
}

/// The means of an octave over pixels whose sides are divided in one way.
#[inline(always)]
fn mean<S: Simd, const N: usize>(
    simd: S,
    form: Form,
    octave: &Octave,
    pixels: Pixels<S>,
    squares: [S::f32s; 2],
    divisions: [Division; 2],
) -> [S::f32s; N] {
    let none = S::f32s::splat(simd, form.mean());
    let weight = weight::<S>(simd, squares, divisions);
    let known = weight.simd_gt(0.0);
    let mut means = [none; N];
    if !known.any_true() {
        return means;
    }
    let mut sums = [S::f32s::splat(simd, 0.0); N];
    let seed = pixels.variant ^ octave.seed;
    let [rows, columns] = divisions;
    for row in 0..rows.count {
        for column in 0..columns.count {
            let at = octave.place::<S>(pixels, [rows.point(row), columns.point(column)]);
            let noises = gradient_noise::<S, N>(simd, at, seed, octave.repeat);
            for (sum, noise) in sums.iter_mut().zip(noises) {
                *sum += form.expected::<S>(noise, weight);
            }
        }
    }
    let share = 1.0 / f32::from(rows.count * columns.count);
    for (mean, sum) in means.iter_mut().zip(sums) {
        *mean = known.select(sum * share, none);
    }
    means
}

impl Octave {
    /// The point that lies some shares of the sides beside the centre, in cells.
    #[inline(always)]
    fn place<S: Simd>(&self, pixels: Pixels<S>, shares: [f32; 2]) -> [S::f32s; 3] {
        let mut at = pixels.centre;
        for axis in 0..3 {
            for (side, share) in pixels.sides.iter().zip(shares) {
                // Most pixels are not divided.
                if share != 0.0 {
                    at[axis] += side[axis] * share;
                }
            }
            at[axis] = at[axis] * self.fineness + self.offset[axis];
        }
        at
    }
}

impl Kernel for NoiseKernel {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("noise").whole(i64::from(VERSION));
        key.whole(self.form as i64)
            .whole(self.columns as i64)
            .whole(self.octaves.len() as i64);
        let mut numbers = |numbers: &[f32]| {
            numbers.iter().for_each(|number| {
                key.number(f64::from(*number));
            });
        };
        numbers(&self.scale);
        numbers(&self.period);
        for octave in &self.octaves {
            numbers(&[octave.fineness, octave.strength]);
            numbers(&octave.offset);
        }
        self.octaves.iter().for_each(|octave| {
            key.whole(i64::from(octave.seed));
        });
    }

    fn width(&self) -> usize {
        self.columns
    }

    fn reads_spread(&self, column: usize) -> bool {
        column < 3
    }

    fn lost(&self, node: &Arc<str>, inputs: &[Field]) -> Option<Field> {
        // Of what is folded it is not known.
        (self.form == Form::Soft)
            .then(|| Field::kernel(node, Arc::new(Lost(self.clone())), inputs.to_vec()))
    }

    fn nanoseconds(&self) -> f32 {
        1.0 + (3.0 + self.columns as f32) * self.octaves.len() as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let columns = block.inputs;
        let outputs = &mut *block.outputs;
        if self.columns == 1 {
            dispatch!(block.level, simd => evaluate_block::<_, 1>(simd, self, columns, outputs));
        } else {
            dispatch!(block.level, simd => evaluate_block::<_, 3>(simd, self, columns, outputs));
        }
    }
}

#[simd]
fn evaluate_block<S: Simd, const N: usize>(
    simd: S,
    kernel: &NoiseKernel,
    columns: &[InputColumn<'_>],
    outputs: &mut [Vec<f32>],
) {
    let border = kernel.border();
    for start in (0..columns[0].values.len()).step_by(S::f32s::LEN) {
        let pixels = kernel.pixels::<S>(simd, columns, start, border);
        let sums = kernel.sums::<S, N>(simd, pixels);
        for (sum, output) in sums.into_iter().zip(outputs.iter_mut()) {
            sum.store_slice(&mut output[start..start + S::f32s::LEN]);
        }
    }
}
