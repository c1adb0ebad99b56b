//! `ring_plot`: ring width by year, drawn on a white piece.
//!
//! The plot is a material like any other: `maps` writes it, at any resolution with lines of the same width in mm.

mod drawing;
mod layout;
mod letters;

use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::surface::material::with_defaults;
use crate::value::{Domain, Material, Type, Unit, Value};
use drawing::Drawing;
use std::sync::Arc;

/// Draws a ring series.
pub static KIND: Kind = Kind {
    name: "ring_plot",
    version: 1,
    about: "The plot of a ring series, ring width in mm by year, as a flat piece that `maps` can write.",
    source: "own construction",
    inputs: &[
        Input::new("of", Type::RingSeries, "The rings."),
        Input::new(
            "size",
            Type::Pair(Unit::Millimetre),
            "Width and height of the piece.",
        )
        .default("(240, 120)")
        .range(10.0, 1e5),
    ],
    outputs: &[
        Output::field("plot", Type::Material, "Black and brown lines on white.").on(Domain::Plane),
    ],
    example: "(nodes: {
        \"oxford\": weather(file: \"weather/oxforddata.txt\", to: 2020),
        \"rings\": growth_model(climate: \"oxford\"),
        \"example\": ring_plot(of: \"rings\"),
    })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let size = inputs.pair("size");
    let drawing = Drawing::new(layout::lines(inputs.ring_series("of"), size), size);
    let colour = build.kernel(drawing, vec![Field::position(Domain::Plane)]);
    Ok(vec![Value::Material(Arc::new(Material {
        domain: Domain::Plane,
        channels: with_defaults([("base_color".to_owned(), colour)]),
        size: Some(size),
        surface: None,
    }))])
}
