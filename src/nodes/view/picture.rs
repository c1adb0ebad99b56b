//! The kernels behind the shading: the mean over each pixel, and the tone curve.

use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;

/// Gives the first three of four columns; where the fourth shows an edge, the mean of samples within the pixel.
#[derive(Debug)]
pub(super) struct Smooth;

/// Bend of the fourth column from which on a pixel is divided: a step of 0.1 bends by an eighth of that.
const EDGE: f32 = 0.012;

impl Kernel for Smooth {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view smooth")
            .whole(i64::from(super::KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn mixes_charts(&self) -> bool {
        true
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereStraight {
            column: 3,
            absolute: EDGE,
            relative: 0.0,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            output.copy_from_slice(input.values);
        }
    }
}

/// Takes light to what a picture can show: as it is up to a shoulder, above that ever closer to white.
#[derive(Debug)]
pub(super) struct Tone;

/// Light that is shown as it is.
const SHOULDER: f32 = 0.8;

impl Kernel for Tone {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view tone").whole(i64::from(super::KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let rest = 1.0 - SHOULDER;
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            for (output, value) in output.iter_mut().zip(input.values) {
                *output = if *value <= SHOULDER {
                    *value
                } else {
                    1.0 - rest * libm::expf((SHOULDER - value) / rest)
                };
            }
        }
    }
}
