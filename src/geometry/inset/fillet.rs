//! Rounded corners between lines and arcs.
//!
//! The middle of a corner's arc is where both edges meet when they move by its radius; the arc touches each edge at the foot
//! from there.

use super::bent::Bow;
use super::curve::Curve;
use crate::geometry::polygon::Bent;
use glam::DVec2;

/// Halvings of the radius' range where an edge is too short for the whole.
const HALVINGS: u32 = 48;

/// Edges whose directions differ by less than this sine have no corner between them.
const STRAIGHT: f64 = 1e-7;

/// A corner's arc.
#[derive(Clone, Copy)]
struct Fillet {
    from: DVec2,
    to: DVec2,
    bulge: f64,
}

/// Rounds the corners of a ring by arcs of `radius`, smaller where an edge is too short: no arc takes more than half of an
/// edge.
pub(super) fn rounded(ring: &Bow, radius: f64) -> Bent {
    let count = ring.corners.len();
    let fillets: Vec<Option<Fillet>> = (0..count)
        .map(|corner| fillet(ring, corner, radius))
        .collect();
    let mut bent = Bent::default();
    for index in 0..count {
        let next = (index + 1) % count;
        if let Some(Fillet { from, bulge, .. }) = fillets[index] {
            bent.push(from, bulge, index);
        }
        let from = fillets[index].map_or(ring.corners[index], |fillet| fillet.to);
        let to = fillets[next].map_or(ring.corners[next], |fillet| fillet.from);
        let near = 1e-12 * (ring.corners[index].distance(ring.corners[next]) + from.length());
        if from.distance(to) > near {
            let bulge = ring.curves[index].map_or(0.0, |curve| curve.bulge(from, to));
            bent.push(from, bulge, index);
        }
    }
    bent
}

fn fillet(ring: &Bow, corner: usize, radius: f64) -> Option<Fillet> {
    let count = ring.corners.len();
    let before = (corner + count - 1) % count;
    let at = ring.corners[corner];
    let ends = [ring.corners[before], ring.corners[(corner + 1) % count]];
    let curves = [ring.curve(before), ring.curve(corner)];
    let sine = curves[0].along(at).perp_dot(curves[1].along(at));
    if radius <= 0.0 || sine.abs() < STRAIGHT {
        return None;
    }
    let most = [
        0.5 * curves[0].way(ends[0], at),
        0.5 * curves[1].way(at, ends[1]),
    ];
    let fit = |radius: f64| arc(curves, at, sine.signum(), radius, most);
    fit(radius).or_else(|| {
        let (mut fits, mut none) = (0.0, radius);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (fits + none);
            if fit(middle).is_some() {
                fits = middle;
            } else {
                none = middle;
            }
        }
        fit(fits)
    })
}

/// The arc of a radius at a corner that turns left (1) or right (-1), unless it takes more than `most` of an edge.
fn arc(curves: [Curve; 2], at: DVec2, turn: f64, radius: f64, most: [f64; 2]) -> Option<Fillet> {
    let [before, next] = curves.map(|curve| curve.moved(turn * radius));
    let centre = before?.meet(next?, at)?;
    let [from, to] = curves.map(|curve| curve.foot(centre));
    let ways = [curves[0].way(from, at), curves[1].way(at, to)];
    let fits = (0..2).all(|side| (0.0..=most[side]).contains(&ways[side]));
    let circle = Curve::Circle {
        centre,
        radius,
        turn,
    };
    (radius > 0.0 && fits).then(|| Fillet {
        from,
        to,
        bulge: circle.bulge(from, to),
    })
}

impl Bow {
    /// What an edge lies on.
    fn curve(&self, edge: usize) -> Curve {
        let to = self.corners[(edge + 1) % self.corners.len()];
        self.curves[edge].unwrap_or_else(|| Curve::of(self.corners[edge], to, 0.0))
    }
}
