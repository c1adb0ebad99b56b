//! `nurbs_surface`: a rational B-spline surface from its control points, knots and weights.
//!
//! P(u, v) = sum N_i(u) N_j(v) w_ij P_ij / sum N_i(u) N_j(v) w_ij (Piegl & Tiller 1997, eq. (4.11)). `points` are rows
//! along u, the first at v = 0. Without knots the surface reaches its outermost control points, with inner knots at equal
//! distances. With weights of 1 it is a B-spline surface; with as many points as the degree and one more, a Bezier patch.

use super::patches_from_file::{GUTTER, INSIDE_OUT};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{HIGHEST_DEGREE, Patch, Patches, Type, Unit, Value};
use glam::DVec3;
use std::sync::Arc;

/// A rational B-spline surface.
pub static KIND: Kind = Kind {
    name: "nurbs_surface",
    version: 1,
    about: "A curved surface from control points, knots and weights: a NURBS, a B-spline or a Bezier patch.",
    source: "Piegl & Tiller 1997, The NURBS Book, eq. (4.11)",
    inputs: &[
        Input::new(
            "points",
            Type::List(&Type::List(&Type::Vector(Unit::Millimetre))),
            "Control points: rows along u, one after the other along v.",
        )
        .range(-1e8, 1e8),
        Input::new(
            "weights",
            Type::List(&Type::List(&Type::Number(Unit::One))),
            "Weights of the control points, in the same rows; without them all are 1.",
        )
        .optional()
        .range(1e-6, 1e6),
        Input::new(
            "degrees",
            Type::Pair(Unit::One),
            "Degree along u and along v.",
        )
        .default("(3, 3)")
        .range(1.0, HIGHEST_DEGREE as f64),
        Input::new(
            "knots_u",
            Type::List(&Type::Number(Unit::One)),
            "Knots along u, rising: as many as the points in a row, the degree and one more.",
        )
        .optional()
        .range(-1e6, 1e6),
        Input::new(
            "knots_v",
            Type::List(&Type::Number(Unit::One)),
            "Knots along v.",
        )
        .optional()
        .range(-1e6, 1e6),
        INSIDE_OUT,
        GUTTER,
    ],
    outputs: &[Output::new(
        "patches",
        Type::Patches,
        "The surface, as one patch.",
    )],
    example: r##"(nodes: {
        "example": nurbs_surface(degrees: (2, 1), points: [
            [(100, 0, 0), (100, 100, 0), (0, 100, 0)],
            [(100, 0, 300), (100, 100, 300), (0, 100, 300)],
        ], weights: [[1, 1, 2], [1, 1, 2]]),
    })"##,
    build,
};

/// From the first to the last inner knot it is as far as this, at least: slopes stay finite.
const SHORTEST: f64 = 1e-6;

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let rows = rows(inputs, "points", |item| match item {
        Value::Vector(vector) => Some(*vector),
        _ => None,
    })?;
    let counts = [rows.first().map_or(0, Vec::len), rows.len()];
    let degrees = degrees(inputs, counts)?;
    let knots = [
        knots(inputs, "knots_u", degrees[0], counts[0])?,
        knots(inputs, "knots_v", degrees[1], counts[1])?,
    ];
    let weights = match inputs.get("weights") {
        Some(_) => weights(inputs, counts)?,
        None => vec![],
    };
    let points: Vec<DVec3> = rows.concat();
    let mut patch = Patch {
        degrees,
        counts: counts.map(|count| count as u32),
        knots,
        points,
        weights,
    };
    if inputs.toggle("inside_out") {
        patch = exchanged(&patch);
    }
    Ok(vec![Value::Patches(Arc::new(Patches {
        patches: vec![patch],
        gutter: inputs.number("gutter"),
    }))])
}

/// The rows of an input, all of one length.
fn rows<T>(
    inputs: &Inputs<'_>,
    input: &'static str,
    item: impl Fn(&Value) -> Option<T>,
) -> Result<Vec<Vec<T>>, Failure> {
    let row = |row: &Value| match row {
        Value::List(items) => items.iter().filter_map(&item).collect(),
        _ => vec![],
    };
    let rows: Vec<Vec<T>> = inputs.list(input).iter().map(row).collect();
    let first = rows.first().map_or(0, Vec::len);
    match rows.iter().position(|row| row.len() != first) {
        None => Ok(rows),
        Some(index) => {
            let message = format!(
                "row {} has {} items, the first has {first}",
                index + 1,
                rows[index].len()
            );
            Err(Failure::of_input(input, message).at_item(index))
        }
    }
}

fn degrees(inputs: &Inputs<'_>, counts: [usize; 2]) -> Result<[u32; 2], Failure> {
    let degrees = inputs.pair("degrees");
    if degrees.iter().any(|degree| degree.fract() != 0.0) {
        return Err(Failure::of_input("degrees", "degrees are whole numbers"));
    }
    for (axis, name) in ["u", "v"].into_iter().enumerate() {
        let (degree, count) = (degrees[axis], counts[axis]);
        if count as f64 <= degree {
            let message = format!(
                "degree {degree} along {name} needs {} control points, found {count}",
                degree + 1.0
            );
            return Err(
                Failure::of_input("points", message).with_hint("lower `degrees`, or add points")
            );
        }
    }
    Ok(degrees.map(|degree| degree as u32))
}

fn weights(inputs: &Inputs<'_>, counts: [usize; 2]) -> Result<Vec<f64>, Failure> {
    let rows = rows(inputs, "weights", |item| match item {
        Value::Number(number) => Some(*number),
        _ => None,
    })?;
    let found = [rows.first().map_or(0, Vec::len), rows.len()];
    if found != counts {
        let message = format!(
            "expected {} rows of {} weights, found {} of {}",
            counts[1], counts[0], found[1], found[0]
        );
        return Err(Failure::of_input("weights", message));
    }
    Ok(rows.concat())
}

/// Knots as stated, or so that the surface reaches its outermost points.
fn knots(
    inputs: &Inputs<'_>,
    input: &'static str,
    degree: u32,
    count: usize,
) -> Result<Vec<f64>, Failure> {
    let degree = degree as usize;
    if inputs.get(input).is_none() {
        let spans = count - degree;
        let knot = |index: usize| index.saturating_sub(degree).min(spans) as f64;
        return Ok((0..count + degree + 1).map(knot).collect());
    }
    let items = inputs.list(input).iter();
    let knots: Vec<f64> = items
        .filter_map(|item| match item {
            Value::Number(number) => Some(*number),
            _ => None,
        })
        .collect();
    let refuse = |message: String| Err(Failure::of_input(input, message));
    if knots.len() != count + degree + 1 {
        return refuse(format!(
            "{count} points of degree {degree} need {} knots, found {}",
            count + degree + 1,
            knots.len()
        ));
    }
    if let Some(index) = (1..knots.len()).find(|index| knots[*index] < knots[index - 1]) {
        return refuse(format!(
            "knots rise, but {} follows {}",
            knots[index],
            knots[index - 1]
        ));
    }
    if knots[count] - knots[degree] < SHORTEST {
        return refuse(format!(
            "the surface would have no length: knots {} and {} are {} and {}",
            degree + 1,
            count + 1,
            knots[degree],
            knots[count]
        ));
    }
    Ok(knots)
}

/// A patch with u and v exchanged.
fn exchanged(patch: &Patch) -> Patch {
    let [across, along] = patch.counts.map(|count| count as usize);
    let turned =
        || (0..across).flat_map(move |column| (0..along).map(move |row| row * across + column));
    let weights = match patch.weights.is_empty() {
        true => vec![],
        false => turned().map(|index| patch.weights[index]).collect(),
    };
    Patch {
        degrees: [patch.degrees[1], patch.degrees[0]],
        counts: [patch.counts[1], patch.counts[0]],
        knots: [patch.knots[1].clone(), patch.knots[0].clone()],
        points: turned().map(|index| patch.points[index]).collect(),
        weights,
    }
}
