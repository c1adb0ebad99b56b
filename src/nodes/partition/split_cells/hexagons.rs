//! Regular hexagons.

use super::laid::{Laid, steps};
use glam::DVec2;

/// Hexagons that stand on a corner, in rows.
pub(super) struct Hexagons {
    /// Distance of opposite sides.
    width: f64,
    /// Length of a side.
    side: f64,
}

impl Hexagons {
    pub(super) fn new(width: f64) -> Hexagons {
        Hexagons {
            width,
            side: width / 3.0_f64.sqrt(),
        }
    }

    pub(super) fn area(&self) -> f64 {
        1.5 * self.width * self.side
    }

    pub(super) fn repeat(&self) -> DVec2 {
        DVec2::new(self.width, 3.0 * self.side)
    }

    pub(super) fn cover(&self, [low, high]: [DVec2; 2]) -> Vec<Laid> {
        let mut laid = vec![];
        let step = 1.5 * self.side;
        // Corners in half widths and half sides, so that neighbours have the same bits.
        let around = [(0, -2), (1, -1), (1, 1), (0, 2), (-1, 1), (-1, -1)];
        for row in steps(low.y - self.side, high.y + self.side, step) {
            for column in steps(low.x - self.width, high.x + self.width, self.width) {
                let middle = (2 * column + row.rem_euclid(2), 3 * row);
                let corner = |(x, y): (i32, i32)| {
                    let (x, y) = (f64::from(middle.0 + x), f64::from(middle.1 + y));
                    DVec2::new(0.5 * self.width * x, 0.5 * self.side * y)
                };
                let corners = around.map(corner).to_vec();
                laid.push(Laid::straight(corners, DVec2::X, [row, column]));
            }
        }
        laid
    }
}
