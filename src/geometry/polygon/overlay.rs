//! Unions, intersections and differences of polygons, computed on a grid of whole numbers.

use crate::value::Polygon;
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;
use std::collections::HashMap;

/// How finely a drawing is divided: its half extent takes this many bits.
const BITS: i32 = 46;

/// What is kept of two drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operation {
    /// What is in one of them.
    Union,
    /// What is in both.
    Intersection,
    /// What is in the first alone.
    Difference,
}

/// A grid so fine that snapping to it hardly moves a point, and on which crossings are found without doubt.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    middle: DVec2,
    /// Steps per mm, a power of two.
    steps: f64,
}

impl Lattice {
    /// The grid for what lies in a box; points up to 2¹⁴ times as far from its middle have their place on it too.
    pub(crate) fn around([low, high]: [DVec2; 2]) -> Lattice {
        let reach = (0.5 * (high - low)).max_element().max(f64::MIN_POSITIVE);
        let (_, exponent) = libm::frexp(reach);
        let steps = libm::ldexp(1.0, (BITS - exponent).clamp(-1000, 1000));
        let middle = (0.5 * (low + high) * steps).round() / steps;
        Lattice { middle, steps }
    }

    /// The distance between neighbouring points of the grid, in mm.
    pub(crate) fn step(self) -> f64 {
        1.0 / self.steps
    }

    fn snap(self, point: DVec2) -> IntPoint<i64> {
        let scaled = ((point - self.middle) * self.steps).round();
        IntPoint::new(scaled.x as i64, scaled.y as i64)
    }

    fn point(self, place: IntPoint<i64>) -> DVec2 {
        self.middle + DVec2::new(place.x as f64, place.y as f64) / self.steps
    }

    /// What an operation leaves of two drawings, each of which encloses what its rings wind around other than 0 times.
    /// Outlines are counterclockwise, holes clockwise. Corners that were there keep their coordinates bit by bit.
    pub(crate) fn overlay(
        self,
        operation: Operation,
        first: &[&[DVec2]],
        second: &[&[DVec2]],
    ) -> Vec<Polygon> {
        self.computed(operation, FillRule::NonZero, first, second)
    }

    /// The polygons that rings fill: what they wind around an odd number of times, or other than 0 times.
    pub(crate) fn filled(self, rings: &[&[DVec2]], even_odd: bool) -> Vec<Polygon> {
        let rule = match even_odd {
            true => FillRule::EvenOdd,
            false => FillRule::NonZero,
        };
        self.computed(Operation::Union, rule, rings, &[])
    }

    fn computed(
        self,
        operation: Operation,
        fill: FillRule,
        first: &[&[DVec2]],
        second: &[&[DVec2]],
    ) -> Vec<Polygon> {
        let rule = match operation {
            Operation::Union => OverlayRule::Union,
            Operation::Intersection => OverlayRule::Intersect,
            Operation::Difference => OverlayRule::Difference,
        };
        let corners = [first, second].into_iter().flatten().map(|ring| ring.len());
        let mut overlay = Overlay::<i64>::new(corners.sum());
        let mut known = HashMap::new();
        for (rings, side) in [(first, ShapeType::Subject), (second, ShapeType::Clip)] {
            for ring in rings {
                let places = ring.iter().map(|corner| self.snap(*corner));
                overlay.add_path_iter(places, side);
                let pairs = ring.iter().map(|corner| (self.snap(*corner), *corner));
                pairs.for_each(|(place, corner)| {
                    known.entry(place).or_insert(corner);
                });
            }
        }
        let back = |place: &IntPoint<i64>| {
            let known = known.get(place).copied();
            known.unwrap_or_else(|| self.point(*place))
        };
        let shapes = overlay.overlay(rule, fill);
        let rings = shapes.iter().map(|shape| {
            let ring = |ring: &Vec<IntPoint<i64>>| ring.iter().map(back).collect();
            shape.iter().map(ring).collect::<Vec<Vec<DVec2>>>()
        });
        rings.filter_map(polygon).collect()
    }
}

/// The polygon of an outline and the holes behind it.
fn polygon(rings: Vec<Vec<DVec2>>) -> Option<Polygon> {
    let mut rings = rings.into_iter();
    let outline = rings.next()?;
    let holes = rings.collect();
    Some(Polygon { outline, holes })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::doubled_area;

    fn rectangle(low: (f64, f64), high: (f64, f64)) -> Vec<DVec2> {
        let corners = [low, (high.0, low.1), high, (low.0, high.1)];
        corners.map(|(x, y)| DVec2::new(x, y)).to_vec()
    }

    fn area(polygons: &[Polygon]) -> f64 {
        let rings = polygons.iter().flat_map(Polygon::rings);
        rings.map(doubled_area).sum::<f64>() / 2.0
    }

    #[test]
    fn operations_keep_what_they_say() {
        let first = rectangle((0.1, 0.1), (3.1, 3.1));
        let second = rectangle((1.1, 1.1), (2.1, 5.1));
        let lattice = Lattice::around([DVec2::ZERO, DVec2::splat(6.0)]);
        let of = |operation| lattice.overlay(operation, &[&first], &[&second]);
        assert!((area(&of(Operation::Union)) - 11.0).abs() < 1e-9);
        assert!((area(&of(Operation::Intersection)) - 2.0).abs() < 1e-9);
        assert!((area(&of(Operation::Difference)) - 7.0).abs() < 1e-9);
        let kept = of(Operation::Difference);
        assert!(first.iter().all(|corner| kept[0].outline.contains(corner)));
    }

    #[test]
    fn holes_run_the_other_way() {
        let first = rectangle((0.0, 0.0), (9.0, 9.0));
        let second = rectangle((3.0, 3.0), (6.0, 6.0));
        let lattice = Lattice::around([DVec2::ZERO, DVec2::splat(9.0)]);
        let framed = lattice.overlay(Operation::Difference, &[&first], &[&second]);
        assert_eq!(framed.len(), 1);
        assert_eq!(doubled_area(&framed[0].outline), 162.0);
        assert_eq!(doubled_area(&framed[0].holes[0]), -18.0);
    }
}
