//! Regions: parts of the plane, as polygons with holes.

use crate::geometry::polygon::doubled_area;
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// A part of the plane, in mm: polygons that do not overlap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// The polygons; at least one.
    pub polygons: Vec<Polygon>,
}

/// A polygon with holes. No edge crosses or touches another but at a common corner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Polygon {
    /// Corners of the outline in mm, counterclockwise; the last is joined to the first.
    pub outline: Vec<DVec2>,
    /// Corners of each hole, clockwise.
    pub holes: Vec<Vec<DVec2>>,
}

/// Most corners of a region, and the largest coordinate in mm.
const MOST: usize = 10_000_000;
const LARGEST: f64 = 1e9;

impl Polygon {
    /// The outline, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &[DVec2]> {
        std::iter::once(&self.outline[..]).chain(self.holes.iter().map(|hole| &hole[..]))
    }
}

impl Region {
    /// Outlines and holes of all polygons: what they enclose lies on the left of each edge.
    pub fn rings(&self) -> impl Iterator<Item = &[DVec2]> {
        self.polygons.iter().flat_map(Polygon::rings)
    }

    /// Whether it is what nodes make: finite, with outlines and holes that run the way they should.
    pub fn is_sound(&self) -> bool {
        let is_within = |point: &DVec2| point.is_finite() && point.abs().max_element() <= LARGEST;
        let corners: usize = self.rings().map(<[DVec2]>::len).sum();
        let runs_well = |polygon: &Polygon| {
            doubled_area(&polygon.outline) > 0.0
                && polygon.holes.iter().all(|hole| doubled_area(hole) < 0.0)
        };
        (1..=MOST).contains(&corners)
            && self.rings().flatten().all(is_within)
            && self.polygons.iter().all(runs_well)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nodes_make_is_sound() {
        let square = |low: f64, high: f64| {
            let corners = [(low, low), (high, low), (high, high), (low, high)];
            corners.map(|(x, y)| DVec2::new(x, y)).to_vec()
        };
        let region = |change: fn(&mut Polygon)| {
            let mut polygon = Polygon {
                outline: square(0.0, 10.0),
                holes: vec![square(2.0, 4.0)],
            };
            polygon.holes[0].reverse();
            change(&mut polygon);
            let polygons = vec![polygon];
            Region { polygons }.is_sound()
        };
        assert!(region(|_| {}));
        assert!(region(|it| it.holes.clear()));
        let unsound: [fn(&mut Polygon); 5] = [
            |it| it.outline.clear(),
            |it| it.outline.reverse(),
            |it| it.holes[0].reverse(),
            |it| it.outline[1].x = f64::NAN,
            |it| it.outline[2] *= 1e12,
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            assert!(!region(change), "{number}");
        }
        assert!(!Region { polygons: vec![] }.is_sound());
    }
}
