//! `growth_field`: when the wood at each point of a tree grew.
//!
//! Momoi & Takatera 2014. By growth of the trunk alone the point P, at the distance d from the trunk's
//! curve at its own height z, grew at `T_1 = z / v_e + d / v_h`, eqs. (9)-(13). A branch starts at b1 on the
//! curve, along the unit vector u. With s the distance of P's foot along the axis and rho that of P from
//! the axis,
//!
//! ```text
//! T_2 = z(b1) / v_e + s / v_e + rho / (v_b cos a)      cos a = s / |P - b1|      (14), (15), (17)
//! T   = T_1 T_2 / sqrt(T_1^2 + T_2^2)                                            (18)
//! ```
//!
//! for s > 0; behind its start a branch has no influence. In (15) the angle is taken at b1: as printed it
//! would always be a right one. All branches together, with an exponent k (2 is eq. (18)) and a fade f:
//!
//! ```text
//! T = (T_1^-k + sum (T_i / f_i)^-k)^(-1/k)      branch = S / (1 + S),  S = sum (f_i T_1 / T_i)^k
//! ```
//!
//! If the smallest T_i is 0 or less, which can be only below the ground, it is T. With a reach, f falls
//! from 1 to 0 between half of the reach and the reach, with a continuous slope (smoothstep), along the
//! axis and across it; without one, f = 1 (own construction). The fade divides the branch's time. As
//! a factor of `T_i^-k` it would act all at once at the end of the reach, the more so the larger k.
//!
//! A ring series says instead of the speeds how thick and tall the trunk was at the end of each year (Shibasaki & Aoyama).
//! With S_n the area of its section at the ground and m the time at which it was as tall as z, ring n reaches at that
//! height to
//!
//! ```text
//! d = sqrt((S_n - S_m) / pi)
//! ```
//!
//! from the trunk's curve, times within a year being linear in area and in height; beyond the last ring and above the
//! tip they go on as in the last year. `T_alpha` is then the time at which the tree was as tall as the branch's start;
//! branches keep a speed of elongation.
//!
//! The bark is where T is the tree's age: `inside` is 1 below it, averaged over each pixel.
//!
//! A branch given by its half width w at the distance L along it has its border there, `T_2 = T_1`:
//! `v_b = w sqrt(L^2 + w^2) / (L (T_1 - z(b1) / v_e - L / v_e))`, with T_1 of the axis' point at L.

use super::growth::{GrowthKernel, GrowthModel, GrowthSettings, Reach};
use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::field::threshold::below;
use crate::value::{Domain, RingSeries, Type, Unit, Value};
use std::sync::Arc;

/// Growth time along a curved skeleton.
pub static KIND: Kind = Kind {
    name: "growth_field",
    version: 1,
    about: "When the wood at each point grew, along a curved trunk and its branches, by speeds or by the rings of a tree.",
    source: "Momoi & Takatera 2014, eqs. (9)-(18); Shibasaki & Aoyama, eqs. (1), (2) (rings); exponent, reach and share are \
             our own construction",
    inputs: INPUTS,
    outputs: &[TIME, BRANCH, INSIDE],
    example: "(nodes: {
        \"tree\": skeleton(
            trunk: [(0, 0, 0), (12, 4, 900), (-6, 9, 2100)],
            branches: [(at: 1200, direction: (1, 0.2, 0.5), thickening: 0.4)],
        ),
        \"example\": growth_field(skeleton: \"tree\", elongation: 420, thickening: 2.4),
    })",
    build,
};

/// What grows, and how; `straight_growth_field` has the same inputs.
pub(super) const INPUTS: &[Input] = &[
    Input::new("skeleton", Type::Skeleton, "Trunk and branches."),
    Input::new(
        "rings",
        Type::RingSeries,
        "How thick and tall the trunk was in each year, instead of `thickening`.",
    )
    .optional(),
    Input::number(
        "elongation",
        Unit::MillimetrePerYear,
        "How fast trunk and branches grow long; with `rings` only branches, else as fast as the tree on average.",
    )
    .optional()
    .range(1.0, 1e5),
    Input::number(
        "thickening",
        Unit::MillimetrePerYear,
        "How fast the trunk's radius grows; needed unless there are `rings`.",
    )
    .optional()
    .range(1e-3, 1e4),
    Input::number(
        "age",
        Unit::Year,
        "Age of the tree, where its bark is; else that of its `rings`, or there is no bark.",
    )
    .optional()
    .range(0.0, 1e5),
    Input::number(
        "sharpness",
        Unit::One,
        "Blend of trunk and branches: 1 soft, 2 paper, 16 hard.",
    )
    .default("2")
    .range(1.0, 16.0),
    Input::new(
        "reach",
        Type::Pair(Unit::Millimetre),
        "Where a branch's influence ends, along and across it; fades from half of that on.",
    )
    .optional()
    .range(1e-3, 1e6),
];

/// The outputs, which `straight_growth_field` has as well.
pub(super) const TIME: Output =
    Output::field("time", Type::Number(Unit::Year), "Growth time.").on(Domain::Solid);
pub(super) const BRANCH: Output = Output::field(
    "branch",
    Type::Number(Unit::One),
    "0 in the trunk's wood, near 1 in a knot.",
)
.on(Domain::Solid);
pub(super) const INSIDE: Output = Output::field(
    "inside",
    Type::Number(Unit::One),
    "1 within the bark and 0 outside; 1 everywhere if the tree has no age.",
)
.on(Domain::Solid);

fn build(inputs: &Inputs<'_>, context: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (settings, rings) = settings(inputs)?;
    let model = GrowthModel::with_rings(inputs.skeleton("skeleton"), settings, rings)?;
    Ok(outputs(inputs, context, model))
}

/// How a tree grows, as the inputs say.
pub(super) fn settings(
    inputs: &Inputs<'_>,
) -> Result<(GrowthSettings, Option<Arc<RingSeries>>), Failure> {
    let reach = inputs.get("reach").map(|_| {
        let [along, across] = inputs.pair("reach");
        Reach { along, across }
    });
    let rings = inputs.get("rings").map(|_| inputs.ring_series("rings"));
    let [elongation, thickening] = speeds(inputs, rings.map(|rings| &**rings))?;
    let settings = GrowthSettings {
        elongation,
        thickening,
        sharpness: inputs.number("sharpness"),
        reach,
    };
    Ok((settings, rings.cloned()))
}

/// Growth time, share of the branches and what is inside the bark.
pub(super) fn outputs(inputs: &Inputs<'_>, context: &Build<'_>, model: GrowthModel) -> Vec<Value> {
    let age = match inputs.get("age") {
        Some(_) => Some(inputs.number("age")),
        None => model.rings.as_ref().map(|rings| rings.years() as f64),
    };
    let position = Field::position(Domain::Solid);
    let growth = context.kernel(GrowthKernel::new(model), vec![position]);
    let inside = match age {
        Some(age) => below(context, growth.part(0, 1), age),
        None => Field::constant(1.0),
    };
    vec![
        Value::Field(growth.part(0, 1)),
        Value::Field(growth.part(1, 1)),
        Value::Field(inside),
    ]
}

/// How fast branches, and trunks without rings, grow long and thick.
fn speeds(inputs: &Inputs<'_>, rings: Option<&RingSeries>) -> Result<[f64; 2], Failure> {
    let speed = |name: &str| inputs.get(name).map(|_| inputs.number(name));
    let (elongation, thickening) = (speed("elongation"), speed("thickening"));
    let Some(rings) = rings else {
        let stated = |name: &'static str, speed: Option<f64>| {
            let message = format!("neither `rings` nor `{name}` is set");
            let hint = "set `elongation` and `thickening`, or link `rings` to a `growth_model`";
            speed.ok_or_else(|| Failure::new(message).with_hint(hint))
        };
        return Ok([
            stated("elongation", elongation)?,
            stated("thickening", thickening)?,
        ]);
    };
    if thickening.is_some() {
        let message = "`thickening` is set, but the `rings` say how thick the trunk was";
        return Err(Failure::of_input("thickening", message).with_hint("remove one of them"));
    }
    let years = rings.years() as f64;
    let height = rings.heights[rings.years() - 1];
    // The trunk's own speed does not count.
    Ok([elongation.unwrap_or(height / years), 1.0])
}
