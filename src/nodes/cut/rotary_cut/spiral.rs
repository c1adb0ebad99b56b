//! The spiral of Archimedes by its arc length, in double precision.

use glam::DVec2;

/// Newton's steps, at most: the estimate before the first is within some per cent.
const STEPS: usize = 40;

/// r = radius - pitch phi / 2 pi, cut from outside to inside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spiral {
    /// The radius where it begins, in mm.
    pub(super) radius: f64,
    /// How much nearer it comes in a turn, in mm.
    pub(super) pitch: f64,
    /// The angle at which it begins, in radians.
    pub(super) start: f64,
    /// 1 if it runs against the clock, -1 with it.
    pub(super) sense: f64,
}

impl Spiral {
    /// The length from the beginning to the radius `radius` (spec of the paper's figure 2): (G(r0) - G(r)) / k.
    pub(super) fn length_to(&self, radius: f64) -> f64 {
        (self.twice_swept(self.radius) - self.twice_swept(radius)) / self.shrink()
    }

    /// The point at a length from the beginning. Before it the spiral goes on outwards, and beyond its centre with a
    /// negative radius.
    pub(super) fn at(&self, length: f64) -> DVec2 {
        let swept = self.twice_swept(self.radius) - self.shrink() * length;
        let radius = self.radius_of(swept.abs()).copysign(swept);
        let angle = self.start + self.sense * (self.radius - radius) / self.shrink();
        radius * DVec2::new(libm::cos(angle), libm::sin(angle))
    }

    /// k: how much nearer it comes in a radian.
    fn shrink(&self) -> f64 {
        self.pitch / std::f64::consts::TAU
    }

    /// G(r) = (r sqrt(r^2 + k^2) + k^2 asinh(r / k)) / 2, about half the square of the radius.
    fn twice_swept(&self, radius: f64) -> f64 {
        let k = self.shrink();
        0.5 * (radius * libm::hypot(radius, k) + k * k * libm::asinh(radius / k))
    }

    /// The radius r >= 0 at which G(r) = `swept`.
    ///
    /// G is convex, and both sqrt(2 G) and G / k are above its inverse, so Newton's steps come down from the lesser one
    /// without passing the root.
    fn radius_of(&self, swept: f64) -> f64 {
        let k = self.shrink();
        let mut radius = (2.0 * swept).sqrt().min(swept / k);
        for _ in 0..STEPS {
            let next = radius - (self.twice_swept(radius) - swept) / libm::hypot(radius, k);
            if next.is_nan() || next >= radius {
                break;
            }
            radius = next.max(0.0);
        }
        radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_are_found_from_the_thinnest_pitch_to_the_thickest() {
        for (radius, pitch) in [(20.0, 0.6), (250.0, 0.5), (5000.0, 0.01), (10.0, 100.0)] {
            let spiral = Spiral {
                radius,
                pitch,
                start: 0.0,
                sense: 1.0,
            };
            for part in 0..=1000 {
                let expected = radius * f64::from(part) / 1000.0;
                let found = spiral.radius_of(spiral.twice_swept(expected));
                assert!(
                    (found - expected).abs() <= 1e-12 * radius,
                    "{radius}, {pitch}: {found}, not {expected}"
                );
            }
        }
    }
}
