//! What filtering has taken from a field: how far its values vary within a pixel of which it shows the mean.
//!
//! The mean of a function that is not straight is not the function of the mean. A kernel that bends what it reads, and does
//! not divide pixels, can do with the variance: see Heitz, Nowrouzezahrai, Poulin & Neyret 2013, who average colours over
//! the values that noise has within a pixel.

use super::{Block, Field, Kernel};
use crate::key::KeyHasher;
use std::sync::Arc;

impl Field {
    /// The variance, in each column, of the values within a pixel whose mean this field is, as far as it is known to have
    /// been averaged away: that of noise, and of sums and multiples of it. `None` where nothing is known of.
    pub fn lost(&self) -> Option<&Field> {
        self.0.lost.as_ref()
    }

    /// A part of the position, and a width in mm: pixels that are wider hold details of this field that are not filtered,
    /// and are divided. That of the first kernel on the way to it which says so by [`Kernel::widest`].
    pub fn widest(&self) -> Option<&(Field, f32)> {
        self.0.widest.as_ref()
    }
}

/// What [`Field::widest`] is of a kernel's columns.
pub(super) fn widest_of(kernel: &dyn Kernel, inputs: &[Field]) -> Option<(Field, f32)> {
    match kernel.widest() {
        Some((column, widest)) => Some((column_of(inputs, column)?, widest)),
        None => inputs.iter().find_map(|input| input.widest().cloned()),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Program, RunContext, Samples, Scratch};
    use crate::value::Domain;

    /// Gives its input, of which 0.25 is lost, and pixels wider than 3 mm are divided.
    #[derive(Debug)]
    struct Rough;

    impl Kernel for Rough {
        fn add_to_key(&self, key: &mut KeyHasher) {
            key.text("rough of a test");
        }

        fn width(&self) -> usize {
            1
        }

        fn widest(&self) -> Option<(usize, f32)> {
            Some((1, 3.0))
        }

        fn lost(&self, _: &Arc<str>, _: &[Field]) -> Option<Field> {
            Some(Field::constant(0.25))
        }

        fn evaluate(&self, block: &mut Block<'_>) {
            block.outputs[0].copy_from_slice(block.inputs[0].values);
        }
    }

    fn value(field: &Field) -> f32 {
        let program = Program::compile(std::slice::from_ref(field));
        let context = RunContext {
            level: fearless_simd::Level::baseline(),
            cache: None,
            filtering: true,
            cancel: None,
        };
        let mut scratch = Scratch::default();
        program.run(&Samples::Points(&[[5.0, 7.0, 0.0]]), &mut scratch, &context);
        program.output(&scratch, 0, 0)[0]
    }

    #[test]
    fn variances_add_up_by_squares_of_factors() {
        let node: Arc<str> = "test".into();
        let place = Field::position(Domain::Plane);
        let rough = Field::kernel(&node, Arc::new(Rough), vec![place.clone()]);
        let factor = |number| Field::constant(number);
        let terms = [
            (factor(3.0), &rough),
            (factor(-2.0), &rough),
            (factor(9.0), &place),
        ];
        let lost = lost_of_sum(&node, &terms).unwrap();
        assert_eq!(value(&lost), 0.25 * (9.0 + 4.0));
        assert!(lost_of_sum(&node, &[(factor(1.0), &place)]).is_none());
    }

    #[test]
    fn what_is_known_of_pixels_goes_through_openings() {
        let node: Arc<str> = "test".into();
        let place = Field::position(Domain::Plane);
        let rough = Field::kernel(&node, Arc::new(Rough), vec![place.clone()]);
        let (y, widest) = rough.widest().unwrap();
        assert_eq!((value(y), *widest), (7.0, 3.0));
        let elsewhere = Field::constants(&[1.0, 2.0, 0.0]);
        let moved = rough.at(&elsewhere);
        assert_eq!(value(&moved.widest().unwrap().0), 2.0);
        assert_eq!(value(moved.lost().unwrap()), 0.25);
        assert!(place.lost().is_none() && place.widest().is_none());
    }
}
