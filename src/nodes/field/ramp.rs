//! `ramp`: colours and numbers along a number, by stops.
//!
//! Between stops the result stays, changes straight, along an S, or along a curve that is smooth through the
//! stops and never overshoots (monotone cubic). Two stops at one place make a hard edge. The mean over what
//! a pixel covers is exact: see `profile`. Colours change in linear light.

mod stops;

use super::profile::Along;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

/// Colours and numbers by stops.
pub static KIND: Kind = Kind {
    name: "ramp",
    version: 1,
    about: "Gives colours and numbers along a number, by stops. Averaged exactly over each pixel.",
    source: "own construction: piecewise cubics and their box filter; monotone: Fritsch & Carlson 1980, with the \
             slopes of Fritsch & Butland 1984",
    inputs: &[
        Input::number(
            "value",
            Unit::One,
            "The number; of another unit by division: `\"= node.time / 1 year\"`.",
        )
        .per_point(),
        Input::new(
            "stops",
            Type::List(&Type::Record(STOP)),
            "What is where, in rising order; each with a colour, a value or both, and all alike.",
        ),
        Input::new(
            "curve",
            Type::Choice(&["linear", "step", "smooth", "monotone"]),
            "Between stops: straight; as the stop before; an S; or smooth through the stops, without overshoot.",
        )
        .default("linear"),
        Input::new(
            "ends",
            Type::Choice(&["hold", "repeat"]),
            "Outside of the stops: the nearest one, or all again.",
        )
        .default("hold"),
        Input::number(
            "period",
            Unit::One,
            "With `ends: repeat`, from the first stop to its return; without it 1.",
        )
        .optional()
        .range(1e-6, 1e9),
    ],
    outputs: &[
        Output::field(
            "colour",
            Type::Colour,
            "Colour of the stops; the grey of their values if they have no colours.",
        ),
        Output::field(
            "value",
            Type::Number(Unit::One),
            "Value of the stops; the luminance of their colours if they have no values.",
        ),
    ],
    example: r##"(nodes: {
    "place": position(),
    "example": ramp(value: "= place.z / 2400 mm", curve: monotone, stops: [
        (at: 0, colour: "#5b3a1e"), (at: 0.3, colour: "#c89a62"), (at: 1, colour: "#ecd9b4"),
    ]),
})"##,
    build,
};

const STOP: &[Input] = &[
    Input::number("at", Unit::One, "Where the stop is.").range(-1e9, 1e9),
    Input::new("colour", Type::Colour, "The colour there.").optional(),
    Input::number("value", Unit::One, "The number there.")
        .optional()
        .range(-1e9, 1e9),
];

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let kernel = Along {
        kind: (KIND.name, KIND.version),
        profile: stops::profile(inputs)?,
    };
    let columns = build.kernel(kernel, vec![inputs.field("value")]);
    let part = |first, width| Value::Field(columns.part(first, width));
    Ok(vec![part(0, 3), part(3, 1)])
}
