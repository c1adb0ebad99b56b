//! The triangles of a mesh on its map: which one shows at a point, and beside all of them, which is nearest.

use crate::geometry::box_tree::BoxTree;
use crate::value::Mesh;
use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;

/// How many times a triangle whose places lie beyond the square shows on it, at most: maps repeat.
const MOST_REPEATS: usize = 16;

/// A point closer than this to a triangle lies in it: what rounding leaves between neighbours.
const TOUCHING: f64 = 1e-12;

/// A mesh with a way to find its triangles on the square.
#[derive(Debug)]
pub(crate) struct Atlas {
    mesh: Arc<Mesh>,
    entries: Vec<Entry>,
    tree: BoxTree,
}

/// A triangle on the square, as often as it shows there.
#[derive(Debug)]
struct Entry {
    triangle: u32,
    corners: [DVec2; 3],
}

/// A point of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    triangle: u32,
    /// Shares of the triangle's corners.
    shares: [f64; 3],
    /// Whether the triangle covers the point that was asked for, or is only the nearest.
    pub(crate) is_covered: bool,
}

impl Atlas {
    /// Prepares a mesh that has places. `go_on` is asked now and then.
    ///
    /// # Errors
    /// What `go_on` says.
    pub(crate) fn new<E>(
        mesh: &Arc<Mesh>,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Atlas, E> {
        let mut entries = vec![];
        for (triangle, corners) in (0..).zip(&mesh.triangles) {
            let corners = corners
                .coordinates
                .map(|index| mesh.coordinates[index as usize]);
            entries.extend(repeats(corners).map(|corners| Entry { triangle, corners }));
        }
        let boxes: Vec<[DVec2; 2]> = entries.iter().map(|entry| bounds(entry.corners)).collect();
        Ok(Atlas {
            mesh: Arc::clone(mesh),
            tree: BoxTree::new(&boxes, go_on)?,
            entries,
        })
    }

    /// The triangle that shows at a point of the square, or the nearest point of one; the first of several.
    pub(crate) fn find(&self, at: DVec2) -> Option<Spot> {
        let distance = |entry: u32| nearest(at, self.entries[entry as usize].corners).0;
        let entry = &self.entries[self.tree.nearest(at, distance)? as usize];
        let (distance, shares) = nearest(at, entry.corners);
        Some(Spot {
            triangle: entry.triangle,
            shares,
            is_covered: distance <= TOUCHING * TOUCHING,
        })
    }

    /// Where a spot is in space.
    pub(crate) fn place(&self, spot: &Spot) -> DVec3 {
        let corners = self.points(spot.triangle).into_iter().zip(spot.shares);
        corners.map(|(corner, share)| corner * share).sum()
    }

    /// The chart of a spot.
    pub(crate) fn chart(&self, spot: &Spot) -> u32 {
        self.mesh.triangles[spot.triangle as usize].chart
    }

    /// The change of the place along the square's u and v; 0 for triangles without an area on it.
    pub(crate) fn tangents(&self, spot: &Spot) -> [DVec3; 2] {
        let [a, b, c] = self.mesh.triangles[spot.triangle as usize]
            .coordinates
            .map(|index| self.mesh.coordinates[index as usize]);
        let [p, q, r] = self.points(spot.triangle);
        let ([s, t], [pq, pr]) = ([b - a, c - a], [q - p, r - p]);
        let area = s.perp_dot(t);
        if area == 0.0 {
            return [DVec3::ZERO; 2];
        }
        [(pq * t.y - pr * s.y) / area, (pr * s.x - pq * t.x) / area]
    }

    /// The side in mm of a square on which the mesh, its points moved by `matrix`, has as large an area as in space;
    /// `None` if its triangles have none on the square.
    pub(crate) fn side(&self, matrix: &DMat3) -> Option<f64> {
        let (mut in_space, mut on_square) = (0.0, 0.0);
        for (index, triangle) in (0..).zip(&self.mesh.triangles) {
            let [p, q, r] = self.points(index);
            in_space += (*matrix * (q - p)).cross(*matrix * (r - p)).length();
            let [a, b, c] = triangle
                .coordinates
                .map(|it| self.mesh.coordinates[it as usize]);
            on_square += (b - a).perp_dot(c - a).abs();
        }
        (on_square > 0.0).then(|| (in_space / on_square).sqrt())
    }

    fn points(&self, triangle: u32) -> [DVec3; 3] {
        let triangle = &self.mesh.triangles[triangle as usize];
        triangle
            .points
            .map(|index| self.mesh.points[index as usize])
    }
}

fn bounds(corners: [DVec2; 3]) -> [DVec2; 2] {
    let [a, b, c] = corners;
    [a.min(b).min(c), a.max(b).max(c)]
}

/// A triangle, moved by whole squares to wherever it shows on the first.
fn repeats(corners: [DVec2; 3]) -> impl Iterator<Item = [DVec2; 3]> {
    let [low, high] = bounds(corners);
    // What only touches the square from outside does not show.
    let range = |low: f64, high: f64| {
        let (first, last) = (low.floor() as i64, (high.ceil() - 1.0) as i64);
        first
            ..=last
                .max(first)
                .min(first.saturating_add(MOST_REPEATS as i64))
    };
    let squares = range(low.x, high.x)
        .flat_map(move |x| range(low.y, high.y).map(move |y| DVec2::new(x as f64, y as f64)));
    squares
        .take(MOST_REPEATS)
        .map(move |square| corners.map(|corner| corner - square))
}

/// The square of the distance to a triangle, and the shares of its corners at the nearest point.
fn nearest(at: DVec2, [a, b, c]: [DVec2; 3]) -> (f64, [f64; 3]) {
    let area = (b - a).perp_dot(c - a);
    if area != 0.0 {
        let of = |p: DVec2, q: DVec2| (p - at).perp_dot(q - at) / area;
        let shares = [of(b, c), of(c, a), of(a, b)];
        if shares.iter().all(|share| *share >= 0.0) {
            return (0.0, shares);
        }
    }
    let on_side = |p: DVec2, q: DVec2| {
        let length = p.distance_squared(q);
        let share = match length > 0.0 {
            true => ((at - p).dot(q - p) / length).clamp(0.0, 1.0),
            false => 0.0,
        };
        (at.distance_squared(p + (q - p) * share), share)
    };
    let sides = [on_side(a, b), on_side(b, c), on_side(c, a)];
    let mut first = 0;
    for side in 1..3 {
        if sides[side].0 < sides[first].0 {
            first = side;
        }
    }
    let (distance, share) = sides[first];
    let mut shares = [0.0; 3];
    shares[first] = 1.0 - share;
    shares[(first + 1) % 3] = share;
    (distance, shares)
}
