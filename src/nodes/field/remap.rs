//! `remap`: a number from one range to another.
//!
//! Beyond the range the result is held, goes on straight, starts again, or runs back and forth. All but the
//! straight continuation are averaged exactly over what a pixel covers: see `profile`.

use super::profile::{Along, Ends, Piece, Profile, hermite};
use crate::field::{Block, Field, Kernel, lost_of_sum};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};
use std::sync::Arc;

/// Brings a number from one range to another.
pub static KIND: Kind = Kind {
    name: "remap",
    version: 1,
    about: "Brings a number from one range to another, straight or along an S, and says what happens beyond. \
            Averaged exactly over each pixel.",
    source: "own construction: linear interpolation; smooth: 3 t^2 - 2 t^3 (Perlin 1985)",
    inputs: &[
        Input::number(
            "value",
            Unit::One,
            "The number; of another unit by division: `\"= node.time / 1 year\"`.",
        )
        .per_point(),
        Input::new(
            "from",
            Type::Pair(Unit::One),
            "Two values that the number has; the first may be the larger.",
        )
        .default("(0, 1)")
        .range(-1e9, 1e9),
        Input::new(
            "to",
            Type::Pair(Unit::One),
            "The results there; the first may be the larger.",
        )
        .default("(0, 1)")
        .range(-1e9, 1e9),
        Input::new(
            "curve",
            Type::Choice(&["linear", "smooth"]),
            "Straight, or an S that is level at both ends.",
        )
        .default("linear"),
        Input::new(
            "beyond",
            Type::Choice(&["clamp", "extend", "repeat", "mirror"]),
            "Outside of `from`: the nearest result, straight on, from the start again, or back and forth.",
        )
        .default("clamp"),
    ],
    outputs: &[Output::field(
        "value",
        Type::Number(Unit::One),
        "The number in the other range.",
    )],
    example: r#"(nodes: {
    "place": position(),
    "example": remap(value: "= place.z / 1 mm", from: (0, 2400), to: (1, 0.2), curve: smooth),
})"#,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let ([first, last], to) = (inputs.pair("from"), inputs.pair("to"));
    if (last - first).abs() < 1e-6 * first.abs().max(last.abs()).max(1e-6) {
        let message = format!("the range is empty: {first} to {last}");
        return Err(Failure::of_input("from", message)
            .with_hint("use `threshold` for a step from one value to another"));
    }
    // A range that falls is one that rises, with its results turned round.
    let (from, to) = if first < last {
        ([first, last], to)
    } else {
        ([last, first], [to[1], to[0]])
    };
    let smooth = inputs.choice("curve") == "smooth";
    let value = inputs.field("value");
    if inputs.choice("beyond") == "extend" {
        if smooth {
            let failure = Failure::of_input("curve", "a smooth curve has no straight continuation");
            return Err(failure.with_hint("use `curve: linear`, or `beyond: clamp`"));
        }
        return Ok(vec![Value::Field(
            build.kernel(Line { from, to }, vec![value]),
        )]);
    }
    let kernel = Along {
        kind: (KIND.name, KIND.version),
        profile: profile(from, to, smooth, inputs.choice("beyond")),
    };
    Ok(vec![Value::Field(build.kernel(kernel, vec![value]))])
}

fn profile([start, end]: [f64; 2], to: [f64; 2], smooth: bool, beyond: &str) -> Profile<1> {
    let width = end - start;
    let piece = |start: f64, from: f64, to: f64| {
        let slope = if smooth { 0.0 } else { (to - from) / width };
        Piece {
            start,
            cubic: [hermite(width, from, to, [slope, slope])],
        }
    };
    let there = piece(start, to[0], to[1]);
    match beyond {
        "repeat" => Profile::new(vec![there], end, Ends::Repeat),
        "mirror" => {
            let back = piece(end, to[1], to[0]);
            Profile::new(vec![there, back], end + width, Ends::Repeat)
        }
        _ => Profile::new(vec![there], end, Ends::Stay),
    }
}

/// The straight line through two points.
#[derive(Debug)]
struct Line {
    from: [f64; 2],
    to: [f64; 2],
}

impl Line {
    fn slope(&self) -> f64 {
        (self.to[1] - self.to[0]) / (self.from[1] - self.from[0])
    }
}

impl Kernel for Line {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("remap line").whole(i64::from(KIND.version));
        self.from.iter().chain(&self.to).for_each(|part| {
            key.number(*part);
        });
    }

    fn width(&self) -> usize {
        1
    }

    fn lost(&self, node: &Arc<str>, inputs: &[Field]) -> Option<Field> {
        lost_of_sum(node, &[(Field::constant(self.slope()), &inputs[0])])
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let slope = self.slope();
        for (output, value) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = (self.to[0] + (f64::from(*value) - self.from[0]) * slope) as f32;
        }
    }
}
