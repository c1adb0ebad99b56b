//! `math`: functions of numbers that arithmetic in recipes does not have.
//!
//! Sine and cosine are averaged exactly over what a pixel covers where their argument is straight there: the
//! mean of sin(c + a x + b y) is sin(c) sinc(a/2) sinc(b/2) with sinc(t) = sin(t)/t. The others are
//! supersampled. Where a function has no value, it has the one stated with it, never NaN.

use crate::field::{Block, InputColumn, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

const OPERATIONS: &[&str] = &[
    "power",
    "exponential",
    "logarithm",
    "sine",
    "cosine",
    "arctangent",
    "floor",
    "modulo",
];

/// Applies a function to numbers.
pub static KIND: Kind = Kind {
    name: "math",
    version: 1,
    about: "Functions of numbers beyond arithmetic. Sine and cosine take turns: 1 is a whole turn. A negative \
            number has the power 0, and the logarithm of what is not above 1e-30 is that of 1e-30.",
    source: "own construction: elementary functions; means of sine and cosine: the box filter's transform",
    inputs: &[
        Input::new(
            "operation",
            Type::Choice(OPERATIONS),
            "a to the power b; e to the power a; natural logarithm of a; sine and cosine of a in turns; direction of \
             (b, a) in turns from -0.5 to 0.5; the whole number below a; what is left of a after whole b.",
        ),
        Input::number("a", Unit::One, "The number.").per_point(),
        Input::number(
            "b",
            Unit::One,
            "The second number of power, arctangent and modulo.",
        )
        .per_point()
        .default("1"),
    ],
    outputs: &[Output::field(
        "value",
        Type::Number(Unit::One),
        "The result.",
    )],
    example: r#"(nodes: {
    "place": position(),
    "example": math(operation: sine, a: "= place.x / 20 mm"),
})"#,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let [a, b] = ["a", "b"].map(|name| inputs.field(name));
    let operation = inputs.choice("operation");
    if operation == "modulo" && b.as_constant().is_some_and(|b| b[0] == 0.0) {
        let failure = Failure::of_input("b", "nothing is left of a number after whole zeros");
        return Err(failure.with_hint("set `b` to the length of the period"));
    }
    let field = match operation {
        "sine" => build.kernel(Wave { ahead: 0.0 }, vec![a]),
        "cosine" => build.kernel(Wave { ahead: 0.25 }, vec![a]),
        _ => build.kernel(Function(operation), vec![a, b]),
    };
    Ok(vec![Value::Field(field)])
}

/// The sine of a number of turns.
#[derive(Debug)]
struct Wave {
    /// Turns that are added.
    ahead: f64,
}

impl Wave {
    fn mean(&self, turns: f64, spread: [f64; 2]) -> f64 {
        let whole = turns - turns.floor() + self.ahead;
        let middle = libm::sin(std::f64::consts::TAU * whole);
        spread.into_iter().fold(middle, |mean, turns| {
            let half = std::f64::consts::PI * turns;
            // The first terms of the series where the quotient would lose digits.
            mean * if half.abs() < 1e-3 {
                1.0 - half * half / 6.0
            } else {
                libm::sin(half) / half
            }
        })
    }
}

impl Kernel for Wave {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("math wave")
            .whole(i64::from(KIND.version))
            .number(self.ahead);
    }

    fn width(&self) -> usize {
        1
    }

    fn reads_spread(&self, _: usize) -> bool {
        true
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereStraight {
            column: 0,
            absolute: 0.001,
            relative: 0.02,
        }
    }

    fn nanoseconds(&self) -> f32 {
        60.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let InputColumn { values, spread } = block.inputs[0];
        for (index, output) in block.outputs[0].iter_mut().enumerate() {
            let turns = f64::from(values[index]);
            let spread = spread.map(|along| f64::from(along[index]));
            let mean = self.mean(turns, spread);
            *output = if mean.is_finite() { mean as f32 } else { 0.0 };
        }
    }
}

/// A function of two numbers.
#[derive(Debug)]
struct Function(&'static str);

impl Kernel for Function {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("math").whole(i64::from(KIND.version)).text(self.0);
    }

    fn width(&self) -> usize {
        1
    }

    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn nanoseconds(&self) -> f32 {
        20.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        match self.0 {
            "power" => each(block, |a, b| libm::pow(a.max(0.0), b)),
            "exponential" => each(block, |a, _| libm::exp(a)),
            "logarithm" => each(block, |a, _| libm::log(a.max(1e-30))),
            "arctangent" => each(block, |a, b| libm::atan2(a, b) / std::f64::consts::TAU),
            "floor" => each(block, |a, _| a.floor()),
            _ => each(block, |a, b| {
                if b == 0.0 {
                    0.0
                } else {
                    a - b * (a / b).floor()
                }
            }),
        }
    }
}

/// Results too large for a column are the largest that it holds.
fn each(block: &mut Block<'_>, f: impl Fn(f64, f64) -> f64) {
    let largest = f64::from(f32::MAX);
    let columns = block.inputs[0].values.iter().zip(block.inputs[1].values);
    for (output, (a, b)) in block.outputs[0].iter_mut().zip(columns) {
        *output = f(f64::from(*a), f64::from(*b)).clamp(-largest, largest) as f32;
    }
}
