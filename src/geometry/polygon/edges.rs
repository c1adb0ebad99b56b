//! The edges of rings in a tree: which are near, what they enclose, how far away they are.

use crate::geometry::box_tree::BoxTree;
use glam::DVec2;
use std::convert::Infallible;

/// Straight edges of rings, found by place.
#[derive(Debug)]
pub(crate) struct Edges {
    ends: Vec<[DVec2; 2]>,
    tree: BoxTree,
}

impl Edges {
    /// The edges of closed rings.
    pub(crate) fn new<'a>(rings: impl Iterator<Item = &'a [DVec2]>) -> Edges {
        let mut ends = vec![];
        for ring in rings {
            let next = ring.iter().cycle().skip(1);
            ends.extend(ring.iter().zip(next).map(|(from, to)| [*from, *to]));
        }
        let boxes: Vec<_> = ends.iter().map(|[a, b]| [a.min(*b), a.max(*b)]).collect();
        let Ok(tree) = BoxTree::new(&boxes, &mut || Ok::<(), Infallible>(()));
        Edges { ends, tree }
    }

    /// Whether the box of an edge touches a box.
    pub(crate) fn come_near(&self, [low, high]: [DVec2; 2]) -> bool {
        let mut near = false;
        self.tree.visit([low, high], &mut |edge| {
            let [a, b] = self.ends[edge as usize];
            near |= a.min(b).cmple(high).all() && a.max(b).cmpge(low).all();
        });
        near
    }

    /// Whether the rings enclose a point, each edge counted once: what lies behind an odd number of edges is inside.
    pub(crate) fn enclose(&self, point: DVec2) -> bool {
        let ray = [point, DVec2::new(f64::INFINITY, point.y)];
        let mut inside = false;
        self.tree.visit(ray, &mut |edge| {
            let [a, b] = self.ends[edge as usize];
            if (a.y > point.y) != (b.y > point.y) {
                let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
                inside ^= (high - low).perp_dot(point - low) > 0.0;
            }
        });
        inside
    }

    /// How far the nearest edge is from a point; infinite if there is none.
    pub(crate) fn distance(&self, point: DVec2) -> f64 {
        let square = |edge: u32| {
            let [a, b] = self.ends[edge as usize];
            nearest_on(a, b, point).distance_squared(point)
        };
        let nearest = self.tree.nearest(point, square);
        nearest.map_or(f64::INFINITY, |edge| square(edge).sqrt())
    }
}

/// The point of the edge from `a` to `b` that is nearest to a point.
pub(crate) fn nearest_on(a: DVec2, b: DVec2, point: DVec2) -> DVec2 {
    let along = b - a;
    let square = along.length_squared();
    if square == 0.0 {
        return a;
    }
    a + along * ((point - a).dot(along) / square).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        let corners = [(low, low), (high, low), (high, high), (low, high)];
        corners.map(|(x, y)| DVec2::new(x, y)).to_vec()
    }

    #[test]
    fn a_square_with_a_hole_encloses_what_is_between() {
        let rings = [square(0.0, 10.0), square(4.0, 6.0)];
        let edges = Edges::new(rings.iter().map(|ring| &ring[..]));
        for (x, y, inside, distance) in [
            (1.0, 2.0, true, 1.0),
            (5.0, 5.0, false, 1.0),
            (5.0, 3.0, true, 1.0),
            (-3.0, -4.0, false, 5.0),
            (12.0, 4.0, false, 2.0),
            (0.0, 4.0, true, 0.0),
        ] {
            let point = DVec2::new(x, y);
            assert_eq!(edges.enclose(point), inside, "{point}");
            assert_eq!(edges.distance(point), distance, "{point}");
        }
        assert!(edges.come_near([DVec2::splat(-1.0), DVec2::splat(0.0)]));
        assert!(!edges.come_near([DVec2::splat(1.0), DVec2::splat(3.0)]));
        assert!(
            Edges::new(std::iter::empty())
                .distance(DVec2::ZERO)
                .is_infinite()
        );
    }
}
