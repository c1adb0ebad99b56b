//! The kernel of noise: octaves of gradient noise, each filtered by the size of a sample.
//!
//! An octave whose features are finer than a sample fades to its mean. Its weight is a smoothstep of the
//! footprint, the larger of the sample's two sides in cells of the octave, from 1 at 0 to 0 at 2.2, or at
//! 1.5 for the folded forms. That is the regression of the mean over a square on the noise in its centre,
//! within 0.08 up to a footprint of 1.5. What no weight could make good stays as an error: at most 0.09 of
//! a deviation of 0.27 for the soft form, 0.11 of 0.31 for the folded ones.

use super::lattice::gradient_noise;
use super::random::Random;
use crate::field::{Block, InputColumn, Kernel};
use crate::key::KeyHasher;
use crate::node::Inputs;
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// Raised whenever a result changes.
pub(super) const VERSION: u32 = 1;

/// The shape that is given to every octave.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Soft,
    Ridged,
    Billow,
}

/// Mean size of gradient noise, measured over 200 000 points.
pub(super) const MEAN_SIZE: f32 = 0.2202;

impl Form {
    /// What an octave becomes where it is averaged away.
    fn mean(self) -> f32 {
        match self {
            Form::Soft => 0.0,
            Form::Ridged => 1.0 - 2.0 * MEAN_SIZE,
            Form::Billow => 2.0 * MEAN_SIZE - 1.0,
        }
    }

    /// The footprint from which on an octave is averaged away, in its cells.
    fn last_footprint(self) -> f32 {
        match self {
            Form::Soft => 2.2,
            Form::Ridged | Form::Billow => 1.5,
        }
    }

    #[inline(always)]
    fn apply<S: Simd>(self, noise: S::f32s) -> S::f32s {
        match self {
            Form::Soft => noise,
            Form::Ridged => noise.abs() * -2.0 + 1.0,
            Form::Billow => noise.abs() * 2.0 - 1.0,
        }
    }
}

/// One octave.
#[derive(Clone, Copy, Debug)]
struct Octave {
    /// How many times finer it is than the first.
    fineness: f32,
    /// Its share of the sum; all add up to 1.
    strength: f32,
    /// Where the lattice begins, in cells: no cut of the solid runs along a plane of lattice points.
    offset: [f32; 3],
    seed: u32,
}

/// From the position in mm to one noise or several.
#[derive(Debug)]
pub(super) struct NoiseKernel {
    /// Cells of the first octave per mm.
    scale: [f32; 3],
    octaves: Vec<Octave>,
    form: Form,
    /// 1, or 3 for a vector.
    columns: usize,
}

impl NoiseKernel {
    /// The kernel with 1 or 3 columns that the inputs describe.
    pub(super) fn new(inputs: &Inputs<'_>, random: &mut Random, columns: usize) -> NoiseKernel {
        let count = inputs.whole("octaves").unsigned_abs() as usize;
        let (gain, lacunarity) = (inputs.number("gain"), inputs.number("lacunarity"));
        let powers = |base: f64| {
            std::iter::successors(Some(1.0), move |power| Some(power * base)).take(count)
        };
        let total: f64 = powers(gain).sum();
        let octave = |(fineness, strength): (f64, f64)| Octave {
            fineness: fineness as f32,
            strength: (strength / total) as f32,
            offset: [random.share(), random.share(), random.share()],
            seed: random.bits(),
        };
        NoiseKernel {
            scale: inputs
                .vector("size")
                .to_array()
                .map(|size| (1.0 / size) as f32),
            octaves: powers(lacunarity).zip(powers(gain)).map(octave).collect(),
            form: match inputs.choice("form") {
                "ridged" => Form::Ridged,
                "billow" => Form::Billow,
                _ => Form::Soft,
            },
            columns,
        }
    }

    /// The sums of N columns' octaves at points given in cells of the first.
    #[inline(always)]
    fn sums<S: Simd, const N: usize>(
        &self,
        simd: S,
        at: [S::f32s; 3],
        footprint: S::f32s,
    ) -> [S::f32s; N] {
        let mean = self.form.mean();
        let share = footprint * (1.0 / self.form.last_footprint());
        let mut sums = [S::f32s::splat(simd, mean); N];
        for octave in &self.octaves {
            let weight = weight::<S>(share * octave.fineness);
            if weight.simd_gt(0.0).any_true() {
                let at = [
                    at[0] * octave.fineness + octave.offset[0],
                    at[1] * octave.fineness + octave.offset[1],
                    at[2] * octave.fineness + octave.offset[2],
                ];
                let noises = gradient_noise::<S, N>(simd, at, octave.seed);
                for (sum, noise) in sums.iter_mut().zip(noises) {
                    *sum += (self.form.apply::<S>(noise) - mean) * weight * octave.strength;
                }
            }
        }
        sums
    }
}

/// What is left of an octave, given its footprint as a share of the last one.
#[inline(always)]
fn weight<S: Simd>(share: S::f32s) -> S::f32s {
    let t = share.min_precise(1.0);
    t * t * (t * 2.0 - 3.0) + 1.0
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

    fn reads_spread(&self, _: usize) -> bool {
        true
    }

    fn nanoseconds(&self) -> f32 {
        1.0 + (3.0 + self.columns as f32) * self.octaves.len() as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let position = [block.inputs[0], block.inputs[1], block.inputs[2]];
        let outputs = &mut *block.outputs;
        if self.columns == 1 {
            dispatch!(block.level, simd => evaluate_block::<_, 1>(simd, self, position, outputs));
        } else {
            dispatch!(block.level, simd => evaluate_block::<_, 3>(simd, self, position, outputs));
        }
    }
}

#[simd]
fn evaluate_block<S: Simd, const N: usize>(
    simd: S,
    kernel: &NoiseKernel,
    position: [InputColumn<'_>; 3],
    outputs: &mut [Vec<f32>],
) {
    let length = position[0].values.len();
    for start in (0..length).step_by(S::f32s::LEN) {
        let range = start..start + S::f32s::LEN;
        let mut at = [S::f32s::splat(simd, 0.0); 3];
        let mut squares = [S::f32s::splat(simd, 0.0); 2];
        for axis in 0..3 {
            let scale = kernel.scale[axis];
            at[axis] = S::f32s::from_slice(simd, &position[axis].values[range.clone()]) * scale;
            for (square, spread) in squares.iter_mut().zip(position[axis].spread) {
                let spread = S::f32s::from_slice(simd, &spread[range.clone()]) * scale;
                *square += spread * spread;
            }
        }
        let footprint = squares[0].max_precise(squares[1]).sqrt();
        let sums = kernel.sums::<S, N>(simd, at, footprint);
        for (sum, output) in sums.into_iter().zip(outputs.iter_mut()) {
            sum.store_slice(&mut output[range.clone()]);
        }
    }
}
