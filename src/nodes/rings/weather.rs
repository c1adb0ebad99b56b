//! `weather`: the weather of a place, month by month, from a station's file or a table.
//!
//! Two formats, told apart by their contents. **Station files** of the Met Office have columns under a line
//! `yyyy mm tmax tmin af rain sun`, with any number of lines before it, of which one may state the latitude or a
//! grid reference; see `station`. **Tables** are CSV with a header: `year`, `month`, and a temperature (a mean,
//! or the lowest and highest, whose mean is taken), rain and perhaps sunshine; or a row for each year with
//! columns `T1` to `T12` and `P1` to `P12`; see `table`.
//!
//! A climate has whole years without a gap, so the rules are:
//!
//! - rows may stand in any order; a month that comes twice is a mistake;
//! - of the years from `from` to `to`, those at the beginning and at the end that lack temperature or rain in any
//!   month are left out;
//! - a month within that lacks temperature or rain gets the mean of its calendar month over the years that are left;
//!   more than `longest_gap` such months in a row are a mistake;
//! - a month without sunshine stays without: `growth_model` gives it that of an average one;
//! - estimates (`*`), values of automatic sensors (`#`) and provisional ones are taken as they are.
//!
//! Whatever is left out, filled or estimated is told in warnings.

mod grid;
mod months;
mod place;
mod station;
mod table;

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::cells::{self, Fault};
use crate::value::{Type, Unit, Value};
use months::{Choice, Record};
use std::sync::Arc;

/// Reads weather from a file.
pub static KIND: Kind = Kind {
    name: "weather",
    version: 1,
    about: "The weather of a place month by month, from a station file of the Met Office or a CSV table. Months \
            without temperature or rain get the mean of their calendar month, with a warning.",
    source: "own construction; station files as the Met Office publishes its historic station data",
    inputs: &[
        Input::new(
            "file",
            Type::File,
            "A station file, or CSV with the columns year, month, temperature (or tmin and tmax), rain, sunshine.",
        ),
        Input::number(
            "latitude",
            Unit::Degree,
            "Latitude of the place, north positive; may be left out where the file states it.",
        )
        .optional()
        .range(-90.0, 90.0),
        Input::new("from", Type::Whole, "The first year to take.")
            .optional()
            .range(1.0, 9999.0),
        Input::new("to", Type::Whole, "The last year to take.")
            .optional()
            .range(1.0, 9999.0),
        Input::new(
            "longest_gap",
            Type::Whole,
            "Most months in a row without temperature or rain that are filled with means.",
        )
        .default("36")
        .range(0.0, 1200.0),
    ],
    outputs: &[Output::new("climate", Type::Climate, "The weather.")],
    example: "(nodes: { \"example\": weather(file: \"weather/oxforddata.txt\", to: 2020) })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let record = read(&inputs.file("file").bytes, build).map_err(of_file)?;
    let year = |name: &str| inputs.get(name).map(|_| inputs.whole(name) as i32);
    let choice = Choice {
        latitude: inputs.get("latitude").map(|_| inputs.number("latitude")),
        from: year("from"),
        to: year("to"),
        longest_gap: usize::try_from(inputs.whole("longest_gap")).unwrap_or(0),
    };
    let mut warnings = vec![];
    let climate = months::climate(record, &choice, &mut warnings)?;
    warnings
        .into_iter()
        .for_each(|warning| inputs.warn(warning));
    Ok(vec![Value::Climate(Arc::new(climate))])
}

/// What the file has, in either format.
fn read(bytes: &[u8], build: &Build<'_>) -> Result<Record, Fault> {
    let text = cells::text(bytes)?;
    match station::header_line(text) {
        Some(header) => station::read(text, header, build),
        None => table::read(bytes, text, build),
    }
}

/// A fault of the file as the node's failure.
fn of_file(fault: Fault) -> Failure {
    Failure {
        message: fault.message,
        input: Some("file"),
        item: None,
        hint: fault.hint,
    }
}
