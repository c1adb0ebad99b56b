//! `ring_table`: writes a ring series as CSV, one row for each year.
//!
//! The file is called after the output: `tree.csv`. Numbers have as many digits as it takes to read them back
//! exactly. `index` is the ring's width over the mean of the 33 around it, fewer at the ends: what is left of it when
//! the tree's age is taken away, 1 for an average year.

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::rings::growth_model::statistics::detrended;
use crate::value::{RingSeries, Table, Type, Value};
use std::fmt::Write;
use std::sync::Arc;

/// Writes a ring series as CSV.
pub static KIND: Kind = Kind {
    name: "ring_table",
    version: 1,
    about: "Writes a ring series as a CSV file: year, age, ring width and index, radius, area, height; stands in \
            `outputs`.",
    source: "own construction; the index is a 33-year running mean's, as is usual for tree rings",
    inputs: &[Input::new("of", Type::RingSeries, "The rings.")],
    outputs: &[Output::new("table", Type::Maps, "The file.")],
    example: "(nodes: {
        \"oxford\": weather(file: \"weather/oxforddata.txt\", to: 2020),
        \"rings\": growth_model(climate: \"oxford\"),
    }, outputs: { \"example\": ring_table(of: \"rings\") })",
    build,
};

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let text = text(inputs.ring_series("of"));
    Ok(vec![Value::Table(Arc::new(Table { text }))])
}

const HEADER: &str = "year,age,ring_width_mm,index,radius_mm,area_mm2,area_increment_mm2,height_m,height_increment_m\n";

fn text(series: &RingSeries) -> String {
    let widths = series.widths();
    let rows = widths.iter().zip(detrended(&widths)).zip(series.radii());
    let mut text = HEADER.to_owned();
    let (mut area_before, mut height_before) = (0.0, 0.0);
    for (year, ((width, index), radius)) in rows.enumerate() {
        let (area, height) = (series.areas[year], series.heights[year] / 1000.0);
        let (area_more, height_more) = (area - area_before, height - height_before);
        (area_before, height_before) = (area, height);
        let (calendar, age) = (i64::from(series.first_year) + year as i64, year + 1);
        writeln!(
            text,
            "{calendar},{age},{width},{index},{radius},{area},{area_more},{height},{height_more}"
        )
        .expect("a string takes all that is written");
    }
    text
}
