//! `straight_growth_field`: when the wood at each point of a tree grew, by the older model of straight segments.
//!
//! Momoi & Takatera 2014, section 2. With the foot of the point P on the skeleton, D_a the way along the skeleton
//! from the ground to the foot and D_b the distance from there to P,
//!
//! ```text
//! T_a = D_a / v_a    T_b = D_b / v_b    T_1 = T_a + T_b          (1)-(3)
//! ```
//!
//! The two segments at the nearest node count: in the influence area of one of them the foot is on its line,
//! in the blend area inside a bend both times are blended, outside a bend the foot is the node (see
//! `growth::straight`). Branches act on T_1, and rings of a tree take the place of speeds, as in `growth_field`; there the
//! tip's height is D_a.
//!
//! The model has two defects, which are kept as published: T jumps far from the axis, on the plane that halves a
//! segment where it crosses a blend area; and near the axis rings are polygons. `growth_field` has neither.

use super::growth::{GrowthModel, RegionKernel};
use super::growth_field::{BRANCH, INPUTS, INSIDE, TIME, outputs, settings};
use crate::field::Field;
use crate::node::{Build, Failure, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};

/// Growth time along a straight skeleton.
pub static KIND: Kind = Kind {
    name: "straight_growth_field",
    version: 1,
    about: "When the wood at each point grew, along straight segments: the older model, with its defects.",
    source: "Momoi & Takatera 2014, section 2, eqs. (1)-(3), (14)-(18); the blend function is our own construction",
    inputs: INPUTS,
    outputs: &[
        TIME,
        BRANCH,
        INSIDE,
        Output::field(
            "region",
            Type::Number(Unit::One),
            "0 in the influence area of a segment, 1 in a blend area, 2 outside a bend.",
        )
        .on(Domain::Solid),
        Output::field(
            "member",
            Type::Number(Unit::One),
            "Which segment it is in an influence area, elsewhere which node, from 0 at the ground.",
        )
        .on(Domain::Solid),
    ],
    example: "(nodes: {
        \"tree\": skeleton(
            trunk: [(0, 0, 0), (12, 4, 900), (-6, 9, 2100)],
            branches: [(at: 1200, direction: (1, 0.2, 0.5), thickening: 0.4)],
        ),
        \"example\": straight_growth_field(skeleton: \"tree\", elongation: 420, thickening: 2.4),
    })",
    build,
};

fn build(inputs: &Inputs<'_>, context: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (settings, rings) = settings(inputs)?;
    let model = GrowthModel::straight(inputs.skeleton("skeleton"), settings, rings)?;
    let trunk = model.trunk.straight().expect("the model was made straight");
    let regions = context.kernel(
        RegionKernel::new(trunk),
        vec![Field::position(Domain::Solid)],
    );
    let mut values = outputs(inputs, context, model);
    values.extend([0, 1].map(|column| Value::Field(regions.part(column, 1))));
    Ok(values)
}
