//! A pen that draws rings: straight edges, Bézier curves and arcs of ellipses, all as straight edges.

use crate::geometry::polygon::steps;
use glam::{DAffine2, DMat2, DVec2};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Draws rings with straight edges.
pub(super) struct Pen {
    /// What was drawn; the last ring may be going on.
    pub(super) rings: Vec<Vec<DVec2>>,
    /// Where the pen is.
    pub(super) at: DVec2,
    /// How far edges may be off a curve.
    tolerance: f64,
}

impl Pen {
    pub(super) fn new(tolerance: f64) -> Pen {
        Pen {
            rings: vec![],
            at: DVec2::ZERO,
            tolerance,
        }
    }

    /// Begins another ring.
    pub(super) fn move_to(&mut self, to: DVec2) {
        self.at = to;
        self.rings.push(vec![to]);
    }

    /// Ends a ring where it began.
    pub(super) fn close(&mut self) {
        let first = self.rings.last().and_then(|ring| ring.first()).copied();
        if let Some(first) = first {
            self.move_to(first);
        }
    }

    pub(super) fn line_to(&mut self, to: DVec2) {
        if self.rings.is_empty() {
            self.move_to(self.at);
        }
        self.at = to;
        self.rings
            .last_mut()
            .expect("a ring was begun above")
            .push(to);
    }

    /// A cubic Bézier curve; its second differences say how many edges it takes.
    pub(super) fn cubic_to(&mut self, first: DVec2, second: DVec2, to: DVec2) {
        let from = self.at;
        let bend = (from - 2.0 * first + second)
            .length()
            .max((first - 2.0 * second + to).length());
        let steps = ((0.75 * bend / self.tolerance).sqrt().ceil()).clamp(1.0, 1e5) as u32;
        for step in 1..=steps {
            let t = f64::from(step) / f64::from(steps);
            let s = 1.0 - t;
            let point = s * s * s * from
                + 3.0 * s * s * t * first
                + 3.0 * s * t * t * second
                + t * t * t * to;
            self.line_to(if step == steps { to } else { point });
        }
    }

    pub(super) fn quadratic_to(&mut self, middle: DVec2, to: DVec2) {
        let towards = |end: DVec2| end + (middle - end) * (2.0 / 3.0);
        self.cubic_to(towards(self.at), towards(to), to);
    }

    /// An arc of an ellipse with the radii and the direction of its first axis, in radians (SVG 2, appendix B.2.4 and B.2.5).
    pub(super) fn arc_to(
        &mut self,
        radii: DVec2,
        axis: f64,
        large: bool,
        counterclockwise: bool,
        to: DVec2,
    ) {
        let from = self.at;
        let radii = radii.abs();
        if radii.min_element() == 0.0 || from == to {
            return self.line_to(to);
        }
        let turn = DMat2::from_cols_array(&{
            let (sine, cosine) = libm::sincos(axis);
            [cosine, sine, -sine, cosine]
        });
        // Where the ellipse is a circle of radius 1.
        let [a, b] = [from, to].map(|point| turn.transpose() * point);
        let half = 0.5 * (b - a) / radii;
        let grown = radii * half.length().max(1.0);
        let half = 0.5 * (b - a) / grown;
        let off = (1.0 / half.length_squared() - 1.0).max(0.0).sqrt();
        let side = if large == counterclockwise { -1.0 } else { 1.0 };
        let centre = 0.5 * (a + b) / grown + side * off * half.perp();
        let [start, end] = [a, b].map(|point| point / grown - centre);
        let mut angle = libm::atan2(start.perp_dot(end), start.dot(end));
        if counterclockwise && angle <= 0.0 {
            angle += TAU;
        } else if !counterclockwise && angle >= 0.0 {
            angle -= TAU;
        }
        let steps = steps(grown.max_element(), angle.abs(), self.tolerance);
        for step in 1..steps {
            let (sine, cosine) = libm::sincos(angle * f64::from(step) / f64::from(steps));
            let point = centre + DVec2::new(cosine, sine).rotate(start);
            self.line_to(turn * (point * grown));
        }
        self.line_to(to);
    }

    /// A whole ellipse.
    pub(super) fn ellipse(&mut self, centre: DVec2, radii: DVec2) {
        self.move_to(centre + DVec2::new(radii.x, 0.0));
        for half in [-1.0, 1.0] {
            self.arc_to(
                radii,
                0.0,
                false,
                true,
                centre + DVec2::new(half * radii.x, 0.0),
            );
        }
        self.close();
    }

    /// A rectangle whose corners are rounded with `radii`.
    pub(super) fn rectangle(&mut self, low: DVec2, high: DVec2, radii: DVec2) {
        let radii = radii.min(0.5 * (high - low));
        let corners = [
            (low.x, low.y),
            (high.x, low.y),
            (high.x, high.y),
            (low.x, high.y),
        ];
        for (index, (x, y)) in corners.into_iter().enumerate() {
            // Along the sides before and behind the corner.
            let (sine, cosine) = libm::sincos(FRAC_PI_2 * index as f64);
            let along = DVec2::new(cosine.round(), sine.round());
            let corner = DVec2::new(x, y);
            let start = corner + along.perp() * radii;
            if index == 0 {
                self.move_to(start);
            } else {
                self.line_to(start);
            }
            self.arc_to(radii, 0.0, false, true, corner + along * radii);
        }
        self.close();
    }

    /// The rings that may enclose something, moved.
    pub(super) fn drawn(self, by: DAffine2) -> Vec<Vec<DVec2>> {
        let rings = self.rings.into_iter().filter(|ring| ring.len() > 2);
        let moved = |ring: Vec<DVec2>| ring.into_iter().map(|at| by.transform_point2(at)).collect();
        rings.map(moved).collect()
    }
}
