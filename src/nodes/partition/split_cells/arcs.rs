//! Setts in rows that are bent, bow beside bow ("Segmentbogen").
//!
//! The rows of a bow are one arc, moved up by the width of a sett again and again. Joints stand across the arc, and are
//! shifted by half a sett from row to row.

use super::laid::{Laid, steps};
use crate::node::Inputs;
use glam::DVec2;

/// Bows of arcs.
pub(super) struct Arcs {
    /// Length and width of a sett.
    pub(super) piece: DVec2,
    bow: f64,
    /// Half the angle of the arc, and its radius.
    half: f64,
    radius: f64,
    /// Setts in a row.
    count: i32,
}

impl Arcs {
    pub(super) fn read(inputs: &Inputs<'_>, piece: DVec2) -> Arcs {
        let bow = inputs.get("bow").map(|_| inputs.number("bow"));
        let bow = bow.unwrap_or(12.0 * piece.x);
        // The tangent of a quarter of the angle is twice the rise over the chord.
        let half = 2.0 * libm::atan(2.0 * inputs.number("rise"));
        let radius = 0.5 * bow / libm::sin(half);
        Arcs {
            piece,
            bow,
            half,
            radius,
            count: (2.0 * half * radius / piece.x).round().max(1.0) as i32,
        }
    }

    pub(super) fn repeat(&self) -> DVec2 {
        // Rows are shifted by turns.
        DVec2::new(self.bow, 2.0 * self.piece.y)
    }

    pub(super) fn cover(&self, [low, high]: [DVec2; 2]) -> Vec<Laid> {
        let mut laid = vec![];
        let rise = self.radius * (1.0 - libm::cos(self.half));
        for column in steps(low.x, high.x, self.bow) {
            for row in steps(low.y - rise - self.piece.y, high.y, self.piece.y) {
                self.row(row, column, &mut laid);
            }
        }
        laid
    }

    /// Where the joints of a row meet the arc below it and the arc above it: angles from the middle of the bow.
    fn joints(&self, row: i32) -> Vec<[f64; 2]> {
        let step = 2.0 * self.half / f64::from(self.count);
        let is_shifted = row.rem_euclid(2) == 1;
        let inner = match is_shifted {
            true => (0..self.count)
                .map(|number| (f64::from(number) + 0.5) * step - self.half)
                .collect::<Vec<_>>(),
            false => (1..self.count)
                .map(|number| f64::from(number) * step - self.half)
                .collect(),
        };
        let leaning = |angle: f64| {
            // Half as far as at right angles, on both sides: between two arcs that are the same.
            let aside = 0.5 * self.piece.y * libm::sin(angle) / self.radius;
            let limit = 0.999 * self.half;
            [angle - aside, angle + aside].map(|angle| angle.clamp(-limit, limit))
        };
        let ends = [-self.half, self.half].map(|end| [end; 2]);
        let inner = inner.into_iter().map(leaning);
        [ends[0]]
            .into_iter()
            .chain(inner)
            .chain([ends[1]])
            .collect()
    }

    fn row(&self, row: i32, column: i32, laid: &mut Vec<Laid>) {
        let joints = self.joints(row);
        // Corners of the rows below and above stand on the same arcs.
        let below: Vec<f64> = self.joints(row - 1).iter().map(|joint| joint[1]).collect();
        let above: Vec<f64> = self.joints(row + 1).iter().map(|joint| joint[0]).collect();
        for (number, pair) in joints.windows(2).enumerate() {
            let [from, to] = [pair[0], pair[1]];
            let mut lower = between(&below, from[0], to[0]);
            lower.insert(0, from[0]);
            lower.push(to[0]);
            let mut upper = between(&above, from[1], to[1]);
            upper.insert(0, from[1]);
            upper.push(to[1]);
            upper.reverse();
            let (mut corners, mut bulges) = (vec![], vec![]);
            for (angles, row, turn) in [(&lower, row, -1.0), (&upper, row + 1, 1.0)] {
                for (index, angle) in angles.iter().enumerate() {
                    corners.push(self.point(*angle, row, column));
                    // The last is joined to the other arc by a straight joint.
                    let next = angles.get(index + 1);
                    bulges.push(
                        next.map_or(0.0, |next| turn * libm::tan(0.25 * (next - angle).abs())),
                    );
                }
            }
            let middle = 0.25 * (from[0] + from[1] + to[0] + to[1]);
            let place = [row, column * self.count + number as i32];
            laid.push(Laid {
                corners,
                bulges,
                along: DVec2::new(libm::cos(middle), -libm::sin(middle)),
                row: place[0],
                column: place[1],
            });
        }
    }

    /// A point of the arc below a row, at an angle from the middle of a bow.
    fn point(&self, angle: f64, row: i32, column: i32) -> DVec2 {
        if angle.abs() == self.half {
            // Bows meet here: the same bits from both.
            let edge = if angle > 0.0 { column + 1 } else { column };
            return DVec2::new(f64::from(edge) * self.bow, f64::from(row) * self.piece.y);
        }
        let middle = (f64::from(column) + 0.5) * self.bow;
        let height = self.radius * (libm::cos(angle) - libm::cos(self.half));
        DVec2::new(
            middle + self.radius * libm::sin(angle),
            f64::from(row) * self.piece.y + height,
        )
    }
}

/// The angles between two others, rising.
fn between(angles: &[f64], from: f64, to: f64) -> Vec<f64> {
    let inner = angles.iter().copied();
    inner.filter(|angle| *angle > from && *angle < to).collect()
}
