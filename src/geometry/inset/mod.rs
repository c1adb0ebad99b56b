//! Cells made smaller: each edge moves inwards by its own distance, and what is left keeps to know which edge is which.

mod bent;
mod concave;
mod convex;
mod curve;
mod fillet;
mod sides;

use crate::geometry::polygon::{Bent, doubled_area, measure, round_corners};
use glam::DVec2;
use sides::Side;

/// A ring of what is left of a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Left {
    pub(crate) corners: Vec<DVec2>,
    /// How much the edge behind each corner is bent, as in partitions.
    pub(crate) bulges: Vec<f64>,
    /// The edge of the cell that each edge runs along, counted over all rings.
    pub(crate) edges: Vec<usize>,
}

/// A ring of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contour<'a> {
    pub(crate) corners: &'a [DVec2],
    /// How much the edge behind each corner is bent, as in partitions; empty if all are straight.
    pub(crate) bulges: &'a [f64],
}

impl Contour<'_> {
    fn bulge(&self, corner: usize) -> f64 {
        self.bulges.get(corner).copied().unwrap_or_default()
    }
}

/// What is left of a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Remains {
    /// The outline, and then the holes; nothing if the cell vanishes.
    pub(crate) rings: Vec<Left>,
    /// Into how many parts it falls, of which this is the largest.
    pub(crate) parts: usize,
}

/// What is left of a cell when each edge moves inwards by `offs`: straight ones stay parallel, arcs keep their centres. Edges in
/// one line move together, by the largest of their distances, and beside arcs all edges that run on smoothly. If the cell falls
/// apart, the largest part is what is left. Corners are rounded by arcs of `radius`.
pub(crate) fn inset(rings: &[Contour<'_>], offs: &[f64], radius: f64) -> Remains {
    let is_bent = |ring: &Contour<'_>| ring.bulges.iter().any(|bulge| *bulge != 0.0);
    let (rings, parts) = if rings.iter().any(is_bent) {
        let (left, parts) = bent::cut(rings, offs);
        let left = left
            .iter()
            .map(|ring| fillet::rounded(ring, radius).left(&ring.edges));
        (left.collect(), parts)
    } else {
        straight(rings, offs, radius)
    };
    let outline = rings
        .first()
        .map(|ring: &Left| measure(&ring.corners, &ring.bulges).area);
    match outline.is_some_and(|area| area > 0.0) {
        true => Remains { rings, parts },
        false => Remains::default(),
    }
}

/// What is left of a cell of straight edges, and into how many parts it falls.
fn straight(rings: &[Contour<'_>], offs: &[f64], radius: f64) -> (Vec<Left>, usize) {
    let mut sides = vec![];
    let mut first = 0;
    for ring in rings {
        let offs = &offs[first..first + ring.corners.len()];
        sides.extend(sides::sides(ring.corners, offs, first));
        first += ring.corners.len();
    }
    let (left, parts) = match rings {
        [only] if is_convex(only.corners) => (vec![convex::cut(&sides)], 1),
        _ => {
            let rings: Vec<&[DVec2]> = rings.iter().map(|ring| ring.corners).collect();
            concave::cut(&rings, &sides)
        }
    };
    let outline = left.first().map(|(corners, _)| doubled_area(corners));
    if outline.is_none_or(|area| area <= 0.0) {
        return (vec![], 0);
    }
    let rings = left.iter().map(|ring| finished(ring, &sides, radius));
    (rings.collect(), parts)
}

/// Whether a ring turns left at each corner, or goes straight on.
fn is_convex(ring: &[DVec2]) -> bool {
    let count = ring.len();
    (0..count).all(|index| {
        let along = ring[(index + 1) % count] - ring[index];
        let next = ring[(index + 2) % count] - ring[(index + 1) % count];
        along.perp_dot(next) >= -1e-12 * along.length() * next.length()
            && along.dot(next) > -0.999_999 * along.length() * next.length()
    })
}

/// A ring with rounded corners, whose sides are the edges of the cell again.
fn finished((corners, of): &(Vec<DVec2>, Vec<usize>), sides: &[Side], radius: f64) -> Left {
    let bent = round_corners(corners, radius);
    let mut left = Left::default();
    for (index, from) in bent.corners.iter().enumerate() {
        let side = &sides[of[bent.edges[index]]];
        let to = bent.corners[(index + 1) % bent.corners.len()];
        if bent.bulges[index] != 0.0 {
            left.push(*from, bent.bulges[index], side.edge_at(to));
            continue;
        }
        left.push(*from, 0.0, side.edge_at(*from));
        for (corner, edge) in side.between(*from, to) {
            left.push(corner, 0.0, edge);
        }
    }
    left
}

impl Bent {
    /// The ring with the edges of the cell that the edges of the rounded ring belong to.
    fn left(self, edges: &[usize]) -> Left {
        Left {
            edges: self.edges.iter().map(|edge| edges[*edge]).collect(),
            corners: self.corners,
            bulges: self.bulges,
        }
    }
}

impl Left {
    fn push(&mut self, corner: DVec2, bulge: f64, edge: usize) {
        self.corners.push(corner);
        self.bulges.push(bulge);
        self.edges.push(edge);
    }
}

#[cfg(test)]
mod tests;
