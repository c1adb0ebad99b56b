//! The force between particles: five cubics (Miyata, Itoh & Shimada, section 3; Shimada & Gossard 1995), and as many more
//! as a stone has corners.
//!
//! A particle pushes or pulls with a cubic of the distance from its middle, plus half of one from each of its corners.
//! The corners lie on the circle around a polygon whose sides touch the circle of half a stone: a neighbour beyond the
//! middle of a side is as far from the two nearest corners as they are from the middle, and feels no force there.

use glam::DVec2;

/// Distance, in stones, from which on no force is felt: from the corner of a square as far as its cubic reaches.
pub(crate) const REACH: f64 = 1.77;

/// Weight of the cubics of the corners; that of the middle is 1.
const CORNER: f64 = 0.5;

/// Largest number of corners.
const MOST: usize = 6;

/// What is added up of the cubics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Law {
    /// Their sum acts along the line from middle to middle.
    Radial,
    /// Each acts along the line from its own source.
    Sources,
}

/// The force of particles with some number of corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Force {
    law: Law,
    /// All x and all y, so that several corners are looked at together.
    corners: [[f64; MOST]; 2],
    count: usize,
    /// One over the distance of the corners from the middle.
    inverse: f64,
}

/// Distance from which on a cubic is 0.
const FAR: f64 = 1.5;

/// The cubic f(w) = 1.25 w³ − 2.375 w² + 1.125 up to 1.5, and 0 beyond: the only one with f'(0) = 0, f(1) = 0, f(1.5) = 0
/// and f'(1) = −1.
///
/// At its end it is 0 to the last bit, so none has to be told apart: which particles are far is hard to foresee.
#[inline]
pub(crate) fn cubic(w: f64) -> f64 {
    let w = w.min(FAR);
    (1.25 * w - 2.375) * (w * w) + 1.125
}

/// The cubic of a distance whose square is given.
#[inline]
fn of_square(square: f64) -> f64 {
    let square = square.min(FAR * FAR);
    (1.25 * square.sqrt() - 2.375) * square + 1.125
}

impl Force {
    /// The force of squares (4 corners), pentagons (5) or hexagons (6); the middle of a side lies on the x axis, of
    /// pentagons halfway between the axes, as in a Cairo tiling along them.
    pub(crate) fn new(corners: u32, law: Law) -> Force {
        let count = (corners as usize).clamp(4, MOST);
        let part = std::f64::consts::PI / count as f64;
        let first = part + Force::first_side(corners);
        let radius = 0.5 / libm::cos(part);
        let corner = |index: usize| {
            let (sine, cosine) = libm::sincos(first + part * (2 * index) as f64);
            radius * DVec2::new(cosine, sine)
        };
        let mut force = Force {
            law,
            corners: [[0.0; MOST]; 2],
            count,
            inverse: 1.0 / radius,
        };
        for index in 0..count {
            let corner = corner(index);
            (force.corners[0][index], force.corners[1][index]) = (corner.x, corner.y);
        }
        force
    }

    /// The angle from the x axis to the middle of a side.
    fn first_side(corners: u32) -> f64 {
        if corners == 5 {
            std::f64::consts::FRAC_PI_4
        } else {
            0.0
        }
    }

    /// The sum ψ of the cubics at a point in the particle's frame, in stones.
    #[cfg(test)]
    fn strength(&self, point: DVec2) -> f64 {
        cubic(point.length()) + self.of_corners(point)
    }

    /// The share of the corners in the sum.
    #[inline]
    fn of_corners(&self, point: DVec2) -> f64 {
        CORNER
            * match self.count {
                4 => self.cubics::<4>(point),
                5 => self.cubics::<5>(point),
                _ => self.cubics::<MOST>(point),
            }
    }

    /// The sum of the cubics of so many corners.
    #[inline]
    fn cubics<const COUNT: usize>(&self, point: DVec2) -> f64 {
        let scale = self.inverse * self.inverse;
        let [along, across] = &self.corners;
        let mut parts = [0.0; COUNT];
        for (part, (x, y)) in parts.iter_mut().zip(along.iter().zip(across)) {
            let (x, y) = (point.x - x, point.y - y);
            *part = scale * (x * x + y * y);
        }
        for part in &mut parts {
            *part = of_square(*part);
        }
        parts.iter().sum()
    }

    /// The force on another particle at a point in the particle's frame, in stones; none in its very middle.
    #[inline]
    pub(crate) fn at(&self, point: DVec2) -> DVec2 {
        match self.law {
            Law::Radial => point * self.pressure(point.length_squared(), point),
            Law::Sources => self.of_sources(point),
        }
    }

    /// The sum of the cubics over the distance, whose square is given.
    #[inline]
    fn pressure(&self, square: f64, point: DVec2) -> f64 {
        if square > 0.0 {
            let distance = square.sqrt();
            (cubic(distance) + self.of_corners(point)) / distance
        } else {
            0.0
        }
    }

    fn of_sources(&self, point: DVec2) -> DVec2 {
        let push = |offset: DVec2, scale: f64| {
            let distance = offset.length();
            if distance > 0.0 {
                cubic(scale * distance) * offset / distance
            } else {
                DVec2::ZERO
            }
        };
        let [along, across] = &self.corners;
        let corners = along.iter().zip(across).take(self.count);
        corners.fold(push(point, 1.0), |sum, (x, y)| {
            sum + CORNER * push(point - DVec2::new(*x, *y), self.inverse)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 2]; 6] = [
        [0.3, 0.2],
        [0.9, 0.4],
        [1.0, 0.0],
        [1.2, 0.1],
        [1.0, 1.0],
        [0.0, 0.01],
    ];

    /// Whether the forces are those of an independent program, for a particle turned by 0.3.
    fn holds(law: Law, expected: [[f64; 2]; 6]) {
        let force = Force::new(4, law);
        let frame = DVec2::from_angle(0.3);
        for (point, expected) in POINTS.iter().zip(expected) {
            let within = frame.conjugate().rotate(DVec2::from_array(*point));
            let found = frame.rotate(force.at(within));
            let difference = found - DVec2::from_array(expected);
            assert!(difference.length() < 1e-13, "{point:?}: {difference}");
        }
    }

    trait Conjugate {
        fn conjugate(self) -> Self;
    }

    impl Conjugate for DVec2 {
        fn conjugate(self) -> DVec2 {
            DVec2::new(self.x, -self.y)
        }
    }

    #[test]
    fn cubic_and_sum_have_the_known_values() {
        let expected = [1.125, 0.99609375, 0.6875, 0.0, -0.14453125, 0.0, 0.0];
        for (w, expected) in [0.0, 0.25, 0.5, 1.0, 1.25, 1.5, 1.6].iter().zip(expected) {
            assert!((cubic(*w) - expected).abs() < 1e-15);
        }
        let expected = [
            1.1286127172530662,
            0.245648814841815,
            0.0,
            -0.26198793859528435,
            -0.08946609406726225,
            1.1249387593757811,
        ];
        let force = Force::new(4, Law::Radial);
        for (point, expected) in POINTS.iter().zip(expected) {
            let found = force.strength(DVec2::from_array(*point));
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }

    #[test]
    fn both_laws_have_the_known_values() {
        holds(
            Law::Radial,
            [
                [0.9349196579949185, 0.6232797719966123],
                [0.04491708008668805, 0.019963146705194692],
                [0.11908639292715623, 0.0],
                [-0.17770565399174906, -0.014808804499312425],
                [-0.08970216715595568, -0.08970216715595568],
                [0.0, 1.124938762364281],
            ],
        );
        holds(
            Law::Sources,
            [
                [0.5930963379234492, 0.2716044819665446],
                [0.07058454947771697, -0.06281995900531316],
                [0.09075235635804763, 0.17480020338219332],
                [-0.17138600387423103, 0.002345233683455461],
                [-0.09590086915487962, -0.08150669161381799],
                [-2.635957444601434e-06, 1.110627588890998],
            ],
        );
    }

    #[test]
    fn neighbours_beyond_the_middle_of_a_side_feel_nothing() {
        for corners in [4, 5, 6] {
            let force = Force::new(corners, Law::Radial);
            for side in 0..corners {
                let turn = std::f64::consts::TAU * f64::from(side) / f64::from(corners);
                let turn = turn + Force::first_side(corners);
                let found = force.strength(DVec2::from_angle(turn));
                assert!(
                    found.abs() < 1e-14,
                    "{corners} corners, side {side}: {found}"
                );
                let nearer = force.strength(0.95 * DVec2::from_angle(turn));
                let farther = force.strength(1.05 * DVec2::from_angle(turn));
                assert!(nearer > 0.01 && farther < -0.01);
            }
        }
    }

    #[test]
    fn a_lattice_of_squares_is_in_balance_and_returns_to_it() {
        for law in [Law::Radial, Law::Sources] {
            let force = Force::new(4, law);
            let on = |moved: DVec2| {
                let lattice = (-2..=2).flat_map(|x| (-2..=2).map(move |y| (x, y)));
                let others = lattice.filter(|site| *site != (0, 0));
                let forces = others.map(|(x, y)| {
                    let offset = moved - DVec2::new(f64::from(x), f64::from(y));
                    if offset.length() < REACH {
                        force.at(offset)
                    } else {
                        DVec2::ZERO
                    }
                });
                forces.sum::<DVec2>()
            };
            assert!(on(DVec2::ZERO).length() < 1e-14);
            for angle in 0..8 {
                let moved = 0.05 * DVec2::from_angle(f64::from(angle) * 0.785);
                assert!(on(moved).dot(moved) < 0.0, "{law:?} {moved}");
            }
        }
    }
}
