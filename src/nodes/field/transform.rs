//! `transform`: moves, turns and scales a material, uncut or flat.
//!
//! A flat piece keeps its size: what moves is what it shows. Heights stay as they are, in mm. Directions turn with
//! the material.

use super::placement::{MOVE, PIVOT, Placement, SCALE, TURN};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Material, Type, Value};
use std::sync::Arc;

/// Moves, turns and scales a material.
pub static KIND: Kind = Kind {
    name: "transform",
    version: 1,
    about: "Moves, turns and scales a material. A flat piece keeps its size, heights stay as they are.",
    source: "own construction: affine maps of the domain",
    inputs: &[
        Input::new("of", Type::Material, "The material, uncut or flat."),
        MOVE,
        TURN,
        SCALE,
        PIVOT,
    ],
    outputs: &[Output::field(
        "material",
        Type::Material,
        "The material in its new place.",
    )],
    example: r##"(nodes: {
    "waves": solid_noise(size: (60, 60, 400)),
    "wood": material(base_color: "#c8a06e", height: "= 0.1 * waves"),
    "example": transform(of: "wood", move: (0, 0, 300), turn: (0, 10, 45), scale: (1, 1, 2)),
})"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let material = inputs.material("of");
    let placement = Placement::read(inputs, material.domain)?;
    if material.domain == Domain::Everywhere && !has_directions(material) {
        return Ok(vec![Value::Material(Arc::clone(material))]);
    }
    let position = placement.position(build);
    let moved = |(name, field): (&String, &crate::field::Field)| {
        let field = field.at(&position);
        let field = match Material::is_direction(name, &field) {
            true => placement.directions(build, field),
            false => field,
        };
        (name.clone(), field)
    };
    Ok(vec![Value::Material(Arc::new(Material {
        channels: material.channels.iter().map(moved).collect(),
        surface: material.surface.as_ref().map(|it| it.at(&position)),
        ..Material::clone(material)
    }))])
}

fn has_directions(material: &Material) -> bool {
    let mut channels = material.channels.iter();
    channels.any(|(name, field)| Material::is_direction(name, field))
}
