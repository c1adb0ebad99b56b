//! `per_cell`: lays a material of its own into each cell of a partition.
//!
//! Each cell is a piece of its own: with x and y from the cell's centre along its own axes, it shows the point
//!
//! ```text
//! S (origin + d + x across + y along)
//! ```
//!
//! of the material, where d is drawn for each cell from the box of `scatter`, and S turns by an angle of its own about the
//! upright axis of the solid. What is laid differs in nothing else, so cells of one material share its maths, and there
//! is no picture of a cell.

mod choice;
mod laid;

use self::choice::{Chosen, Drawn, Pick};
use self::laid::Laid;
use super::cell_fields::seed;
use super::found::{Found, Quantity};
use crate::field::{Field, names_read};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, counted, field_of};
use crate::nodes::surface::material::default_of;
use crate::value::{Domain, Material, Partition, Surface, Type, Unit, Value};
use glam::DVec2;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Lays materials into cells.
pub static KIND: Kind = Kind {
    name: "per_cell",
    version: 1,
    about: "Lays a material into each cell of a partition, from a place of its own in the solid; which of several \
            materials is drawn, or chosen by a number. `cell_value` reads what the cells say inside the materials.",
    source: "own construction; solid textures placed piece by piece (Peachey 1985; Perlin 1985)",
    inputs: &[
        Input::new("cells", Type::Partition, "The cells."),
        Input::new(
            "of",
            Type::Materials,
            "What is laid: a link to a material, or several by names, `{\"oak\": \"oak\", \"ash\": \"pale\"}`.",
        ),
        Input::number(
            "choose",
            Unit::One,
            "Which of the materials a cell has, counted from 0: the number at its centre, rounded. Left out, it is drawn.",
        )
        .per_point()
        .of(Domain::Plane)
        .optional(),
        Input::new(
            "weights",
            Type::Channels,
            "How often each material is drawn, by name; 1 where it is left out.",
        )
        .optional(),
        Input::new(
            "origin",
            Type::Vector(Unit::Millimetre),
            "Where in the material a cell's centre lies; as it is at the centre.",
        )
        .per_point()
        .range(-1e9, 1e9)
        .of(Domain::Plane)
        .default("(0, 0, 0)"),
        Input::new(
            "scatter",
            Type::Vector(Unit::Millimetre),
            "How far each way that place is drawn from the origin, along x, y and z.",
        )
        .default("(0, 0, 0)")
        .range(0.0, 1e7),
        Input::new(
            "across",
            Type::Vector(Unit::One),
            "Direction in the material of a cell's first axis.",
        )
        .default("(1, 0, 0)"),
        Input::new(
            "along",
            Type::Vector(Unit::One),
            "Direction in the material of a cell's second axis; left out, up the trunk of a solid, and v of a flat piece.",
        )
        .optional(),
        Input::number(
            "spin",
            Unit::Degree,
            "The place is turned about the upright axis of the solid by an angle drawn from so wide a range.",
        )
        .default("0")
        .range(0.0, 360.0),
        Input::new(
            "turns",
            Type::Whole,
            "In how many ways a piece may lie in its cell: 1 only as it is, 2 also upside down, 4 also across.",
        )
        .default("1")
        .range(1.0, 360.0),
        Input::new(
            "frame",
            Type::Choice(&["cell", "piece"]),
            "Whether the material follows the axes of each cell or those of the whole piece.",
        )
        .default("cell"),
        Input::new(
            "values",
            Type::Channels,
            "What `cell_value` finds inside the materials, by name, besides `random`, `id`, `area` and the attributes.",
        )
        .per_point()
        .of(Domain::Plane)
        .optional(),
        Input::new("seed", Type::Whole, "Another seed draws otherwise.").default("0"),
    ],
    outputs: &[
        Output::field("piece", Type::Material, "The piece of all cells.").on(Domain::Plane),
        Output::field(
            "choice",
            Type::Number(Unit::One),
            "Which of the materials a cell has, counted from 0.",
        )
        .on(Domain::Plane),
    ],
    example: r##"(nodes: {
    "tone": cell_value(name: "random"),
    "shade": mix(a: "#c8a06e", b: "#9a7444", amount: "tone"),
    "oak": material(base_color: "shade", roughness: "= 0.5 + 0.2 * tone"),
    "ash": material(base_color: "#e8d8b8"),
    "blocks": voronoi_split(size: (100, 100), cell_size: 20),
    "example": per_cell(cells: "blocks", of: {"oak": "oak", "ash": "ash"}, scatter: (500, 500, 500)),
})"##,
    build,
};

/// Draws of one node for a cell: each has a seed of its own.
const CHOICE: u64 = 1;
const PLACE: u64 = 2;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let partition = inputs.partition("cells");
    let materials = materials(inputs)?;
    let found = Found::new(build, partition);
    let seed = seed(build.seed, inputs.whole("seed"));
    let choice = choice(inputs, build, &found, &materials, seed)?;
    let given = given(inputs, build, &found, seed);
    warn_of_names(inputs, &materials, &given);
    let centre = found.quantity(build, Quantity::Centre);
    let origin = inputs.field("origin").at(&centre);
    let mut charts = vec![found.chart(build)];
    let mut channels: Vec<BTreeMap<String, Field>> = vec![];
    for (_, material) in &materials {
        let laid = Laid::read(
            inputs,
            (partition, found.key()),
            material.domain,
            seed ^ PLACE,
        )?;
        let place = build.kernel(laid, vec![found.index(), found.place(), origin.clone()]);
        let here =
            |(name, field): (&String, &Field)| (name.clone(), field.at_given(&place, &given));
        channels.push(material.channels.iter().map(here).collect());
        let of_material = material.surface.as_ref().map(|surface| surface.at(&place));
        charts.extend(of_material.into_iter().flat_map(|surface| surface.charts));
    }
    let picked = picked(build, &found.index(), &choice, &channels)?;
    let piece = Material {
        domain: Domain::Plane,
        channels: picked,
        size: size(partition),
        surface: Some(Surface {
            tangents: None,
            charts,
        }),
    };
    Ok(vec![Value::Material(Arc::new(piece)), Value::Field(choice)])
}

/// The materials by their names, in the order of the recipe.
fn materials<'i>(inputs: &'i Inputs<'_>) -> Result<Vec<(&'i str, &'i Arc<Material>)>, Failure> {
    let listed = inputs.channels("of").iter();
    let materials: Vec<_> = listed
        .filter_map(|(name, value)| match value {
            Value::Material(material) => Some((name.as_str(), material)),
            _ => None,
        })
        .collect();
    if materials.is_empty() {
        let failure = Failure::of_input("of", "expected one material or more, found none");
        return Err(failure.with_hint("name them, as in `of: {\"oak\": \"oak\"}`"));
    }
    Ok(materials)
}

/// Which of the materials each cell has.
fn choice(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    found: &Found,
    materials: &[(&str, &Arc<Material>)],
    seed: u64,
) -> Result<Field, Failure> {
    let last = materials.len() - 1;
    if inputs.get("choose").is_some() {
        if inputs.get("weights").is_some() {
            let message = "`weights` are stated, but `choose` says which material a cell has";
            return Err(Failure::of_input("weights", message).with_hint("remove one of them"));
        }
        warn_of_numbers(inputs, build, last)?;
        let centre = found.quantity(build, Quantity::Centre);
        let number = inputs.field("choose").at(&centre);
        return Ok(build.kernel(Chosen { last }, vec![number, found.index()]));
    }
    let random = found.quantity(build, Quantity::Random(seed ^ CHOICE));
    let drawn = Drawn::new(&weights(inputs, materials)?).ok_or_else(|| {
        Failure::of_input("weights", "no material has a weight above 0")
            .with_hint("give one of them a weight of 1")
    })?;
    Ok(build.kernel(drawn, vec![random]))
}

/// Warns of cells whose number is not that of a material.
fn warn_of_numbers(inputs: &Inputs<'_>, build: &Build<'_>, last: usize) -> Result<(), Failure> {
    let numbers = inputs.sample("choose", build, &inputs.partition("cells").centres)?;
    let is_beyond = |number: &&f32| **number < -0.5 || **number >= last as f32 + 0.5;
    let count = numbers[0].iter().filter(is_beyond).count();
    if count > 0 {
        let cells = counted(count, "cell", "cells");
        inputs.warn(format!(
            "`choose` gives {cells} a number that is not from 0 to {last}: the nearest material is taken"
        ));
    }
    Ok(())
}

/// The weight of each material.
fn weights(inputs: &Inputs<'_>, materials: &[(&str, &Arc<Material>)]) -> Result<Vec<f64>, Failure> {
    let mut weights = vec![1.0; materials.len()];
    if inputs.get("weights").is_none() {
        return Ok(weights);
    }
    for (name, value) in inputs.channels("weights") {
        let refuse = |message: String| Failure::of_input("weights", message);
        let Some(index) = materials.iter().position(|(material, _)| material == name) else {
            let names: Vec<_> = materials.iter().map(|(name, _)| *name).collect();
            return Err(refuse(format!("no material is called `{name}`"))
                .with_hint(format!("the materials are {}", names.join(", "))));
        };
        weights[index] = match value.as_number() {
            Some(weight) if weight >= 0.0 => weight,
            _ => {
                return Err(refuse(format!(
                    "the weight of `{name}` is not a number from 0 on"
                )));
            }
        };
    }
    Ok(weights)
}

/// What the materials find out about their cell, by name.
fn given(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    found: &Found,
    seed: u64,
) -> Vec<(Arc<str>, Field)> {
    let mut given: Vec<(Arc<str>, Field)> = vec![];
    if inputs.get("values").is_some() {
        let values = inputs.channels("values").iter();
        given.extend(
            values.filter_map(|(name, value)| Some((name.as_str().into(), field_of(value)?))),
        );
    }
    let attributes = inputs.partition("cells").attributes.keys();
    let attributes = attributes.map(|name| (name.as_str(), Quantity::Attribute(name.clone())));
    let always = [
        ("random", Quantity::Random(seed)),
        ("id", Quantity::Id),
        ("area", Quantity::Area),
        ("centre", Quantity::Centre),
        ("extent", Quantity::Extent),
    ];
    for (name, quantity) in attributes.chain(always) {
        if given.iter().all(|(known, _)| &**known != name) {
            given.push((name.into(), found.quantity(build, quantity)));
        }
    }
    given
}

/// Warns of names that nobody reads, and of names that nobody gives.
fn warn_of_names(
    inputs: &Inputs<'_>,
    materials: &[(&str, &Arc<Material>)],
    given: &[(Arc<str>, Field)],
) {
    let fields = |material: &Arc<Material>| material.channels.values().cloned().collect::<Vec<_>>();
    let read = names_read(materials.iter().flat_map(|(_, material)| fields(material)));
    let is_given = |name: &str, width| {
        let mut given = given.iter();
        given.any(|(known, field)| &**known == name && field.width() == width)
    };
    for (name, width) in &read {
        if !is_given(name, *width) {
            inputs.warn(format!(
                "a material reads the cell value `{name}`, which is not among `values` nor known of the cells"
            ));
        }
    }
    if inputs.get("values").is_none() {
        return;
    }
    for (name, _) in inputs.channels("values") {
        if read.iter().all(|(known, _)| **known != **name) {
            inputs.warn(format!("no material reads the cell value `{name}`"));
        }
    }
}

/// The channels of all materials, each from the material that the cell has.
fn picked(
    build: &Build<'_>,
    index: &Field,
    choice: &Field,
    materials: &[BTreeMap<String, Field>],
) -> Result<BTreeMap<String, Field>, Failure> {
    let names: BTreeSet<&String> = materials.iter().flat_map(BTreeMap::keys).collect();
    let pick = |name: &&String| {
        let fields = || materials.iter().filter_map(|channels| channels.get(*name));
        let width = fields().next().map_or(1, Field::width);
        if fields().any(|field| field.width() != width) {
            let message =
                format!("the channel `{name}` is a number in one material and not in another");
            return Err(Failure::of_input("of", message)
                .with_hint("make them alike, or give one of them another name"));
        }
        let of_each = materials.iter().map(|channels| match channels.get(*name) {
            Some(field) => field.clone(),
            None => default_of(name, width),
        });
        let of_each: Vec<Field> = of_each.collect();
        let is_same = of_each.iter().all(|field| field.key() == of_each[0].key());
        if is_same && of_each[0].as_constant().is_some() {
            return Ok(((*name).clone(), of_each[0].clone()));
        }
        let kernel = Pick {
            width,
            count: of_each.len(),
        };
        let columns = [vec![index.clone(), choice.clone()], of_each].concat();
        Ok(((*name).clone(), build.kernel(kernel, columns)))
    };
    names.iter().map(pick).collect()
}

/// Width and height of the piece from the origin on, if all cells lie there.
fn size(partition: &Partition) -> Option<[f64; 2]> {
    if let Some(period) = partition.period {
        return Some(period.to_array());
    }
    let boxes = (0..partition.len()).map(|cell| partition.box_of(cell));
    let [low, high] = boxes.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |all, one| {
        [all[0].min(one[0]), all[1].max(one[1])]
    });
    let slack = 1e-6 * high.abs().max_element();
    (low.min_element() >= -slack).then(|| high.to_array())
}
