//! `grow_region`: a part of the plane, wider or narrower by a distance.
//!
//! To grow, all that is nearer to an edge than the distance is added: a rectangle on each edge and a sector at each corner, round
//! or pointed. To shrink, the same is taken away.

use super::combine_regions::bounds;
use crate::geometry::polygon::{Lattice, Operation, rings_of, steps};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Region, Type, Unit, Value};
use glam::DVec2;
use std::sync::Arc;

/// A part of the plane, wider or narrower.
pub static KIND: Kind = Kind {
    name: "grow_region",
    version: 1,
    about: "Moves the outline of a part of the plane outwards, or inwards if the distance is below 0.",
    source: "Minkowski sum with a disk, by boolean operations on the integer grid of i_overlay",
    inputs: &[
        Input::new("of", Type::Region, "What grows."),
        Input::number("by", Unit::Millimetre, "How far the outline moves; below 0 inwards.").range(-1e8, 1e8),
        Input::new(
            "corners",
            Type::Choice(&["round", "pointed"]),
            "Where the outline turns away: arcs, or straight edges that go on until they meet, at most four times `by`.",
        )
        .default("round"),
        Input::number("tolerance", Unit::Millimetre, "How far straight edges may be off an arc.")
            .default("0.01")
            .range(1e-6, 1e4),
    ],
    outputs: &[Output::new("region", Type::Region, "The part of the plane.")],
    example: "(nodes: {
        \"plate\": region_shape(shape: polygon, size: (100, 100), sides: 3),
        \"example\": grow_region(of: \"plate\", by: -5),
    })",
    build,
};

/// A pointed corner goes so many times the distance off, at most.
const FARTHEST: f64 = 4.0;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let region = inputs.region("of");
    let by = inputs.number("by");
    if by == 0.0 {
        return Ok(vec![Value::Region(Arc::clone(region))]);
    }
    let mut around = vec![];
    for ring in region.rings() {
        build.go_on()?;
        let is_pointed = inputs.choice("corners") == "pointed";
        let tolerance = (!is_pointed).then(|| inputs.number("tolerance"));
        add_border(ring, by, tolerance, &mut around);
    }
    let [low, high] = bounds([&**region]);
    let lattice = Lattice::around([low - FARTHEST * by.abs(), high + FARTHEST * by.abs()]);
    let operation = if by > 0.0 {
        Operation::Union
    } else {
        Operation::Difference
    };
    let around: Vec<&[DVec2]> = around.iter().map(|ring| &ring[..]).collect();
    let polygons = lattice.overlay(operation, &rings_of(&region.polygons), &around);
    if polygons.is_empty() {
        return Err(
            Failure::of_input("by", "nothing is left of the region").with_hint("shrink it less")
        );
    }
    Ok(vec![Value::Region(Arc::new(Region { polygons }))])
}

/// The rings of what is nearer than `by` to a ring on one side of it, all of them counterclockwise. Corners are pointed
/// without a tolerance.
fn add_border(ring: &[DVec2], by: f64, tolerance: Option<f64>, around: &mut Vec<Vec<DVec2>>) {
    let count = ring.len();
    let normal = |index: usize| {
        let edge = ring[(index + 1) % count] - ring[index % count];
        -by * edge.perp() / edge.length()
    };
    for index in 0..count {
        let (from, to) = (ring[index], ring[(index + 1) % count]);
        let (off, next) = (normal(index), normal(index + 1));
        let mut side = vec![from, from + off, to + off, to];
        if by < 0.0 {
            side.reverse();
        }
        around.push(side);
        // Where the border turns away from its side there is a gap between two rectangles.
        if off.perp_dot(next) * by.signum() > 0.0 {
            let mut corner = vec![to];
            corner.extend(outer(to, off, next, tolerance));
            if by < 0.0 {
                corner.reverse();
            }
            around.push(corner);
        }
    }
}

/// The outer border of a corner.
fn outer(at: DVec2, off: DVec2, next: DVec2, tolerance: Option<f64>) -> Vec<DVec2> {
    let angle = libm::atan2(off.perp_dot(next), off.dot(next));
    let Some(tolerance) = tolerance else {
        let middle = off + next;
        let square = middle.length_squared();
        let point = middle * (2.0 * off.length_squared() / square);
        let is_near = point.length() <= FARTHEST * off.length();
        let pointed = is_near.then_some(at + point);
        return [Some(at + off), pointed, Some(at + next)]
            .into_iter()
            .flatten()
            .collect();
    };
    let steps = steps(off.length(), angle.abs(), tolerance);
    let point = |step: u32| {
        let (sine, cosine) = libm::sincos(angle * f64::from(step) / f64::from(steps));
        at + DVec2::new(cosine, sine).rotate(off)
    };
    let last = std::iter::once(at + next);
    (0..steps).map(point).chain(last).collect()
}
