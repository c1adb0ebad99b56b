//! After how many mm of the plane a field repeats, as far as its kernels say so.

use super::{Field, Operation};
use std::collections::BTreeSet;

impl Field {
    /// Width and height in mm after which kernels that this field is made of repeat, each once: those that read the position of
    /// the sample as it is. What is evaluated elsewhere does not count.
    pub(crate) fn periods(&self) -> Vec<[f64; 2]> {
        let mut periods: Vec<[f64; 2]> = vec![];
        let mut seen = BTreeSet::new();
        let mut waiting = vec![self];
        while let Some(field) = waiting.pop() {
            if !seen.insert(field.key()) {
                continue;
            }
            match &field.0.operation {
                Operation::Constant(_) | Operation::Position | Operation::Remainder => {}
                Operation::Part { of, .. } => waiting.push(of),
                Operation::At { opening, .. } => {
                    waiting.push(&opening.position);
                    waiting.extend(opening.given.iter().map(|(_, given)| given));
                }
                Operation::Given { otherwise, .. } => waiting.push(otherwise),
                Operation::Kernel { kernel, inputs, .. } => {
                    let is_here = |input: &Field| matches!(input.0.operation, Operation::Position);
                    let period = kernel.period().filter(|_| inputs.iter().any(is_here));
                    periods.extend(period.filter(|period| !periods.contains(period)));
                    waiting.extend(inputs);
                }
            }
        }
        periods
    }
}
