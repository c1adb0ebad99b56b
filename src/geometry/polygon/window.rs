//! What of a ring lies in a box.

use glam::DVec2;

/// The part of a ring in a box; pieces that belong apart stay joined along the box's sides (Sutherland & Hodgman 1974).
/// Where the ring lies inside the box, nothing is changed.
pub(crate) fn cut_to_box(ring: &[DVec2], [low, high]: [DVec2; 2]) -> Vec<DVec2> {
    let mut kept = ring.to_vec();
    let sides = [
        (0, low.x, 1.0),
        (0, high.x, -1.0),
        (1, low.y, 1.0),
        (1, high.y, -1.0),
    ];
    for (axis, limit, sign) in sides {
        if kept
            .iter()
            .any(|corner| sign * (corner[axis] - limit) < 0.0)
        {
            kept = beyond(&kept, axis, limit, sign);
        }
    }
    kept
}

/// The part of a ring on one side of a line along an axis.
fn beyond(ring: &[DVec2], axis: usize, limit: f64, sign: f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(ring.len());
    for (index, corner) in ring.iter().enumerate() {
        let before = ring[(index + ring.len() - 1) % ring.len()];
        let [from, to] = [before, *corner].map(|point| sign * (point[axis] - limit));
        if (from < 0.0) != (to < 0.0) {
            let mut crossing = before + (*corner - before) * (from / (from - to));
            crossing[axis] = limit;
            kept.push(crossing);
        }
        if to >= 0.0 {
            kept.push(*corner);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::doubled_area;

    #[test]
    fn a_triangle_is_cut_on_all_sides() {
        let ring = [(-10.0, -1.0), (10.0, -1.0), (0.0, 9.0)].map(|(x, y)| DVec2::new(x, y));
        let cut = cut_to_box(&ring, [DVec2::ZERO, DVec2::new(3.0, 8.0)]);
        // The rectangle without the corner above the line x + y = 9.
        assert!((doubled_area(&cut) / 2.0 - 22.0).abs() < 1e-12);
        let inside = [DVec2::ONE, DVec2::new(2.0, 1.0), DVec2::new(1.0, 3.0)];
        assert_eq!(
            cut_to_box(&inside, [DVec2::ZERO, DVec2::splat(8.0)]),
            inside
        );
        assert!(cut_to_box(&inside, [DVec2::splat(4.0), DVec2::splat(8.0)]).is_empty());
    }
}
