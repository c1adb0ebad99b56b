//! The mean over a pixel of columns that have steps.

use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;

/// Gives its columns as they are, averaged over each pixel in which they vary.
#[derive(Debug)]
pub(in crate::nodes) struct Average {
    /// Number of columns.
    pub(in crate::nodes) width: usize,
}

impl Kernel for Average {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("average").whole(1).whole(self.width as i64);
    }

    fn width(&self) -> usize {
        self.width
    }

    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            output.copy_from_slice(input.values);
        }
    }
}
