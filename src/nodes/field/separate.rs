//! `separate`: the parts of a colour or of a vector as numbers.

use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

/// Gives the parts of a colour or of a vector.
pub static KIND: Kind = Kind {
    name: "separate",
    version: 1,
    about: "Gives the three parts of a colour or of a vector as numbers, and its length.",
    source: "own construction: the parts, and the Euclidean norm",
    inputs: &[
        Input::new("colour", Type::Colour, "The colour to take apart.")
            .per_point()
            .optional(),
        Input::new(
            "vector",
            Type::Vector(Unit::One),
            "Instead of a colour: the vector to take apart.",
        )
        .per_point()
        .optional(),
    ],
    outputs: &[
        number("x", "First part: red in linear light."),
        number("y", "Second part: green in linear light."),
        number("z", "Third part: blue in linear light."),
        number("length", "Length of the vector that the parts make."),
    ],
    example: r#"(nodes: {
    "waves": solid_noise(size: (60, 60, 400)),
    "example": separate(vector: "waves.vector"),
})"#,
    build,
};

const fn number(name: &'static str, about: &'static str) -> Output {
    Output::field(name, Type::Number(Unit::One), about)
}

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let given = [
        inputs.optional_field("colour"),
        inputs.optional_field("vector"),
    ];
    let whole = match given {
        [Some(whole), None] | [None, Some(whole)] => whole,
        [None, None] => {
            let failure = Failure::new("neither `colour` nor `vector` is set");
            return Err(failure.with_hint("link one of them"));
        }
        [Some(_), Some(_)] => {
            let failure = Failure::of_input("vector", "both `colour` and `vector` are set");
            return Err(failure.with_hint("remove one of them, or use two nodes"));
        }
    };
    let part = |axis| Value::Field(whole.part(axis, 1));
    let length = Value::Field(build.kernel(Length, vec![whole.clone()]));
    Ok(vec![part(0), part(1), part(2), length])
}

/// The length of a vector.
#[derive(Debug)]
pub(super) struct Length;

impl Kernel for Length {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("length").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        1
    }

    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [x, y, z] = [0, 1, 2].map(|axis| block.inputs[axis].values);
        for (index, output) in block.outputs[0].iter_mut().enumerate() {
            *output = (x[index] * x[index] + y[index] * y[index] + z[index] * z[index]).sqrt();
        }
    }
}
