//! Which of several materials a cell has.

use super::KIND;
use crate::field::{Alternatives, Block, Kernel, Sampling};
use crate::key::KeyHasher;

/// Rounds a number to one of the materials. The second column, the cell's index, is where it may change.
#[derive(Debug)]
pub(super) struct Chosen {
    /// The number of the last material.
    pub(super) last: usize,
}

impl Kernel for Chosen {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("chosen material")
            .whole(i64::from(KIND.version))
            .whole(self.last as i64);
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let last = self.last as f32;
        for (output, number) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = (number + 0.5).floor().clamp(0.0, last);
        }
    }
}

/// Draws one of the materials by a random number from 0 to 1.
#[derive(Debug)]
pub(super) struct Drawn {
    /// The numbers below which each of the materials but the last are drawn.
    below: Vec<f32>,
}

impl Drawn {
    /// By weights; `None` if none is above 0.
    pub(super) fn new(weights: &[f64]) -> Option<Drawn> {
        let total: f64 = weights.iter().sum();
        let mut sum = 0.0;
        let below = weights.iter().map(|weight| {
            sum += weight;
            (sum / total) as f32
        });
        let below = below.take(weights.len() - 1).collect();
        (total > 0.0).then_some(Drawn { below })
    }
}

impl Kernel for Drawn {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("drawn material").whole(i64::from(KIND.version));
        self.below.iter().for_each(|limit| {
            key.number(f64::from(*limit));
        });
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, random) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = self.below.iter().filter(|limit| *random >= **limit).count() as f32;
        }
    }
}

/// Takes the columns of the chosen material. Columns in: index of the cell, choice, and those of each material.
#[derive(Debug)]
pub(super) struct Pick {
    /// Columns of each material.
    pub(super) width: usize,
    /// Number of materials.
    pub(super) count: usize,
}

impl Kernel for Pick {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("picked material")
            .whole(i64::from(KIND.version))
            .whole(self.width as i64);
    }

    fn width(&self) -> usize {
        self.width
    }

    fn sampling(&self) -> Sampling {
        // Where another cell begins within the pixel.
        Sampling::FilteredWhereEven {
            column: 0,
            absolute: 0.5,
        }
    }

    fn alternatives(&self) -> Option<Alternatives> {
        Some(Alternatives {
            choice: 1,
            first: 2,
            width: self.width,
        })
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let choice = block.inputs[1].values;
        for (part, output) in block.outputs.iter_mut().enumerate() {
            for (index, output) in output.iter_mut().enumerate() {
                let chosen = (choice[index] as usize).min(self.count - 1);
                *output = block.inputs[2 + chosen * self.width + part].values[index];
            }
        }
    }
}
