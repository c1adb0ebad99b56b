//! `region`: a part of the plane, written out.
//!
//! What is drawn badly is mended, with a warning that says what and where: corners are repeated, lines turn back on
//! themselves, an outline runs clockwise, a line crosses itself, a hole lies outside or touches another ring, outlines
//! overlap, parts are thinner than a billionth of the whole. The rule is that a ring encloses what it winds around other than 0
//! times, whichever way it runs; that holes are taken from their own outline; and that what lies in several outlines counts
//! once. A ring may repeat its first corner at the end.

use super::mended::mended;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Polygon, Type, Unit, Value};
use glam::DVec2;
use std::sync::Arc;

/// A part of the plane, written out.
pub static KIND: Kind = Kind {
    name: "region",
    version: 1,
    about: "A part of the plane with corners written out: outlines, each with holes. Bow-ties, spikes, repeated corners and \
            the like are mended with a warning.",
    source: "own construction; fill rule non-zero, as in SVG 2 (W3C 2018), on the integer grid of i_overlay",
    inputs: &[Input::new(
        "outlines",
        Type::List(&Type::Record(PARTS)),
        "Polygons; where they overlap they are joined.",
    )],
    outputs: &[Output::new("region", Type::Region, "The part of the plane.")],
    example: "(nodes: {
        \"example\": region(outlines: [
            (outline: [(0, 0), (120, 0), (120, 80), (60, 100), (0, 80)], holes: [[(40, 30), (40, 60), (80, 60), (80, 30)]]),
            (outline: [(140, 0), (180, 0), (160, 60)]),
        ]),
    })",
    build,
};

const CORNERS: Type = Type::List(&Type::Pair(Unit::Millimetre));

const PARTS: &[Input] = &[
    Input::new(
        "outline",
        CORNERS,
        "Corners around the polygon, counterclockwise.",
    )
    .range(-1e9, 1e9),
    Input::new(
        "holes",
        Type::List(&CORNERS),
        "Corners around each hole, either way.",
    )
    .optional()
    .range(-1e9, 1e9),
];

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let drawn: Vec<Polygon> = inputs.list("outlines").iter().map(polygon).collect();
    let name = |number: usize, hole: Option<usize>| match hole {
        None => format!("outline {}", number + 1),
        Some(hole) => format!("hole {} of outline {}", hole + 1, number + 1),
    };
    let region = mended(inputs, "outlines", &drawn, &name)?;
    Ok(vec![Value::Region(Arc::new(region))])
}

fn polygon(record: &Value) -> Polygon {
    let Value::Record(parts) = record else {
        return Polygon {
            outline: vec![],
            holes: vec![],
        };
    };
    let part = |name: &str| {
        parts
            .iter()
            .find(|(part, _)| *part == name)
            .map(|(_, part)| part)
    };
    let holes = part("holes").map(items).unwrap_or_default();
    Polygon {
        outline: part("outline").map(corners).unwrap_or_default(),
        holes: holes.iter().map(corners).collect(),
    }
}

fn items(list: &Value) -> &[Value] {
    match list {
        Value::List(items) => items,
        _ => &[],
    }
}

fn corners(list: &Value) -> Vec<DVec2> {
    let corner = |item: &Value| match item {
        Value::Pair(pair) => Some(DVec2::from_array(*pair)),
        _ => None,
    };
    items(list).iter().filter_map(corner).collect()
}
