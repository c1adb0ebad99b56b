//! The curve of a trunk: a cubic spline through its nodes, made linear in height.
//!
//! Momoi & Takatera 2014. Tangents `D_i` on the nodes `N_i` give Bezier segments (eq. (4), with its
//! first line corrected to `C1 = (7 C0 + 6 C3 - C6) / 12`). Each inner control point is then moved along
//! its tangent until its height is at a third of the segment (eqs. (5)-(8)). What results is, in each of
//! x and y, the cubic Hermite interpolant *in z* whose slope at a node is `D_xy / D_z`: the curve's
//! point at a height needs no root finding.
//!
//! Optimising needs tangents that rise. Where the chosen tangent does not, the direction is that of the
//! chord: `N_1 - N_0` at the lower end, `N_m - N_(m-1)` at the upper one, `N_(i+1) - N_(i-1)` inside
//! (own construction; the paper leaves it open). Natural tangents all rise if the largest difference in
//! height between neighbours is less than 3.73 times the smallest. Beyond its ends the curve continues
//! straight along the end tangents.

use super::tangents::rising_tangents;
use crate::value::Tangents;
use glam::{DVec2, DVec3};
use std::fmt;

/// Why there is no curve through some nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurveError {
    /// Fewer than two nodes.
    TooFewNodes {
        /// How many there are.
        found: usize,
    },
    /// A coordinate that is not a finite number.
    NotFinite {
        /// The node, counted from 0.
        node: usize,
    },
    /// A node that is not above the one before it.
    NotRising {
        /// The node, counted from 0.
        node: usize,
        /// Height of the node before it.
        before: f64,
        /// Height of the node.
        height: f64,
    },
}

impl fmt::Display for CurveError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CurveError::TooFewNodes { found } => {
                write!(formatter, "expected at least 2 nodes, found {found}")
            }
            CurveError::NotFinite { node } => {
                write!(
                    formatter,
                    "node {} has a coordinate that is not finite",
                    node + 1
                )
            }
            CurveError::NotRising {
                node,
                before,
                height,
            } => write!(
                formatter,
                "expected z to rise from node to node, found z = {height} at node {} after z = {before}",
                node + 1
            ),
        }
    }
}

impl std::error::Error for CurveError {}

/// The curve of a trunk as a function of height.
#[derive(Clone, Debug, PartialEq)]
pub struct TrunkCurve {
    nodes: Vec<DVec3>,
    /// The tangents by the parameter of the spline, in mm for each segment.
    tangents: Vec<DVec3>,
    /// d(x, y)/dz at the nodes.
    slopes: Vec<DVec2>,
}

/// One piece of the curve: `(x, y) = c0 + c1 h + c2 h^2 + c3 h^3` with `h = z - start`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Height in mm from which `h` is counted.
    pub start: f64,
    /// The coefficients in mm, 1, 1/mm, 1/mm^2.
    pub coefficients: [DVec2; 4],
}

impl Piece {
    /// The point at height `z`.
    pub fn at(&self, z: f64) -> DVec2 {
        let h = z - self.start;
        let [c0, c1, c2, c3] = self.coefficients;
        ((c3 * h + c2) * h + c1) * h + c0
    }

    /// d(x, y)/dz at height `z`.
    pub fn slope(&self, z: f64) -> DVec2 {
        let h = z - self.start;
        let [_, c1, c2, c3] = self.coefficients;
        (c3 * (3.0 * h) + c2 * 2.0) * h + c1
    }

    /// The same piece with `h` counted from another height.
    pub fn counted_from(&self, start: f64) -> Piece {
        let shift = start - self.start;
        let [_, _, c2, c3] = self.coefficients;
        let coefficients = [
            self.at(start),
            self.slope(start),
            c3 * (3.0 * shift) + c2,
            c3,
        ];
        Piece {
            start,
            coefficients,
        }
    }
}

impl TrunkCurve {
    /// The curve through `nodes`, in mm.
    ///
    /// # Errors
    /// Fewer than two nodes, coordinates that are not finite, heights that do not rise strictly.
    pub fn through(nodes: &[DVec3], tangents: Tangents) -> Result<TrunkCurve, CurveError> {
        check(nodes)?;
        let tangents = rising_tangents(nodes, tangents);
        let slopes = tangents
            .iter()
            .map(|tangent| tangent.truncate() / tangent.z)
            .collect();
        Ok(TrunkCurve {
            nodes: nodes.to_vec(),
            tangents,
            slopes,
        })
    }

    /// The nodes that the curve passes through.
    pub fn nodes(&self) -> &[DVec3] {
        &self.nodes
    }

    /// Heights of the first and the last node in mm.
    pub fn heights(&self) -> [f64; 2] {
        [self.nodes[0].z, self.nodes[self.nodes.len() - 1].z]
    }

    /// The control points before optimisation: node, two inner points, node, and so on.
    pub fn raw_control_points(&self) -> Vec<DVec3> {
        self.control_points(|_, tangent| tangent / 3.0)
    }

    /// The control points after optimisation: the heights of the inner ones divide each segment in three.
    pub fn optimised_control_points(&self) -> Vec<DVec3> {
        self.control_points(|rise, tangent| tangent * (rise / (3.0 * tangent.z)))
    }

    /// All pieces from the bottom up: the straight one below the first node, one for every segment, the
    /// straight one above the last node.
    pub fn pieces(&self) -> Vec<Piece> {
        let last = self.nodes.len() - 1;
        let inner = (0..last).map(|segment| self.segment(segment));
        std::iter::once(self.straight(0))
            .chain(inner)
            .chain([self.straight(last)])
            .collect()
    }

    /// The point of the curve at height `z`.
    pub fn at(&self, z: f64) -> DVec3 {
        self.piece_at(z).at(z).extend(z)
    }

    /// d(x, y)/dz of the curve at height `z`.
    pub fn slope(&self, z: f64) -> DVec2 {
        self.piece_at(z).slope(z)
    }

    /// The largest slope |d(x, y)/dz| anywhere, or a bound on it.
    pub fn steepest(&self) -> f64 {
        // The slope of a piece is a quadratic in h: its Bezier coefficients bound it.
        let bound = |index: usize| {
            let [below, above] = [self.slopes[index], self.slopes[index + 1]];
            let chord = self.nodes[index + 1] - self.nodes[index];
            let middle = chord.truncate() / chord.z * 3.0 - below - above;
            below.length().max(above.length()).max(middle.length())
        };
        (0..self.nodes.len() - 1).map(bound).fold(0.0, f64::max)
    }

    fn piece_at(&self, z: f64) -> Piece {
        let above = self.nodes.partition_point(|node| node.z <= z);
        match above {
            0 => self.straight(0),
            above if above == self.nodes.len() => self.straight(above - 1),
            above => self.segment(above - 1),
        }
    }

    fn straight(&self, node: usize) -> Piece {
        let (at, slope) = (self.nodes[node], self.slopes[node]);
        Piece {
            start: at.z,
            coefficients: [at.truncate(), slope, DVec2::ZERO, DVec2::ZERO],
        }
    }

    fn segment(&self, index: usize) -> Piece {
        let [from, to] = [self.nodes[index], self.nodes[index + 1]];
        let [below, above] = [self.slopes[index], self.slopes[index + 1]];
        let rise = to.z - from.z;
        let chord = (to - from).truncate() / rise;
        let c2 = (chord * 3.0 - below * 2.0 - above) / rise;
        let c3 = (below + above - chord * 2.0) / rise / rise;
        Piece {
            start: from.z,
            coefficients: [from.truncate(), below, c2, c3],
        }
    }

    /// Control points whose inner ones are `arm(rise of the segment, tangent)` away from the nodes.
    fn control_points(&self, arm: impl Fn(f64, DVec3) -> DVec3) -> Vec<DVec3> {
        let mut points = vec![self.nodes[0]];
        for (nodes, tangents) in self.nodes.windows(2).zip(self.tangents.windows(2)) {
            let rise = nodes[1].z - nodes[0].z;
            points.push(nodes[0] + arm(rise, tangents[0]));
            points.push(nodes[1] - arm(rise, tangents[1]));
            points.push(nodes[1]);
        }
        points
    }
}

fn check(nodes: &[DVec3]) -> Result<(), CurveError> {
    if nodes.len() < 2 {
        return Err(CurveError::TooFewNodes { found: nodes.len() });
    }
    if let Some(node) = nodes.iter().position(|node| !node.is_finite()) {
        return Err(CurveError::NotFinite { node });
    }
    match nodes.windows(2).position(|pair| pair[1].z <= pair[0].z) {
        Some(first) => Err(CurveError::NotRising {
            node: first + 1,
            before: nodes[first].z,
            height: nodes[first + 1].z,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes(heights: &[f64]) -> Vec<DVec3> {
        let x = |index: usize| [0.0, 3.0, -1.0, 2.0, 2.5][index % 5];
        heights
            .iter()
            .enumerate()
            .map(|(i, z)| DVec3::new(x(i), -0.5 * x(i + 2), *z))
            .collect()
    }

    #[test]
    fn two_nodes_are_joined_by_a_straight_line() {
        for tangents in [Tangents::Natural, Tangents::Local] {
            let curve = TrunkCurve::through(&nodes(&[1.0, 5.0]), tangents).unwrap();
            assert!(curve.at(3.0).distance(DVec3::new(1.5, -0.5 * 0.5, 3.0)) < 1e-12);
            assert!(curve.at(-3.0).distance(DVec3::new(-3.0, 2.0, -3.0)) < 1e-12);
            assert!(curve.at(9.0).distance(DVec3::new(6.0, -2.5, 9.0)) < 1e-12);
        }
    }

    #[test]
    fn nodes_that_make_no_curve_are_refused_with_the_reason() {
        let refused = |nodes: &[DVec3]| TrunkCurve::through(nodes, Tangents::Local).unwrap_err();
        assert_eq!(
            refused(&nodes(&[1.0])),
            CurveError::TooFewNodes { found: 1 }
        );
        assert_eq!(
            refused(&nodes(&[1.0, f64::NAN])),
            CurveError::NotFinite { node: 1 }
        );
        assert_eq!(
            refused(&nodes(&[0.0, 2.0, 2.0])).to_string(),
            "expected z to rise from node to node, found z = 2 at node 3 after z = 2"
        );
    }

    #[test]
    fn counting_from_another_height_changes_nothing() {
        let curve = TrunkCurve::through(&nodes(&[0.0, 1.0, 2.5, 3.0]), Tangents::Natural).unwrap();
        for piece in curve.pieces() {
            let moved = piece.counted_from(1.7);
            assert!((0..40).all(|i| {
                let z = 0.1 * f64::from(i);
                moved.at(z).distance(piece.at(z)) < 1e-11
                    && (moved.slope(z) - piece.slope(z)).length() < 1e-11
            }));
        }
    }
}
