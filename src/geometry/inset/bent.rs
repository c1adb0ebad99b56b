//! Cells with arcs: what the moved edges sweep over is taken away with arcs as chords; then chords become arcs again, each about
//! the centre of the one it comes from, and corners the points where moved lines and circles meet.
//!
//! Chords, no farther off than [`CHORD`] of the cell's extent, only decide what is left, not where it ends.

use super::Contour;
use super::concave::{corner, largest};
use super::curve::Curve;
use crate::geometry::polygon::{Lattice, Operation, arc_points, steps};
use glam::DVec2;

/// How far chords may be from arcs, as a share of the cell's extent.
const CHORD: f64 = 2e-4;

/// Edges whose directions differ by less than this sine run on smoothly.
const SMOOTH: f64 = 1e-7;

/// How far a corner between chords may be from the corner between their arcs, as a share of the cell's extent: where arcs
/// almost touch it goes with the root of what the chords are off.
const REACH: f64 = 0.06;

/// A ring of what is left: from each corner the curve that the edge behind it lies on, and the edge of the cell it belongs to.
#[derive(Clone, Debug, Default)]
pub(super) struct Bow {
    pub(super) corners: Vec<DVec2>,
    /// `None` for short straight edges where a moved edge ends beside another.
    pub(super) curves: Vec<Option<Curve>>,
    pub(super) edges: Vec<usize>,
}

/// An edge of the cell and what it sweeps over.
struct Side {
    from: DVec2,
    to: DVec2,
    curve: Curve,
    /// Directions at its ends.
    along: [DVec2; 2],
    off: f64,
    /// The edge as straight edges, with both ends.
    chords: Vec<DVec2>,
    /// The side before it, and whether it runs on from there smoothly.
    before: usize,
    is_smooth: bool,
}

/// The largest part that is left of a cell when each edge moves inwards by `offs`, and how many parts there are. Edges that run
/// on smoothly move together, by the largest of their distances.
pub(super) fn cut(rings: &[Contour<'_>], offs: &[f64]) -> (Vec<Bow>, usize) {
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    let corners = rings.iter().flat_map(|ring| ring.corners);
    let [low, high] = corners.fold(none, |[low, high], at| [low.min(*at), high.max(*at)]);
    let extent = (high - low).max_element();
    let mut sides = vec![];
    for ring in rings {
        let first = sides.len();
        let offs = &offs[first..first + ring.corners.len()];
        sides.extend(Side::all(ring, offs, first, CHORD * extent));
    }
    let most = sides.iter().map(|side| side.off).fold(0.0, f64::max);
    let lattice = Lattice::around([low - 4.0 * (most + extent), high + 4.0 * (most + extent)]);
    let mut drawn: Vec<Vec<DVec2>> = vec![];
    let mut first = 0;
    for ring in rings {
        let of_ring = &sides[first..first + ring.corners.len()];
        let chords = of_ring.iter().flat_map(Side::without_end);
        drawn.push(chords.copied().collect());
        first += ring.corners.len();
    }
    let away = away(&sides, 32.0 * lattice.step());
    let [drawn, away] =
        [&drawn, &away].map(|rings| rings.iter().map(|ring| &ring[..]).collect::<Vec<_>>());
    let parts = lattice.overlay(Operation::Difference, &drawn, &away);
    let (left, count) = largest(&parts, lattice);
    let rings = left.iter().map(|ring| recovered(ring, &sides, extent));
    (rings.collect(), count)
}

impl Side {
    /// The sides of a ring whose first edge has the number `first`.
    fn all(ring: &Contour<'_>, offs: &[f64], first: usize, tolerance: f64) -> Vec<Side> {
        let count = ring.corners.len();
        let side = |index: usize| {
            let (from, to) = (ring.corners[index], ring.corners[(index + 1) % count]);
            let curve = Curve::of(from, to, ring.bulge(index));
            Side {
                from,
                to,
                curve,
                along: [from, to].map(|end| curve.along(end)),
                off: offs[index],
                chords: vec![],
                before: first + (index + count - 1) % count,
                is_smooth: false,
            }
        };
        let mut sides: Vec<Side> = (0..count).map(side).collect();
        for index in 0..count {
            let before = sides[(index + count - 1) % count].along[1];
            let next = sides[index].along[0];
            sides[index].is_smooth = before.perp_dot(next).abs() < SMOOTH && before.dot(next) > 0.0;
        }
        move_together(&mut sides);
        for (index, side) in sides.iter_mut().enumerate() {
            side.chords = side.flat(ring.bulge(index), tolerance);
        }
        sides
    }

    /// The edge as straight edges so short that those it moves to are near enough too.
    fn flat(&self, bulge: f64, tolerance: f64) -> Vec<DVec2> {
        let mut chords = vec![self.from];
        if let Curve::Circle { radius, turn, .. } = self.curve {
            let angle = 4.0 * libm::atan(bulge).abs();
            let largest = radius.max(radius - turn * self.off);
            let count = steps(largest, angle, tolerance).max(2);
            arc_points(self.from, self.to, bulge, count, &mut chords);
        }
        chords.push(self.to);
        chords
    }

    fn without_end(&self) -> &[DVec2] {
        &self.chords[..self.chords.len() - 1]
    }

    /// Where its ends come to lie.
    fn moved_ends(&self) -> [DVec2; 2] {
        let end = |at: DVec2, along: DVec2| at + along.perp() * self.off;
        [end(self.from, self.along[0]), end(self.to, self.along[1])]
    }

    /// What it sweeps over.
    fn strips(&self) -> Vec<Vec<DVec2>> {
        let [from, to] = self.moved_ends();
        let moved = self.curve.moved(self.off);
        let mut strip = self.chords.clone();
        match (self.curve, moved) {
            (Curve::Circle { centre, .. }, None) => {
                // Beyond the centre of its circle the sides cross.
                strip.push(centre);
                vec![strip, vec![centre, from, to]]
            }
            (_, moved) => {
                let inner = &self.chords[1..self.chords.len() - 1];
                let inner = inner.iter().rev();
                strip.push(to);
                strip.extend(inner.filter_map(|at| moved.map(|moved| moved.foot(*at))));
                strip.push(from);
                vec![strip]
            }
        }
    }
}

/// Gives sides that run on smoothly the largest of their distances.
fn move_together(sides: &mut [Side]) {
    let count = sides.len();
    let start = (0..count).find(|side| !sides[*side].is_smooth).unwrap_or(0);
    let mut chain: Vec<usize> = vec![];
    for step in 0..=count {
        let side = (start + step) % count;
        if step == count || !(sides[side].is_smooth || chain.is_empty()) {
            let off = chain
                .iter()
                .map(|side| sides[*side].off)
                .fold(0.0, f64::max);
            chain.drain(..).for_each(|side| sides[side].off = off);
        }
        chain.push(side);
    }
}

/// All that is taken away. Beside smooth corners a seam as wide as some steps of the lattice covers what rounding leaves
/// between two strips.
fn away(sides: &[Side], seam: f64) -> Vec<Vec<DVec2>> {
    let mut away = vec![];
    for side in sides.iter().filter(|side| side.off > 0.0) {
        away.extend(side.strips());
        if side.is_smooth {
            let along = side.along[0] * seam;
            let off = side.along[0].perp() * side.off;
            let [before, behind] = [side.from - along, side.from + along];
            away.push(vec![before, behind, behind + off, before + off]);
        }
    }
    for next in sides {
        let before = &sides[next.before];
        if !next.is_smooth {
            let ends = [(before.along[1], before.off), (next.along[0], next.off)];
            away.extend(corner(next.from, ends));
        }
    }
    away
}

/// What an edge of the chords' remains lies on: a side, and whether on the curve it moved to.
#[derive(Clone, Copy, PartialEq)]
struct Lies {
    side: usize,
    is_on: bool,
}

/// A ring of chords as a ring of lines and arcs.
fn recovered(ring: &[DVec2], sides: &[Side], extent: f64) -> Bow {
    let count = ring.len();
    let lies: Vec<Lies> = (0..count)
        .map(|index| lies([ring[index], ring[(index + 1) % count]], sides, extent))
        .collect();
    let is_start = |index: &usize| {
        let before = lies[(index + count - 1) % count];
        before != lies[*index] || !before.is_on
    };
    let mut bow = Bow::default();
    for index in (0..count).filter(is_start) {
        let (before, next) = (lies[(index + count - 1) % count], lies[index]);
        bow.corners
            .push(met(ring[index], [before, next], sides, REACH * extent));
        let side = &sides[next.side];
        let curve = side.curve.moved(side.off);
        bow.curves.push(curve.filter(|_| next.is_on));
        bow.edges.push(next.side);
    }
    bow
}

/// The side that an edge is nearest to in place and direction.
fn lies([from, to]: [DVec2; 2], sides: &[Side], extent: f64) -> Lies {
    let middle = 0.5 * (from + to);
    let length = from.distance(to);
    let along = (to - from).normalize_or_zero();
    let mut best = (
        f64::INFINITY,
        Lies {
            side: 0,
            is_on: false,
        },
    );
    for (number, side) in sides.iter().enumerate() {
        let Some(moved) = side.curve.moved(side.off) else {
            continue;
        };
        let off = moved.inside(from).abs().max(moved.inside(to).abs());
        let aside = length * moved.along(middle).distance(along);
        let score = off + 0.1 * side.beyond(middle) + aside;
        if score < best.0 {
            let is_on = off + aside <= 4.0 * CHORD * extent;
            best = (
                score,
                Lies {
                    side: number,
                    is_on,
                },
            );
        }
    }
    best.1
}

impl Side {
    /// How far beyond its ends a point lies.
    fn beyond(&self, at: DVec2) -> f64 {
        let (here, whole) = (
            self.curve.way(self.from, at),
            self.curve.way(self.from, self.to),
        );
        match self.curve {
            Curve::Line { .. } => (-here).max(here - whole).max(0.0),
            Curve::Circle { .. } if here <= whole => 0.0,
            Curve::Circle { .. } => (here - whole).min(self.curve.way(at, self.from)),
        }
    }
}

/// The corner where the curves of two edges meet, near the corner between their chords.
fn met(corner: DVec2, [before, next]: [Lies; 2], sides: &[Side], reach: f64) -> DVec2 {
    let side = &sides[next.side];
    let [a, b] = [before, next].map(|lies| {
        let side = &sides[lies.side];
        side.curve.moved(side.off).filter(|_| lies.is_on)
    });
    let point = match (a, b) {
        _ if side.before == before.side && side.is_smooth => Some(side.moved_ends()[0]),
        (Some(a), Some(b)) => a.meet(b, corner),
        _ => None,
    };
    let near = point.filter(|point| point.distance(corner) <= reach);
    near.unwrap_or(corner)
}
