//! `slice_cut`: cuts a flat piece out of a solid material with one straight stroke of the saw.
//!
//! A point (u, v) of the piece, in mm from its lower left corner, shows the point
//! origin + (u - width/2) across + (v - height/2) along of the solid. For the named cuts the trunk is
//! taken to stand upright through `origin`:
//!
//! - `quarter_sawn`: the plane holds the trunk's axis; rings run as parallel lines;
//! - `plain_sawn`: the plane stands `offset` mm away from the axis; rings form cathedrals;
//! - `end_grain`: the plane lies across the trunk; rings are circles.
//!
//! `turn` says from which side: at 0 the piece's width runs along +x. `placed` moves, turns and scales the whole piece, which then has the size
//! that it has in the solid; one that becomes oblique is shown as if its sides stood at right angles.

use super::placed::{PLACED, piece, placed, spanned};
use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};
use glam::DVec3;

/// Cuts a flat piece out of a solid material.
pub static KIND: Kind = Kind {
    name: "slice_cut",
    version: 1,
    about: "Cuts a flat piece out of a solid material, by any plane or by the name of the cut.",
    source: "Momoi & Takatera 2014, section 1 (solid texture sampled on a plane); names as in forestry",
    inputs: &[
        Input::new("of", Type::Material, "The material to cut.").of(Domain::Solid),
        Input::new(
            "cut",
            Type::Choice(&["plane", "plain_sawn", "quarter_sawn", "end_grain"]),
            "How the saw runs; `plane` takes `across` and `along`.",
        )
        .default("plane"),
        Input::new(
            "origin",
            Type::Vector(Unit::Millimetre),
            "Centre of the piece; for the named cuts a point on the trunk's axis.",
        ),
        Input::new(
            "across",
            Type::Vector(Unit::One),
            "Direction of the piece's width.",
        )
        .optional(),
        Input::new(
            "along",
            Type::Vector(Unit::One),
            "Direction of the piece's height; what of it runs along `across` is taken off.",
        )
        .optional(),
        Input::number(
            "turn",
            Unit::Degree,
            "Turns a named cut about the upright axis.",
        )
        .default("0")
        .range(-360.0, 360.0),
        Input::number(
            "offset",
            Unit::Millimetre,
            "Distance of a plain-sawn piece from the axis.",
        )
        .default("0"),
        Input::new(
            "size",
            Type::Pair(Unit::Millimetre),
            "Width and height of the piece.",
        )
        .range(0.001, 100_000.0),
        PLACED,
    ],
    outputs: &[Output::field("piece", Type::Material, "The flat piece.").on(Domain::Plane)],
    example: r##"(nodes: {
        "grain": solid_noise(size: (2, 2, 60)),
        "wood": material(base_color: "#c8a06e", height: "= 0.05 * grain.value"),
        "example": slice_cut(of: "wood", cut: plain_sawn, origin: (0, 0, 500), offset: 40, size: (140, 900)),
    })"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let size = inputs.pair("size");
    let place = placed(inputs)?;
    let plane = Plane::new(inputs)?;
    let corner = plane.centre - plane.across * (0.5 * size[0]) - plane.along * (0.5 * size[1]);
    // The piece is measured in mm as it lies in the solid.
    let factor = |side: DVec3| place.transform_vector3(side).length() / side.length();
    let factors = [plane.across, plane.along].map(factor);
    let position = build.kernel(
        Affine {
            corner: place.transform_point3(corner),
            across: place.transform_vector3(plane.across) / factors[0],
            along: place.transform_vector3(plane.along) / factors[1],
        },
        vec![Field::position(Domain::Plane)],
    );
    let size = [size[0] * factors[0], size[1] * factors[1]];
    Ok(vec![piece(inputs.material("of"), &position, size)])
}

/// Where the saw runs.
struct Plane {
    centre: DVec3,
    across: DVec3,
    along: DVec3,
}

impl Plane {
    fn new(inputs: &Inputs<'_>) -> Result<Plane, Failure> {
        let (origin, cut) = (inputs.vector("origin"), inputs.choice("cut"));
        let is_idle = |name, cuts: &[&str]| inputs.number(name) != 0.0 && !cuts.contains(&cut);
        for (name, cuts) in [
            ("offset", &["plain_sawn"][..]),
            ("turn", &["plain_sawn", "quarter_sawn", "end_grain"]),
        ] {
            if is_idle(name, cuts) {
                let message = format!("`{name}` is set, but does nothing in a cut that is `{cut}`");
                let hint = format!("remove it; it is for {}", cuts.join(", "));
                return Err(Failure::of_input(name, message).with_hint(hint));
            }
        }
        if cut == "plane" {
            return Plane::free(inputs, origin);
        }
        for name in ["across", "along"] {
            if inputs.get(name).is_some() {
                let message = format!("`{name}` is set, but the cut is `{}`", inputs.choice("cut"));
                return Err(Failure::of_input("cut", message)
                    .with_hint("use `cut: plane` with `across` and `along`, or `turn` instead"));
            }
        }
        Ok(Plane::named(inputs, origin))
    }

    fn free(inputs: &Inputs<'_>, centre: DVec3) -> Result<Plane, Failure> {
        let direction = |name: &'static str| match inputs.get(name) {
            Some(_) => Ok(inputs.vector(name)),
            None => Err(
                Failure::of_input("cut", format!("a cut by a plane needs `{name}`"))
                    .with_hint("set `across` and `along`, or name the cut: `cut: plain_sawn`"),
            ),
        };
        let [across, along] = spanned(direction("across")?, direction("along")?, "along")?;
        Ok(Plane {
            centre,
            across,
            along,
        })
    }

    fn named(inputs: &Inputs<'_>, origin: DVec3) -> Plane {
        let turn = inputs.number("turn").to_radians();
        let (sine, cosine) = (libm::sin(turn), libm::cos(turn));
        let across = DVec3::new(cosine, sine, 0.0);
        let away = DVec3::new(-sine, cosine, 0.0);
        match inputs.choice("cut") {
            "end_grain" => Plane {
                centre: origin,
                across,
                along: away,
            },
            "plain_sawn" => Plane {
                centre: origin + away * inputs.number("offset"),
                across,
                along: DVec3::Z,
            },
            _ => Plane {
                centre: origin,
                across,
                along: DVec3::Z,
            },
        }
    }
}

/// Sends (u, v) to corner + u across + v along.
#[derive(Debug)]
struct Affine {
    corner: DVec3,
    across: DVec3,
    along: DVec3,
}

impl Kernel for Affine {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("slice_cut").whole(i64::from(KIND.version));
        for vector in [self.corner, self.across, self.along] {
            vector.to_array().iter().for_each(|part| {
                key.number(*part);
            });
        }
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let (u, v) = (block.inputs[0].values, block.inputs[1].values);
        for (axis, output) in block.outputs.iter_mut().enumerate() {
            let (corner, across, along) = (
                self.corner[axis] as f32,
                self.across[axis] as f32,
                self.along[axis] as f32,
            );
            for ((output, u), v) in output.iter_mut().zip(u).zip(v) {
                *output = corner + (u * across + v * along);
            }
        }
    }
}
