//! Partitions from pieces: corners that all share, edges with one neighbour each, and cells cut, joined and counted.

mod clip;
mod dissolve;
mod draft;
mod edges;
mod split;
mod weld;

pub(crate) use clip::{clip, clip_from};
pub(crate) use dissolve::merge_slivers;
pub(crate) use weld::{Corner, weld};

use crate::geometry::polygon::{Measure, measure};
use crate::value::Partition;
use draft::Draft;
use glam::DVec2;
use rayon::prelude::*;

/// What is to become a cell.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The outline, and then the holes, in mm.
    pub(crate) rings: Vec<Ring>,
    /// A number that no other piece has.
    pub(crate) id: u32,
    /// The direction of its own first axis, of length 1.
    pub(crate) frame: DVec2,
    /// Its middle; `None` for the centre of gravity.
    pub(crate) centre: Option<DVec2>,
}

/// A closed line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ring {
    /// Its corners in mm; the last is joined to the first.
    pub(crate) corners: Vec<DVec2>,
    /// How much the edge behind each corner is bent, as in [`Partition::bulges`]; empty if all are straight.
    pub(crate) bulges: Vec<f64>,
}

impl Ring {
    /// The ring with straight edges between corners.
    pub(crate) fn straight(corners: Vec<DVec2>) -> Ring {
        let bulges = vec![];
        Ring { corners, bulges }
    }

    /// What it encloses.
    pub(crate) fn measure(&self) -> Measure {
        measure(&self.corners, &self.bulges)
    }
}

/// The cells of a partition as pieces, with their own centres.
pub(crate) fn pieces_of(partition: &Partition) -> Vec<Piece> {
    let ring = |corners: std::ops::Range<usize>| Ring {
        bulges: match partition.bulges.is_empty() {
            true => vec![],
            false => partition.bulges[corners.clone()].to_vec(),
        },
        corners: partition.corners[corners].to_vec(),
    };
    let piece = |cell: usize| Piece {
        rings: partition.rings_of(cell).map(ring).collect(),
        id: partition.ids[cell],
        frame: partition.frames[cell],
        centre: Some(partition.centres[cell]),
    };
    (0..partition.len()).into_par_iter().map(piece).collect()
}

/// The partition of which the pieces, which must not overlap, are the cells.
///
/// Corners closer than `tolerance` mm become one, straight edges are split where a corner of another piece lies on them, rings run
/// the way they should, and pieces without area are dropped; the others keep their order. In a periodic
/// partition, cells are moved by whole periods until their centres lie within the first. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn assemble<E>(
    pieces: Vec<Piece>,
    period: Option<DVec2>,
    tolerance: f64,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Partition, E> {
    Ok(assemble_kept(pieces, period, tolerance, go_on)?.0)
}

/// [`assemble`], and which pieces became cells.
fn assemble_kept<E>(
    pieces: Vec<Piece>,
    period: Option<DVec2>,
    tolerance: f64,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(Partition, Vec<usize>), E> {
    let mut draft = Draft::new(&pieces, period, tolerance, go_on)?;
    draft.tidy();
    go_on()?;
    split::split_edges(&mut draft, tolerance, go_on)?;
    draft.tidy();
    go_on()?;
    let kept: Vec<usize> = (0..pieces.len())
        .filter(|piece| draft.has_outline(*piece))
        .collect();
    let of_kept = |piece: &usize| std::mem::take(&mut draft.pieces[*piece]);
    let cells: Vec<_> = kept.iter().map(of_kept).collect();
    draft.pieces = cells;
    let neighbours = edges::neighbours(&draft);
    go_on()?;
    let cells: Vec<Cell> = kept
        .par_iter()
        .zip(&draft.pieces)
        .map(|(piece, rings)| Cell::new(&pieces[*piece], rings, &draft))
        .collect();
    go_on()?;
    let mut partition = Partition {
        neighbours,
        period,
        ..starts(&draft)
    };
    for (cell, piece) in cells.into_iter().zip(&kept) {
        partition.corners.extend(cell.corners);
        partition.centres.push(cell.centre);
        partition.areas.push(cell.area);
        partition.ids.push(pieces[*piece].id);
        partition.frames.push(cell.frame);
    }
    Ok((partition, kept))
}

/// Where the rings and cells of a draft begin, and how its edges are bent.
fn starts(draft: &Draft) -> Partition {
    let mut partition = Partition {
        rings: vec![0],
        cells: vec![0],
        ..Partition::default()
    };
    let mut corners = 0;
    for rings in &draft.pieces {
        for ring in rings {
            corners += ring.corners.len() as u32;
            partition.rings.push(corners);
            partition.bulges.extend(&ring.bulges);
        }
        partition.cells.push(partition.rings.len() as u32 - 1);
    }
    if partition.bulges.iter().all(|bulge| *bulge == 0.0) {
        partition.bulges.clear();
    }
    partition
}

/// A cell with what is computed from its corners.
struct Cell {
    corners: Vec<DVec2>,
    centre: DVec2,
    area: f64,
    frame: DVec2,
}

impl Cell {
    fn new(piece: &Piece, rings: &[draft::Ring], draft: &Draft) -> Cell {
        let places = |ring: &draft::Ring| {
            let corners = ring.corners.iter();
            corners.map(|corner| draft.place(*corner)).collect()
        };
        let placed: Vec<Vec<DVec2>> = rings.iter().map(places).collect();
        let measures = placed.iter().zip(rings);
        let whole = measures
            .map(|(corners, ring)| measure(corners, &ring.bulges))
            .fold(Measure::default(), |whole, ring| whole + ring);
        let centre = piece.centre.unwrap_or_else(|| whole.centre());
        let away = draft.periods_to(centre);
        let moved = |corner: &Corner| draft.place(corner.moved(away.map(|periods| -periods)));
        Cell {
            corners: rings
                .iter()
                .flat_map(|ring| ring.corners.iter().map(moved))
                .collect(),
            centre: draft.moved(centre, away),
            area: whole.area,
            frame: piece.frame.try_normalize().unwrap_or(DVec2::X),
        }
    }
}

#[cfg(test)]
mod tests;
