//! `skeleton_from_file`: trunk and branches from a scanned log, or from a measured tree.
//!
//! `pith` is a JSON list of `[x, y, z]` in mm with rising z. `knots` is a JSON list of nine numbers
//! `[A, B, C, D, E, F, G, H, I]` for each knot, in mm and radians, as published with Larsson et al. 2022,
//! "Procedural Texturing of Solid Wood with Knots". At the distance r from the pith a knot is at
//!
//! ```text
//! z(r) = C + D sqrt(r) + E r        azimuth(r) = F + G ln(r)
//! ```
//!
//! and it ends at r = H. Its branch is the chord from b1, the point of the trunk's curve at height C, to
//! the knot's end, H away from the curve's point at height z(H) in the direction (cos, sin) of
//! azimuth(H). Above its last node the curve continues straight.
//!
//! The source does not say what A and B mean. We read `A + B r^(1/4)` as the angle in radians that the
//! knot's diameter spans, seen from the pith. So half of its thickness is `H tan((A + B H^(1/4)) / 2)` at
//! its end, and that is what `growth_field` solves for the branch's speed of thickening. I, the distance
//! at which the knot died, is not used.
//!
//! Left out are knots that have no positive thickness or length at their end, and knots that start below
//! the first or above the last point of the pith: nothing is clamped to it.
//!
//! `tree` is a CSV file instead of both; see `tree_file`.

use super::growth::log_file;
use super::skeleton::{TANGENTS, tangents};
use super::tree_file::{self, LengthUnit};
use crate::geometry::spline::TrunkCurve;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Skeleton, Type, Value};
use std::sync::Arc;

/// Trunk and branches from the pith and the knots of a measured log.
pub static KIND: Kind = Kind {
    name: "skeleton_from_file",
    version: 3,
    about: "The skeleton of a measured log, its pith as trunk and its knots as branches, or of a measured tree. Parts \
            of a trunk that do not rise and branches of branches are left out, with a warning.",
    source: "Larsson et al. 2022 (the knots' formulas and data); Raumonen et al. 2013 (cylinders of TreeQSM); Momoi & \
             Takatera 2014, eqs. (4)-(8)",
    inputs: &[
        Input::new(
            "pith",
            Type::File,
            "JSON list of [x, y, z] in mm, from the ground up.",
        )
        .optional(),
        Input::new(
            "knots",
            Type::File,
            "JSON list of nine numbers A to I for each knot.",
        )
        .optional(),
        Input::new(
            "tree",
            Type::File,
            "Instead of a pith: CSV with the columns id, parent, x, y, z, radius, or with the cylinders of TreeQSM.",
        )
        .optional(),
        Input::new(
            "unit",
            Type::Choice(LengthUnit::NAMES),
            "Unit of the lengths in `tree`; without it, what the file says: `# unit: m`.",
        )
        .optional(),
        TANGENTS,
        Input::new(
            "every",
            Type::Whole,
            "Take every n-th point of the pith or trunk, and the last.",
        )
        .default("1")
        .range(1.0, 100_000.0),
    ],
    outputs: &[Output::new(
        "skeleton",
        Type::Skeleton,
        "Trunk and branches.",
    )],
    example: "(nodes: { \"example\": skeleton_from_file(
        pith: \"spruce_log/Gran_1_pith.json\",
        knots: \"spruce_log/Gran_1_knots.json\",
        every: 10,
    ) })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let given = |name: &str| inputs.get(name).is_some();
    if given("tree") {
        return from_tree(inputs, build);
    }
    if given("unit") {
        let failure = Failure::of_input("unit", "`unit` is for a `tree`, and piths are in mm");
        return Err(failure.with_hint("leave it out"));
    }
    if !given("pith") {
        let failure = Failure::new("neither `pith` nor `tree` is set");
        return Err(failure.with_hint("name the file of a pith in JSON, or of a tree in CSV"));
    }
    let pith = log_file::pith(&inputs.file("pith").bytes)
        .map_err(|reason| Failure::of_input("pith", reason))?;
    let every = every(inputs);
    let last = pith.len().saturating_sub(1);
    let kept = |(index, node)| (index % every == 0 || index == last).then_some(node);
    let trunk: Vec<_> = pith.into_iter().enumerate().filter_map(kept).collect();
    let tangents = tangents(inputs);
    let curve = TrunkCurve::through(&trunk, tangents)
        .map_err(|error| Failure::of_input("pith", error.to_string()))?;
    let knots = if inputs.get("knots").is_some() {
        log_file::knots(&inputs.file("knots").bytes)
            .map_err(|reason| Failure::of_input("knots", reason))?
    } else {
        vec![]
    };
    let branches = knots
        .iter()
        .filter_map(|knot| knot.branch(&curve))
        .collect();
    Ok(vec![Value::Skeleton(Arc::new(Skeleton {
        trunk,
        tangents,
        branches,
    }))])
}

fn every(inputs: &Inputs<'_>) -> usize {
    usize::try_from(inputs.whole("every")).unwrap_or(1).max(1)
}

fn from_tree(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    for log in ["pith", "knots"] {
        if inputs.get(log).is_some() {
            let message = format!("`{log}` is set, but the skeleton comes from `tree`");
            return Err(Failure::of_input(log, message).with_hint("remove one of them"));
        }
    }
    let unit = inputs.get("unit").map(|_| inputs.choice("unit"));
    let unit = unit.and_then(LengthUnit::from_name);
    let bytes = &inputs.file("tree").bytes;
    let (tangents, every) = (tangents(inputs), every(inputs));
    let (skeleton, warnings) =
        tree_file::skeleton(bytes, unit, tangents, every, build).map_err(|fault| Failure {
            message: fault.message,
            input: Some("tree"),
            item: None,
            hint: fault.hint,
        })?;
    warnings
        .into_iter()
        .for_each(|warning| inputs.warn(warning));
    Ok(vec![Value::Skeleton(Arc::new(skeleton))])
}
