//! `inlay`: lets one material into another.
//!
//! With d the distance to the outline of what is let in, above 0 inside, and g the width of the gap:
//!
//! ```text
//! d < -g/2          the ground
//! -g/2 < d < g/2    the glue, `depth` below the level of the ground
//! g/2 < d           what is let in, `step` above that level
//! ```
//!
//! Both edges of the gap are chamfered at 45 degrees. The glue lies in the shade: at the bottom of a groove of width g and
//! depth h the share sin(atan(g / 2h)) of the sky is seen. All of this is a profile of d, averaged exactly over each
//! pixel, so a gap that is finer than a pixel darkens it as much as it should.

mod room;
mod zones;

use self::zones::{Cut, Joined, Seen, Zones};
use super::blend::channels::{Axes, pairs};
use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::partition::found::Found;
use crate::nodes::partition::region_cells::cells;
use crate::value::{Domain, Material, Partition, Surface, Type, Unit, Value};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Lets a material into another.
pub static KIND: Kind = Kind {
    name: "inlay",
    version: 3,
    about: "Lets one flat material into another, inside a region or the cells of a partition: with a gap, a glue line, a \
            step in height and chamfered edges, in all channels alike.",
    source: "own construction: a profile of the distance to the outline; shade of a groove after Lambert's cosine law",
    inputs: &[
        Input::new("ground", Type::Material, "What it is let into.").of(Domain::Plane),
        Input::new(
            "of",
            Type::Material,
            "What is let in, laid out where it shall be seen.",
        )
        .of(Domain::Plane),
        Input::new(
            "region",
            Type::Region,
            "Where it is let in; or state `cells`.",
        )
        .optional(),
        Input::new(
            "cells",
            Type::Partition,
            "The pieces that are let in, each with a gap around it; instead of a `region`.",
        )
        .optional(),
        Input::number(
            "gap",
            Unit::Millimetre,
            "Width of the gap, half of it on each side of the outline.",
        )
        .default("0.15")
        .range(0.0, 1e5),
        Input::number(
            "depth",
            Unit::Millimetre,
            "How far the glue lies below `level`.",
        )
        .default("0.1")
        .range(0.0, 1e5),
        Input::number(
            "step",
            Unit::Millimetre,
            "How far what is let in stands above `level`; below 0 it is sunk.",
        )
        .default("0")
        .range(-1e5, 1e5),
        Input::number(
            "level",
            Unit::Millimetre,
            "Height of the ground's face in its own material: of stones their height, of boards mostly 0.",
        )
        .default("0")
        .range(-1e6, 1e6),
        Input::number(
            "chamfer",
            Unit::Millimetre,
            "Width of the chamfer on what is let in.",
        )
        .default("0.1")
        .range(0.0, 1e5),
        Input::number(
            "ground_chamfer",
            Unit::Millimetre,
            "Width of the chamfer on the ground.",
        )
        .default("0.05")
        .range(0.0, 1e5),
        Input::new(
            "glue",
            Type::Colour,
            "Colour of the glue, or of the dirt in the gap.",
        )
        .per_point()
        .default("\"#2e2118\""),
        Input::number("glue_roughness", Unit::One, "Roughness of the glue.")
            .per_point()
            .default("0.8")
            .range(0.0, 1.0),
        Input::new(
            "missing",
            Type::Channels,
            "Values of extras where a material lacks them.",
        )
        .per_point()
        .optional(),
    ],
    outputs: &[
        Output::field("piece", Type::Material, "Both materials in one piece.").on(Domain::Plane),
        Output::field(
            "share",
            Type::Number(Unit::One),
            "1 where it is let in, 0 on the ground and the glue.",
        )
        .on(Domain::Plane),
        Output::field(
            "gap",
            Type::Number(Unit::One),
            "1 on the glue, 0 elsewhere.",
        )
        .on(Domain::Plane),
    ],
    example: r##"(nodes: {
    "oak": material(base_color: "#b98d5a", roughness: 0.5),
    "slate": material(base_color: "#5b6066", roughness: 0.7),
    "board": slice_cut(of: "oak", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), size: (100, 100)),
    "plate": slice_cut(of: "slate", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), size: (100, 100)),
    "shape": region_shape(size: (70, 70), at: (15, 15), round: 12),
    "example": inlay(ground: "board", of: "plate", region: "shape", gap: 0.4),
})"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (ground, of) = (inputs.material("ground"), inputs.material("of"));
    let outline = outline(inputs, build)?;
    let cut = Cut::read(inputs);
    let across = Field::position(Domain::Plane).part(0, 1);
    let [border, beyond, index] = outline;
    let zones = build.kernel(Zones::new(&cut), vec![border, beyond, across.clone()]);
    let shares = zones.part(0, 2);
    let seen = build.kernel(Seen, vec![shares.clone()]);
    let channels = pairs(ground, of, ["ground", "of"], inputs)?;
    let joined = |(name, [a, b]): (String, [Field; 2])| {
        let width = a.width();
        let glue = match name.as_str() {
            "base_color" => Some(inputs.field("glue")),
            "roughness" => Some(inputs.field("glue_roughness")),
            "metalness" => Some(Field::constant(0.0)),
            "height" => Some(Field::constant(cut.level - cut.depth)),
            _ => None,
        };
        if Material::is_direction(&name, &a) {
            let axes = build.kernel(Axes, vec![a, b, zones.part(1, 1)]);
            return (name, axes);
        }
        let is_same = a.key() == b.key() && a.as_constant().is_some() && glue.is_none();
        let field = match is_same {
            true => a,
            false => {
                // What the glue does not say is as on the ground.
                let glue = glue.unwrap_or_else(|| a.clone());
                let joined = Joined {
                    width,
                    detail: cut.detail(),
                };
                let columns = [&seen, &shares, &a, &glue, &b, &index, &across];
                build.kernel(joined, columns.map(Field::clone).into())
            }
        };
        let field = match name.as_str() {
            "height" => build.kernel(zones::Sum, vec![field, zones.part(2, 1)]),
            "occlusion" => build.kernel(zones::Product, vec![field, zones.part(3, 1)]),
            _ => field,
        };
        (name, field)
    };
    let channels: BTreeMap<String, Field> = channels.into_iter().map(joined).collect();
    let piece = Material {
        domain: Domain::Plane,
        channels,
        size: ground.size.or(of.size),
        surface: Surface::of_both(ground.surface.as_ref(), of.surface.as_ref()),
    };
    Ok(vec![
        Value::Material(Arc::new(piece)),
        Value::Field(zones.part(1, 1)),
        Value::Field(zones.part(0, 1)),
    ])
}

/// The distance to the outline, above 0 inside, the id of the cell that touches it there, -1 for none, and the index of the
/// nearest cell.
fn outline(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<[Field; 3], Failure> {
    let stated = ["region", "cells"].map(|name| inputs.get(name).is_some());
    match stated {
        [true, false] => {
            let cells = cells(inputs.region("region"), build)?;
            Ok(of_cells(&Arc::new(cells), inputs, build))
        }
        [false, true] => Ok(of_cells(inputs.partition("cells"), inputs, build)),
        [true, true] => {
            let message = "both a `region` and `cells` are stated";
            Err(Failure::of_input("region", message).with_hint("keep one of them"))
        }
        [false, false] => {
            let failure = Failure::new("nothing says where it is let in");
            Err(failure.with_hint("link a `region`, or the `cells` of a partition"))
        }
    }
}

/// What [`outline`] gives, of cells. Warns if all of them are beside the ground.
fn of_cells(cells: &Arc<Partition>, inputs: &Inputs<'_>, build: &Build<'_>) -> [Field; 3] {
    let is_beside = |[width, height]: [f64; 2]| {
        let beside = |cell: usize| {
            let [low, high] = cells.box_of(cell);
            high.min_element() <= 0.0 || low.x >= width || low.y >= height
        };
        cells.period.is_none() && (0..cells.len()).all(beside)
    };
    if inputs.material("ground").size.is_some_and(is_beside) {
        inputs
            .warn("nothing is let in: the outline lies beside the ground, which begins at (0, 0)");
    } else {
        room::warn_of_room(inputs, cells);
    }
    let found = Found::new(build, cells);
    let beyond = match cells.touches() {
        true => found.beyond(),
        false => Field::constant(-1.0),
    };
    [found.border(), beyond, found.index()]
}
