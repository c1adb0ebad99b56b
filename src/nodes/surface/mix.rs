//! `mix`: a colour between two colours, in linear light.
//!
//! The inputs arrive averaged over the pixel, and what is mixed are the averages: exact where only the
//! colours or only the amount change within a pixel. Amounts beyond 0 to 1 are clamped. Where the amount
//! bends within a pixel, as at the rim of a knot, the mix is supersampled.

use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

/// Mixes two colours.
pub static KIND: Kind = Kind {
    name: "mix",
    version: 1,
    about: "Mixes two colours in linear light: `a` where the amount is 0, `b` where it is 1. Amounts beyond \
            are clamped.",
    source: "own construction: linear interpolation",
    inputs: &[
        Input::new("a", Type::Colour, "Colour where the amount is 0.").per_point(),
        Input::new("b", Type::Colour, "Colour where the amount is 1.").per_point(),
        Input::number("amount", Unit::One, "Share of `b`.")
            .per_point()
            .range(0.0, 1.0),
    ],
    outputs: &[Output::field("colour", Type::Colour, "The mixed colour.")],
    example: r##"(nodes: {
        "grain": solid_noise(size: (2, 2, 60)),
        "example": mix(a: "#e8c79a", b: "#5b3a1e", amount: "= 0.25 + 0.2 * grain.value"),
    })"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let inputs = ["a", "b", "amount"].map(|name| inputs.field(name));
    Ok(vec![Value::Field(build.kernel(Mix, inputs.into()))])
}

/// The amount's column, behind those of the two colours.
const AMOUNT: usize = 6;

/// Columns in: three of `a`, three of `b`, amount.
#[derive(Debug)]
struct Mix;

impl Kernel for Mix {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("mix").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereStraight {
            column: AMOUNT,
            absolute: 0.08,
            relative: 0.0,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let amounts = block.inputs[AMOUNT].values;
        for (part, output) in block.outputs.iter_mut().enumerate() {
            let colours = block.inputs[part]
                .values
                .iter()
                .zip(block.inputs[3 + part].values);
            for ((output, (a, b)), amount) in output.iter_mut().zip(colours).zip(amounts) {
                let amount = amount.clamp(0.0, 1.0);
                // Exact at both ends, which a + (b - a) * amount is not.
                *output = a * (1.0 - amount) + b * amount;
            }
        }
    }
}
