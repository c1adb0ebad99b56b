//! Pieces on their way to a partition: rings of shared corners.

use super::weld::{Corner, weld};
use super::{Piece, Ring as Drawn};
use crate::geometry::polygon::measure;
use crate::value::Partition;
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// Pieces as rings of shared corners.
#[derive(Debug)]
pub(super) struct Draft {
    /// The rings of each piece, the outline first; none if nothing is left of it.
    pub(super) pieces: Vec<Vec<Ring>>,
    /// Where the shared corners are, within the first period.
    pub(super) points: Vec<DVec2>,
    pub(super) period: Option<DVec2>,
    tolerance: f64,
}

/// A closed line through shared corners.
#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    pub(super) corners: Vec<Corner>,
    /// How much the edge behind each corner is bent.
    pub(super) bulges: Vec<f64>,
}

impl Draft {
    pub(super) fn new<E>(
        pieces: &[Piece],
        period: Option<DVec2>,
        tolerance: f64,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Draft, E> {
        let rings = || pieces.iter().flat_map(|piece| &piece.rings);
        let drawn: Vec<DVec2> = rings()
            .flat_map(|ring| ring.corners.iter().copied())
            .collect();
        let (points, welded) = weld(&drawn, period, tolerance, go_on)?;
        let mut welded = welded.into_iter();
        let mut take = |ring: &Drawn| Ring {
            corners: welded.by_ref().take(ring.corners.len()).collect(),
            bulges: (0..ring.corners.len())
                .map(|index| ring.bulges.get(index).copied().unwrap_or_default())
                .collect(),
        };
        let pieces = pieces
            .iter()
            .map(|piece| piece.rings.iter().map(&mut take).collect());
        Ok(Draft {
            pieces: pieces.collect(),
            points,
            period,
            tolerance,
        })
    }

    /// Where a corner is.
    pub(super) fn place(&self, corner: Corner) -> DVec2 {
        let point = self.points[corner.point as usize];
        let Some(period) = self.period else {
            return point;
        };
        let [x, y] = corner.period.map(f64::from);
        point + DVec2::new(x, y) * period
    }

    /// How many periods from the first the one is in which a point lies.
    pub(super) fn periods_to(&self, point: DVec2) -> [i32; 2] {
        let periods = self
            .period
            .map_or(DVec2::ZERO, |period| (point / period).floor());
        periods.to_array().map(|periods| periods as i32)
    }

    /// A point that is moved back by whole periods.
    pub(super) fn moved(&self, point: DVec2, [x, y]: [i32; 2]) -> DVec2 {
        let Some(period) = self.period else {
            return point;
        };
        let moved = point - DVec2::new(x.into(), y.into()) * period;
        // What is just before a period's end may be rounded onto it.
        DVec2::select(moved.cmpge(period), moved - period, moved)
    }

    pub(super) fn has_outline(&self, piece: usize) -> bool {
        !self.pieces[piece].is_empty()
    }

    /// Takes out edges without length, edges that turn back on themselves, and rings without area; makes outlines
    /// run counterclockwise and holes clockwise.
    pub(super) fn tidy(&mut self) {
        let mut pieces = std::mem::take(&mut self.pieces);
        pieces.par_iter_mut().for_each(|rings| {
            let mut number = 0;
            rings.retain_mut(|ring| {
                let is_outline = number == 0;
                number += 1;
                ring.tidy();
                self.turn(ring, is_outline) || is_outline
            });
            if rings
                .first()
                .is_some_and(|outline| outline.corners.is_empty())
            {
                rings.clear();
            }
        });
        self.pieces = pieces;
    }

    /// Makes a ring run the right way; whether it has an area. What has none is emptied.
    fn turn(&self, ring: &mut Ring, counterclockwise: bool) -> bool {
        let places: Vec<DVec2> = ring
            .corners
            .iter()
            .map(|corner| self.place(*corner))
            .collect();
        let area = measure(&places, &ring.bulges).area;
        let lengths = places.windows(2).map(|pair| pair[0].distance(pair[1]));
        // A strip as wide as the tolerance is no area.
        if ring.corners.len() < 2 || area.abs() <= 0.5 * self.tolerance * lengths.sum::<f64>() {
            *ring = Ring::default();
            return false;
        }
        if (area > 0.0) != counterclockwise {
            ring.reverse();
        }
        true
    }
}

impl Ring {
    /// Takes out edges without length, and straight ones that turn back on themselves.
    fn tidy(&mut self) {
        loop {
            let count = self.corners.len();
            let corner = |index: usize| self.corners[index % count];
            let is_straight = |index: usize| self.bulges[index % count] == 0.0;
            let repeated = (0..count).find(|at| count > 1 && corner(*at) == corner(at + 1));
            let spike = (0..count).find(|at| {
                count > 2
                    && corner(*at) == corner(at + 2)
                    && is_straight(*at)
                    && is_straight(at + 1)
            });
            match (repeated, spike) {
                (Some(at), _) => self.remove(at),
                (None, Some(at)) => self.remove((at + 1) % count),
                (None, None) => break,
            }
        }
        let is_flat = self.bulges.iter().all(|bulge| *bulge == 0.0);
        if self.corners.len() < if is_flat { 3 } else { 2 } {
            *self = Ring::default();
        }
    }

    /// Takes out a corner and the edge behind it.
    fn remove(&mut self, corner: usize) {
        self.corners.remove(corner);
        self.bulges.remove(corner);
    }

    fn reverse(&mut self) {
        self.corners.reverse();
        self.bulges.reverse();
        self.bulges.rotate_left(1);
        self.bulges.iter_mut().for_each(|bulge| *bulge = -*bulge);
    }
}

impl Draft {
    /// The corners of a partition.
    pub(super) fn of<E>(
        partition: &Partition,
        tolerance: f64,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Draft, E> {
        let (points, corners) = weld(&partition.corners, partition.period, tolerance, go_on)?;
        let ring = |range: Range<usize>| Ring {
            bulges: range
                .clone()
                .map(|corner| partition.bulge(corner))
                .collect(),
            corners: corners[range].to_vec(),
        };
        let pieces = (0..partition.len()).map(|cell| partition.rings_of(cell).map(ring).collect());
        Ok(Draft {
            pieces: pieces.collect(),
            points,
            period: partition.period,
            tolerance,
        })
    }

    /// The edges of a cell of [`Draft::of`]: its ends, what is beyond, and how it is bent.
    pub(super) fn edges(
        &self,
        partition: &Partition,
        cell: usize,
    ) -> impl Iterator<Item = (Corner, Corner, u32, f64)> {
        let rings = self.pieces[cell].iter().zip(partition.rings_of(cell));
        rings.flat_map(|(ring, range)| {
            let next = ring.corners.iter().cycle().skip(1);
            let beyond = &partition.neighbours[range];
            let edges = ring.corners.iter().zip(next).zip(beyond).zip(&ring.bulges);
            edges.map(|(((from, to), beyond), bulge)| (*from, *to, *beyond, *bulge))
        })
    }

    /// Where the edge of a cell that runs from `to` to `from` ends, whole periods aside.
    pub(super) fn facing(
        &self,
        partition: &Partition,
        cell: usize,
        from: Corner,
        to: Corner,
    ) -> Option<Corner> {
        let mut edges = self.edges(partition, cell);
        let facing = edges.find(|(start, end, ..)| {
            let away = |axis: usize| end.period[axis] - start.period[axis];
            let needed = |axis: usize| from.period[axis] - to.period[axis];
            let ends = end.point == from.point && start.point == to.point;
            ends && (0..2).all(|axis| away(axis) == needed(axis))
        });
        facing.map(|(_, end, ..)| end)
    }

    /// The rings of a cell where they are.
    pub(super) fn drawn(&self, partition: &Partition, cell: usize) -> Vec<Drawn> {
        let rings = self.pieces[cell].iter().zip(partition.rings_of(cell));
        let drawn = rings.map(|(ring, range)| Drawn {
            corners: partition.corners[range].to_vec(),
            bulges: ring.bulges.clone(),
        });
        drawn.collect()
    }
}
