//! `vector_math`: operations on vectors.

use super::separate::Length;
use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

const OPERATIONS: &[&str] = &["add", "subtract", "multiply", "cross", "normalise"];

/// Combines vectors.
pub static KIND: Kind = Kind {
    name: "vector_math",
    version: 1,
    about: "Combines two vectors. A vector without length has itself as its direction.",
    source: "own construction: vector algebra",
    inputs: &[
        Input::new(
            "operation",
            Type::Choice(OPERATIONS),
            "The sum, the difference, the products part by part, the vector at right angles to both, or the \
             direction of `a`.",
        )
        .default("add"),
        Input::new("a", Type::Vector(Unit::One), "The first vector.").per_point(),
        Input::new("b", Type::Vector(Unit::One), "The second vector.")
            .per_point()
            .default("(0, 0, 0)"),
    ],
    outputs: &[
        Output::field("vector", Type::Vector(Unit::One), "The result."),
        Output::field("length", Type::Number(Unit::One), "Length of the result."),
        Output::field(
            "dot",
            Type::Number(Unit::One),
            "Sum of the products of the parts of `a` and `b`.",
        ),
    ],
    example: r#"(nodes: {
    "waves": solid_noise(size: (60, 60, 400)),
    "example": vector_math(operation: multiply, a: "waves.vector", b: (1, 1, 0.2)),
})"#,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let operands = ["a", "b"].map(|name| inputs.field(name));
    let both_vary = operands.iter().all(|field| field.as_constant().is_none());
    let operation = inputs.choice("operation");
    let kernel = |operation, width| VectorKernel {
        operation,
        width,
        both_vary,
    };
    let vector = build.kernel(kernel(operation, 3), operands.to_vec());
    let dot = build.kernel(kernel("dot", 1), operands.to_vec());
    let length = build.kernel(Length, vec![vector.clone()]);
    Ok([vector, length, dot].map(Value::Field).into())
}

/// Columns in: three of `a`, three of `b`.
#[derive(Debug)]
struct VectorKernel {
    operation: &'static str,
    width: usize,
    /// Products of what varies are not linear.
    both_vary: bool,
}

impl Kernel for VectorKernel {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("vector_math")
            .whole(i64::from(KIND.version))
            .text(self.operation);
    }

    fn width(&self) -> usize {
        self.width
    }

    fn sampling(&self) -> Sampling {
        match self.operation {
            "add" | "subtract" => Sampling::Filtered,
            "multiply" | "cross" | "dot" if !self.both_vary => Sampling::Filtered,
            _ => Sampling::Supersampled,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let part = |index: usize| {
            let columns: [f32; 6] = std::array::from_fn(|part| block.inputs[part].values[index]);
            let [ax, ay, az, bx, by, bz] = columns;
            ([ax, ay, az], [bx, by, bz])
        };
        for index in 0..block.inputs[0].values.len() {
            let (a, b) = part(index);
            let result = combined(self.operation, a, b);
            for (output, value) in block.outputs.iter_mut().zip(result) {
                output[index] = value;
            }
        }
    }
}

fn combined(operation: &str, a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    let each = |f: fn(f32, f32) -> f32| [0, 1, 2].map(|axis| f(a[axis], b[axis]));
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    match operation {
        "add" => each(|a, b| a + b),
        "subtract" => each(|a, b| a - b),
        "multiply" => each(|a, b| a * b),
        "cross" => [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i]),
        "dot" => [dot(a, b), 0.0, 0.0],
        _ => {
            let length = dot(a, a).sqrt();
            let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
            a.map(|part| part * scale)
        }
    }
}
