//! `combine_regions`: what two parts of the plane have together, in common, or one without the other.

use crate::geometry::polygon::{Lattice, Operation, rings_of};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Region, Type, Value};
use glam::DVec2;
use std::sync::Arc;

/// A part of the plane from two.
pub static KIND: Kind = Kind {
    name: "combine_regions",
    version: 1,
    about: "Joins two parts of the plane, takes one from the other, or keeps what they have in common.",
    source: "boolean operations on the integer grid of i_overlay; corners that were there stay bit by bit",
    inputs: &[
        Input::new("a", Type::Region, "The first."),
        Input::new("b", Type::Region, "The second."),
        Input::new(
            "operation",
            Type::Choice(&["union", "difference", "intersection"]),
            "What is in either, in `a` but not in `b`, or in both.",
        )
        .default("union"),
    ],
    outputs: &[Output::new(
        "region",
        Type::Region,
        "The part of the plane.",
    )],
    example: "(nodes: {
        \"board\": region_shape(size: (200, 120)),
        \"window\": region_shape(shape: ellipse, size: (80, 60), at: (60, 30)),
        \"example\": combine_regions(a: \"board\", b: \"window\", operation: difference),
    })",
    build,
};

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (a, b) = (inputs.region("a"), inputs.region("b"));
    let operation = match inputs.choice("operation") {
        "union" => Operation::Union,
        "difference" => Operation::Difference,
        _ => Operation::Intersection,
    };
    let lattice = Lattice::around(bounds([&**a, b]));
    let polygons = lattice.overlay(operation, &rings_of(&a.polygons), &rings_of(&b.polygons));
    if polygons.is_empty() {
        return Err(match operation {
            Operation::Intersection => Failure::new("`a` and `b` have nothing in common"),
            _ => Failure::new("`b` leaves nothing of `a`"),
        });
    }
    Ok(vec![Value::Region(Arc::new(Region { polygons }))])
}

/// The box around regions.
pub(super) fn bounds<'r>(regions: impl IntoIterator<Item = &'r Region>) -> [DVec2; 2] {
    let corners = regions.into_iter().flat_map(Region::rings).flatten();
    corners.fold(
        [DVec2::INFINITY, DVec2::NEG_INFINITY],
        |[low, high], corner| [low.min(*corner), high.max(*corner)],
    )
}
