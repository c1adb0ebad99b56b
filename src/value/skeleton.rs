//! Skeletons: the trunk and the branches along which wood grows.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How tangents are put on the trunk's nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tangents {
    /// Natural cubic spline with uniform parameter: the whole curve is C2.
    Natural,
    /// Equation (4) on sliding triples of nodes: moving a node bends only its surroundings.
    Local,
}

/// Trunk and branches, in mm; z points up and the ground is at z = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Skeleton {
    /// The nodes of the trunk; z rises strictly from node to node, and there are at least two.
    pub trunk: Vec<DVec3>,
    /// How the curve runs through the nodes.
    pub tangents: Tangents,
    /// The branches, in the order of the recipe.
    pub branches: Vec<Branch>,
}

/// A straight branch that starts on the trunk's curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Branch {
    /// Height of the start (b1) in mm.
    pub height: f64,
    /// Unit vector along the axis.
    pub direction: DVec3,
    /// How thick the branch grows.
    pub thickness: Thickness,
}

/// How thick a branch grows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Thickness {
    /// Speed of thickening v_b in mm/year.
    Speed(f64),
    /// The speed that gives the branch this half-width in mm at this distance along its axis in mm, at
    /// the time when the trunk's bark is there.
    HalfWidth {
        /// Distance from the start along the axis.
        distance: f64,
        /// Distance from the axis to the branch's border.
        half_width: f64,
    },
}
