//! Areas and centres of gravity of rings, whose edges may be arcs.

use glam::DVec2;

/// Twice the area that a ring of straight edges encloses, in the square of its unit; below 0 if it runs clockwise.
pub(crate) fn doubled_area(ring: &[DVec2]) -> f64 {
    let Some(first) = ring.first() else {
        return 0.0;
    };
    let pairs = ring.windows(2).map(|pair| (pair[0], pair[1]));
    pairs.map(|(a, b)| (a - *first).perp_dot(b - *first)).sum()
}

/// What a ring encloses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Measure {
    /// The area, below 0 if the ring runs clockwise.
    pub(crate) area: f64,
    /// The integral of the position over the area.
    pub(crate) moment: DVec2,
}

impl Measure {
    /// The centre of gravity; not a number where there is no area.
    pub(crate) fn centre(self) -> DVec2 {
        self.moment / self.area
    }
}

impl std::ops::Add for Measure {
    type Output = Measure;

    fn add(self, other: Measure) -> Measure {
        Measure {
            area: self.area + other.area,
            moment: self.moment + other.moment,
        }
    }
}

/// What a ring encloses. `bulges` are the tangents of a quarter of each edge's angle, or nothing if all edges are straight.
pub(crate) fn measure(ring: &[DVec2], bulges: &[f64]) -> Measure {
    let Some(first) = ring.first() else {
        return Measure::default();
    };
    // About the first corner, so that rings far from the origin lose nothing.
    let mut whole = Measure::default();
    for (index, corner) in ring.iter().enumerate() {
        let (a, b) = (*corner - *first, ring[(index + 1) % ring.len()] - *first);
        let area = 0.5 * a.perp_dot(b);
        let triangle = Measure {
            area,
            moment: area * (a + b) / 3.0,
        };
        let bulge = bulges.get(index).copied().unwrap_or_default();
        whole = whole + triangle + segment(a, b, bulge);
    }
    whole.moment += whole.area * *first;
    whole
}

/// What lies between an arc and its chord.
fn segment(a: DVec2, b: DVec2, bulge: f64) -> Measure {
    if bulge == 0.0 {
        return Measure::default();
    }
    let chord = b - a;
    let length = chord.length();
    let (area, off) = unit_segment(bulge);
    let area = area * length * length;
    // An arc that turns left lies on the right of its chord.
    let outward = -chord.perp();
    Measure {
        area,
        moment: area * 0.5 * (a + b) + off * length * length * outward,
    }
}

/// The area between an arc and its chord of length 1, and the integral of the distance from the chord over it.
fn unit_segment(bulge: f64) -> (f64, f64) {
    let square = bulge * bulge;
    if square < 1e-4 {
        // The series of what is below, which loses digits there.
        let area = bulge * (1.0 / 3.0 + square * (1.0 / 15.0 - square / 105.0));
        return (area, square * (1.0 / 15.0 + square * 2.0 / 105.0));
    }
    let wide = 1.0 + square;
    let area = (wide * wide * libm::atan(bulge) - bulge * (1.0 - square)) / (8.0 * square);
    // The segment's moment about the arc's centre is a twelfth of the chord's cube.
    let to_centre = (1.0 - square) / (4.0 * bulge);
    (area, 1.0 / 12.0 - area * to_centre)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_square_far_away_has_its_area_and_centre() {
        let far = DVec2::new(1e8, -3e8);
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
        let ring = corners.map(|(x, y)| far + DVec2::new(x, y));
        let measure = measure(&ring, &[]);
        assert_eq!(measure.area, 2.0);
        assert!((measure.centre() - far - DVec2::new(1.0, 0.5)).length() < 1e-6);
        assert_eq!(doubled_area(&ring), 4.0);
    }

    #[test]
    fn two_half_circles_make_a_disk() {
        let ring = [DVec2::new(2.0, 5.0), DVec2::new(8.0, 5.0)];
        let whole = measure(&ring, &[1.0, 1.0]);
        assert!((whole.area - 9.0 * PI).abs() < 1e-12);
        assert!((whole.centre() - DVec2::splat(5.0)).length() < 1e-12);
        let half = measure(&ring, &[1.0, 0.0]);
        let below = 5.0 - 4.0 * 3.0 / (3.0 * PI);
        assert!((half.centre() - DVec2::new(5.0, below)).length() < 1e-12);
        let bitten = measure(&ring, &[1.0, -1.0]);
        assert!(bitten.area.abs() < 1e-12);
    }

    #[test]
    fn the_series_continues_the_formula() {
        for sign in [-1.0, 1.0] {
            let (below, above) = (
                unit_segment(sign * 0.00999999),
                unit_segment(sign * 0.01000001),
            );
            assert!((below.0 / above.0 - 0.999998).abs() < 1e-10);
            assert!((below.1 / above.1 - 0.999996).abs() < 1e-8);
        }
    }
}
