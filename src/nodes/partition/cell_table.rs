//! `cell_table`: writes what is known of cells as CSV, one row for each, or a summary.
//!
//! Numbers have as many digits as it takes to read them back exactly. Of `rows: cells` the columns are `id`, the centre, the area, the
//! number of corners, the direction of the first axis in degrees, the number of neighbours, and the attributes by name.
//!
//! Of `rows: summary` the columns are a name and a number: how many cells, their area together, on average, and its coefficient of
//! variation; shares of cells by their number of neighbours; bond order psi4 and psi6, the mean over cells with at least two
//! neighbours of |mean of e^(i k angle)| over the directions to their centres; the distance to the nearest centre on average, divided by
//! that of random centres of the same density (Clark & Evans 1954), and by the mean distance to neighbours.

mod statistics;

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Partition, Table, Type, Value};
use std::fmt::Write;
use std::sync::Arc;

/// Writes cells as CSV.
pub static KIND: Kind = Kind {
    name: "cell_table",
    version: 1,
    about: "Writes cells as a CSV file: one row for each with its centre, area and attributes, or a summary with their statistics; \
            stands in `outputs`.",
    source: "bond order after Nelson & Halperin 1979; nearest distance ratio after Clark & Evans 1954",
    inputs: &[
        Input::new("of", Type::Partition, "The cells."),
        Input::new(
            "rows",
            Type::Choice(&["cells", "summary"]),
            "One row for each cell, or one for each number of the summary.",
        )
        .default("cells"),
    ],
    outputs: &[Output::new("table", Type::Maps, "The file.")],
    example: "(nodes: {
        \"cells\": voronoi_split(size: (200, 200), cell_size: 20),
    }, outputs: { \"example\": cell_table(of: \"cells\", rows: summary) })",
    build,
};

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let cells = inputs.partition("of");
    let text = match inputs.choice("rows") {
        "summary" => summary(cells),
        _ => rows(cells),
    };
    Ok(vec![Value::Table(Arc::new(Table { text }))])
}

fn rows(cells: &Partition) -> String {
    let mut text = "id,x_mm,y_mm,area_mm2,corners,axis_degree,neighbours".to_owned();
    for name in cells.attributes.keys() {
        text.push(',');
        text.push_str(&quoted(name));
    }
    text.push('\n');
    for cell in 0..cells.len() {
        let (centre, frame) = (cells.centres[cell], cells.frames[cell]);
        let axis = libm::atan2(frame.y, frame.x).to_degrees();
        let corners: usize = cells.rings_of(cell).map(|ring| ring.len()).sum();
        let neighbours = cells.neighbours_of(cell).len();
        write!(
            text,
            "{},{},{},{},{corners},{axis},{neighbours}",
            cells.ids[cell], centre.x, centre.y, cells.areas[cell]
        )
        .expect("a string takes all that is written");
        for numbers in cells.attributes.values() {
            write!(text, ",{}", numbers[cell]).expect("a string takes all that is written");
        }
        text.push('\n');
    }
    text
}

/// A name as a field of a CSV file.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        return format!("\"{}\"", name.replace('"', "\"\""));
    }
    name.to_owned()
}

fn summary(cells: &Partition) -> String {
    let mut text = "name,number\n".to_owned();
    for (name, number) in statistics::of(cells) {
        writeln!(text, "{name},{number}").expect("a string takes all that is written");
    }
    text
}
