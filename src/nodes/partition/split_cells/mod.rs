//! `split_cells`: divides a plane into boards, bricks, setts in arcs, or ever smaller parts.
//!
//! A pattern is laid over the ground, turned by `angle` about the ground's lower left corner, or over each cell of another partition
//! along the cell's own axes from its centre. What lies across the outline is cut, and what is left of a piece that is
//! too small is joined to the neighbour it shares the longest border with.
//!
//! On a ground with a period the pieces are stretched until the pattern closes.

mod arcs;
mod hexagons;
mod laid;
mod recursive;
mod rows;
mod woven;

use self::laid::{Laid, Pattern, flattened};
use super::ground::{Ground, PERIOD, REGION, SIZE};
use crate::geometry::assemble::{Piece, Ring, assemble, clip, merge_slivers};
use crate::geometry::cells::CellIndex;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::random::Random;
use crate::value::{Partition, Polygon, Region, Type, Unit, Value};
use glam::DVec2;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Divides a plane into the pieces of a pattern.
pub static KIND: Kind = Kind {
    name: "split_cells",
    version: 1,
    about: "Divides a region, or each cell of a partition, by a pattern: rows of bricks or boards, herringbone, basket weave, \
            chevron, hexagons, setts in arcs, or splits of splits.",
    source: "own construction after the bonds of the trades; splits of splits after Qin & Pugno 2014 (hierarchical cracks)",
    inputs: &[
        REGION,
        SIZE,
        PERIOD,
        Input::new(
            "within",
            Type::Partition,
            "Divides each of these cells along its own axes; instead of a `region`, `size` or `period`.",
        )
        .optional(),
        Input::new(
            "pattern",
            Type::Choice(&[
                "rows",
                "herringbone",
                "basket",
                "chevron",
                "hexagons",
                "arcs",
                "recursive",
            ]),
            "rows: bricks and boards; herringbone, basket, chevron: parquet; hexagons; arcs: setts in rows that are bent, bow beside \
             bow; recursive: parts that are split across, with joints that end at others.",
        )
        .default("rows"),
        Input::new(
            "piece",
            Type::Pair(Unit::Millimetre),
            "Length and width of a piece; of `hexagons` the first is the distance of opposite sides, of `recursive` both are means.",
        )
        .range(1e-3, 1e7),
        Input::new(
            "bond",
            Type::Choice(&["stack", "running", "third", "random"]),
            "Of `rows`: how far each row is shifted: not at all, by half a piece, by a third, by chance.",
        )
        .default("running"),
        Input::new(
            "lengths",
            Type::Pair(Unit::One),
            "Of `rows`: the shortest and the longest piece, relative to `piece`. Of `recursive`: where a part is split, in parts of its length.",
        )
        .optional()
        .range(0.05, 20.0),
        Input::new(
            "widths",
            Type::Pair(Unit::One),
            "Of `rows`: the narrowest and the widest row, relative to `piece`.",
        )
        .default("(1, 1)")
        .range(0.05, 20.0),
        Input::new(
            "strands",
            Type::Whole,
            "Of `herringbone`: boards side by side. Of `basket`: boards in a square, 0 for as many as fit.",
        )
        .default("0")
        .range(0.0, 1000.0),
        Input::number("bow", Unit::Millimetre, "Of `arcs`: width of a bow; left out, twelve pieces.")
            .optional()
            .range(1e-3, 1e7),
        Input::number("rise", Unit::One, "Of `arcs`: how high a bow is, relative to its width.")
            .default("0.2")
            .range(0.01, 0.5),
        Input::number("slant", Unit::Degree, "Of `chevron`: the angle of the boards; of `recursive`: how slanted splits are at most.")
            .optional()
            .range(0.0, 80.0),
        Input::number("angle", Unit::Degree, "Turns the pattern, counterclockwise.")
            .default("0")
            .range(-360.0, 360.0),
        Input::new("shift", Type::Pair(Unit::Millimetre), "Moves the pattern along its own axes.")
            .default("(0, 0)")
            .range(-1e7, 1e7),
        Input::number(
            "merge_below",
            Unit::One,
            "Cut pieces with less than this share of a whole one are joined to a neighbour.",
        )
        .default("0.15")
        .range(0.0, 1.0),
        Input::new("seed", Type::Whole, "Another seed draws otherwise.").default("0"),
    ],
    outputs: &[Output::new("cells", Type::Partition, "The pieces; attributes `row`, `column`, and `parent` within cells.")],
    example: "(nodes: { \"example\": split_cells(size: (1000, 600), piece: (200, 100)) })",
    build,
};

/// Most pieces.
const MOST: f64 = 4e6;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let piece = DVec2::from_array(inputs.pair("piece"));
    let mut random = Random::new(build.seed, KIND.name, inputs.whole("seed"));
    let parts = match inputs.get("within") {
        Some(_) => within(inputs, build, piece, &mut random)?,
        None => {
            let ground = Ground::read(inputs)?;
            vec![match ground.period {
                Some(period) => periodic(inputs, piece, period, &mut random)?,
                None => {
                    let origin = low(&ground.region);
                    let angle = inputs.number("angle").to_radians();
                    let axis = DVec2::new(libm::cos(angle), libm::sin(angle));
                    cut(inputs, piece, &ground.region, origin, axis, &mut random)?
                }
            }]
        }
    };
    let cells = joined(parts);
    match cells.is_empty() {
        true => Err(Failure::new("nothing is left of the pieces")
            .with_hint("let the pieces be smaller, or `merge_below`")),
        false => Ok(vec![Value::Partition(Arc::new(cells))]),
    }
}

/// The lower left corner of the box around a region.
fn low(region: &Region) -> DVec2 {
    let corners = region.rings().flatten();
    corners.fold(DVec2::INFINITY, |low, corner| low.min(*corner))
}

/// The pattern on a ground that repeats.
fn periodic(
    inputs: &Inputs<'_>,
    piece: DVec2,
    period: DVec2,
    random: &mut Random,
) -> Result<Partition, Failure> {
    for input in ["angle", "shift"] {
        let is_set = match input {
            "angle" => inputs.number("angle") != 0.0,
            _ => inputs.pair("shift") != [0.0; 2],
        };
        if is_set {
            let message = format!(
                "`{input}` is set, but the ground has a period, in which the pattern has to close"
            );
            return Err(Failure::of_input(input, message).with_hint("leave it out"));
        }
    }
    check_count(piece, period)?;
    let pattern = Pattern::read(inputs, piece, Some(period))?;
    let fitted = pattern.closed(period, random);
    let stretched = fitted.stretched - 1.0;
    if stretched.abs().max_element() > 0.005 {
        let [x, y] = (stretched * 100.0).to_array();
        inputs.warn(format!(
            "the pieces are stretched by {x:+.1} % along x and {y:+.1} % along y, so that the pattern closes"
        ));
    }
    let named = named(&fitted.pieces);
    let pieces = pieces(&fitted.pieces, DVec2::ZERO, DVec2::X);
    let cells = assemble(pieces, Some(period), 1e-9 * period.max_element());
    Ok(with_attributes(cells, &named, &[]))
}

/// The pattern cut to a region.
fn cut(
    inputs: &Inputs<'_>,
    piece: DVec2,
    region: &Region,
    origin: DVec2,
    axis: DVec2,
    random: &mut Random,
) -> Result<Partition, Failure> {
    let pattern = Pattern::read(inputs, piece, None)?;
    let shift = DVec2::from_array(inputs.pair("shift"));
    let to_pattern = |corner: &DVec2| {
        let offset = *corner - origin;
        DVec2::new(axis.dot(offset), axis.perp_dot(offset)) - shift
    };
    let corners = region.rings().flatten().map(to_pattern);
    let [low, high] = corners.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| {
        [low.min(at), high.max(at)]
    });
    check_count(piece, high - low)?;
    let laid = pattern.cover([low, high], random);
    let laid: Vec<Laid> = laid.into_iter().map(flattened).collect();
    let named = named(&laid);
    let origin = origin + axis.rotate(shift);
    let whole = pieces(&laid, origin, axis);
    let extent = (high - low).max_element();
    let tolerance = 1e-9 * extent.max(1e-6);
    let clipped = clip(whole.clone(), region);
    let cells = assemble(clipped, None, tolerance);
    if cells.is_empty() {
        return Ok(cells);
    }
    let cells = with_attributes(cells, &named, &whole);
    let least = inputs.number("merge_below") * pattern.area();
    Ok(merge_slivers(&cells, least).0)
}

/// # Errors
/// If there would be too many pieces.
fn check_count(piece: DVec2, extent: DVec2) -> Result<(), Failure> {
    let count = extent.x * extent.y / (piece.x * piece.y);
    if count <= MOST {
        return Ok(());
    }
    let message = format!(
        "the pieces are so small that there would be {count:.0} of them, expected at most {MOST:.0}"
    );
    Err(Failure::of_input("piece", message).with_hint("let them be larger"))
}

/// The cells of another partition, each divided along its own axes.
fn within(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    piece: DVec2,
    random: &mut Random,
) -> Result<Vec<Partition>, Failure> {
    for input in ["region", "size", "period"] {
        if inputs.get(input).is_some() {
            let message = format!("both `within` and `{input}` are stated");
            return Err(Failure::of_input(input, message).with_hint("keep one of them"));
        }
    }
    let outer = inputs.partition("within");
    if outer.period.is_some() || !outer.bulges.is_empty() {
        let message =
            "the cells repeat or have curved edges, along which they cannot be divided yet";
        return Err(Failure::of_input("within", message));
    }
    let angle = inputs.number("angle").to_radians();
    let turn = DVec2::new(libm::cos(angle), libm::sin(angle));
    let mut parts = vec![];
    for cell in 0..outer.len() {
        build.go_on()?;
        let mut rings = outer
            .rings_of(cell)
            .map(|ring| outer.corners[ring].to_vec());
        let region = Region {
            polygons: vec![Polygon {
                outline: rings.next().unwrap_or_default(),
                holes: rings.collect(),
            }],
        };
        let axis = outer.frames[cell].rotate(turn);
        let mut part = cut(inputs, piece, &region, outer.centres[cell], axis, random)?;
        let parent = vec![f64::from(outer.ids[cell]); part.len()];
        part.attributes.insert("parent".to_owned(), parent);
        parts.push(part);
    }
    Ok(parts)
}

/// The pieces in the plane.
fn pieces(laid: &[Laid], origin: DVec2, axis: DVec2) -> Vec<Piece> {
    let piece = |(id, laid): (usize, &Laid)| Piece {
        rings: vec![Ring {
            corners: laid
                .corners
                .iter()
                .map(|corner| origin + axis.rotate(*corner))
                .collect(),
            bulges: laid.bulges.clone(),
        }],
        id: id as u32,
        frame: axis.rotate(laid.along),
        centre: None,
    };
    laid.iter().enumerate().map(piece).collect()
}

/// Row and column of each piece.
fn named(laid: &[Laid]) -> Vec<[i32; 2]> {
    laid.iter().map(|laid| [laid.row, laid.column]).collect()
}

/// Adds `row` and `column`; parts that were cut off have those of the piece they were part of.
fn with_attributes(mut cells: Partition, named: &[[i32; 2]], whole: &[Piece]) -> Partition {
    let is_part = cells.ids.iter().any(|id| *id as usize >= named.len());
    let index = is_part.then(|| {
        let pattern = assemble(whole.to_vec(), None, 0.0);
        CellIndex::new(&Arc::new(pattern))
    });
    let of_cell = |cell: usize| {
        let id = cells.ids[cell] as usize;
        let piece = match (named.get(id), &index) {
            (None, Some(index)) => index.id_at(cells.centres[cell]) as usize,
            _ => id,
        };
        named.get(piece).copied().unwrap_or_default()
    };
    let found: Vec<[i32; 2]> = (0..cells.len()).map(of_cell).collect();
    for (index, name) in ["row", "column"].into_iter().enumerate() {
        let numbers = found.iter().map(|named| f64::from(named[index]));
        cells.attributes.insert(name.to_owned(), numbers.collect());
    }
    cells
}

/// All parts as one partition, with ids of their own.
fn joined(mut parts: Vec<Partition>) -> Partition {
    if parts.len() == 1 {
        return parts.remove(0);
    }
    let mut pieces: Vec<Piece> = vec![];
    let mut attributes: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let mut extent = 0.0_f64;
    for part in &parts {
        for cell in 0..part.len() {
            let rings = part
                .rings_of(cell)
                .map(|ring| Ring::straight(part.corners[ring].to_vec()));
            extent = extent.max(part.centres[cell].abs().max_element());
            pieces.push(Piece {
                rings: rings.collect(),
                id: pieces.len() as u32,
                frame: part.frames[cell],
                centre: None,
            });
        }
        for (name, numbers) in &part.attributes {
            attributes.entry(name.clone()).or_default().extend(numbers);
        }
    }
    let mut cells = assemble(pieces, None, 1e-9 * extent);
    for (name, numbers) in attributes {
        let of_cells = cells.ids.iter().map(|id| numbers[*id as usize]).collect();
        cells.attributes.insert(name, of_cells);
    }
    cells
}
