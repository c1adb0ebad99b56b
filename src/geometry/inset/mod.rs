//! Cells made smaller: each edge moves inwards by its own distance, and what is left keeps to know which edge is which.

mod concave;
mod convex;
mod sides;

use crate::geometry::polygon::{doubled_area, round_corners};
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

/// What is left of a cell of straight edges when each edge moves inwards by `offs`: the outline, and then the holes.
/// Edges in one line move together, by the largest of their distances. If it falls apart, the largest part is what is left.
/// Corners are rounded by arcs of `radius`. Nothing if the cell vanishes.
pub(crate) fn inset(rings: &[&[DVec2]], offs: &[f64], radius: f64) -> Vec<Left> {
    let mut sides = vec![];
    let mut first = 0;
    for ring in rings {
        sides.extend(sides::sides(ring, &offs[first..first + ring.len()], first));
        first += ring.len();
    }
    let left = match rings {
        [only] if is_convex(only) => vec![convex::cut(&sides)],
        _ => concave::cut(rings, &sides),
    };
    let outline = left.first().map(|(corners, _)| doubled_area(corners));
    if outline.is_none_or(|area| area <= 0.0) {
        return vec![];
    }
    left.iter()
        .map(|ring| finished(ring, &sides, radius))
        .collect()
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

impl Left {
    fn push(&mut self, corner: DVec2, bulge: f64, edge: usize) {
        self.corners.push(corner);
        self.bulges.push(bulge);
        self.edges.push(edge);
    }
}

#[cfg(test)]
mod tests;
