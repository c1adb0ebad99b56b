//! `blend`: one material where a mask is 0, another where it is 1.
//!
//! Every channel that either has is blended. Standard channels that one lacks have the defaults of `material`, extras
//! that one lacks are 0 or black, unless `missing` says otherwise. Directions are blended as axes, so opposite ones
//! are the same, and have length 1.
//!
//! Where the share changes within a pixel and what is blended does too, the blend is supersampled.
//!
//! With `by: height` the higher material wins. Its share is the S of `transition` around 0 over
//!
//! ```text
//! height of b - height of a + (2 mask - 1) reach
//! ```
//!
//! so the mask raises and lowers `b` by up to `reach`.

pub(super) mod channels;

use super::mix::{Within, mixed};
use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, common_domain};
use crate::nodes::field::threshold::transition;
use crate::value::{Material, Surface, Type, Unit, Value};
use std::sync::Arc;

/// Blends two materials.
pub static KIND: Kind = Kind {
    name: "blend",
    version: 2,
    about: "Blends two whole materials by a mask, or by which of them is higher. Extras that one of them lacks are 0 \
            or black there.",
    source: "own construction; by height after Mishkinis 2013 (terrain texture splatting), with the S of Perlin 1985",
    inputs: &[
        Input::new("a", Type::Material, "The material where the mask is 0."),
        Input::new("b", Type::Material, "The material where the mask is 1."),
        Input::number("mask", Unit::One, "Share of `b`.")
            .per_point()
            .default("0.5")
            .range(0.0, 1.0),
        Input::new(
            "by",
            Type::Choice(&["mask", "height"]),
            "mask: each has its share; height: the higher one wins, and the mask raises `b`.",
        )
        .default("mask"),
        Input::number(
            "transition",
            Unit::Millimetre,
            "With `by: height`: difference in height over which one goes over into the other.",
        )
        .optional()
        .range(0.0, 1e6),
        Input::number(
            "reach",
            Unit::Millimetre,
            "With `by: height`: how far the mask raises `b` at 1 and lowers it at 0; without it 1.",
        )
        .optional()
        .range(0.0, 1e6),
        Input::new(
            "missing",
            Type::Channels,
            "Values of extras where a material lacks them.",
        )
        .per_point()
        .optional(),
    ],
    outputs: &[Output::field(
        "material",
        Type::Material,
        "The blended material.",
    )],
    example: r##"(nodes: {
    "clouds": solid_noise(size: (40, 40, 200)),
    "wood": material(base_color: "#c8a06e", height: "= 0.2 * clouds"),
    "moss": material(base_color: "#5d6b2f", roughness: 0.9),
    "example": blend(a: "wood", b: "moss", mask: 0.4, by: height, transition: 0.05, reach: 0.2),
})"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (a, b) = (inputs.material("a"), inputs.material("b"));
    let size = size(a, b)?;
    let share = share(inputs, build, a, b)?;
    let pairs = channels::pairs(a, b, ["a", "b"], inputs)?;
    let blended = |(name, [a, b]): (String, [Field; 2])| {
        let is_direction = Material::is_direction(&name, &a);
        let within = match [&a, &b].iter().all(|field| field.as_constant().is_some()) {
            true => Within::Straight,
            false => Within::Even,
        };
        let fields = [a, b, share.clone()];
        let field = match is_direction {
            true => build.kernel(channels::Axes, fields.into()),
            false => mixed(build, "normal", within, fields),
        };
        (name, field)
    };
    let channels: std::collections::BTreeMap<_, _> = pairs.into_iter().map(blended).collect();
    Ok(vec![Value::Material(Arc::new(Material {
        domain: common_domain(channels.values()),
        channels,
        size,
        surface: Surface::of_both(a.surface.as_ref(), b.surface.as_ref()),
    }))])
}

/// The size that both pieces have, if they are cut.
fn size(a: &Material, b: &Material) -> Result<Option<[f64; 2]>, Failure> {
    if let ([Some(one), Some(other)], true) = ([a.size, b.size], a.size != b.size) {
        let [one, other] = [one, other].map(|[width, height]| format!("{width} x {height} mm"));
        let message = format!("`a` is a piece of {one}, `b` one of {other}");
        return Err(Failure::of_input("b", message).with_hint("cut both to one size"));
    }
    Ok(a.size.or(b.size))
}

/// The share of `b`.
fn share(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    a: &Material,
    b: &Material,
) -> Result<Field, Failure> {
    let mask = inputs.field("mask");
    if inputs.choice("by") == "mask" {
        for input in ["transition", "reach"] {
            if inputs.get(input).is_some() {
                let message =
                    format!("`{input}` is set, but the materials are not blended by height");
                return Err(Failure::of_input(input, message)
                    .with_hint("write `by: height`, or leave it out"));
            }
        }
        return Ok(mask);
    }
    let Some(width) = inputs
        .get("transition")
        .map(|_| inputs.number("transition"))
    else {
        let failure = Failure::of_input("by", "a blend by height needs `transition`");
        return Err(failure.with_hint("set it to a part of the height of the relief, in mm"));
    };
    let reach = inputs.get("reach").map_or(1.0, |_| inputs.number("reach"));
    let height = |material: &Material| {
        let height = material.channels.get("height");
        height.cloned().unwrap_or_else(|| Field::constant(0.0))
    };
    let above = build.kernel(Above { reach }, vec![height(a), height(b), mask]);
    Ok(transition(build, above, width))
}

/// How far `b` stands above `a`. Columns in: height of `a`, height of `b`, mask.
#[derive(Debug)]
struct Above {
    reach: f64,
}

impl Kernel for Above {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("blend by height")
            .whole(i64::from(KIND.version))
            .number(self.reach);
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [a, b, mask] = [0, 1, 2].map(|column| block.inputs[column].values);
        for (index, output) in block.outputs[0].iter_mut().enumerate() {
            *output = b[index] - a[index] + (2.0 * mask[index] - 1.0) * self.reach as f32;
        }
    }
}
