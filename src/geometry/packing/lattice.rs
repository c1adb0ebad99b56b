//! Lattices that stones of one shape lie on.

use glam::DVec2;

/// Distance of the stones of a Cairo tiling from the corners of its squares, over the squares' side, and the side over
/// the distance of neighbouring stones.
pub(crate) const CAIRO: f64 = 0.183_012_701_892_219_3;
pub(crate) const CAIRO_SIDE: f64 = 1.931_851_652_578_136_6;

/// How the four stones around a corner are turned.
pub(crate) const CAIRO_TURNS: [(f64, f64); 4] = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];

/// The area of a stone with 4, 5 or 6 corners, over that of the rectangle of its length and width: of hexagons, and of the
/// pentagons of a Cairo tiling, these are distances to their neighbours.
pub(crate) fn area_share(corners: u32) -> f64 {
    match corners {
        5 => 0.25 * CAIRO_SIDE * CAIRO_SIDE,
        6 => 0.75_f64.sqrt(),
        _ => 1.0,
    }
}

/// Rows of points: `step.x` apart within a row, rows `step.y` apart, each row moved by `shift` of a step against the
/// one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// Distance within a row and between rows, in mm.
    pub(crate) step: DVec2,
    /// How far each row is moved, as a share of `step.x`.
    pub(crate) shift: f64,
}

impl Lattice {
    /// The lattice point nearest to an offset from a lattice point, both in the lattice's own frame; distances along each
    /// axis count in steps.
    pub(crate) fn nearest(&self, offset: DVec2) -> DVec2 {
        let rows = offset.y / self.step.y;
        if self.shift == 0.0 {
            return DVec2::new(rounded(offset.x / self.step.x), rounded(rows)) * self.step;
        }
        let in_row = |row: f64| {
            let moved = self.shift * row;
            let column = rounded(offset.x / self.step.x - moved) + moved;
            DVec2::new(column, row) * self.step
        };
        let row = rounded(rows - 0.5);
        let (below, above) = (in_row(row), in_row(row + 1.0));
        let steps = |point: DVec2| ((offset - point) / self.step).length_squared();
        if steps(above) < steps(below) {
            above
        } else {
            below
        }
    }

    /// The same with all lengths multiplied.
    pub(crate) fn scaled(&self, scale: f64) -> Lattice {
        Lattice {
            step: scale * self.step,
            ..*self
        }
    }
}

/// The nearest whole number, without a call: behind 1.5 * 2^52 there are no places after the point.
fn rounded(number: f64) -> f64 {
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    (number + WHOLE) - WHOLE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_the_one_that_a_search_finds() {
        for (step, shift) in [
            ((2.0, 1.0), 0.0),
            ((2.0, 1.0), 0.5),
            ((1.0, 0.866), 0.5),
            ((3.0, 1.0), 0.25),
        ] {
            let lattice = Lattice {
                step: DVec2::from(step),
                shift,
            };
            let point = |x: i32, y: i32| {
                DVec2::new(f64::from(x) + shift * f64::from(y), f64::from(y)) * lattice.step
            };
            let all: Vec<DVec2> = (-9..10)
                .flat_map(|x| (-9..10).map(move |y| point(x, y)))
                .collect();
            for at in 0..200 {
                let offset = DVec2::new(
                    f64::from(at * 37 % 101) / 33.0 - 1.5,
                    f64::from(at * 61 % 97) / 32.0 - 1.5,
                );
                let steps = |point: DVec2| ((offset - point) / lattice.step).length();
                let found = lattice.nearest(offset);
                assert!(all.iter().any(|point| point.distance(found) < 1e-12));
                let best = all
                    .iter()
                    .map(|point| steps(*point))
                    .fold(f64::INFINITY, f64::min);
                assert!(steps(found) <= best + 1e-12);
            }
        }
    }
}
