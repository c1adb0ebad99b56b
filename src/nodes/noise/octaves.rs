//! The kernel of noise: octaves of gradient noise, each filtered by the size of a sample.
//!
//! An octave whose features are finer than a sample fades to its mean. With the footprint f, the larger
//! of the sample's two sides in cells of the octave, its weight is 1 up to f = 1/4, 0 from f = 1, and a
//! smoothstep between: the share of the noise at the centre of a square that its mean keeps, within 0.1.

use super::lattice::gradient_noise;
use super::random::Random;
use crate::field::{Block, Field, InputColumn, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Input, Inputs, Output};
use crate::value::{Domain, Type, Unit, Value};
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// Raised whenever a result changes.
pub(super) const VERSION: u32 = 1;

/// Where the maths of the noise kinds comes from.
pub(super) const SOURCE: &str =
    "Perlin 2002 (gradients and fade); Musgrave 1994 (octaves, ridges); fading: own construction";

/// The inputs of the noise kinds.
pub(super) const INPUTS: &[Input] = &[
    Input::new(
        "size",
        Type::Vector(Unit::Millimetre),
        "Size of the features along x, y and z: a large part stretches them.",
    )
    .range(1e-4, 1e6),
    Input::new(
        "octaves",
        Type::Whole,
        "Layers of noise, each finer than the one before.",
    )
    .default("1")
    .range(1.0, 16.0),
    Input::number(
        "gain",
        Unit::One,
        "Strength of each octave relative to the one before.",
    )
    .default("0.5")
    .range(0.0, 1.0),
    Input::number(
        "lacunarity",
        Unit::One,
        "How many times finer each octave is.",
    )
    .default("2")
    .range(1.0, 8.0),
    Input::new(
        "form",
        Type::Choice(&["fbm", "ridged", "billow"]),
        "Soft around 0, sharp crests at 1, or round bumps between creases at -1.",
    )
    .default("fbm"),
    Input::new(
        "seed",
        Type::Whole,
        "Another number gives other noise; so does the recipe's seed.",
    )
    .default("0"),
];

/// The outputs of the noise kinds, on one domain.
pub(super) const fn outputs(domain: Domain) -> [Output; 2] {
    [
        Output::field(
            "value",
            Type::Number(Unit::One),
            "Between -1 and 1, for `fbm` mostly within 0.5 of its mean 0.",
        )
        .on(domain),
        Output::field(
            "vector",
            Type::Vector(Unit::One),
            "Three values that have nothing to do with each other, nor with `value`.",
        )
        .on(domain),
    ]
}

/// The outputs of a noise node called `kind` whose points lie in `domain`.
pub(super) fn build(
    kind: &str,
    domain: Domain,
    inputs: &Inputs<'_>,
    build: &Build<'_>,
) -> Vec<Value> {
    let mut random = Random::new(build.seed, kind, inputs.whole("seed"));
    let mut columns = |count| {
        let kernel = NoiseKernel::new(inputs, &mut random, count);
        Value::Field(build.kernel(kernel, vec![Field::position(domain)]))
    };
    vec![columns(1), columns(3)]
}

/// The shape that is given to every octave.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Soft,
    Ridged,
    Billow,
}

/// Mean size of gradient noise, measured over a million cells.
pub(super) const MEAN_SIZE: f32 = 0.2122;

impl Form {
    /// What an octave becomes where it is averaged away.
    fn mean(self) -> f32 {
        match self {
            Form::Soft => 0.0,
            Form::Ridged => 1.0 - 2.0 * MEAN_SIZE,
            Form::Billow => 2.0 * MEAN_SIZE - 1.0,
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

/// One octave of one column.
#[derive(Clone, Copy, Debug)]
struct Layer {
    /// Where the lattice begins, in cells: no cut of the solid runs along a plane of lattice points.
    offset: [f32; 3],
    seed: u32,
}

/// From the position in mm to one noise or several.
#[derive(Debug)]
pub(super) struct NoiseKernel {
    /// Cells of the first octave per mm.
    scale: [f32; 3],
    /// For every octave its fineness relative to the first, and its strength; these add up to 1.
    octaves: Vec<[f32; 2]>,
    form: Form,
    /// For every column its octaves.
    columns: Vec<Vec<Layer>>,
}

impl NoiseKernel {
    fn new(inputs: &Inputs<'_>, random: &mut Random, columns: usize) -> NoiseKernel {
        let count = inputs.whole("octaves").unsigned_abs() as usize;
        let (gain, lacunarity) = (inputs.number("gain"), inputs.number("lacunarity"));
        let powers = |base: f64| {
            std::iter::successors(Some(1.0), move |power| Some(power * base)).take(count)
        };
        let total: f64 = powers(gain).sum();
        let mut layer = || Layer {
            offset: [random.share(), random.share(), random.share()],
            seed: random.bits(),
        };
        NoiseKernel {
            scale: inputs
                .vector("size")
                .to_array()
                .map(|size| (1.0 / size) as f32),
            octaves: powers(lacunarity)
                .zip(powers(gain))
                .map(|(fineness, strength)| [fineness as f32, (strength / total) as f32])
                .collect(),
            form: match inputs.choice("form") {
                "ridged" => Form::Ridged,
                "billow" => Form::Billow,
                _ => Form::Soft,
            },
            columns: (0..columns)
                .map(|_| (0..count).map(|_| layer()).collect())
                .collect(),
        }
    }

    /// The sum of a column's octaves at points given in cells of the first.
    #[inline(always)]
    fn sum<S: Simd>(
        &self,
        simd: S,
        layers: &[Layer],
        at: [S::f32s; 3],
        footprint: S::f32s,
    ) -> S::f32s {
        let mean = self.form.mean();
        let mut sum = S::f32s::splat(simd, 0.0);
        for (layer, [fineness, strength]) in layers.iter().zip(&self.octaves) {
            let weight = weight::<S>(footprint * *fineness);
            if weight.simd_gt(0.0).any_true() {
                let at = [
                    at[0] * *fineness + layer.offset[0],
                    at[1] * *fineness + layer.offset[1],
                    at[2] * *fineness + layer.offset[2],
                ];
                let noise = self.form.apply::<S>(gradient_noise(simd, at, layer.seed));
                sum += (noise - mean) * weight * *strength;
            }
        }
        sum + mean
    }
}

/// What is left of an octave when it is averaged over a footprint.
#[inline(always)]
fn weight<S: Simd>(footprint: S::f32s) -> S::f32s {
    let t = ((footprint - 0.25) * (1.0 / 0.75))
        .max_precise(0.0)
        .min_precise(1.0);
    t * t * (t * 2.0 - 3.0) + 1.0
}

impl Kernel for NoiseKernel {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("noise").whole(i64::from(VERSION));
        key.whole(self.form as i64)
            .whole(self.columns.len() as i64)
            .whole(self.octaves.len() as i64);
        let numbers = self.scale.iter().chain(self.octaves.iter().flatten());
        numbers.for_each(|number| {
            key.number(f64::from(*number));
        });
        for layer in self.columns.iter().flatten() {
            key.whole(i64::from(layer.seed));
            layer.offset.iter().for_each(|offset| {
                key.number(f64::from(*offset));
            });
        }
    }

    fn width(&self) -> usize {
        self.columns.len()
    }

    fn reads_spread(&self, _: usize) -> bool {
        true
    }

    fn nanoseconds(&self) -> f32 {
        1.0 + 6.0 * (self.columns.len() * self.octaves.len()) as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let position = [block.inputs[0], block.inputs[1], block.inputs[2]];
        let outputs = &mut *block.outputs;
        dispatch!(block.level, simd => evaluate_block(simd, self, position, outputs));
    }
}

#[simd]
fn evaluate_block<S: Simd>(
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
            for side in 0..2 {
                let spread = &position[axis].spread[side][range.clone()];
                let spread = S::f32s::from_slice(simd, spread) * scale;
                squares[side] += spread * spread;
            }
        }
        let footprint = squares[0].max_precise(squares[1]).sqrt();
        for (layers, output) in kernel.columns.iter().zip(outputs.iter_mut()) {
            let sum = kernel.sum(simd, layers, at, footprint);
            sum.store_slice(&mut output[range.clone()]);
        }
    }
}
