//! What a pixel takes from noise: the variance that it has within the pixel, from the size of the pixel alone.

use super::filter::lost;
use super::form::VARIANCE;
use super::octaves::NoiseKernel;
use crate::field::{Block, InputColumn, Kernel};
use crate::key::KeyHasher;
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// The variance within pixels of the columns of noise that is not folded, from the same inputs.
#[derive(Debug)]
pub(super) struct Lost(pub(super) NoiseKernel);

impl Kernel for Lost {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("lost");
        self.0.add_to_key(key);
    }

    fn width(&self) -> usize {
        self.0.columns
    }

    fn reads_spread(&self, column: usize) -> bool {
        column < 3
    }

    fn nanoseconds(&self) -> f32 {
        1.0 + 0.5 * self.0.octaves.len() as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let (columns, outputs) = (block.inputs, &mut *block.outputs);
        dispatch!(block.level, simd => write_lost(simd, &self.0, columns, outputs));
    }
}

#[simd]
fn write_lost<S: Simd>(
    simd: S,
    kernel: &NoiseKernel,
    columns: &[InputColumn<'_>],
    outputs: &mut [Vec<f32>],
) {
    for start in (0..columns[0].values.len()).step_by(S::f32s::LEN) {
        let squares = kernel.squares::<S>(simd, columns, start);
        let mut sum = S::f32s::splat(simd, 0.0);
        for octave in &kernel.octaves {
            let [fine, strong] = [octave.fineness, octave.strength].map(|it| it * it);
            sum += lost::<S>(simd, squares.map(|side| side * fine)) * (VARIANCE * strong);
        }
        for output in outputs.iter_mut() {
            sum.store_slice(&mut output[start..start + S::f32s::LEN]);
        }
    }
}
