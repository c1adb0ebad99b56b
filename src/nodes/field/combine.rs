//! `combine`: three numbers as a colour and as a vector.

use crate::field::{Block, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

/// Makes a colour or a vector of three numbers.
pub static KIND: Kind = Kind {
    name: "combine",
    version: 1,
    about: "Makes a colour or a vector of three numbers.",
    source: "own construction: the three parts side by side",
    inputs: &[
        Input::number("x", Unit::One, "First part: red in linear light.")
            .per_point()
            .default("0"),
        Input::number("y", Unit::One, "Second part: green in linear light.")
            .per_point()
            .default("0"),
        Input::number("z", Unit::One, "Third part: blue in linear light.")
            .per_point()
            .default("0"),
    ],
    outputs: &[
        Output::field("colour", Type::Colour, "The parts as a colour."),
        Output::field("vector", Type::Vector(Unit::One), "The parts as a vector."),
    ],
    example: r#"(nodes: {
    "waves": solid_noise(size: (60, 60, 400)),
    "example": combine(x: 0.5, y: "= 0.3 + 0.1 * waves", z: 0.2),
})"#,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let parts = ["x", "y", "z"].map(|name| inputs.field(name));
    let joined = Value::Field(build.kernel(Join, parts.into()));
    Ok(vec![joined.clone(), joined])
}

/// Three columns side by side.
#[derive(Debug)]
pub(in crate::nodes) struct Join;

impl Kernel for Join {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("combine").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            output.copy_from_slice(input.values);
        }
    }
}
