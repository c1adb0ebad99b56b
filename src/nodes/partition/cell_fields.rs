//! `cell_fields`: what a partition says at each point of the plane.
//!
//! Where a point is in no cell, as in a joint, it is that of the nearest cell, with a border distance below 0. What has a
//! step at the border is averaged over each pixel there; ids are not.

use super::found::{Found, Quantity};
use crate::diagnostics::nearest;
use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::average::Average;
use crate::value::{Domain, Partition, Type, Unit, Value};

/// Samples a partition.
pub static KIND: Kind = Kind {
    name: "cell_fields",
    version: 2,
    about: "What a partition says at each point: the cell's id, the distance to its border, where in the cell the point \
            is, a random number for each cell, an attribute.",
    source: "own construction; distances to segments and arcs, the cell by crossings (Shimrat 1962)",
    inputs: &[
        Input::new("cells", Type::Partition, "The cells."),
        Input::new(
            "attribute",
            Type::Text,
            "The attribute that `attribute` gives, such as \"size\".",
        )
        .optional(),
        Input::new(
            "seed",
            Type::Whole,
            "Another seed gives other random numbers.",
        )
        .default("0"),
    ],
    outputs: &[
        on_plane(
            "border",
            LENGTH,
            "Distance to the cell's border; below 0 outside of all cells.",
        ),
        on_plane("inside", NUMBER, "1 in cells, 0 outside of all."),
        on_plane("id", NUMBER, "The cell's id, a whole number."),
        on_plane(
            "random",
            NUMBER,
            "A random number from 0 to 1 for each cell.",
        ),
        on_plane(
            "attribute",
            NUMBER,
            "The attribute named by `attribute`, else 0.",
        ),
        on_plane(
            "place",
            VECTOR,
            "Where the point is in the cell: mm along the cell's own axes, from its centre.",
        ),
        on_plane(
            "unit",
            Type::Vector(Unit::One),
            "The same from -1 to 1: over the box around the cell along its own axes.",
        ),
        on_plane("centre", VECTOR, "The cell's centre."),
        on_plane(
            "extent",
            VECTOR,
            "Width and height of the box around the cell along its own axes.",
        ),
        on_plane(
            "angle",
            Type::Number(Unit::Degree),
            "The angle of the cell's first axis.",
        ),
        on_plane("area", NUMBER, "The cell's area in mm²."),
        on_plane(
            "beyond",
            NUMBER,
            "The id of the cell beyond the nearest border; -1 if there is none.",
        ),
    ],
    example: r#"(nodes: {
    "blocks": voronoi_split(size: (100, 100), cell_size: 20),
    "example": cell_fields(cells: "blocks"),
})"#,
    build,
};

const NUMBER: Type = Type::Number(Unit::One);
const LENGTH: Type = Type::Number(Unit::Millimetre);
const VECTOR: Type = Type::Vector(Unit::Millimetre);

const fn on_plane(name: &'static str, value_type: Type, about: &'static str) -> Output {
    Output::field(name, value_type, about).on(Domain::Plane)
}

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let partition = inputs.partition("cells");
    let found = Found::new(build, partition);
    let of_cell = |quantity| found.quantity(build, quantity);
    let averaged = |field: Field| {
        build.kernel(
            Average {
                width: field.width(),
            },
            vec![field],
        )
    };
    let attribute = match inputs.get("attribute") {
        None => Field::constant(0.0),
        Some(_) => averaged(of_cell(attribute(partition, inputs.text("attribute"))?)),
    };
    let (extent, middle) = (of_cell(Quantity::Extent), of_cell(Quantity::Middle));
    let unit = build.kernel(Unitary, vec![found.place(), middle, extent.clone()]);
    let random = Quantity::Random(seed(build.seed, inputs.whole("seed")));
    let fields = [
        found.border(),
        averaged(build.kernel(Inside, vec![found.border()])),
        of_cell(Quantity::Id),
        averaged(of_cell(random)),
        attribute,
        averaged(found.place()),
        averaged(unit),
        averaged(of_cell(Quantity::Centre)),
        averaged(extent),
        averaged(of_cell(Quantity::Angle)),
        averaged(of_cell(Quantity::Area)),
        found.beyond(),
    ];
    Ok(fields.map(Value::Field).into())
}

/// The seed of a node that draws a number for each cell.
pub(super) fn seed(recipe_seed: u64, node_seed: i64) -> u64 {
    let key = KeyHasher::new("random of cells", 1)
        .bytes(&recipe_seed.to_le_bytes())
        .whole(node_seed)
        .finish();
    key.short()
}

/// An attribute that the partition has.
fn attribute(partition: &Partition, name: &str) -> Result<Quantity, Failure> {
    if partition.attributes.contains_key(name) {
        return Ok(Quantity::Attribute(name.to_owned()));
    }
    let names = || partition.attributes.keys().map(String::as_str);
    let message = format!("the cells have no attribute `{name}`");
    let hint = match (nearest(name, names()).first(), names().next()) {
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, Some(_)) => format!("they have {}", names().collect::<Vec<_>>().join(", ")),
        (None, None) => "they have none: `cell_attribute` adds some".to_owned(),
    };
    Err(Failure::of_input("attribute", message).with_hint(hint))
}

/// 1 where the distance to the border is not below 0: between cells that touch, nothing is outside.
#[derive(Debug)]
struct Inside;

impl Kernel for Inside {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("inside cells").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let borders = block.inputs[0].values;
        for (output, border) in block.outputs[0].iter_mut().zip(borders) {
            *output = f32::from(u8::from(*border >= 0.0));
        }
    }
}

/// Columns in: place, middle and extent of the cell.
#[derive(Debug)]
struct Unitary;

impl Kernel for Unitary {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("unit of cell").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (axis, output) in block.outputs.iter_mut().enumerate() {
            let [place, middle, extent] = [0, 3, 6].map(|first| block.inputs[first + axis].values);
            for (index, unit) in output.iter_mut().enumerate() {
                let half = 0.5 * extent[index];
                *unit = if half > 0.0 {
                    (place[index] - middle[index]) / half
                } else {
                    0.0
                };
            }
        }
    }
}
