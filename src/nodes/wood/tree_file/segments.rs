//! Straight parts of a measured tree, from nodes or from cylinders.

use crate::nodes::cells::{Fault, Row, Table};
use glam::DVec3;
use std::collections::HashMap;

/// A straight part, in mm.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    /// The line of the file that ends it.
    pub(super) line: u64,
    pub(super) start: DVec3,
    pub(super) end: DVec3,
    pub(super) radius: f64,
    /// The part that it grows out of.
    pub(super) parent: Option<usize>,
    /// The part that continues it, if the file says so.
    pub(super) extension: Option<usize>,
}

/// Farthest that a part may be from the root, in mm.
const FARTHEST: f64 = 1e6;

const NODES: [&str; 6] = ["id", "parent", "x", "y", "z", "radius"];

const CYLINDERS: [&str; 9] = [
    "radius", "length", "start_x", "start_y", "start_z", "axis_x", "axis_y", "axis_z", "parent",
];

/// The parts of a tree, with its root at the origin; every parent leads to the root.
///
/// # Errors
/// Missing columns, cells that are no numbers, parents that are not there or lead round in a circle, several roots.
pub(super) fn read(table: &Table<'_>, scale: f64) -> Result<Vec<Segment>, Fault> {
    let lacks = |columns: &[&'static str]| -> Vec<&'static str> {
        columns
            .iter()
            .copied()
            .filter(|column| !table.has(column))
            .collect()
    };
    let (nodes, cylinders) = (lacks(&NODES), lacks(&CYLINDERS));
    let mut segments = if nodes.is_empty() {
        from_nodes(table, scale)?
    } else if cylinders.is_empty() {
        from_cylinders(table, scale)?
    } else {
        let message = format!("the columns are {}", table.names());
        let hint = format!(
            "for nodes there is no {}; for cylinders there is no {}",
            nodes.join(", "),
            cylinders.join(", ")
        );
        return Err(Fault::whole(message).hint(hint));
    };
    let root = segments.iter().find(|segment| segment.parent.is_none());
    let origin = root.map_or(DVec3::ZERO, |segment| segment.start);
    for segment in &mut segments {
        segment.start -= origin;
        segment.end -= origin;
        if segment.end.abs().max_element() > FARTHEST {
            let fault = Fault::line(segment.line, "the part lies more than 1 km from the root");
            return Err(fault.hint("is the unit right?"));
        }
    }
    Ok(segments)
}

fn vector(table: &Table<'_>, row: &Row, columns: [&str; 3]) -> Result<DVec3, Fault> {
    let [x, y, z] = columns.map(|column| table.number(row, column));
    Ok(DVec3::new(x?, y?, z?))
}

fn radius(table: &Table<'_>, row: &Row) -> Result<f64, Fault> {
    let radius = table.number(row, "radius")?;
    match radius >= 0.0 {
        true => Ok(radius),
        false => Err(table.refuse(row, "radius", "a radius of at least 0")),
    }
}

/// One segment for each node but the root, from its parent to it.
fn from_nodes(table: &Table<'_>, scale: f64) -> Result<Vec<Segment>, Fault> {
    let mut index_of = HashMap::new();
    for (index, row) in table.rows.iter().enumerate() {
        if index_of.insert(table.whole(row, "id")?, index).is_some() {
            return Err(table.refuse(row, "id", "an id that no line before has"));
        }
    }
    let parent = |row: &Row| match table.cell(row, "parent") {
        "" => Ok(None),
        _ => match table.whole(row, "parent")? {
            id if index_of.contains_key(&id) => Ok(index_of.get(&id).copied()),
            0 | -1 => Ok(None),
            _ => Err(table.refuse(row, "parent", "an id of the file, 0 or -1")),
        },
    };
    let parents: Vec<Option<usize>> = table.rows.iter().map(parent).collect::<Result<_, _>>()?;
    let root = check_parents(table, &parents)?;
    let point = |row: &Row| Ok(scale * vector(table, row, ["x", "y", "z"])?);
    let points: Vec<DVec3> = table.rows.iter().map(point).collect::<Result<_, Fault>>()?;
    // Nodes before the root keep their number, those behind it lose one.
    let segment_of = |node: usize| if node > root { node - 1 } else { node };
    let mut segments = vec![];
    for (index, row) in table.rows.iter().enumerate() {
        let radius = scale * radius(table, row)?;
        let Some(parent) = parents[index] else {
            continue;
        };
        segments.push(Segment {
            line: row.line,
            start: points[parent],
            end: points[index],
            radius,
            parent: (parent != root).then(|| segment_of(parent)),
            extension: None,
        });
    }
    match segments.is_empty() {
        true => Err(Fault::whole("the tree has one node only")),
        false => Ok(segments),
    }
}

fn from_cylinders(table: &Table<'_>, scale: f64) -> Result<Vec<Segment>, Fault> {
    let count = table.rows.len();
    let link = |row: &Row, column: &str| match table.whole(row, column)? {
        0 => Ok(None),
        number => usize::try_from(number - 1)
            .ok()
            .filter(|index| *index < count)
            .map(Some)
            .ok_or_else(|| table.refuse(row, column, &format!("0 or a row from 1 to {count}"))),
    };
    let parents: Vec<Option<usize>> = table
        .rows
        .iter()
        .map(|row| link(row, "parent"))
        .collect::<Result<_, _>>()?;
    check_parents(table, &parents)?;
    let mut segments = vec![];
    for (index, row) in table.rows.iter().enumerate() {
        let start = scale * vector(table, row, ["start_x", "start_y", "start_z"])?;
        let axis = vector(table, row, ["axis_x", "axis_y", "axis_z"])?;
        let length = scale * table.number(row, "length")?;
        let extension = match table.has("extension") {
            true => link(row, "extension")?,
            false => None,
        };
        if extension.is_some_and(|extension| parents[extension] != Some(index)) {
            return Err(table.refuse(row, "extension", "a row whose `parent` is this one"));
        }
        let axis = axis.try_normalize();
        let axis = axis.ok_or_else(|| table.refuse(row, "axis_x", "an axis with a length"))?;
        segments.push(Segment {
            line: row.line,
            start,
            end: start + axis * length,
            radius: scale * radius(table, row)?,
            parent: parents[index],
            extension,
        });
    }
    Ok(segments)
}

/// The one root, from which all can be reached.
fn check_parents(table: &Table<'_>, parents: &[Option<usize>]) -> Result<usize, Fault> {
    let mut roots = (0..parents.len()).filter(|index| parents[*index].is_none());
    let Some(root) = roots.next() else {
        return Err(circle(table, parents, 0));
    };
    if let Some(other) = roots.next() {
        let [first, second] = [root, other].map(|index| table.rows[index].line);
        let message = format!("the tree has several roots, in lines {first} and {second}");
        return Err(Fault::whole(message).hint("one tree has one root; give the others a parent"));
    }
    let mut known = vec![false; parents.len()];
    known[root] = true;
    for start in 0..parents.len() {
        let mut path = vec![];
        let mut next = Some(start);
        while let Some(index) = next.filter(|index| !known[*index]) {
            if path.len() > parents.len() {
                return Err(circle(table, parents, start));
            }
            path.push(index);
            next = parents[index];
        }
        path.into_iter().for_each(|index| known[index] = true);
    }
    Ok(root)
}

/// Says which lines are each other's parents; `start` leads into a circle.
fn circle(table: &Table<'_>, parents: &[Option<usize>], start: usize) -> Fault {
    let mut at = start;
    for _ in 0..parents.len() {
        at = parents[at].unwrap_or(at);
    }
    let mut lines = vec![table.rows[at].line];
    let mut next = parents[at];
    while let Some(index) = next.filter(|index| *index != at) {
        lines.push(table.rows[index].line);
        next = parents[index];
    }
    lines.sort_unstable();
    let shown: Vec<String> = lines.iter().take(5).map(u64::to_string).collect();
    let message = match lines.as_slice() {
        [line] => format!("the part in line {line} is its own parent"),
        _ => format!(
            "parts are each other's parents, in lines {}",
            shown.join(", ")
        ),
    };
    Fault::whole(message).hint("every part leads to the root by its parents")
}
