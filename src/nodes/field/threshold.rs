//! `threshold`: 0 below an edge, 1 above it, with a transition that is at least as wide as a pixel.
//!
//! The edge is averaged exactly over what a pixel covers, so a hard one is as wide as the pixel and no wider.

use super::profile::{Along, Ends, Piece, Profile, hermite};
use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

/// Makes a mask of a number.
pub static KIND: Kind = Kind {
    name: "threshold",
    version: 1,
    about: "Makes a mask of a number: 0 below an edge, 1 above it. Averaged exactly over each pixel, so the edge \
            is never jagged.",
    source: "own construction: Heaviside's function and its box filter",
    inputs: &[
        Input::number(
            "value",
            Unit::One,
            "The number; of another unit by division: `\"= node.time / 1 year\"`.",
        )
        .per_point(),
        Input::number("edge", Unit::One, "Where the mask turns from 0 to 1.")
            .per_point()
            .default("0.5"),
        Input::number(
            "width",
            Unit::One,
            "Width of the transition around the edge, in the number's unit; 0 is a hard edge.",
        )
        .default("0")
        .range(0.0, 1e9),
        Input::new(
            "curve",
            Type::Choice(&["linear", "smooth"]),
            "How the mask rises over `width`: straight, or as an S.",
        )
        .default("smooth"),
    ],
    outputs: &[Output::field(
        "mask",
        Type::Number(Unit::One),
        "0 below the edge, 1 above it.",
    )],
    example: r#"(nodes: {
    "clouds": solid_noise(size: (40, 40, 200)),
    "example": threshold(value: "clouds", edge: 0.1, width: 0.05),
})"#,
    build,
};

/// Narrower transitions are steps.
const STEP: f64 = 1e-9;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let difference = build.kernel(
        Difference,
        vec![inputs.field("value"), inputs.field("edge")],
    );
    let mask = Along {
        kind: (KIND.name, KIND.version),
        profile: above(inputs.number("width"), inputs.choice("curve") == "smooth"),
    };
    Ok(vec![Value::Field(build.kernel(mask, vec![difference]))])
}

/// From 0 to 1 along an S of `width` around the value 0: the mask of other kinds.
pub(in crate::nodes) fn transition(build: &Build<'_>, value: Field, width: f64) -> Field {
    let kernel = Along {
        kind: (KIND.name, KIND.version),
        profile: above(width, true),
    };
    build.kernel(kernel, vec![value])
}

/// 1 where a value is below an edge and 0 above it, averaged over each pixel.
pub(in crate::nodes) fn below(build: &Build<'_>, value: Field, edge: f64) -> Field {
    let left = build.kernel(Difference, vec![Field::constant(edge), value]);
    transition(build, left, 0.0)
}

/// The step at 0 with a transition of `width` around it.
fn above(width: f64, smooth: bool) -> Profile<1> {
    let flat = |start: f64, value: f64| Piece {
        start,
        cubic: [[value, 0.0, 0.0, 0.0]],
    };
    if width < STEP {
        return Profile::new(vec![flat(-1.0, 0.0), flat(0.0, 1.0)], 1.0, Ends::Stay);
    }
    let slope = if smooth { 0.0 } else { 1.0 / width };
    let rise = Piece {
        start: -0.5 * width,
        cubic: [hermite(width, 0.0, 1.0, [slope, slope])],
    };
    Profile::new(vec![rise], 0.5 * width, Ends::Stay)
}

/// The first column less the second.
#[derive(Debug)]
struct Difference;

impl Kernel for Difference {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("difference").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let columns = block.inputs[0].values.iter().zip(block.inputs[1].values);
        for (output, (value, edge)) in block.outputs[0].iter_mut().zip(columns) {
            *output = value - edge;
        }
    }
}
