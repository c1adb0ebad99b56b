//! Partitions: a part of the plane divided into cells.

use crate::key::{Key, KeyHasher};
use glam::DVec2;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;

/// A part of the plane divided into cells, all lists in the order of the cells.
///
/// Cells that tile a region share the corners of their common edges exactly, bit by bit, also where three meet in a T:
/// each edge has one neighbour. Cells that were inset keep the neighbours that lie beyond the joint.
///
/// In a periodic partition a cell lies around its centre, which is within the first period, and may reach beyond it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Partition {
    /// Corners of all rings in mm, ring after ring. The first ring of a cell is its outline, counterclockwise; the
    /// others are holes, clockwise.
    pub corners: Vec<DVec2>,
    /// How much the edge from each corner to the next is bent: the tangent of a quarter of the arc's angle, above 0 if the
    /// arc turns left. Empty if all edges are straight.
    pub bulges: Vec<f64>,
    /// The cell beyond the edge from each corner to the next, or [`Partition::NONE`].
    pub neighbours: Vec<u32>,
    /// The first corner of each ring, and behind them the number of corners.
    pub rings: Vec<u32>,
    /// The first ring of each cell, and behind them the number of rings.
    pub cells: Vec<u32>,
    /// A number for each cell that stays with it when others come and go; no two are equal.
    pub ids: Vec<u32>,
    /// Centres of gravity in mm; for a cell that something was built around, its own middle.
    pub centres: Vec<DVec2>,
    /// The direction of the cell's own first axis, of length 1.
    pub frames: Vec<DVec2>,
    /// Areas in mm².
    pub areas: Vec<f64>,
    /// What else is known of the cells, by name.
    pub attributes: BTreeMap<String, Vec<f64>>,
    /// Width and height of the piece that is repeated, in mm.
    pub period: Option<DVec2>,
}

/// How far the corners of cells that touch are apart at most, as a share of their coordinates: a period is not exact.
const TOUCHING: f64 = 1e-12;

/// Most cells, most corners, and the largest coordinate in mm.
const MOST_CELLS: usize = 16_000_000;
const MOST_CORNERS: usize = 200_000_000;
const LARGEST: f64 = 1e9;

impl Partition {
    /// Stands for no cell.
    pub const NONE: u32 = u32::MAX;

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no cells, which no node makes.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// The rings of a cell: of each the indices of its corners.
    pub fn rings_of(&self, cell: usize) -> impl Iterator<Item = Range<usize>> {
        let rings = self.cells[cell] as usize..self.cells[cell + 1] as usize;
        rings.map(|ring| self.rings[ring] as usize..self.rings[ring + 1] as usize)
    }

    /// The corners of a cell's outline.
    pub fn outline(&self, cell: usize) -> &[DVec2] {
        let outline = self.rings_of(cell).next().unwrap_or_default();
        &self.corners[outline]
    }

    /// The lowest and the highest corner of the box around a cell.
    pub fn box_of(&self, cell: usize) -> [DVec2; 2] {
        let outline = self.rings_of(cell).next().unwrap_or_default();
        let mut around = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        for corner in outline.clone() {
            let next = if corner + 1 == outline.end {
                outline.start
            } else {
                corner + 1
            };
            let (from, to) = (self.corners[corner], self.corners[next]);
            // An arc reaches no farther beside its chord than its sagitta, nor beyond its ends.
            let reach = from.distance(to) * 0.5 * self.bulge(corner).abs();
            around[0] = around[0].min(from.min(to) - reach);
            around[1] = around[1].max(from.max(to) + reach);
        }
        around
    }

    /// Whether cells share corners with their neighbours, as they do unless they were inset. One edge says it of all.
    pub fn touches(&self) -> bool {
        let Some(corner) =
            (0..self.neighbours.len()).find(|corner| self.neighbours[*corner] != Partition::NONE)
        else {
            return false;
        };
        let is_there = |other: &DVec2| {
            let mut apart = self.corners[corner] - *other;
            if let Some(period) = self.period {
                apart -= (apart / period).round() * period;
            }
            apart.length() <= TOUCHING * self.corners[corner].length().max(1.0)
        };
        let neighbour = self.neighbours[corner] as usize;
        let mut rings = self.rings_of(neighbour);
        rings.any(|ring| self.corners[ring].iter().any(is_there))
    }

    /// Identifies all that the partition is.
    pub fn key(&self) -> Key {
        let mut key = KeyHasher::new("partition", 1);
        let bytes = postcard::to_stdvec(self).expect("plain data always has bytes");
        key.bytes(&bytes).finish()
    }

    /// How much the edge behind a corner is bent; 0 if it is straight.
    pub fn bulge(&self, corner: usize) -> f64 {
        self.bulges.get(corner).copied().unwrap_or_default()
    }

    /// The cells that a cell has edges with, in rising order and each once.
    pub fn neighbours_of(&self, cell: usize) -> Vec<u32> {
        let rings = self.rings_of(cell);
        let across = rings.flat_map(|ring| self.neighbours[ring].iter().copied());
        let mut cells: Vec<u32> = across.filter(|cell| *cell != Partition::NONE).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    /// Whether it is what nodes make.
    pub fn is_sound(&self) -> bool {
        let (cells, corners) = (self.len(), self.corners.len());
        let is_near = |point: &DVec2| point.is_finite() && point.abs().max_element() <= LARGEST;
        let is_cell = |cell: &u32| *cell == Partition::NONE || (*cell as usize) < cells;
        let has_one_each =
            |list: &Vec<f64>| list.len() == cells && list.iter().all(|number| number.is_finite());
        (1..=MOST_CELLS).contains(&cells)
            && corners <= MOST_CORNERS
            && is_division(&self.cells, self.rings.len().wrapping_sub(1))
            && is_division(&self.rings, corners)
            && self.cells.len() == cells + 1
            && self.corners.iter().all(is_near)
            && (self.bulges.is_empty() || self.bulges.len() == corners)
            && self.bulges.iter().all(|bulge| bulge.is_finite())
            && self.neighbours.len() == corners
            && self.neighbours.iter().all(is_cell)
            && self.centres.len() == cells
            && self.centres.iter().all(is_near)
            && self.frames.len() == cells
            && self
                .frames
                .iter()
                .all(|frame| (frame.length() - 1.0).abs() < 1e-6)
            && has_one_each(&self.areas)
            && self.attributes.values().all(has_one_each)
            && self
                .period
                .is_none_or(|period| is_near(&period) && period.min_element() > 0.0)
    }
}

/// Whether these are the starts of parts, none of them empty, and behind them the end of the last.
fn is_division(starts: &[u32], end: usize) -> bool {
    starts.first() == Some(&0)
        && starts.last().is_some_and(|last| *last as usize == end)
        && starts.windows(2).all(|pair| pair[0] < pair[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares side by side.
    fn squares() -> Partition {
        let corners = [0.0, 1.0].map(|x| {
            let corners = [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0)];
            corners.map(|(x, y)| DVec2::new(x, y))
        });
        const NONE: u32 = Partition::NONE;
        Partition {
            corners: corners.concat(),
            neighbours: vec![NONE, 1, NONE, NONE, NONE, NONE, NONE, 0],
            rings: vec![0, 4, 8],
            cells: vec![0, 1, 2],
            ids: vec![0, 1],
            centres: vec![DVec2::new(0.5, 0.5), DVec2::new(1.5, 0.5)],
            frames: vec![DVec2::X; 2],
            areas: vec![1.0; 2],
            ..Partition::default()
        }
    }

    #[test]
    fn cells_know_their_corners_and_neighbours() {
        let squares = squares();
        assert!(squares.is_sound());
        assert_eq!(squares.outline(1)[0], DVec2::X);
        assert_eq!(squares.neighbours_of(0), [1]);
        assert_eq!(squares.neighbours_of(1), [0]);
        assert_eq!(squares.bulge(3), 0.0);
    }

    #[test]
    fn cells_touch_unless_they_are_inset() {
        let mut apart = squares();
        assert!(apart.touches());
        apart.corners[4..]
            .iter_mut()
            .for_each(|corner| corner.x += 0.1);
        assert!(!apart.touches());
        // The right one lies a period farther.
        apart.corners[4..]
            .iter_mut()
            .for_each(|corner| corner.x += 3.9);
        apart.period = Some(DVec2::new(4.0, 1.0));
        assert!(apart.touches());
        apart.neighbours = vec![Partition::NONE; 8];
        assert!(!apart.touches());
    }

    #[test]
    fn only_what_nodes_make_is_sound() {
        let unsound: [fn(&mut Partition); 12] = [
            |it| *it = Partition::default(),
            |it| it.rings[1] = 9,
            |it| it.rings[1] = 0,
            |it| it.cells = vec![0, 2],
            |it| it.neighbours[1] = 2,
            |it| it.corners[0].x = f64::INFINITY,
            |it| it.bulges = vec![0.0; 3],
            |it| it.frames[0] = DVec2::ZERO,
            |it| it.areas[1] = f64::NAN,
            |it| it.centres.truncate(1),
            |it| it.attributes = BTreeMap::from([("size".to_owned(), vec![1.0])]),
            |it| it.period = Some(DVec2::ZERO),
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            let mut partition = squares();
            change(&mut partition);
            assert!(!partition.is_sound(), "{number}");
        }
    }
}
