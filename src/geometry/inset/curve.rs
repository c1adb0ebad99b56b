//! The line or the circle that an edge lies on, and where two of them meet.

use glam::DVec2;
use std::f64::consts::TAU;

/// What an edge lies on; inside of the ring is on the left of the way it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Curve {
    Line {
        from: DVec2,
        /// Its direction, of length 1.
        along: DVec2,
    },
    Circle {
        centre: DVec2,
        radius: f64,
        /// 1 if it runs counterclockwise, -1 if it runs clockwise.
        turn: f64,
    },
}

impl Curve {
    /// What the edge between two points lies on.
    pub(super) fn of(from: DVec2, to: DVec2, bulge: f64) -> Curve {
        let chord = to - from;
        if bulge == 0.0 {
            let along = chord.normalize_or_zero();
            return Curve::Line { from, along };
        }
        let square = bulge * bulge;
        Curve::Circle {
            centre: 0.5 * (from + to) + chord.perp() * ((1.0 - square) / (4.0 * bulge)),
            radius: chord.length() * ((1.0 + square) / (4.0 * bulge)).abs(),
            turn: bulge.signum(),
        }
    }

    /// The same moved inwards: a parallel line, a circle about the same centre. `None` if the circle vanishes.
    pub(super) fn moved(self, off: f64) -> Option<Curve> {
        match self {
            Curve::Line { from, along } => Some(Curve::Line {
                from: from + along.perp() * off,
                along,
            }),
            Curve::Circle {
                centre,
                radius,
                turn,
            } => {
                let radius = radius - turn * off;
                (radius > 0.0).then_some(Curve::Circle {
                    centre,
                    radius,
                    turn,
                })
            }
        }
    }

    /// Its direction beside a point, of length 1.
    pub(super) fn along(self, at: DVec2) -> DVec2 {
        match self {
            Curve::Line { along, .. } => along,
            Curve::Circle { centre, turn, .. } => (turn * (at - centre)).perp().normalize_or_zero(),
        }
    }

    /// How far inside of it a point is.
    pub(super) fn inside(self, at: DVec2) -> f64 {
        match self {
            Curve::Line { from, along } => along.perp_dot(at - from),
            Curve::Circle {
                centre,
                radius,
                turn,
            } => turn * (radius - at.distance(centre)),
        }
    }

    /// Its point that is nearest to another.
    pub(super) fn foot(self, at: DVec2) -> DVec2 {
        match self {
            Curve::Line { from, along } => from + along * (at - from).dot(along),
            Curve::Circle { centre, radius, .. } => {
                centre + radius * (at - centre).normalize_or(DVec2::X)
            }
        }
    }

    /// How long the way along it is from beside one point to beside another; around a circle always forward.
    pub(super) fn way(self, from: DVec2, to: DVec2) -> f64 {
        match self {
            Curve::Line { along, .. } => (to - from).dot(along),
            Curve::Circle { radius, .. } => self.angle(from, to) * radius,
        }
    }

    /// The bulge of the edge on it from one point to another.
    pub(super) fn bulge(self, from: DVec2, to: DVec2) -> f64 {
        match self {
            Curve::Line { .. } => 0.0,
            Curve::Circle { turn, .. } => turn * libm::tan(0.25 * self.angle(from, to)),
        }
    }

    /// The angle from one point to another, from 0 to a whole turn.
    fn angle(self, from: DVec2, to: DVec2) -> f64 {
        let Curve::Circle { centre, turn, .. } = self else {
            return 0.0;
        };
        let (from, to) = (from - centre, to - centre);
        let angle = turn * libm::atan2(from.perp_dot(to), from.dot(to));
        if angle < 0.0 { angle + TAU } else { angle }
    }

    /// The point that two have in common and that is nearest to `near`; where they only just miss each other, the point between
    /// them.
    pub(super) fn meet(self, other: Curve, near: DVec2) -> Option<DVec2> {
        let [a, b] = match (self, other) {
            (Curve::Line { from, along }, Curve::Line { .. }) => {
                let sine = along.perp_dot(other.along(near));
                let only = from - along * (other.inside(from) / -sine);
                (sine.abs() > 1e-12).then_some([only; 2])
            }
            (Curve::Circle { .. }, Curve::Line { .. }) => other.with_circle(self),
            _ => self.with_circle(other),
        }?;
        let is_first = a.distance_squared(near) <= b.distance_squared(near);
        Some(if is_first { a } else { b })
    }

    /// The two points that it has in common with a circle.
    fn with_circle(self, circle: Curve) -> Option<[DVec2; 2]> {
        let Curve::Circle { centre, radius, .. } = circle else {
            return None;
        };
        let Curve::Circle {
            centre: own,
            radius: own_radius,
            ..
        } = self
        else {
            let middle = self.foot(centre);
            return beside(middle, self.along(centre), radius, middle.distance(centre));
        };
        let apart = own - centre;
        let distance = apart.length();
        if distance <= 1e-12 * (radius + own_radius) {
            return None;
        }
        let squares = distance * distance + radius * radius - own_radius * own_radius;
        let off = squares / (2.0 * distance);
        let along = apart / distance;
        beside(centre + along * off, along.perp(), radius, off.abs())
    }
}

/// The two points of a circle on a line: `middle` is the line's point nearest to the centre, `off` its distance from there.
fn beside(middle: DVec2, along: DVec2, radius: f64, off: f64) -> Option<[DVec2; 2]> {
    let square = radius * radius - off * off;
    let half = square.max(0.0).sqrt();
    (square > -1e-9 * radius * radius).then(|| [middle - along * half, middle + along * half])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of the circle of radius 5 about (1, 2).
    fn quarter() -> Curve {
        let bulge = libm::tan(std::f64::consts::PI / 8.0);
        Curve::of(DVec2::new(6.0, 2.0), DVec2::new(1.0, 7.0), bulge)
    }

    #[test]
    fn an_arc_lies_on_its_circle_and_moves_about_its_centre() {
        let Some(Curve::Circle {
            centre,
            radius,
            turn,
        }) = quarter().moved(1.5)
        else {
            panic!("expected a circle");
        };
        assert!(centre.distance(DVec2::new(1.0, 2.0)) < 1e-12);
        assert!((radius - 3.5).abs() < 1e-12);
        assert_eq!(turn, 1.0);
        assert_eq!(quarter().moved(5.1), None);
        let way = quarter().way(DVec2::new(6.0, 2.0), DVec2::new(1.0, 7.0));
        assert!((way - 2.5 * std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn curves_meet_where_they_should() {
        let line = Curve::of(DVec2::new(-9.0, 5.0), DVec2::new(9.0, 5.0), 0.0);
        // (x - 1)² + 3² = 5²
        let right = line.meet(quarter(), DVec2::new(9.0, 9.0)).unwrap();
        assert!(right.distance(DVec2::new(5.0, 5.0)) < 1e-12);
        let left = quarter().meet(line, DVec2::ZERO).unwrap();
        assert!(left.distance(DVec2::new(-3.0, 5.0)) < 1e-12);
        // A circle of radius 3 about (5, 2): x = (16 + 25 - 9) / 8 from the first.
        let other = Curve::of(DVec2::new(8.0, 2.0), DVec2::new(2.0, 2.0), 1.0);
        let above = quarter().meet(other, DVec2::new(5.0, 9.0)).unwrap();
        assert!(above.distance(DVec2::new(5.0, 5.0)) < 1e-12);
        let far = Curve::of(DVec2::new(-9.0, 8.0), DVec2::new(9.0, 8.0), 0.0);
        assert_eq!(quarter().meet(far, DVec2::ZERO), None);
    }
}
