//! Arithmetic of recipes (`"= 0.03 * look.position"`) as fields.

use super::Cancel;
use crate::field::{Block, Field, InputColumn, Kernel, Sampling, lost_of_sum};
use crate::graph::{Arithmetic, Function, Link, Operator};
use crate::key::KeyHasher;
use std::sync::Arc;

/// The field of an expression whose links `field_of` resolves, on behalf of `node`; `None` if the run was
/// cancelled.
pub(super) fn field(
    node: &Arc<str>,
    arithmetic: &Arithmetic,
    field_of: &dyn Fn(&Link) -> Field,
    cancel: &Cancel,
) -> Option<Field> {
    if cancel.is_cancelled() {
        return None;
    }
    let operand = |inner: &Arithmetic| field(node, inner, field_of, cancel);
    Some(match arithmetic {
        Arithmetic::Number(number) => Field::constant(*number),
        Arithmetic::Link(link) => field_of(link),
        Arithmetic::Negate(inner) => apply(node, Operation::Negate, vec![operand(inner)?]),
        Arithmetic::Binary(operator, sides) => {
            let sides: Option<Vec<Field>> = sides.iter().map(operand).collect();
            apply(node, Operation::Binary(*operator), sides?)
        }
        Arithmetic::Call(function, arguments) => {
            let arguments: Option<Vec<Field>> = arguments.iter().map(operand).collect();
            apply(node, Operation::Call(*function), arguments?)
        }
    })
}

fn apply(node: &Arc<str>, operation: Operation, operands: Vec<Field>) -> Field {
    let varying = operands
        .iter()
        .filter(|operand| operand.as_constant().is_none())
        .count();
    Field::kernel(node, Arc::new(Apply { operation, varying }), operands)
}

#[derive(Clone, Copy, Debug)]
enum Operation {
    Negate,
    Binary(Operator),
    Call(Function),
}

/// One operation on columns.
#[derive(Debug)]
struct Apply {
    operation: Operation,
    /// Number of operands that are not the same everywhere.
    varying: usize,
}

impl Kernel for Apply {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("arithmetic").whole(1);
        match self.operation {
            Operation::Negate => key.text("negate"),
            Operation::Binary(operator) => key.text("binary").whole(operator as i64),
            Operation::Call(function) => key.text("call").whole(function as i64),
        };
    }

    fn width(&self) -> usize {
        1
    }

    fn sampling(&self) -> Sampling {
        match self.operation {
            Operation::Negate
            | Operation::Binary(Operator::Add | Operator::Subtract)
            | Operation::Call(Function::Luminance) => Sampling::Filtered,
            // The mean of a product is the product of the means only if one side does not vary.
            Operation::Binary(Operator::Multiply) | Operation::Call(Function::Mix)
                if self.varying < 2 =>
            {
                Sampling::Filtered
            }
            Operation::Binary(Operator::Multiply | Operator::Divide) | Operation::Call(_) => {
                Sampling::Supersampled
            }
        }
    }

    fn lost(&self, node: &Arc<str>, inputs: &[Field]) -> Option<Field> {
        let one = Field::constant(1.0);
        match (self.operation, inputs) {
            (Operation::Negate, [a]) => a.lost().cloned(),
            (Operation::Binary(Operator::Add | Operator::Subtract), [a, b]) => {
                lost_of_sum(node, &[(one.clone(), a), (one, b)])
            }
            (Operation::Binary(Operator::Multiply), [a, b]) => {
                lost_of_sum(node, &[(b.clone(), a), (a.clone(), b)])
            }
            (Operation::Binary(Operator::Divide), [a, b]) if a.lost().is_some() => {
                let factor = apply(node, self.operation, vec![one, b.clone()]);
                lost_of_sum(node, &[(factor, a)])
            }
            _ => None,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let Block {
            inputs, outputs, ..
        } = block;
        let output = &mut outputs[0];
        match self.operation {
            Operation::Negate => one(output, inputs, |a| -a),
            Operation::Binary(Operator::Add) => two(output, inputs, |a, b| a + b),
            Operation::Binary(Operator::Subtract) => two(output, inputs, |a, b| a - b),
            Operation::Binary(Operator::Multiply) => two(output, inputs, |a, b| a * b),
            Operation::Binary(Operator::Divide) => two(output, inputs, |a, b| a / b),
            Operation::Call(Function::Min) => two(output, inputs, |a, b| if a < b { a } else { b }),
            Operation::Call(Function::Max) => two(output, inputs, |a, b| if a > b { a } else { b }),
            Operation::Call(Function::Abs) => one(output, inputs, f32::abs),
            Operation::Call(Function::Sqrt) => {
                one(output, inputs, |a| if a > 0.0 { a.sqrt() } else { 0.0 });
            }
            Operation::Call(Function::Clamp) => three(output, inputs, |a, low, high| {
                let raised = if a > low { a } else { low };
                if raised < high { raised } else { high }
            }),
            Operation::Call(Function::Mix) => {
                three(output, inputs, |a, b, amount| a + amount * (b - a));
            }
            Operation::Call(Function::Luminance) => {
                three(output, inputs, |r, g, b| {
                    crate::colour::luminance([r, g, b])
                });
            }
        }
    }
}

fn one(output: &mut [f32], inputs: &[InputColumn<'_>], f: impl Fn(f32) -> f32) {
    for (output, a) in output.iter_mut().zip(inputs[0].values) {
        *output = f(*a);
    }
}

fn two(output: &mut [f32], inputs: &[InputColumn<'_>], f: impl Fn(f32, f32) -> f32) {
    for ((output, a), b) in output
        .iter_mut()
        .zip(inputs[0].values)
        .zip(inputs[1].values)
    {
        *output = f(*a, *b);
    }
}

fn three(output: &mut [f32], inputs: &[InputColumn<'_>], f: impl Fn(f32, f32, f32) -> f32) {
    let columns = inputs[0]
        .values
        .iter()
        .zip(inputs[1].values)
        .zip(inputs[2].values);
    for (output, ((a, b), c)) in output.iter_mut().zip(columns) {
        *output = f(*a, *b, *c);
    }
}
