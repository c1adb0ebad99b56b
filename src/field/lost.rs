//! What filtering has taken from a field: how far its values vary within a pixel of which it shows the mean.
//!
//! The mean of a function that is not straight is not the function of the mean. A kernel that bends what it reads, and does
//! not divide pixels, can do with the variance: see Heitz, Nowrouzezahrai, Poulin & Neyret 2013, who average colours over
//! the values that noise has within a pixel.

use super::{Block, Field, Kernel, Operation, Sampling};
use crate::key::KeyHasher;
use std::sync::Arc;

impl Field {
    /// The variance, in each column, of the values within a pixel whose mean this field is, as far as it is known to have
    /// been averaged away: that of noise, and of sums and multiples of it. `None` where nothing is known of.
    pub fn lost(&self) -> Option<&Field> {
        self.0.lost.as_ref()
    }

    /// Where pixels of this field are divided because they are too wide: a part of the position and its change from one
    /// sample to the next, in mm, that is still allowed.
    pub fn divided_where(&self) -> Option<(Field, f32)> {
        let mut field = self;
        loop {
            match &field.0.operation {
                Operation::Part { of, .. } => field = of,
                Operation::Kernel { kernel, inputs, .. } => {
                    let Sampling::FilteredWhereNarrow { column, widest } = kernel.sampling() else {
                        return None;
                    };
                    return column_of(inputs, column).map(|column| (column, widest));
                }
                _ => return None,
            }
        }
    }
}

/// One of all the columns of some fields.
fn column_of(fields: &[Field], mut column: usize) -> Option<Field> {
    for field in fields {
        if column < field.width() {
            return Some(field.part(column, 1));
        }
        column -= field.width();
    }
    None
}

/// What is lost of a sum of numbers, each multiplied by a factor, on behalf of `node`. Terms are taken to vary independently
/// of each other, and factors not to vary within pixels.
pub fn lost_of_sum(node: &Arc<str>, terms: &[(Field, &Field)]) -> Option<Field> {
    let pair = |(factor, term): &(Field, &Field)| Some([factor.clone(), term.lost()?.clone()]);
    let pairs: Vec<Field> = terms.iter().filter_map(pair).flatten().collect();
    (!pairs.is_empty()).then(|| Field::kernel(node, Arc::new(SumOfVariances), pairs))
}

/// Columns in: pairs of a factor and a variance. Column out: the sum of variances by squares of factors.
#[derive(Debug)]
struct SumOfVariances;

impl Kernel for SumOfVariances {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("sum of variances").whole(1);
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let output = &mut block.outputs[0];
        output.fill(0.0);
        for pair in block.inputs.chunks_exact(2) {
            let columns = pair[0].values.iter().zip(pair[1].values);
            for (output, (factor, variance)) in output.iter_mut().zip(columns) {
                *output += factor * factor * variance;
            }
        }
    }
}
