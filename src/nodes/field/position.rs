//! `position`: where a point is, as numbers in mm.

use crate::field::Field;
use crate::node::{Build, Failure, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};

/// Gives the coordinates of points.
pub static KIND: Kind = Kind {
    name: "position",
    version: 1,
    about: "Gives the coordinates of each point: x, y, z in a solid, u to the right and v up on a flat piece.",
    source: "own construction: the identity",
    inputs: &[],
    outputs: &[
        solid("x", "Along x in the solid."),
        solid("y", "Along y in the solid."),
        solid("z", "Height in the solid; the ground is at 0."),
        plane("u", "From the left side of the flat piece."),
        plane("v", "From the lower side of the flat piece."),
    ],
    example: r#"(nodes: { "example": position() })"#,
    build,
};

const fn solid(name: &'static str, about: &'static str) -> Output {
    Output::field(name, Type::Number(Unit::Millimetre), about).on(Domain::Solid)
}

const fn plane(name: &'static str, about: &'static str) -> Output {
    Output::field(name, Type::Number(Unit::Millimetre), about).on(Domain::Plane)
}

fn build(_: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let part = |domain, axis| Value::Field(Field::position(domain).part(axis, 1));
    let solid = (0..3).map(|axis| part(Domain::Solid, axis));
    let plane = (0..2).map(|axis| part(Domain::Plane, axis));
    Ok(solid.chain(plane).collect())
}
