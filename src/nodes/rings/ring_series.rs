//! `ring_series`: how a tree grew, written down in the recipe.
//!
//! Either the widths of all rings from the pith outwards, or sections of equal area, as Shibasaki & Aoyama assume,
//! eq. (1): `S_n = S_1 + (n - 1) dS`. Heights follow from the extended allometry, eq. (2),
//! `1 / H = 1 / (A D^h) + 1 / H*` with the diameter D = 2 R in cm and heights in m, or a height is given for the
//! last year: then the same law is stretched to reach it.

use super::growth_model::series::series;
use super::growth_model::species;
use super::growth_model::{ALLOMETRY, allometry};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};
use std::f64::consts::PI;
use std::sync::Arc;

/// A ring series from literals.
pub static KIND: Kind = Kind {
    name: "ring_series",
    version: 1,
    about: "How a tree grew, from the widths of its rings or with sections of equal area.",
    source: "Shibasaki & Aoyama, eqs. (1) and (2)",
    inputs: &[
        Input::new(
            "widths",
            Type::List(&Type::Number(Unit::Millimetre)),
            "The width of each ring from the pith outwards.",
        )
        .optional()
        .range(1e-4, 1000.0),
        Input::new(
            "years",
            Type::Whole,
            "Instead: so many rings of equal area ..",
        )
        .optional()
        .range(1.0, 10_000.0),
        Input::number(
            "radius",
            Unit::Millimetre,
            ".. that make a trunk of this radius.",
        )
        .optional()
        .range(1e-2, 1e5),
        Input::new(
            "first_year",
            Type::Whole,
            "The calendar year of the first ring.",
        )
        .default("1")
        .range(-9999.0, 9999.0),
        Input::new(
            "species",
            Type::Choice(&species::NAMES),
            "Whose allometry gives the heights.",
        )
        .optional(),
        ALLOMETRY,
        Input::number(
            "height",
            Unit::Millimetre,
            "Height in the last year, instead of what the allometry gives.",
        )
        .optional()
        .range(1.0, 1e6),
    ],
    outputs: &[Output::new("rings", Type::RingSeries, "The ring series.")],
    example: "(nodes: { \"example\": ring_series(years: 60, radius: 180) })",
    build,
};

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let first_year = inputs.whole("first_year") as i32;
    let mut series = series(first_year, areas(inputs)?, &allometry(inputs));
    if inputs.get("height").is_some() {
        let stretch = inputs.number("height") / series.heights[series.years() - 1];
        series
            .heights
            .iter_mut()
            .for_each(|height| *height *= stretch);
    }
    if !series.is_sound() {
        let message = "the tree does not grow in each year by as much as a number can show";
        return Err(Failure::new(message).with_hint("choose fewer or wider rings"));
    }
    Ok(vec![Value::RingSeries(Arc::new(series))])
}

/// The section's area in mm² at the end of each year.
fn areas(inputs: &Inputs<'_>) -> Result<Vec<f64>, Failure> {
    let given = ["widths", "years", "radius"].map(|name| inputs.get(name).is_some());
    match given {
        [true, false, false] => {
            let widths = inputs.list("widths").iter().filter_map(Value::as_number);
            let mut radius = 0.0;
            let areas: Vec<f64> = widths
                .map(|width| {
                    radius += width;
                    PI * radius * radius
                })
                .collect();
            if areas.is_empty() {
                return Err(Failure::of_input(
                    "widths",
                    "expected at least one ring, found none",
                ));
            }
            Ok(areas)
        }
        [false, true, true] => {
            let (years, radius) = (inputs.whole("years"), inputs.number("radius"));
            let step = PI * radius * radius / years as f64;
            Ok((1..=years).map(|year| year as f64 * step).collect())
        }
        _ => Err(
            Failure::new("expected either `widths`, or `years` with `radius`")
                .with_hint("write `years: 60, radius: 180`"),
        ),
    }
}
