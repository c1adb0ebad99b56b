//! `material`: bundles fields into the channels of a material.
//!
//! Every channel is defined where its input is; a material whose channels are all constant fits into a
//! solid and onto a plane. Lengths are mm, colours linear Rec. 709, the rest ratios from 0 to 1.

use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, Presence, common_domain, field_of};
use crate::value::{Material, Type, Unit, Value};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Bundles fields into a material.
pub static KIND: Kind = Kind {
    name: "material",
    version: 1,
    about: "Bundles colour, height, roughness and any extras into one material.",
    source: "own construction; channel names follow OpenPBR and glTF",
    inputs: &[
        Input::new("base_color", Type::Colour, "Colour of the surface.").per_point(),
        Input::number(
            "height",
            Unit::Millimetre,
            "Relief; positive stands out of the surface.",
        )
        .per_point()
        .default("0"),
        Input::number(
            "roughness",
            Unit::One,
            "Roughness of the reflection: 0 mirror, 1 chalk.",
        )
        .per_point()
        .default("0.5")
        .range(0.0, 1.0),
        Input::number(
            "metalness",
            Unit::One,
            "1 for metal, 0 for everything else.",
        )
        .per_point()
        .default("0")
        .range(0.0, 1.0),
        Input::number(
            "occlusion",
            Unit::One,
            "Share of the sky that the point sees.",
        )
        .per_point()
        .default("1")
        .range(0.0, 1.0),
        Input::number(
            "opacity",
            Unit::One,
            "1 where there is material, 0 where there is none.",
        )
        .per_point()
        .default("1")
        .range(0.0, 1.0),
        Input::new(
            "extras",
            Type::Channels,
            "Channels of your own, such as `growth_time`; vectors by links, such as `fibre`.",
        )
        .per_point()
        .optional(),
    ],
    outputs: &[Output::field(
        "material",
        Type::Material,
        "The material, uncut or flat.",
    )],
    example: r##"(nodes: {
        "grain": solid_noise(size: (2, 2, 60)),
        "example": material(base_color: "#c8a06e", height: "= 0.05 * grain.value", roughness: 0.6),
    })"##,
    build,
};

/// The channels that every material has, in the order of the inputs.
pub const STANDARD_CHANNELS: [&str; 6] = [
    "base_color",
    "height",
    "roughness",
    "metalness",
    "occlusion",
    "opacity",
];

/// What a channel of `width` columns is where a material does not have it: the default of the input, 0 or black for
/// extras.
pub(in crate::nodes) fn default_of(channel: &str, width: usize) -> Field {
    let declared = match KIND.input(channel).map(|(_, input)| input.presence) {
        Some(Presence::Default(literal)) => literal.parse().ok(),
        _ => None,
    };
    let number = declared.unwrap_or(0.0);
    Field::constants(&vec![number; width])
}

/// Channels, with the defaults of the standard ones that are not among them.
pub(in crate::nodes) fn with_defaults(
    channels: impl IntoIterator<Item = (String, Field)>,
) -> BTreeMap<String, Field> {
    let width = |name: &str| if name == "base_color" { 3 } else { 1 };
    let defaults = STANDARD_CHANNELS.map(|name| (name.to_owned(), default_of(name, width(name))));
    defaults.into_iter().chain(channels).collect()
}

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let standard = STANDARD_CHANNELS.map(|name| (name.to_owned(), inputs.field(name)));
    let mut channels = BTreeMap::from(standard);
    if inputs.get("extras").is_some() {
        for (name, value) in inputs.channels("extras") {
            if STANDARD_CHANNELS.contains(&name.as_str()) || name == "normal" {
                let message = format!("the extra `{name}` has the name of a standard channel");
                return Err(Failure::of_input("extras", message).with_hint("choose another name"));
            }
            channels.extend(field_of(value).map(|field| (name.clone(), field)));
        }
    }
    let domain = common_domain(channels.values());
    Ok(vec![Value::Material(Arc::new(Material {
        domain,
        channels,
        size: None,
        surface: None,
    }))])
}
