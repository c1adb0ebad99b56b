//! `colour_pattern`: one year of wood from early to late, as colour stops.
//!
//! Colours change linearly, in linear light, from stop to stop. Before the first stop and after the last
//! one they stay. Stops at the same place make a hard edge: the first of them ends what is before, the last
//! begins what is after. A texel is the exact mean over its width.

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{AfterEnd, ColourPattern, Type, Unit, Value};
use std::sync::Arc;

/// One year of colour by stops.
pub static KIND: Kind = Kind {
    name: "colour_pattern",
    version: 1,
    about: "Makes one year of colour, from the start of earlywood to the end of latewood, out of stops. \
            Two stops at one place make a hard edge.",
    source: "own construction; the pattern is that of Momoi & Takatera 2014, there sampled from wood",
    inputs: &[
        Input::new(
            "stops",
            Type::List(&Type::Record(STOP)),
            "Colours in the order of the year.",
        ),
        Input::new("texels", Type::Whole, "Number of colours in the table.")
            .default("256")
            .range(2.0, 65536.0),
        Input::new(
            "smooth",
            Type::Toggle,
            "Whether the table is interpolated between its colours.",
        )
        .default("true"),
    ],
    outputs: &[Output::new(
        "pattern",
        Type::ColourPattern,
        "One year, repeated.",
    )],
    example: r##"(nodes: { "example": colour_pattern(stops: [
    (at: 0, colour: "#ecd0a4"), (at: 0.7, colour: "#dcb27c"), (at: 0.95, colour: "#a06c3c"),
]) })"##,
    build,
};

const STOP: &[Input] = &[
    Input::number(
        "at",
        Unit::One,
        "Position in the year: 0 start of earlywood, 1 end of latewood.",
    )
    .range(0.0, 1.0),
    Input::new("colour", Type::Colour, "The colour there."),
];

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let stops: Vec<Stop> = inputs.list("stops").iter().filter_map(Stop::read).collect();
    if stops.is_empty() {
        return Err(Failure::of_input(
            "stops",
            "expected at least one stop, found none",
        ));
    }
    for (index, pair) in stops.windows(2).enumerate() {
        if pair[1].at < pair[0].at {
            let (number, at, before) = (index + 2, pair[1].at, pair[0].at);
            let message = format!("stop {number} at {at} stands before the stop at {before}");
            return Err(Failure::of_input("stops", message).with_hint("sort the stops by `at`"));
        }
    }
    let texels = inputs.whole("texels").clamp(2, 65536) as usize;
    let pattern = ColourPattern {
        colours: table(&stops, texels),
        years: 1.0,
        ring_starts: vec![0.0],
        after_end: AfterEnd::Repeat,
        smooth: inputs.toggle("smooth"),
    };
    Ok(vec![Value::ColourPattern(Arc::new(pattern))])
}

/// A colour and its position in the year.
struct Stop {
    at: f64,
    colour: [f64; 3],
}

impl Stop {
    /// The stop that a checked record holds.
    fn read(record: &Value) -> Option<Stop> {
        let Value::Record(parts) = record else {
            return None;
        };
        let part = |name| parts.iter().find(|part| part.0 == name).map(|part| &part.1);
        match (part("at")?, part("colour")?) {
            (Value::Number(at), Value::Colour(colour)) => Some(Stop {
                at: *at,
                colour: *colour,
            }),
            _ => None,
        }
    }
}

/// The mean colours of `texels` equal parts of the year.
fn table(stops: &[Stop], texels: usize) -> Vec<[f32; 3]> {
    let sums = Sums::new(stops);
    let border = |texel: usize| sums.up_to(texel as f64 / texels as f64);
    let mean = |texel: usize| {
        let (start, end) = (border(texel), border(texel + 1));
        [0, 1, 2].map(|part| ((end[part] - start[part]) * texels as f64) as f32)
    };
    (0..texels).map(mean).collect()
}

/// The integral of the colour from the first stop to each of the others.
struct Sums<'a> {
    stops: &'a [Stop],
    sums: Vec<[f64; 3]>,
}

impl Sums<'_> {
    fn new(stops: &[Stop]) -> Sums<'_> {
        let mut sums = vec![[0.0; 3]];
        for pair in stops.windows(2) {
            let width = pair[1].at - pair[0].at;
            let last = sums[sums.len() - 1];
            sums.push([0, 1, 2].map(|part| {
                last[part] + 0.5 * width * (pair[0].colour[part] + pair[1].colour[part])
            }));
        }
        Sums { stops, sums }
    }

    /// The integral from the first stop to `x`; negative before it.
    fn up_to(&self, x: f64) -> [f64; 3] {
        let index = self.stops.partition_point(|stop| stop.at <= x).max(1) - 1;
        let stop = &self.stops[index];
        let along = x - stop.at;
        let half_slope = |part: usize| match self.stops.get(index + 1) {
            // Before the first stop the colour does not change.
            Some(next) if along >= 0.0 => {
                0.5 * (next.colour[part] - stop.colour[part]) / (next.at - stop.at)
            }
            _ => 0.0,
        };
        [0, 1, 2].map(|part| {
            self.sums[index][part] + along * (stop.colour[part] + along * half_slope(part))
        })
    }
}
