//! `region_shape`: rectangles, ellipses and regular polygons, with rounded corners.

use super::mended::mended;
use crate::geometry::polygon::{flatten, round_corners, steps};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Polygon, Type, Unit, Value};
use glam::DVec2;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A simple part of the plane.
pub static KIND: Kind = Kind {
    name: "region_shape",
    version: 1,
    about: "A rectangle, an ellipse or a regular polygon as a part of the plane, with rounded corners if wanted.",
    source: "own construction",
    inputs: &[
        Input::new(
            "shape",
            Type::Choice(&["rectangle", "ellipse", "polygon"]),
            "What fills the box: all of it, the largest ellipse, or a polygon with its corners on that ellipse, the first at the \
             top.",
        )
        .default("rectangle"),
        Input::new("size", Type::Pair(Unit::Millimetre), "Width and height of the box.").range(1e-3, 1e8),
        Input::new("at", Type::Pair(Unit::Millimetre), "Where the box's lower left corner is.")
            .default("(0, 0)")
            .range(-1e8, 1e8),
        Input::number("turn", Unit::Degree, "Turns it around the middle of the box, counterclockwise.")
            .default("0")
            .range(-360.0, 360.0),
        Input::new("sides", Type::Whole, "Sides of a `polygon`.").default("6").range(3.0, 1000.0),
        Input::number("round", Unit::Millimetre, "Radius of the corners; no arc takes more than half a side.")
            .default("0")
            .range(0.0, 1e8),
        Input::number("tolerance", Unit::Millimetre, "How far straight edges may be off a curve.")
            .default("0.01")
            .range(1e-6, 1e4),
    ],
    outputs: &[Output::new("region", Type::Region, "The part of the plane.")],
    example: "(nodes: { \"example\": region_shape(shape: polygon, size: (100, 100), sides: 5, round: 8) })",
    build,
};

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let half = 0.5 * DVec2::from_array(inputs.pair("size"));
    let tolerance = inputs.number("tolerance");
    let around = match inputs.choice("shape") {
        "rectangle" => vec![
            -half,
            DVec2::new(half.x, -half.y),
            half,
            DVec2::new(-half.x, half.y),
        ],
        "polygon" => ellipse(half, inputs.whole("sides") as u32),
        _ => ellipse(half, steps(half.max_element(), TAU, tolerance).max(8)),
    };
    let around = match inputs.choice("shape") {
        "ellipse" => around,
        _ => flatten(&round_corners(&around, inputs.number("round")), tolerance),
    };
    let (sine, cosine) = libm::sincos(inputs.number("turn").to_radians());
    let middle = DVec2::from_array(inputs.pair("at")) + half;
    let outline = around
        .iter()
        .map(|corner| middle + DVec2::new(cosine, sine).rotate(*corner));
    let polygon = Polygon {
        outline: outline.collect(),
        holes: vec![],
    };
    let region = mended(inputs, "size", &[polygon], &|_, _| "the shape".to_owned())?;
    Ok(vec![Value::Region(Arc::new(region))])
}

/// Points on an ellipse, the first at the top.
fn ellipse(half: DVec2, count: u32) -> Vec<DVec2> {
    let point = |index: u32| {
        let (sine, cosine) = libm::sincos(TAU * f64::from(index) / f64::from(count));
        half * DVec2::new(-sine, cosine)
    };
    (0..count).map(point).collect()
}
