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
//! A branch given by its half width w at the distance L along it has its border there, `T_2 = T_1`:
//! `v_b = w sqrt(L^2 + w^2) / (L (T_1 - z(b1) / v_e - L / v_e))`, with T_1 of the axis' point at L.

use super::growth::{GrowthKernel, GrowthModel, GrowthSettings, Reach};
use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};

/// Growth time along a curved skeleton.
pub static KIND: Kind = Kind {
    name: "growth_field",
    version: 1,
    about: "When the wood at each point grew, along a curved trunk and its branches.",
    source: "Momoi & Takatera 2014, eqs. (9)-(18); exponent, reach and share are our own construction",
    inputs: INPUTS,
    outputs: &[
        Output::field("time", Type::Number(Unit::Year), "Growth time.").on(Domain::Solid),
        Output::field(
            "branch",
            Type::Number(Unit::One),
            "0 in the trunk's wood, near 1 in a knot.",
        )
        .on(Domain::Solid),
    ],
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
    Input::number(
        "elongation",
        Unit::MillimetrePerYear,
        "How fast trunk and branches grow long.",
    )
    .range(1.0, 1e5),
    Input::number(
        "thickening",
        Unit::MillimetrePerYear,
        "How fast the trunk's radius grows.",
    )
    .range(1e-3, 1e4),
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

fn build(inputs: &Inputs<'_>, context: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let model = GrowthModel::new(inputs.skeleton("skeleton"), settings(inputs))?;
    Ok(times(context, model))
}

/// How a tree grows, as the inputs say.
pub(super) fn settings(inputs: &Inputs<'_>) -> GrowthSettings {
    let reach = inputs.get("reach").map(|_| {
        let [along, across] = inputs.pair("reach");
        Reach { along, across }
    });
    GrowthSettings {
        elongation: inputs.number("elongation"),
        thickening: inputs.number("thickening"),
        sharpness: inputs.number("sharpness"),
        reach,
    }
}

/// The outputs `time` and `branch` of a model.
pub(super) fn times(context: &Build<'_>, model: GrowthModel) -> Vec<Value> {
    let position = Field::position(Domain::Solid);
    let growth = context.kernel(GrowthKernel::new(model), vec![position]);
    [0, 1]
        .map(|column| Value::Field(growth.part(column, 1)))
        .to_vec()
}
