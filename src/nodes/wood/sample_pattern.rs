//! `sample_pattern`: the colours of real wood along a line through a photograph.
//!
//! The line runs from early to late: across one year, or from the pith to the bark. Each texel is the
//! exact mean, in linear light, over its share of the line and the width of the band. Translucent pixels
//! count by their opacity. Colour profiles and orientation notes in the file are not applied: values are
//! taken as sRGB, pixels as they are stored.

mod band;
mod photograph;
mod rings;

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{AfterEnd, ColourPattern, Type, Unit, Value};
use band::Band;
use photograph::Photograph;
use std::sync::Arc;

/// A colour pattern from a photograph.
pub static KIND: Kind = Kind {
    name: "sample_pattern",
    version: 1,
    about: "Reads a colour pattern from a photograph, along a line from early to late wood. A year is \
            repeated; after the last ring of a bar the wood ends, unless `after` says otherwise.",
    source: "own construction; Momoi & Takatera 2014 sample one year's colours from wood, Larsson et al. \
             2022 a bar from pith to bark",
    inputs: &[
        Input::new(
            "file",
            Type::File,
            "The photograph: PNG, JPEG or BMP, read as sRGB.",
        ),
        Input::new(
            "from",
            Type::Pair(Unit::Pixel),
            "Start of the line, at the earliest wood.",
        )
        .optional(),
        Input::new(
            "to",
            Type::Pair(Unit::Pixel),
            "End of the line. Without both, the middle row.",
        )
        .optional(),
        Input::number(
            "band",
            Unit::Pixel,
            "Width across the line over which colours are averaged; without \
            it 1, or the whole height if there is no line either.",
        )
        .optional()
        .range(0.01, 32768.0),
        Input::new(
            "spans",
            Type::Choice(&["year", "bar"]),
            "What the line crosses: one year, or years from \
            pith to bark.",
        )
        .default("year"),
        Input::number(
            "years",
            Unit::Year,
            "Growth time that a bar covers; without it `rings`, or 1.",
        )
        .optional()
        .range(0.01, 100_000.0),
        Input::new(
            "rings",
            Type::Whole,
            "Rings to find in a bar, by their edges from dark to light; without it \
            the bar has a ring of equal width for each year.",
        )
        .optional()
        .range(1.0, 10_000.0),
        Input::new(
            "even_years",
            Type::Toggle,
            "Stretches every found ring to one equal part of the bar, so that \
            a year of growth time shows one ring.",
        )
        .default("false"),
        Input::new(
            "texels",
            Type::Whole,
            "Number of colours in the table; without it one for each pixel of \
            the line.",
        )
        .optional()
        .range(2.0, 65536.0),
        Input::new(
            "smooth",
            Type::Toggle,
            "Whether the table is interpolated between its colours.",
        )
        .default("true"),
        Input::new(
            "after",
            Type::Choice(&["repeat", "end"]),
            "What follows the last ring: the first one, or \
            nothing. Without it a year repeats and a bar ends.",
        )
        .optional(),
    ],
    outputs: &[Output::new(
        "pattern",
        Type::ColourPattern,
        "The colours along the line.",
    )],
    example: r##"(nodes: { "example": sample_pattern(file: "spruce_bar/spruce_bar.png", spans: bar, rings: 47) })"##,
    build,
};

/// Most colours that a table can have.
const MAX_TEXELS: usize = 65_536;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let bar = inputs.choice("spans") == "bar";
    let even = inputs.toggle("even_years");
    let rings = inputs
        .get("rings")
        .map(|_| inputs.whole("rings").clamp(1, 10_000) as usize);
    check_spans(inputs, bar, even)?;
    let years = match inputs.get("years") {
        Some(_) => inputs.number("years"),
        None => rings.unwrap_or(1) as f64,
    };
    let photograph = Photograph::decode(&inputs.file("file").bytes)?;
    let band = Band::read(inputs, &photograph)?;
    let starts = match rings {
        Some(rings) => band.rings(&photograph, rings, build)?,
        // A year and a half has two rings, not one and a half.
        None => equal_starts(years.round().max(1.0) as usize),
    };
    let texels = match inputs.get("texels") {
        Some(_) => inputs.whole("texels").clamp(2, MAX_TEXELS as i64) as usize,
        None => band.texels(even.then_some(starts.len())),
    };
    let border = |texel: usize| {
        let at = texel as f64 / texels as f64;
        if even { stretched(&starts, at) } else { at }
    };
    let colours = band.colours(&photograph, texels, border, build)?;
    let pattern = ColourPattern {
        colours: colours
            .into_iter()
            .map(|colour| colour.map(|part| part as f32))
            .collect(),
        years,
        ring_starts: if even {
            equal_starts(starts.len())
        } else {
            starts
        },
        after_end: after_end(inputs, bar),
        smooth: inputs.toggle("smooth"),
    };
    Ok(vec![Value::ColourPattern(Arc::new(pattern))])
}

/// A year repeats and a bar ends, unless the recipe says otherwise.
fn after_end(inputs: &Inputs<'_>, bar: bool) -> AfterEnd {
    let ends = match inputs.get("after") {
        Some(_) => inputs.choice("after") == "end",
        None => bar,
    };
    if ends {
        AfterEnd::End
    } else {
        AfterEnd::Repeat
    }
}

/// Refuses what only makes sense for a bar.
fn check_spans(inputs: &Inputs<'_>, bar: bool, even: bool) -> Result<(), Failure> {
    let given = |name: &str| inputs.get(name).is_some();
    for (name, present) in [
        ("years", given("years")),
        ("rings", given("rings")),
        ("even_years", even),
    ] {
        if present && !bar {
            let message = format!("`{name}` is for a bar, but the line spans one year");
            return Err(
                Failure::of_input(name, message).with_hint("write `spans: bar`, or leave it out")
            );
        }
    }
    if even && !given("rings") {
        let failure =
            Failure::of_input("even_years", "without `rings` there is no ring to stretch");
        return Err(failure.with_hint("say how many `rings` the bar has"));
    }
    Ok(())
}

fn equal_starts(rings: usize) -> Vec<f64> {
    (0..rings).map(|ring| ring as f64 / rings as f64).collect()
}

/// Where on the line the place `at` of a table lies whose rings are all equally wide; all from 0 to 1.
fn stretched(starts: &[f64], at: f64) -> f64 {
    let along = at * starts.len() as f64;
    let ring = (along as usize).min(starts.len() - 1);
    let end = starts.get(ring + 1).copied().unwrap_or(1.0);
    starts[ring] + (along - ring as f64) * (end - starts[ring])
}
