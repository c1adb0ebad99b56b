//! The centre line of a trunk: curved through its nodes, or straight from node to node.

use crate::geometry::spline::{CurveError, TrunkCurve};
use crate::value::Skeleton;
use glam::DVec3;

/// A curve is charged in straight pieces; so many stand for one piece of it.
const RODS_IN_A_PIECE: usize = 8;

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
            // Two nodes make a straight line.
            Axis::Curved(curve) if curve.nodes().len() == 2 => curve.nodes().to_vec(),
            Axis::Curved(curve) => {
                let within = |ends: &[DVec3]| {
                    let [low, high] = [ends[0].z, ends[1].z];
                    let shares =
                        (0..RODS_IN_A_PIECE).map(|rod| rod as f64 / RODS_IN_A_PIECE as f64);
                    shares.map(move |share| low + share * (high - low))
                };
                let heights = curve.nodes().windows(2).flat_map(within);
                let heights = heights.chain([curve.heights()[1]]);
                heights.map(|height| curve.at(height)).collect()
            }
        }
    }
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
