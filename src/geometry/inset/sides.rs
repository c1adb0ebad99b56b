//! Edges in one line as one side.

use glam::DVec2;

/// Edges of a ring that lie in one line, and how far they move inwards.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    /// Its direction, of length 1; inside is on the left.
    pub(super) along: DVec2,
    /// How far it moves inwards.
    pub(super) off: f64,
    /// Where each edge begins, measured along the side, and its number.
    edges: Vec<(f64, usize)>,
}

/// Edges whose directions differ by less than this sine are in one line.
const STRAIGHT: f64 = 1e-9;

/// The sides of a ring whose first edge has the number `first`.
pub(super) fn sides(ring: &[DVec2], offs: &[f64], first: usize) -> Vec<Side> {
    let count = ring.len();
    let along = |edge: usize| (ring[(edge + 1) % count] - ring[edge % count]).normalize_or_zero();
    let turns = |corner: &usize| {
        let (before, next) = (along(corner + count - 1), along(*corner));
        before.perp_dot(next).abs() > STRAIGHT || before.dot(next) < 0.0
    };
    let corners: Vec<usize> = (0..count).filter(turns).collect();
    let mut sides = vec![];
    for (index, start) in corners.iter().enumerate() {
        let next = corners[(index + 1) % corners.len()];
        let length = if next > *start {
            next - start
        } else {
            next + count - start
        };
        let edges = (0..length).map(|step| (start + step) % count);
        let (from, to) = (ring[*start], ring[next]);
        let direction = (to - from).normalize_or_zero();
        sides.push(Side {
            from,
            to,
            along: direction,
            off: edges.clone().map(|edge| offs[edge]).fold(0.0, f64::max),
            edges: edges
                .map(|edge| ((ring[edge] - from).dot(direction), first + edge))
                .collect(),
        });
    }
    sides
}

impl Side {
    /// Where a point is along the side.
    fn position(&self, point: DVec2) -> f64 {
        (point - self.from).dot(self.along)
    }

    /// How far a point is inside of where the side comes to lie.
    pub(super) fn inside(&self, point: DVec2) -> f64 {
        self.along.perp_dot(point - self.from) - self.off
    }

    /// The edge beside which a point lies.
    pub(super) fn edge_at(&self, point: DVec2) -> usize {
        let near = 1e-9 * self.from.distance(self.to);
        let position = self.position(point) + near;
        let behind = self.edges.partition_point(|(start, _)| *start <= position);
        self.edges[behind.saturating_sub(1)].1
    }

    /// The places between two points of the moved side at which another edge begins.
    pub(super) fn between(&self, from: DVec2, to: DVec2) -> impl Iterator<Item = (DVec2, usize)> {
        let near = 1e-9 * self.from.distance(self.to);
        let [start, end] = [from, to].map(|point| self.position(point));
        let inner = self.edges.iter().skip(1);
        let inner = inner.filter(move |(at, _)| *at > start + near && *at < end - near);
        inner.map(move |(at, edge)| (from + self.along * (at - start), *edge))
    }
}
