//! Where a ray first meets a surface of heights.

use super::Heights;
use super::line::{Holds, Line, Stretch, Way};
use crate::geometry::hierarchy::Ray;
use glam::DVec2;

impl Heights {
    /// The distance at which a ray first comes to lie on or below the surface, and whether that is where it enters the
    /// space over the rectangle: then it meets the surface's edge.
    pub(crate) fn first(&self, ray: &Ray) -> Option<(f64, bool)> {
        let (origin, direction) = (ray.point(0.0), ray.direction());
        let line = Line::new(self, origin.truncate(), direction.truncate());
        if direction.truncate() == DVec2::ZERO {
            return self.straight_down(ray);
        }
        let everything = Stretch {
            from: 0.0,
            to: f64::INFINITY,
        };
        let entry = line.over(self, everything)?.from;
        let above = |distance: f64| origin.z + direction.z * distance;
        // What lies above everything is not looked at.
        let below_all = (self.range[1] - origin.z) / direction.z;
        let rest = Stretch {
            from: match direction.z < 0.0 {
                true => below_all.max(0.0),
                false => 0.0,
            },
            ..everything
        };
        let mut found = None;
        line.walk(self, (rest, usize::MAX), |square| {
            let Stretch { from, to } = square.stretch;
            let cell = match square.holds {
                Holds::Many(greatest) if above(from).min(above(to)) > greatest => {
                    return Way::Past;
                }
                Holds::Many(_) => return Way::Into,
                Holds::Cell(cell) => cell,
            };
            let [height, rise, bend] = self.along(cell, &line);
            let met = first_root(
                [origin.z - height, direction.z - rise, -bend],
                &square.stretch,
            );
            let Some(distance) = met else {
                return Way::Past;
            };
            found = Some((distance, distance == entry));
            Way::End
        });
        found
    }

    /// A ray along the heights themselves.
    fn straight_down(&self, ray: &Ray) -> Option<(f64, bool)> {
        let (origin, down) = (ray.point(0.0), ray.direction().z);
        let distance = (self.height(origin.truncate()) - origin.z) / down;
        (self.is_over(origin.truncate()) && down < 0.0).then_some((distance.max(0.0), false))
    }
}

/// The first distance of a stretch at which a polynomial of second degree is not above 0.
fn first_root([a, b, c]: [f64; 3], stretch: &Stretch) -> Option<f64> {
    let Stretch { from, to } = *stretch;
    let value = |at: f64| a + (b + c * at) * at;
    if value(from) <= 0.0 {
        return Some(from);
    }
    // Around the beginning of the stretch, so that far away nothing is lost.
    let (a, b) = (value(from), b + 2.0 * c * from);
    let squared = b * b - 4.0 * a * c;
    if squared < 0.0 {
        return None;
    }
    // The first root ahead, without a difference of large numbers.
    let sum = -0.5
        * (b + if b < 0.0 {
            -squared.sqrt()
        } else {
            squared.sqrt()
        });
    let roots = [a / sum, sum / c];
    let ahead = roots.into_iter().filter(|root| *root >= 0.0);
    let nearest = ahead.fold(f64::INFINITY, f64::min);
    (nearest <= to - from).then_some(from + nearest)
}
