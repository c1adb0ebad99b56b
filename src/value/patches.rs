//! Patches: curved surfaces over squares, each a NURBS surface; bicubic Bezier patches are the simplest.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Curved surfaces in space, each over a square of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Patches {
    /// The surfaces, at least one.
    pub patches: Vec<Patch>,
    /// Free border of each square on a map, at each side, in parts of the square.
    pub gutter: f64,
}

/// A rational B-spline surface: P(u, v) = sum N_i(u) N_j(v) w_ij P_ij / sum N_i(u) N_j(v) w_ij, u and v from 0 to 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Patch {
    /// Degree along u and along v.
    pub degrees: [u32; 2],
    /// Control points along u and along v.
    pub counts: [u32; 2],
    /// Knots along u and along v, rising; the surface lies between the first and the last inner ones, which become 0 and 1.
    pub knots: [Vec<f64>; 2],
    /// Control points in mm, one row along u after the other.
    pub points: Vec<DVec3>,
    /// Weights of the control points; empty if all are 1.
    pub weights: Vec<f64>,
}

/// Most patches, control points of a patch, and the highest degree.
const MOST: usize = 1_000_000;
const MOST_POINTS: usize = 10_000_000;

/// The highest degree of a patch.
pub(crate) const HIGHEST_DEGREE: u32 = 15;

/// The largest coordinate in mm.
const LARGEST: f64 = 1e9;

impl Patches {
    /// Whether they are what nodes make: finite, with as many knots and weights as belong to the points.
    pub fn is_sound(&self) -> bool {
        (1..=MOST).contains(&self.patches.len())
            && (0.0..0.5).contains(&self.gutter)
            && self.patches.iter().all(Patch::is_sound)
    }
}

impl Patch {
    /// A bicubic Bezier patch: four rows of four control points.
    pub fn bezier(points: [DVec3; 16]) -> Patch {
        let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        Patch {
            degrees: [3; 2],
            counts: [4; 2],
            knots: [knots.clone(), knots],
            points: points.to_vec(),
            weights: vec![],
        }
    }

    fn is_sound(&self) -> bool {
        let [across, along] = self.counts.map(|count| count as usize);
        let count = across.checked_mul(along);
        let has_knots = |axis: usize| {
            let (degree, knots) = (self.degrees[axis] as usize, &self.knots[axis]);
            let points = self.counts[axis] as usize;
            (1..=HIGHEST_DEGREE).contains(&self.degrees[axis])
                && points > degree
                && knots.len() == points.saturating_add(degree + 1)
                && knots.iter().all(|knot| knot.is_finite())
                && knots.windows(2).all(|pair| pair[0] <= pair[1])
                && knots[degree] < knots[points]
        };
        count == Some(self.points.len())
            && self.points.len() <= MOST_POINTS
            && has_knots(0)
            && has_knots(1)
            && (self.weights.is_empty() || self.weights.len() == self.points.len())
            && self
                .weights
                .iter()
                .all(|weight| (1e-9..=1e9).contains(weight))
            && self
                .points
                .iter()
                .all(|point| point.is_finite() && point.abs().max_element() <= LARGEST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nodes_make_is_sound() {
        let patches = |change: fn(&mut Patch)| {
            let mut patch = Patch::bezier([DVec3::ONE; 16]);
            change(&mut patch);
            let patches = vec![patch];
            Patches {
                patches,
                gutter: 0.0,
            }
            .is_sound()
        };
        assert!(patches(|_| {}));
        assert!(patches(|it| it.weights = vec![2.0; 16]));
        let unsound: [fn(&mut Patch); 8] = [
            |it| it.degrees[0] = 0,
            |it| it.counts = [u32::MAX; 2],
            |it| it.knots[1][3] = f64::NAN,
            |it| it.knots[0][2] = 0.5,
            |it| it.knots[0] = vec![1.0; 8],
            |it| it.points[5].z = f64::INFINITY,
            |it| it.weights = vec![1.0; 15],
            |it| it.weights = vec![0.0; 16],
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            assert!(!patches(change), "{number}");
        }
    }
}
