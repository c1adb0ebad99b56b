//! How high a surface of heights stands before the sky, seen from a point.

use super::Heights;
use super::line::{Line, Square, Stretch, Way};
use glam::{DVec2, DVec3};

/// Where lines begin, in cells: from a point of the surface it is seen by its slope there, and not by how the point is
/// rounded.
const BEGINNING: f64 = 1e-6;

impl Heights {
    /// The steepest rise from a point to the surface in a level direction of length 1, up to a distance: the tangent of
    /// the horizon's elevation. Minus infinity if there is no surface in this direction.
    pub(crate) fn horizon(&self, point: DVec3, direction: DVec2, furthest: f64) -> f64 {
        let line = Line::new(self, point.truncate(), direction);
        let stretch = Stretch {
            from: BEGINNING * self.cell.min_element(),
            to: furthest,
        };
        let mut steepest = f64::NEG_INFINITY;
        line.walk(self, stretch, |square| {
            let Stretch { from, to } = square.stretch;
            let above = square.greatest - point.z;
            // Up to a higher one it is steepest from nearby, down to a lower one from far away.
            let reached = above / if above > 0.0 { from } else { to };
            if reached <= steepest {
                let nothing_higher = steepest > 0.0 && self.range[1] - point.z <= steepest * from;
                return if nothing_higher { Way::End } else { Way::Past };
            }
            let Square {
                cell: Some(cell), ..
            } = square
            else {
                return Way::Into;
            };
            let [height, rise, bend] = self.along(*cell, &line);
            let found = steepest_in([height - point.z, rise, bend], &square.stretch);
            steepest = steepest.max(found);
            Way::Past
        });
        steepest
    }
}

/// The greatest of (a + b t + c t^2) / t in a stretch.
fn steepest_in([a, b, c]: [f64; 3], stretch: &Stretch) -> f64 {
    let Stretch { from, to } = *stretch;
    let slope = |at: f64| a / at + b + c * at;
    let ends = slope(from).max(slope(to));
    let turning = a / c;
    match c < 0.0 && turning > from * from && turning < to * to {
        true => ends.max(slope(turning.sqrt())),
        false => ends,
    }
}
