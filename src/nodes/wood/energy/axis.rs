//! The centre line of a trunk: curved through its nodes, or straight from node to node.

use crate::geometry::spline::{CurveError, Piece, TrunkCurve};
use crate::value::Skeleton;
use glam::DVec3;

/// A curve is charged in straight rods, whose middles lie this far off it in mm, at most. Energies near the axis change
/// by twice the quotient of that and the distance from it.
const SAG: f64 = 0.01;

/// Most rods that stand for one piece of a curve, however much it bends.
const MOST_RODS: f64 = 256.0;

/// The centre line of a trunk.
#[derive(Clone, Debug, PartialEq)]
pub enum Axis {
    /// A curve; the foot of a point lies at its own height (Momoi & Takatera 2014, eq. (9)).
    Curved(TrunkCurve),
    /// Straight lines from node to node, going on beyond the ends; the foot of a point is the nearest one.
    Straight(Vec<DVec3>),
}

impl Axis {
    /// The centre line through a skeleton's nodes.
    ///
    /// # Errors
    /// Nodes that make no curve: fewer than two, or not rising.
    pub fn new(skeleton: &Skeleton, is_straight: bool) -> Result<Axis, CurveError> {
        let curve = TrunkCurve::through(&skeleton.trunk, skeleton.tangents)?;
        Ok(if is_straight {
            Axis::Straight(skeleton.trunk.clone())
        } else {
            Axis::Curved(curve)
        })
    }

    /// Height in mm of its ends.
    pub fn heights(&self) -> [f64; 2] {
        match self {
            Axis::Curved(curve) => curve.heights(),
            Axis::Straight(nodes) => [nodes[0].z, nodes[nodes.len() - 1].z],
        }
    }

    /// Its point at a height in mm; beyond the ends straight on.
    pub fn at(&self, height: f64) -> DVec3 {
        let nodes = match self {
            Axis::Curved(curve) => return curve.at(height),
            Axis::Straight(nodes) => nodes,
        };
        let above = nodes.partition_point(|node| node.z <= height);
        let [below, above] = [
            above.clamp(1, nodes.len() - 1) - 1,
            above.clamp(1, nodes.len() - 1),
        ];
        let (below, above) = (nodes[below], nodes[above]);
        below + (above - below) * ((height - below.z) / (above.z - below.z))
    }

    /// From the foot of a point to the point, in mm.
    pub fn offset(&self, point: DVec3) -> DVec3 {
        match self {
            Axis::Curved(curve) => point - curve.at(point.z),
            Axis::Straight(nodes) => {
                let offsets = nodes.windows(2).enumerate().map(|(index, ends)| {
                    let (whole, from_start) = (ends[1] - ends[0], point - ends[0]);
                    let [low, high] = reach(index, nodes.len() - 1).map(f64::from);
                    let share = from_start.dot(whole) / whole.length_squared();
                    from_start - whole * share.clamp(low, high)
                });
                let nearest = offsets.reduce(|nearest, offset| {
                    let is_nearer = offset.length_squared() < nearest.length_squared();
                    if is_nearer { offset } else { nearest }
                });
                nearest.expect("an axis has at least two nodes")
            }
        }
    }

    /// Points along it from end to end between which it is as good as straight.
    pub fn points(&self) -> Vec<DVec3> {
        match self {
            Axis::Straight(nodes) => nodes.clone(),
            Axis::Curved(curve) => {
                let pieces = curve.pieces();
                // Before the first segment a straight piece comes from below.
                let within = |(ends, piece): (&[DVec3], &Piece)| {
                    let [low, high] = [ends[0].z, ends[1].z];
                    let rods = rods(piece, high - low);
                    (0..rods).map(move |rod| low + rod as f64 / rods as f64 * (high - low))
                };
                let segments = curve.nodes().windows(2).zip(&pieces[1..]);
                let heights = segments.flat_map(within).chain([curve.heights()[1]]);
                heights.map(|height| curve.at(height)).collect()
            }
        }
    }
}

/// How many rods stand for a piece of a curve that is `rise` mm high.
///
/// A chord lies off its curve by an eighth of the second derivative times the square of its length; that derivative is
/// linear along a piece, so it is largest at an end.
fn rods(piece: &Piece, rise: f64) -> usize {
    let [_, _, c2, c3] = piece.coefficients;
    let bend = (c2 * 2.0)
        .length()
        .max((c2 * 2.0 + c3 * (6.0 * rise)).length());
    let count = rise * (bend / (8.0 * SAG)).sqrt();
    count.ceil().clamp(1.0, MOST_RODS) as usize
}

/// Between which shares of its length line `index` of `count` holds feet: the first and the last go on.
pub(super) fn reach(index: usize, count: usize) -> [f32; 2] {
    let low = if index == 0 { f32::NEG_INFINITY } else { 0.0 };
    let high = if index + 1 == count {
        f32::INFINITY
    } else {
        1.0
    };
    [low, high]
}
