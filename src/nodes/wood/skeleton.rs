//! `skeleton`: trunk and branches of a tree, written down in the recipe.
//!
//! Momoi & Takatera 2014. Lengths are mm, z points up, the ground is at z = 0. The trunk's curve runs
//! through all nodes (see `geometry::spline`); a branch starts on the curve at a height and runs straight.

use crate::geometry::spline::TrunkCurve;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Branch, Skeleton, Tangents, Thickness, Type, Unit, Value};
use glam::DVec3;
use std::sync::Arc;

/// Trunk and branches from literals.
pub static KIND: Kind = Kind {
    name: "skeleton",
    version: 2,
    about: "The skeleton of a tree: a curved trunk through nodes, and straight branches on it.",
    source: "Momoi & Takatera 2014, eqs. (4)-(8)",
    inputs: &[
        Input::new(
            "trunk",
            Type::List(&Type::Vector(Unit::Millimetre)),
            "At least two nodes of the trunk from the ground up; z rises from node to node.",
        )
        .range(-1e6, 1e6),
        Input::new(
            "branches",
            Type::List(&Type::Record(BRANCH)),
            "The branches.",
        )
        .default("[]"),
        TANGENTS,
    ],
    outputs: &[Output::new(
        "skeleton",
        Type::Skeleton,
        "Trunk and branches.",
    )],
    example: "(nodes: { \"example\": skeleton(
        trunk: [(0, 0, 0), (12, 4, 900), (-6, 9, 2100)],
        branches: [
            (at: 1200, direction: (1, 0.2, 0.5), thickening: 0.4),
            (at: 1600, direction: (-1, 0.3, 0.4), half_width: 9, at_distance: 150),
        ],
    ) })",
    build,
};

/// How the curve runs through the nodes; `skeleton_from_file` has the same input.
pub(super) const TANGENTS: Input = Input::new(
    "tangents",
    Type::Choice(&["natural", "local"]),
    "natural: the smoothest curve; local: moving a node bends only its surroundings.",
)
.default("natural");

/// The parts of a branch.
const BRANCH: &[Input] = &[
    Input::number(
        "at",
        Unit::Millimetre,
        "Height at which it leaves the trunk's curve.",
    ),
    Input::new(
        "direction",
        Type::Vector(Unit::One),
        "Where it grows; the length does not matter.",
    ),
    Input::number(
        "thickening",
        Unit::MillimetrePerYear,
        "Speed v_b at which it grows thicker.",
    )
    .optional()
    .range(1e-6, 1e5),
    Input::number(
        "half_width",
        Unit::Millimetre,
        "Instead: half of its thickness in the wood ..",
    )
    .optional()
    .range(1e-6, 1e5),
    Input::number(
        "at_distance",
        Unit::Millimetre,
        ".. at this distance along it from its start.",
    )
    .optional()
    .range(1e-6, 1e6),
    Input::number(
        "length",
        Unit::Millimetre,
        "From the start to the tip, for kinds whose branches end: `virtual_energy`.",
    )
    .optional()
    .range(1e-3, 1e6),
];

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let trunk: Vec<DVec3> = inputs
        .list("trunk")
        .iter()
        .filter_map(Value::as_vector)
        .collect();
    let tangents = tangents(inputs);
    let curve = TrunkCurve::through(&trunk, tangents)
        .map_err(|error| Failure::of_input("trunk", error.to_string()))?;
    let branches = inputs
        .list("branches")
        .iter()
        .enumerate()
        .map(|(index, item)| {
            branch(item, &curve).map_err(|reason| {
                let message = format!("branch {}: {reason}", index + 1);
                Failure::of_input("branches", message).at_item(index)
            })
        })
        .collect::<Result<_, _>>()?;
    Ok(vec![Value::Skeleton(Arc::new(Skeleton {
        trunk,
        tangents,
        branches,
    }))])
}

/// The choice made for the input `tangents`.
pub(super) fn tangents(inputs: &Inputs<'_>) -> Tangents {
    match inputs.choice("tangents") {
        "local" => Tangents::Local,
        _ => Tangents::Natural,
    }
}

fn branch(item: &Value, curve: &TrunkCurve) -> Result<Branch, String> {
    let height = item
        .part("at")
        .and_then(Value::as_number)
        .ok_or("`at` is missing")?;
    let direction = item
        .part("direction")
        .and_then(Value::as_vector)
        .ok_or("`direction` is missing")?;
    let [lowest, highest] = curve.heights();
    if !(lowest..=highest).contains(&height) {
        return Err(format!(
            "expected `at` between {lowest} and {highest} mm, found {height}"
        ));
    }
    let direction = direction
        .try_normalize()
        .ok_or("expected a `direction`, found a vector of length 0")?;
    let [speed, half_width, distance] = ["thickening", "half_width", "at_distance"]
        .map(|name| item.part(name).and_then(Value::as_number));
    let thickness = match (speed, half_width, distance) {
        (Some(speed), None, None) => Thickness::Speed(speed),
        (None, Some(half_width), Some(distance)) => Thickness::HalfWidth {
            distance,
            half_width,
        },
        _ => return Err("expected either `thickening` or `half_width` with `at_distance`".into()),
    };
    Ok(Branch {
        height,
        direction,
        thickness,
        length: item.part("length").and_then(Value::as_number),
    })
}
