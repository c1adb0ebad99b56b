//! Rounded corners as exact arcs, and arcs as short straight edges.

use glam::DVec2;

/// A ring whose edges may be arcs.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Bent {
    pub(crate) corners: Vec<DVec2>,
    /// How much the edge behind each corner is bent: the tangent of a quarter of its angle.
    pub(crate) bulges: Vec<f64>,
    /// The edge of the ring that was rounded on which each edge lies; an arc belongs to the edge behind it.
    pub(crate) edges: Vec<usize>,
}

impl Bent {
    /// Adds a corner and how the edge behind it is bent.
    pub(crate) fn push(&mut self, corner: DVec2, bulge: f64, edge: usize) {
        self.corners.push(corner);
        self.bulges.push(bulge);
        self.edges.push(edge);
    }
}

/// Corners that turn by less than this are not rounded, as a sine.
const STRAIGHT: f64 = 1e-9;

/// Rounds the corners of a ring of straight edges by arcs of `radius`, smaller where an edge is too short: no arc takes
/// more than half of an edge.
pub(crate) fn round_corners(ring: &[DVec2], radius: f64) -> Bent {
    let count = ring.len();
    let mut bent = Bent::default();
    for (index, corner) in ring.iter().enumerate() {
        let to_before = ring[(index + count - 1) % count] - *corner;
        let to_next = ring[(index + 1) % count] - *corner;
        let (before, next) = (to_before.length(), to_next.length());
        let (cosine, sine) = turn(-to_before / before, to_next / next);
        if radius <= 0.0 || sine.abs() < STRAIGHT && cosine > 0.0 {
            bent.push(*corner, 0.0, index);
            continue;
        }
        let half = sine / (1.0 + cosine).max(1e-12);
        let off = (radius * half.abs()).min(0.5 * before.min(next));
        let bulge = half / (1.0 + (1.0 + half * half).sqrt());
        bent.push(*corner + to_before * (off / before), bulge, index);
        bent.push(*corner + to_next * (off / next), 0.0, index);
    }
    without_points(&bent)
}

/// Cosine and sine of the angle between two directions.
fn turn(from: DVec2, to: DVec2) -> (f64, f64) {
    (from.dot(to), from.perp_dot(to))
}

/// Arcs that take half an edge each leave nothing between them.
fn without_points(bent: &Bent) -> Bent {
    let (corners, count) = (&bent.corners, bent.corners.len());
    let extent = corners.iter().map(|corner| corner.abs().max_element());
    let near = 1e-14 * extent.fold(0.0, f64::max);
    let mut kept = Bent::default();
    for index in 0..count {
        let bulge = bent.bulges[index];
        if bulge != 0.0 || corners[index].distance(corners[(index + 1) % count]) > near {
            kept.push(corners[index], bulge, bent.edges[index]);
        }
    }
    kept
}

/// A ring of straight edges that is nowhere farther from the bent one than `tolerance`.
pub(crate) fn flatten(bent: &Bent, tolerance: f64) -> Vec<DVec2> {
    let corners = &bent.corners;
    let mut flat = vec![];
    for (index, from) in corners.iter().enumerate() {
        let to = corners[(index + 1) % corners.len()];
        flat.push(*from);
        let bulge = bent.bulges[index];
        if bulge != 0.0 {
            add_arc(*from, to, bulge, tolerance, &mut flat);
        }
    }
    flat
}

/// A ring of straight edges that is nowhere farther from a bent one than `share` of the length of the arc beside it. An arc has the
/// same chords, bit by bit, from both of its sides.
pub(crate) fn chorded(corners: &[DVec2], bulges: &[f64], share: f64) -> Vec<DVec2> {
    let mut flat = Vec::with_capacity(corners.len());
    for (index, from) in corners.iter().enumerate() {
        let to = corners[(index + 1) % corners.len()];
        flat.push(*from);
        let bulge = bulges.get(index).copied().unwrap_or_default();
        if bulge == 0.0 {
            continue;
        }
        let first = flat.len();
        let is_forward = (from.x, from.y) < (to.x, to.y);
        let (low, high, bend) = match is_forward {
            true => (*from, to, bulge),
            false => (to, *from, -bulge),
        };
        let angle = 4.0 * libm::atan(bulge.abs());
        let parts = steps(1.0, angle, share * angle);
        arc_points(low, high, bend, parts, &mut flat);
        if !is_forward {
            flat[first..].reverse();
        }
    }
    flat
}

/// The points between the ends of an arc as near as `tolerance` needs them.
fn add_arc(from: DVec2, to: DVec2, bulge: f64, tolerance: f64, flat: &mut Vec<DVec2>) {
    let angle = 4.0 * libm::atan(bulge);
    let radius = (from - centre(from, to, bulge)).length();
    arc_points(from, to, bulge, steps(radius, angle.abs(), tolerance), flat);
}

/// The points that divide an arc into so many equal parts.
pub(crate) fn arc_points(from: DVec2, to: DVec2, bulge: f64, parts: u32, points: &mut Vec<DVec2>) {
    let centre = centre(from, to, bulge);
    let angle = 4.0 * libm::atan(bulge);
    for step in 1..parts {
        let (sine, cosine) = libm::sincos(angle * f64::from(step) / f64::from(parts));
        points.push(centre + DVec2::new(cosine, sine).rotate(from - centre));
    }
}

/// The centre of an arc's circle.
fn centre(from: DVec2, to: DVec2, bulge: f64) -> DVec2 {
    0.5 * (from + to) + (to - from).perp() * ((1.0 - bulge * bulge) / (4.0 * bulge))
}

/// How many straight edges stay within `tolerance` of an arc.
pub(crate) fn steps(radius: f64, angle: f64, tolerance: f64) -> u32 {
    let share = (1.0 - tolerance / radius.max(tolerance)).clamp(0.0, 1.0);
    let widest = 2.0 * libm::acos(share).max(1e-4);
    (angle / widest).ceil().clamp(1.0, 1e5) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::{doubled_area, measure};
    use std::f64::consts::PI;

    fn square() -> Vec<DVec2> {
        [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
            .map(|(x, y)| DVec2::new(x, y))
            .to_vec()
    }

    #[test]
    fn a_square_loses_what_four_arcs_leave_out() {
        let area = |bent: &Bent| measure(&bent.corners, &bent.bulges).area;
        let rounded = round_corners(&square(), 1.0);
        assert_eq!(rounded.edges, [0, 0, 1, 1, 2, 2, 3, 3]);
        assert!((area(&rounded) - (12.0 + PI)).abs() < 1e-12);
        let disk = round_corners(&square(), 9.0);
        assert_eq!(disk.edges, [0, 1, 2, 3]);
        assert!((area(&disk) - 4.0 * PI).abs() < 1e-12);
    }

    #[test]
    fn flat_arcs_stay_within_the_tolerance() {
        let flat = flatten(&round_corners(&square(), 2.0), 1e-3);
        let centre = DVec2::splat(2.0);
        assert!(
            flat.iter()
                .all(|corner| (corner.distance(centre) - 2.0).abs() < 1e-12)
        );
        let middle = 0.5 * (flat[0] + flat[1]);
        assert!((1.999..2.0).contains(&middle.distance(centre)));
        let area = doubled_area(&flat) / 2.0;
        assert!(area < 4.0 * PI && area > 4.0 * PI - 4.0 * PI * 1e-3);
    }

    #[test]
    fn an_arc_has_the_same_chords_from_both_sides() {
        let ends = [DVec2::new(0.1, 0.7), DVec2::new(-3.3, 5.9)];
        let forward = chorded(&ends, &[0.37, 0.0], 1e-3);
        let backward = chorded(&[ends[1], ends[0]], &[-0.37, 0.0], 1e-3);
        assert!(forward.len() > 8);
        let count = forward.len();
        let reversed: Vec<DVec2> = backward[1..count - 1].iter().rev().copied().collect();
        assert_eq!(forward[1..count - 1], reversed);
        // What the chords leave out of the segment is their share of the arc's length at most.
        let whole = measure(&ends, &[0.37, 0.0]).area;
        let length =
            4.0 * libm::atan(0.37) * (1.0 + 0.37 * 0.37) / (4.0 * 0.37) * ends[0].distance(ends[1]);
        let left_out = whole - doubled_area(&forward) / 2.0;
        assert!(left_out > 0.0 && left_out < 1e-3 * length * length);
    }

    #[test]
    fn a_corner_that_turns_right_is_rounded_inwards() {
        let notched =
            [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
        let bulges = round_corners(&notched, 0.1).bulges;
        let signs = bulges
            .iter()
            .map(|bulge| bulge.partial_cmp(&0.0).unwrap() as i32);
        assert_eq!(signs.collect::<Vec<i32>>(), [1, 0, 1, 0, 1, 0, -1, 0]);
    }
}
