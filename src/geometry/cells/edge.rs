//! One edge of a cell: a segment or an arc.

use glam::DVec2;

/// An edge between two corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    /// The tangent of a quarter of its angle: above 0 if it turns left, 0 if it is straight.
    pub(super) bulge: f64,
}

/// The circle of an arc.
struct Circle {
    centre: DVec2,
    radius: f64,
}

impl Edge {
    /// Whether a ray from the point to the right meets the edge an odd number of times. An edge answers alike in both
    /// directions, bit by bit.
    pub(super) fn turns_over(&self, point: DVec2) -> bool {
        let edge = self.upwards();
        let is_passed = (edge.from.y > point.y) != (edge.to.y > point.y);
        let is_left = edge.left_of(point) > 0.0;
        let over = is_passed && is_left;
        if edge.bulge == 0.0 {
            return over;
        }
        // Between chord and arc it is the other way round.
        let is_beside = is_left == (edge.bulge < 0.0);
        over ^ (is_beside && edge.circle().is_around(point))
    }

    /// The square of the distance to the edge.
    pub(super) fn distance_squared(&self, point: DVec2) -> f64 {
        let chord = self.to - self.from;
        if self.bulge == 0.0 {
            let length = chord.length_squared();
            let along = (point - self.from).dot(chord).clamp(0.0, length);
            let nearest = if length > 0.0 {
                chord * (along / length)
            } else {
                DVec2::ZERO
            };
            return (point - self.from - nearest).length_squared();
        }
        let circle = self.circle();
        let outwards = point - circle.centre;
        let length = outwards.length();
        if length > 0.0 && self.faces(&circle, outwards) {
            let distance = length - circle.radius;
            return distance * distance;
        }
        let ends = [self.from, self.to].map(|end| point.distance_squared(end));
        ends[0].min(ends[1])
    }

    /// The lowest and the highest corner of a box around it.
    pub(super) fn around(&self) -> [DVec2; 2] {
        // An arc reaches no farther beside its chord than its sagitta, nor beyond its ends.
        let reach = self.from.distance(self.to) * 0.5 * self.bulge.abs();
        [
            self.from.min(self.to) - reach,
            self.from.max(self.to) + reach,
        ]
    }

    /// The same edge from its lower end to its upper one.
    fn upwards(self) -> Edge {
        let is_down =
            self.to.y < self.from.y || (self.to.y == self.from.y && self.to.x < self.from.x);
        match is_down {
            false => self,
            true => Edge {
                from: self.to,
                to: self.from,
                bulge: -self.bulge,
            },
        }
    }

    /// Above 0 for points on the left of the chord, seen along it.
    fn left_of(&self, point: DVec2) -> f64 {
        (self.to - self.from).perp_dot(point - self.from)
    }

    fn circle(&self) -> Circle {
        let chord = self.to - self.from;
        // With the bulge b the sagitta is b/2 of the chord, and the radius (1 + b²) / (4 b) of it.
        let square = self.bulge * self.bulge;
        let to_centre = chord.perp() * ((1.0 - square) / (4.0 * self.bulge));
        Circle {
            centre: (self.from + self.to) * 0.5 + to_centre,
            radius: chord.length() * ((1.0 + square) / (4.0 * self.bulge)).abs(),
        }
    }

    /// Whether the arc passes a direction from its centre.
    fn faces(&self, circle: &Circle, outwards: DVec2) -> bool {
        let [from, to] = [self.from - circle.centre, self.to - circle.centre];
        let (first, last) = if self.bulge > 0.0 {
            (from, to)
        } else {
            (to, from)
        };
        let (after_first, before_last) = (first.perp_dot(outwards), outwards.perp_dot(last));
        match self.bulge.abs() <= 1.0 {
            true => after_first >= 0.0 && before_last >= 0.0,
            // More than half of the circle.
            false => after_first >= 0.0 || before_last >= 0.0,
        }
    }
}

impl Circle {
    fn is_around(&self, point: DVec2) -> bool {
        point.distance_squared(self.centre) < self.radius * self.radius
    }
}
