//! `packing_table`: says how good a packing is, as CSV.
//!
//! One row. Angles are between the axes of the stones and the direction field: of oblong stones and stones in a bond up to 90
//! degrees, of hexagons up to 30, of others up to 45. The order is 1 if neighbours lie on the stones' own lattice, and is left
//! out for pentagons, which have none. Stones larger than half as much again as their size asks for count as empty beyond that. A joint is measured from the edge of a stone
//! straight to the next stone, three times along each edge; where a stone is missing it is as wide as the empty place, up to one
//! and a half stones.

use crate::geometry::packing::attributes::symmetry;
use crate::geometry::packing::direction::Directions;
use crate::geometry::packing::statistics::{Statistics, measure};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Table, Type, Unit, Value};
use glam::DVec2;
use std::sync::Arc;

/// Writes the quality of a packing as CSV.
pub static KIND: Kind = Kind {
    name: "packing_table",
    version: 3,
    about: "Writes how good a packing is as a CSV file: order, angles to the field, occupancy, joints, overlaps, stones across \
            the outline; stands in `outputs`.",
    source: "own construction",
    inputs: &[
        Input::new(
            "of",
            Type::Partition,
            "The stones: cells, or what is left of them behind their joints.",
        ),
        Input::new("region", Type::Region, "What they were packed into."),
        Input::new(
            "direction",
            Type::Vector(Unit::One),
            "The direction that they should follow; left out, that of the border.",
        )
        .per_point()
        .of(Domain::Plane)
        .optional(),
    ],
    outputs: &[Output::new("table", Type::Maps, "The file.")],
    example: "(nodes: {
        \"court\": region(outlines: [(outline: [(0, 0), (2000, 0), (2000, 1500), (0, 1500)])]),
        \"stones\": square_packing(region: \"court\", stone: 100),
    }, outputs: { \"example\": packing_table(of: \"stones\", region: \"court\") })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (partition, region) = (inputs.partition("of"), inputs.region("region"));
    let directions: Vec<DVec2> = match inputs.optional_field("direction") {
        Some(field) => {
            let columns = build.sample(&field, &partition.centres)?;
            let vectors = columns[0].iter().zip(&columns[1]);
            let vector = |(x, y): (&f32, &f32)| DVec2::new(f64::from(*x), f64::from(*y));
            vectors
                .map(|parts| vector(parts).normalize_or(DVec2::X))
                .collect()
        }
        None => {
            let symmetry = symmetry(partition);
            let border = Directions::of_border(region, symmetry);
            let at = |centre: &DVec2| border.at(*centre).direction(symmetry);
            partition.centres.iter().map(at).collect()
        }
    };
    build.go_on()?;
    let Some(found) = measure(partition, region, &directions) else {
        let failure = Failure::of_input("region", "none of the stones lies in the region");
        return Err(failure.with_hint("link the region that they were packed into"));
    };
    let text = text(&found);
    Ok(vec![Value::Table(Arc::new(Table { text }))])
}

fn text(found: &Statistics) -> String {
    let [median, nine_in_ten] = found.angles.map(f64::to_degrees);
    let columns = [
        ("stones", Some(found.stones as f64)),
        ("angle_median_degrees", Some(median)),
        ("angle_90_percent_degrees", Some(nine_in_ten)),
        ("order", found.order),
        ("four_corners", Some(found.quads)),
        ("area_variation", Some(found.area_variation)),
        ("occupancy", Some(found.occupancy)),
        ("joint_mm", Some(found.joint)),
        ("joint_variation", Some(found.joint_variation)),
        ("largest_overlap", Some(found.overlap)),
        ("across_outline", Some(found.across as f64)),
    ];
    let names = columns.map(|column| column.0).join(",");
    let number = |number: f64| number.to_string();
    let numbers = columns.map(|column| column.1.map(number).unwrap_or_default());
    let numbers = numbers.join(",");
    format!("{names}\n{numbers}\n")
}
