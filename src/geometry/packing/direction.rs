//! The direction that stones take: along the border of a region, and along what the user draws.
//!
//! Miyata, Itoh & Shimada, eq. (1), adds the segments of the border divided by their squared distances. Opposite sides of
//! a street run opposite ways and cancel, so the angles are multiplied by the number of ways a stone looks the same
//! before they are added, and divided afterwards.

use crate::value::Region;
use glam::DVec2;

/// Segments that give a direction to the plane around them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Directions {
    symmetry: u32,
    segments: Vec<Segment>,
}

/// A straight piece of the border or of a curve.
#[derive(Clone, Copy, Debug)]
struct Segment {
    from: DVec2,
    along: DVec2,
    /// One over its squared length.
    inverse: f64,
    /// Its length times its weight, turned to its direction as often as the symmetry says.
    turned: DVec2,
    weight: f64,
    /// One over the squared distance at which it is no longer felt; 0 if it is felt everywhere.
    fade: f64,
}

/// What the segments say at a point: a sum of turned directions, and how much it would be if they all agreed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turned {
    /// Sum of the turned directions.
    pub(crate) sum: DVec2,
    /// Sum of their weights.
    pub(crate) weight: f64,
}

impl Directions {
    /// No segments yet, for something that looks the same after each turn by one part in `symmetry`.
    pub(crate) fn new(symmetry: u32) -> Directions {
        Directions {
            symmetry,
            segments: vec![],
        }
    }

    /// The border of a region: outlines and holes.
    pub(crate) fn of_border(region: &Region, symmetry: u32) -> Directions {
        let mut directions = Directions::new(symmetry);
        for ring in region.rings() {
            let next = ring.iter().cycle().skip(1);
            for (from, to) in ring.iter().zip(next) {
                directions.add([*from, *to], 1.0, 0.0);
            }
        }
        directions
    }

    /// Adds a segment with a weight (1 is that of the border), felt up to a distance of `reach` mm; 0 is everywhere.
    pub(crate) fn add(&mut self, [from, to]: [DVec2; 2], weight: f64, reach: f64) {
        let along = to - from;
        let length = along.length();
        if length > 0.0 {
            self.segments.push(Segment {
                from,
                along,
                inverse: 1.0 / (length * length),
                turned: weight * length * power(along / length, self.symmetry),
                weight: weight * length,
                fade: if reach > 0.0 {
                    1.0 / (reach * reach)
                } else {
                    0.0
                },
            });
        }
    }

    /// Whether no segment says anything.
    pub(crate) fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// What the segments say at a point: eq. (1) with multiplied angles, without its factor 1/n. On a segment it is that
    /// segment's direction alone.
    pub(crate) fn at(&self, point: DVec2) -> Turned {
        let (mut sum, mut weight) = (DVec2::ZERO, 0.0);
        for segment in &self.segments {
            let distance = segment.distance_squared(point);
            if distance == 0.0 {
                let (sum, weight) = (segment.turned, segment.weight);
                return Turned { sum, weight };
            }
            let left = (1.0 - distance * segment.fade).max(0.0);
            let share = left * left / distance;
            sum += share * segment.turned;
            weight += share * segment.weight;
        }
        Turned { sum, weight }
    }

    /// The vector of eq. (1) as it is printed.
    #[cfg(test)]
    fn printed(&self, point: DVec2) -> DVec2 {
        let shares = self
            .segments
            .iter()
            .map(|it| it.along / it.distance_squared(point));
        shares.sum::<DVec2>() / self.segments.len() as f64
    }
}

impl Segment {
    fn distance_squared(&self, point: DVec2) -> f64 {
        let offset = point - self.from;
        let share = (offset.dot(self.along) * self.inverse).clamp(0.0, 1.0);
        (offset - share * self.along).length_squared()
    }
}

impl Turned {
    /// How far the segments agree: 1 if all say the same, 0 if they cancel.
    pub(crate) fn coherence(&self) -> f64 {
        if self.weight > 0.0 {
            self.sum.length() / self.weight
        } else {
            0.0
        }
    }

    /// The direction itself, of length 1: the one nearest to the x axis of those that are as good.
    pub(crate) fn direction(&self, symmetry: u32) -> DVec2 {
        unturned(self.sum, symmetry)
    }
}

/// A unit vector turned to `symmetry` times its angle.
pub(crate) fn power(unit: DVec2, symmetry: u32) -> DVec2 {
    (1..symmetry).fold(unit, |power, _| power.rotate(unit))
}

/// The unit vector with one part in `symmetry` of a vector's angle.
pub(crate) fn unturned(vector: DVec2, symmetry: u32) -> DVec2 {
    if vector == DVec2::ZERO {
        return DVec2::X;
    }
    let angle = libm::atan2(vector.y, vector.x) / f64::from(symmetry);
    let (sine, cosine) = libm::sincos(angle);
    DVec2::new(cosine, sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTLINE: [[f64; 2]; 4] = [[0.0, 0.0], [6.0, 0.0], [6.0, 2.0], [1.0, 3.0]];
    const POINTS: [[f64; 2]; 4] = [[1.0, 1.0], [3.0, 0.2], [5.5, 1.0], [2.0, 2.2]];

    fn of_outline(symmetry: u32) -> Directions {
        let mut directions = Directions::new(symmetry);
        for (index, from) in OUTLINE.iter().enumerate() {
            let ends = [*from, OUTLINE[(index + 1) % 4]].map(DVec2::from_array);
            directions.add(ends, 1.0, 0.0);
        }
        directions
    }

    /// Angles and coherences of an independent program.
    fn holds(symmetry: u32, expected: [[f64; 2]; 4]) {
        let directions = of_outline(symmetry);
        for (point, [angle, coherence]) in POINTS.iter().zip(expected) {
            let found = directions.at(DVec2::from_array(*point));
            let direction = found.direction(symmetry);
            assert!((libm::atan2(direction.y, direction.x) - angle).abs() < 1e-14);
            assert!((found.coherence() - coherence).abs() < 1e-14);
        }
    }

    #[test]
    fn four_fold_and_two_fold_fields_have_the_known_values() {
        holds(
            4,
            [
                [-0.18655213203475624, 0.820719850243331],
                [-0.001731501099073489, 0.9962865657417996],
                [-0.04672828679595923, 0.9412408360323191],
                [-0.19847665849319826, 0.963419005755611],
            ],
        );
        holds(
            2,
            [
                [0.6898264874356308, 0.2816225788483159],
                [-0.00036289653632713323, 0.9917502608494799],
                [-0.34581616859383196, 0.13606117955547176],
                [-0.16196729492144002, 0.7476952648479697],
            ],
        );
    }

    #[test]
    fn the_printed_equation_has_the_known_values_and_cancels_between_opposite_sides() {
        let expected = [
            [0.55, -1.79],
            [37.24202249770431, 0.003845270890725408],
            [0.4152140074474764, 2.1836585512680493],
            [-3.4743239496450298, 0.2340037103302074],
        ];
        let directions = of_outline(4);
        for (point, expected) in POINTS.iter().zip(expected) {
            let found = directions.printed(DVec2::from_array(*point));
            assert!((found - DVec2::from_array(expected)).length() < 1e-13 * found.length());
        }
    }

    #[test]
    fn on_the_border_it_is_the_direction_of_the_border() {
        let directions = of_outline(4);
        let found = directions.at(DVec2::new(3.5, 2.5));
        let expected = DVec2::new(5.0, -1.0).normalize();
        assert!((found.direction(4) - expected).length() < 1e-12);
        assert!((found.coherence() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_guide_is_felt_up_to_its_reach() {
        let mut directions = Directions::new(2);
        directions.add([DVec2::ZERO, DVec2::X], 1.0, 0.0);
        let before = directions.at(DVec2::new(0.5, 3.0));
        directions.add([DVec2::new(0.5, 4.0), DVec2::new(0.5, 5.0)], 9.0, 2.0);
        assert_eq!(directions.at(DVec2::new(0.5, 1.9)), directions.at(DVec2::new(0.5, 1.9)));
        let after = directions.at(DVec2::new(0.5, 3.0));
        assert!(before.direction(2).x > 0.999 && after.direction(2).y.abs() > 0.999);
        let beyond = directions.at(DVec2::new(0.5, 1.9));
        assert!(beyond.direction(2).x > 0.999);
    }
}
