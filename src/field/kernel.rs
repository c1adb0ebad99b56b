//! What a node's maths looks like to the engine: columns in, columns out.

use super::{Alternatives, Field};
use crate::key::KeyHasher;
use fearless_simd::Level;
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

/// How a kernel deals with what happens between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// The kernel filters by the spread of its inputs, or is linear in them.
    Filtered,
    /// As `Filtered` where an input is close to linear within a sample; where it bends more than
    /// `absolute + relative * spread` (in the input's unit), the engine supersamples.
    FilteredWhereStraight {
        /// The input column that has to be straight.
        column: usize,
        /// Bend that is always allowed, in the column's unit.
        absolute: f32,
        /// Bend that is allowed for each unit of the column's spread.
        relative: f32,
    },
    /// As `Filtered` where an input hardly changes within a sample; where it changes by more than `absolute`
    /// (in the input's unit), the engine supersamples. For products of inputs that change together.
    FilteredWhereEven {
        /// The input column that has to be even.
        column: usize,
        /// Change from one sample to the next that is always allowed, in the column's unit.
        absolute: f32,
    },
    /// Not linear (threshold, choice, min): the engine supersamples every sample that varies.
    Supersampled,
}

/// The maths of a node: a pure function from columns to columns.
///
/// A kernel sees one block of samples. It owns no loop over tiles, no thread, no cache and no file.
/// Columns are padded to a multiple of 16 samples, so vector loops have no remainder.
pub trait Kernel: Send + Sync + Debug {
    /// Adds the kernel's name, version and parameters to a key: all that its results depend on
    /// besides the input columns.
    fn add_to_key(&self, key: &mut KeyHasher);

    /// Number of columns it writes.
    fn width(&self) -> usize;

    /// Whether it reads the spread of input column `column`.
    fn reads_spread(&self, column: usize) -> bool {
        let _ = column;
        false
    }

    /// Whether input column `column`, whose spread it reads, has kinks, as a distance has in the middle between two edges:
    /// within pixels the spread is there the larger of the changes to both sides, and not their mean, which may be 0.
    fn has_kinks(&self, column: usize) -> bool {
        let _ = column;
        false
    }

    /// How it deals with what happens between two samples.
    fn sampling(&self) -> Sampling {
        Sampling::Filtered
    }

    /// A column in with a part of the position, and a width in mm: where samples are supersampled and several times as wide,
    /// they are looked at the more closely. For what has details of a size that is known.
    fn widest(&self) -> Option<(usize, f32)> {
        None
    }

    /// Width and height in mm after which its columns repeat if it reads the position on a plane as it is.
    fn period(&self) -> Option<[f64; 2]> {
        None
    }

    /// Whether the mean over a supersampled pixel takes in samples of other charts: so where a picture shows what lies
    /// side by side in it, and not a piece.
    fn mixes_charts(&self) -> bool {
        false
    }

    /// The inputs of which it reads one alternative in each sample, if it has such: the others need not be computed.
    fn alternatives(&self) -> Option<Alternatives> {
        None
    }

    /// What the kernel of `node` averages away within pixels, or lets through of what was lost of its inputs, as
    /// [`Field::lost`] of its columns.
    fn lost(&self, node: &Arc<str>, inputs: &[Field]) -> Option<Field> {
        let _ = (node, inputs);
        None
    }

    /// Nanoseconds of work per sample, roughly; dear columns are worth caching.
    fn nanoseconds(&self) -> f32 {
        1.0
    }

    /// Writes the output columns of a block.
    fn evaluate(&self, block: &mut Block<'_>);
}

/// One column that a kernel reads.
#[derive(Clone, Copy, Debug)]
pub struct InputColumn<'a> {
    /// The value at every sample.
    pub values: &'a [f32],
    /// Change from one sample to the next along the picture's rows and columns; empty unless the kernel
    /// asked for it with [`Kernel::reads_spread`].
    pub spread: [&'a [f32]; 2],
}

impl<'a> InputColumn<'a> {
    /// The column for some of the samples.
    pub(super) fn part(&self, range: &Range<usize>) -> InputColumn<'a> {
        let part = |column: &'a [f32]| column.get(range.clone()).unwrap_or_default();
        InputColumn {
            values: part(self.values),
            spread: self.spread.map(part),
        }
    }
}

/// A block of samples on its way through a kernel.
pub struct Block<'a> {
    /// The vector instructions to use; results do not depend on it.
    pub level: Level,
    /// The columns of all input fields, in order; a vector counts three.
    pub inputs: &'a [InputColumn<'a>],
    /// The columns to write, each as long as the input columns.
    pub outputs: &'a mut [Vec<f32>],
}
