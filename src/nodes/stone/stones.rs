//! `stones`: a stone on every cell of a partition, as relief and colours of a flat piece.
//!
//! A stone is a prism over its cell, narrower by the joint, whose top corners are moved by chance; `round` and `corner`
//! stones are what Loop subdivision makes of it (fig. 7 and 8 of the paper). A `sett` is dressed flat, with a rim that is
//! a quarter of a circle.
//!
//! At each point the stones near it are asked for their height, and the highest counts: stones are never drawn into a
//! picture. A pixel at a rim has the share of each stone in it: of setts by the distance to the outline, of others by four points.

mod bed;
mod cage;
mod depth;
mod form;
mod grid;
mod ground;
mod kernels;
mod laying;
mod manner;
mod optics;
mod outline;
mod shape;
mod top;

use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};
use kernels::{Find, OfStone, Relief, Shown};
use laying::{Laid, lay};
use optics::OPTICS;

/// Stones on the cells of a partition.
pub static KIND: Kind = Kind {
    name: "stones",
    version: 4,
    about: "A stone on every cell: prisms, round stones, stones with corners or dressed setts, each a little different, \
            let into a bed that fills the joints.",
    source: "Miyata, Itoh & Shimada 2000 (section 4); Loop 1987; setts, tilt, wear and chips: own construction",
    inputs: INPUTS,
    outputs: &[
        Output::field(
            "height",
            Type::Number(Unit::Millimetre),
            "Height of what is seen, stone or bed, above the base.",
        )
        .on(Domain::Plane),
        Output::field(
            "mask",
            Type::Number(Unit::One),
            "1 where a stone is seen, 0 where the bed is.",
        )
        .on(Domain::Plane),
        Output::field(
            "colour",
            Type::Colour,
            "Colour of the stone; in joints that of the nearest.",
        )
        .on(Domain::Plane),
        Output::field(
            "roughness",
            Type::Number(Unit::One),
            "Roughness of the stone.",
        )
        .on(Domain::Plane),
        Output::field(
            "optical_index",
            Type::Number(Unit::One),
            "Which record of `optics` the stone has, from 0 on; not averaged.",
        )
        .on(Domain::Plane),
        Output::field(
            "specular",
            Type::Number(Unit::One),
            "Strength of Phong's highlight.",
        )
        .on(Domain::Plane),
        Output::field("exponent", Type::Number(Unit::One), "Phong's exponent.").on(Domain::Plane),
        Output::field(
            "stone",
            Type::Number(Unit::One),
            "1 more than the id of the cell whose stone is seen, 0 where the bed is; not averaged.",
        )
        .on(Domain::Plane),
        Output::field(
            "random",
            Type::Number(Unit::One),
            "A number from 0 to 1 for each stone.",
        )
        .on(Domain::Plane),
        Output::field(
            "edge",
            Type::Number(Unit::Millimetre),
            "How far inside the stone's outline the point is; below 0 in joints.",
        )
        .on(Domain::Plane),
        Output::field(
            "tilt",
            Type::Number(Unit::Degree),
            "How far the stone's top leans.",
        )
        .on(Domain::Plane),
        Output::field(
            "recess",
            Type::Number(Unit::One),
            "How hidden the point is: 0 on stones and on open ground, 1 in the middle of joints, soft between.",
        )
        .on(Domain::Plane),
    ],
    example: r##"(nodes: {
        "cells": voronoi_split(size: (1000, 1000), cell_size: 80),
        "example": stones(cells: "cells", height: 60, bed: 45, optics: [(colour: "#91968f"), (colour: "#7a7e78", weight: 2)]),
    })"##,
    build,
};

const INPUTS: &[Input] = &[
    Input::new("cells", Type::Partition, "The cells."),
    Input::new(
        "stone",
        Type::Choice(&["sett", "prism", "round", "corner"]),
        "sett: dressed, flat with a round rim; prism: with sharp edges; round: rounded all over; corner: rounded, with corners.",
    )
    .default("sett"),
    Input::number("height", Unit::Millimetre, "Height of the stones above the base.").default("100").range(1e-3, 1e5),
    Input::number("unevenness", Unit::Millimetre, "Standard deviation of the stones' heights.").default("1.5").range(0.0, 1e4),
    Input::number("deformation", Unit::Millimetre, "How far the corners of the top are moved at most, along x, y and z.")
        .default("2")
        .range(0.0, 1e4),
    Input::number("joint", Unit::Millimetre, "Width of the joints.").default("8").range(0.0, 1e4),
    Input::number("joint_variation", Unit::One, "Standard deviation of the joints' width, relative to it.")
        .default("0.2")
        .range(0.0, 0.5),
    Input::number("rounding", Unit::Millimetre, "Of setts: radius of the rim.").default("6").range(0.0, 1e4),
    Input::number("corner_radius", Unit::Millimetre, "Of setts: radius of the corners, seen from above.").default("8").range(0.0, 1e4),
    Input::number("crown", Unit::Millimetre, "Of setts: how far the middle stands above the rim.").default("1").range(-1e3, 1e3),
    Input::number("corner_ratio", Unit::One, "Of stones with corners: how far along the edges the vertices are that hold them.")
        .default("0.2")
        .range(0.01, 0.45),
    Input::number("swell", Unit::One, "Of round stones and those with corners: 0 leaves them as small as subdivision makes them, 1 lets them fill cell and height.")
        .default("0")
        .range(0.0, 1.0),
    Input::number("tilt", Unit::Degree, "Standard deviation of the angle at which the stones lie, along x and along y.").default("1").range(0.0, 30.0),
    Input::number("settle", Unit::Millimetre, "How far the ground has risen or sunk: stones move and lean with it.")
        .per_point()
        .of(Domain::Plane)
        .default("0"),
    Input::number("wear", Unit::One, "How far feet and wheels have worn the stones: 0 not at all, 1 flat.")
        .per_point()
        .of(Domain::Plane)
        .default("0")
        .range(0.0, 1.0),
    Input::number("bed", Unit::Millimetre, "Height of what fills the joints above the base.").per_point().of(Domain::Plane).default("0"),
    Input::number("chips", Unit::Millimetre, "How far from its edge the stone is chipped.").per_point().of(Domain::Plane).default("0"),
    Input::number("relief", Unit::Millimetre, "What is added to the height of stones, in their mask: their rough faces.")
        .per_point()
        .of(Domain::Plane)
        .default("0"),
    Input::number("variety", Unit::One, "How far the brightness differs from stone to stone, on top of the table; it follows `random`.")
        .default("0")
        .range(0.0, 1.0),
    Input::new("optics", Type::List(&Type::Record(OPTICS)), "What stones look like: each gets one of these by chance.")
        .default("[(colour: \"#868b86\")]"),
    Input::new("seed", Type::Whole, "Another number gives other stones; so does the recipe's seed.").default("0"),
];

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let table = optics::read(inputs)?;
    let laid = lay(inputs, build, &table)?;
    let [colours, optics, chances, numbers] = columns(&laid, &table, inputs.number("variety"));
    let find = Find {
        key: laid.ground.key(),
        ground: laid.ground,
    };
    let widest = laid.widest as f32;
    let place = Field::position(Domain::Plane);
    let found = build.kernel(find, vec![place.clone()]);
    let [bed, chips, face] = ["bed", "chips", "relief"].map(|name| inputs.field(name));
    let joint = inputs.number("joint") as f32;
    let relief = Relief { joint, widest };
    let relief = build.kernel(
        relief,
        vec![found.part(0, 4), bed, chips, face, place.clone()],
    );
    let of_stone = |columns: Vec<Vec<f32>>, widest: Option<f32>| {
        build.kernel(
            OfStone::new(columns, widest),
            vec![found.part(4, 3), place.clone()],
        )
    };
    let [colours, optics, chances] =
        [colours, optics, chances].map(|columns| of_stone(columns, Some(widest)));
    let numbers = of_stone(numbers, None);
    let id = build.kernel(Shown, vec![relief.part(1, 1), numbers.part(1, 1)]);
    let fields = [
        relief.part(0, 1),
        relief.part(1, 1),
        colours,
        optics.part(0, 1),
        numbers.part(0, 1),
        optics.part(1, 1),
        optics.part(2, 1),
        id,
        chances.part(0, 1),
        relief.part(2, 1),
        chances.part(1, 1),
        relief.part(3, 1),
    ];
    Ok(fields.map(Value::Field).to_vec())
}

/// What belongs to each stone: colours, optics and chances, which are averaged over pixels, and numbers, which are not.
/// Behind the stones stands what counts where there is none.
fn columns(laid: &Laid, table: &[optics::Optics], variety: f64) -> [Vec<Vec<f32>>; 4] {
    let column = |value: &dyn Fn(usize) -> f64, none: f64| -> Vec<f32> {
        let stones = (0..laid.records.len()).map(value);
        stones.chain([none]).map(|value| value as f32).collect()
    };
    let of_record = |value: &dyn Fn(&optics::Optics) -> f64| {
        column(
            &|stone| value(&table[laid.records[stone]]),
            value(&table[0]),
        )
    };
    let colours = [0, 1, 2].map(|part| {
        let of_stone = |stone: usize| {
            let brightness = 1.0 + variety * (2.0 * laid.shares[stone] - 1.0);
            table[laid.records[stone]].colour[part] * brightness
        };
        column(&of_stone, table[0].colour[part])
    });
    let optics = vec![
        of_record(&|record| record.roughness),
        of_record(&|record| record.specular),
        of_record(&|record| record.exponent),
    ];
    let chances = vec![
        column(&|stone| laid.shares[stone], 0.0),
        column(&|stone| laid.tilts[stone], 0.0),
    ];
    let numbers = vec![
        column(&|stone| laid.records[stone] as f64, 0.0),
        column(&|stone| f64::from(laid.ids[stone]) + 1.0, 0.0),
    ];
    [colours.to_vec(), optics, chances, numbers]
}
