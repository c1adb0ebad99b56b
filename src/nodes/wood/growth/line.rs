//! The line along which a trunk grew: a curve, or straight segments.

use super::straight::StraightTrunk;
use crate::geometry::spline::TrunkCurve;
use glam::DVec3;

/// The line along which a trunk grew.
#[derive(Clone, Debug, PartialEq)]
pub enum TrunkLine {
    /// The curved skeleton: a point's foot lies at its own height, and way along the trunk is height.
    Curved(TrunkCurve),
    /// The straight skeleton: nearest node, influence and blend areas, way along the segments.
    Straight(StraightTrunk),
}

impl TrunkLine {
    /// Height in mm of its ends.
    pub fn heights(&self) -> [f64; 2] {
        match self {
            TrunkLine::Curved(curve) => curve.heights(),
            TrunkLine::Straight(trunk) => {
                let nodes = trunk.nodes();
                [nodes[0].z, nodes[nodes.len() - 1].z]
            }
        }
    }

    /// Its point at a height in mm.
    pub fn at(&self, height: f64) -> DVec3 {
        match self {
            TrunkLine::Curved(curve) => curve.at(height),
            TrunkLine::Straight(trunk) => trunk.at(height).0,
        }
    }

    /// The way in mm that the trunk's tip had come when it reached a height.
    pub fn way_to(&self, height: f64) -> f64 {
        match self {
            TrunkLine::Curved(_) => height,
            TrunkLine::Straight(trunk) => trunk.at(height).1,
        }
    }

    /// The curve, if it is one.
    pub fn curve(&self) -> Option<&TrunkCurve> {
        match self {
            TrunkLine::Curved(curve) => Some(curve),
            TrunkLine::Straight(_) => None,
        }
    }

    /// The straight trunk, if it is one.
    pub fn straight(&self) -> Option<&StraightTrunk> {
        match self {
            TrunkLine::Curved(_) => None,
            TrunkLine::Straight(trunk) => Some(trunk),
        }
    }
}
