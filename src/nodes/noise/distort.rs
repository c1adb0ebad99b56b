//! `distort`: moves the points at which a solid material is evaluated.
//!
//! The point p shows what the undistorted material has at p + by * amount: a wave in the offset is a wave
//! in the grain. Every channel moves alike, and the spread of the moved points tells lookups how fine to be.

use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Material, Type, Unit, Value};
use glam::DVec3;
use std::sync::Arc;

/// Distorts a solid material.
pub static KIND: Kind = Kind {
    name: "distort",
    version: 1,
    about: "Bends a solid material: each point shows what the material has a little way off.",
    source: "Perlin 1985 (domain distortion)",
    inputs: &[
        Input::new("of", Type::Material, "The material to bend.").of(Domain::Solid),
        Input::new(
            "by",
            Type::Vector(Unit::One),
            "Which way and how far, in parts of `amount`; usually the `vector` of a noise.",
        )
        .per_point()
        .of(Domain::Solid),
        Input::new(
            "amount",
            Type::Vector(Unit::Millimetre),
            "Distance along x, y and z where `by` is 1.",
        )
        .range(-1e4, 1e4),
    ],
    outputs: &[Output::field("material", Type::Material, "The bent material.").on(Domain::Solid)],
    example: r##"(nodes: {
        "grain": solid_noise(size: (2, 2, 60)),
        "wood": material(base_color: "#c8a06e", height: "= 0.05 * grain.value"),
        "waves": solid_noise(size: (60, 60, 400)),
        "example": distort(of: "wood", by: "waves.vector", amount: (2, 2, 0)),
    })"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let position = Field::position(Domain::Solid);
    let amount = inputs.vector("amount");
    let moved = build.kernel(Offset { amount }, vec![position, inputs.field("by")]);
    let solid = inputs.material("of");
    let channels = solid
        .channels
        .iter()
        .map(|(name, field)| (name.clone(), field.at(&moved)))
        .collect();
    Ok(vec![Value::Material(Arc::new(Material {
        channels,
        ..Material::clone(solid)
    }))])
}

/// Adds three columns times `amount` to three columns of positions.
#[derive(Debug)]
pub(in crate::nodes) struct Offset {
    /// Distance in mm where the three columns are 1.
    pub(in crate::nodes) amount: DVec3,
}

impl Kernel for Offset {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("offset").whole(i64::from(KIND.version));
        self.amount.to_array().iter().for_each(|part| {
            key.number(*part);
        });
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (axis, output) in block.outputs.iter_mut().enumerate() {
            let amount = self.amount[axis] as f32;
            let (from, by) = (block.inputs[axis].values, block.inputs[3 + axis].values);
            for ((output, from), by) in output.iter_mut().zip(from).zip(by) {
                *output = from + by * amount;
            }
        }
    }
}
