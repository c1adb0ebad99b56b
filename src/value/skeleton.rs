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

/// No tree is as large as this, in mm.
const LARGEST: f64 = 1e9;

impl Skeleton {
    /// Whether it is what nodes make: finite, with a trunk that rises and branches that start on it.
    pub fn is_sound(&self) -> bool {
        let nodes = || self.trunk.iter();
        let [Some(lowest), Some(highest)] = [self.trunk.first(), self.trunk.last()] else {
            return false;
        };
        let heights = lowest.z..=highest.z;
        nodes().count() > 1
            && nodes().all(|node| node.abs().max_element() <= LARGEST && node.is_finite())
            && self.trunk.windows(2).all(|pair| pair[0].z < pair[1].z)
            && self
                .branches
                .iter()
                .all(|branch| heights.contains(&branch.height) && branch.is_sound())
    }
}

impl Branch {
    fn is_sound(&self) -> bool {
        let length = self.direction.length();
        (length - 1.0).abs() < 1e-6
            && self.thickness.is_sound()
            && self.length.is_none_or(is_length)
    }
}

/// Whether a number can be a length in mm.
fn is_length(length: f64) -> bool {
    length > 0.0 && length <= LARGEST
}

impl Thickness {
    fn is_sound(self) -> bool {
        match self {
            Thickness::Speed(speed) => is_length(speed),
            Thickness::HalfWidth {
                distance,
                half_width,
            } => is_length(distance) && is_length(half_width),
        }
    }
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
    /// Distance in mm from the start to the tip, if it is known.
    pub length: Option<f64>,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn skeleton(change: fn(&mut Skeleton)) -> Skeleton {
        let mut skeleton = Skeleton {
            trunk: vec![DVec3::ZERO, DVec3::new(1.0, 2.0, 100.0)],
            tangents: Tangents::Natural,
            branches: vec![Branch {
                height: 50.0,
                direction: DVec3::X,
                thickness: Thickness::Speed(1.0),
                length: None,
            }],
        };
        change(&mut skeleton);
        skeleton
    }

    #[test]
    fn only_what_nodes_make_is_sound() {
        assert!(skeleton(|_| {}).is_sound());
        let unsound: [fn(&mut Skeleton); 13] = [
            |it| it.branches[0].length = Some(0.0),
            |it| it.trunk.clear(),
            |it| it.trunk.truncate(1),
            |it| it.trunk[1].z = 0.0,
            |it| it.trunk[1].z = f64::INFINITY,
            |it| it.trunk[1].x = f64::NAN,
            |it| it.trunk[0].x = -1e300,
            |it| it.branches[0].height = 101.0,
            |it| it.branches[0].height = f64::NAN,
            |it| it.branches[0].direction = DVec3::ZERO,
            |it| it.branches[0].direction.y = f64::NAN,
            |it| it.branches[0].thickness = Thickness::Speed(0.0),
            |it| {
                it.branches[0].thickness = Thickness::HalfWidth {
                    distance: 1.0,
                    half_width: f64::INFINITY,
                }
            },
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            assert!(!skeleton(change).is_sound(), "{number}");
        }
    }
}
