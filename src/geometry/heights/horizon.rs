//! How high a surface of heights stands before the sky, seen from a point.

use super::Heights;
use super::line::{Holds, Line, Square, Stretch, Way};
use glam::{DVec2, DVec3};

/// Where lines begin, in cells: from a point of the surface it is seen by its slope there, and not by how the point is
/// rounded.
const BEGINNING: f64 = 1e-6;

/// Which rises count, as tangents of elevations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rises {
    /// What is less steep does not count.
    pub(crate) least: f64,
    /// When it is as steep as this, nothing steeper is looked for.
    pub(crate) most: f64,
    /// By so much a steeper one may be missed.
    pub(crate) tolerance: f64,
}

impl Heights {
    /// The steepest rise from a point to the surface in a level direction of length 1, up to a distance: the tangent of
    /// the horizon's elevation, or the least that counts.
    pub(crate) fn horizon(
        &self,
        point: DVec3,
        direction: DVec2,
        furthest: f64,
        rises: &Rises,
    ) -> f64 {
        let line = Line::new(self, point.truncate(), direction);
        let stretch = Stretch {
            from: BEGINNING * self.cell.min_element(),
            to: furthest,
        };
        let highest = self.range[1] - point.z;
        let mut steepest = rises.least;
        // Close to a point over the surface everything counts, so the smallest squares come first.
        let level = match self.is_over(point.truncate()) {
            true => 0,
            false => usize::MAX,
        };
        line.walk(self, (stretch, level), |square| {
            let Stretch { from, to } = square.stretch;
            let wanted = steepest + rises.tolerance;
            match square.holds {
                Holds::Cell(cell) => {
                    let [height, rise, bend] = self.along(cell, &line);
                    let found = steepest_in([height - point.z, rise, bend], square);
                    steepest = steepest.max(found);
                    if steepest >= rises.most {
                        Way::End
                    } else {
                        Way::Past
                    }
                }
                Holds::Many(greatest) => {
                    let above = greatest - point.z;
                    // Up to a higher one it is steepest from nearby, down to a lower one from far away.
                    if above > wanted * if above > 0.0 { from } else { to } {
                        return Way::Into;
                    }
                    let nothing_higher = wanted >= 0.0 && highest <= wanted * from;
                    if nothing_higher { Way::End } else { Way::Past }
                }
            }
        });
        steepest
    }
}

/// The greatest of (a + b t + c t^2) / t in a square; where the stretch only goes on, its beginning has been seen.
#[inline]
fn steepest_in([a, b, c]: [f64; 3], square: &Square) -> f64 {
    let Stretch { from, to } = square.stretch;
    let slope = |at: f64| a / at + b + c * at;
    let mut steepest = slope(to);
    if square.is_first {
        steepest = steepest.max(slope(from));
    }
    if a < 0.0 && c < 0.0 {
        let turning = (a / c).sqrt();
        if turning > from && turning < to {
            steepest = steepest.max(slope(turning));
        }
    }
    steepest
}
