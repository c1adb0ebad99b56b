//! `sample_at`: fields as they are at other points.

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};

/// Evaluates fields at other points.
pub static KIND: Kind = Kind {
    name: "sample_at",
    version: 1,
    about: "Numbers, colours and vectors of a solid as they are at other points: where `virtual_energy.place` points, \
            noise follows the grain.",
    source: "Perlin 1985 (composition of space functions)",
    inputs: &[
        Input::new(
            "to",
            Type::Vector(Unit::Millimetre),
            "The point to look at.",
        )
        .per_point()
        .of(Domain::Solid),
        Input::number(
            "value",
            Unit::One,
            "A number; of another unit by division: `\"= node.time / 1 year\"`.",
        )
        .per_point()
        .of(Domain::Solid)
        .default("0"),
        Input::new("colour", Type::Colour, "A colour.")
            .per_point()
            .of(Domain::Solid)
            .default("(0, 0, 0)"),
        Input::new("vector", Type::Vector(Unit::One), "A vector.")
            .per_point()
            .of(Domain::Solid)
            .default("(0, 0, 0)"),
    ],
    outputs: &[
        Output::field("value", Type::Number(Unit::One), "The number there.").on(Domain::Solid),
        Output::field("colour", Type::Colour, "The colour there.").on(Domain::Solid),
        Output::field("vector", Type::Vector(Unit::One), "The vector there.").on(Domain::Solid),
    ],
    example: r#"(nodes: {
    "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 2000)]),
    "rings": ring_series(years: 40, radius: 120),
    "energy": virtual_energy(skeleton: "tree", rings: "rings", burls: [(at: (60, 0, 550), charge: 20)]),
    "fibres": solid_noise(size: (20, 20, 400)),
    "example": sample_at(to: "energy.place", value: "fibres.value"),
})"#,
    build,
};

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let to = inputs.field("to");
    let fields = ["value", "colour", "vector"].map(|name| inputs.field(name).at(&to));
    Ok(fields.map(Value::Field).into())
}
