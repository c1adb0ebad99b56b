//! Which branches can influence the samples of a run.

use super::GrowthModel;
use glam::{DVec3, Vec3};

/// More branches than this are kept in a tree.
const MOST_IN_A_LIST: usize = 16;

/// Branches in a leaf of the tree, at most.
const LEAF: usize = 4;

/// Share of the distances involved by which a volume is taken larger: much more than the kernel's
/// rounding, so that a branch left out contributes exactly 0 to every sample.
const ROUNDING: f64 = 1e-5;

/// A box parallel to the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

impl Bounds {
    fn meets(&self, other: &Bounds) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    fn joined(self, other: Bounds) -> Bounds {
        Bounds {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// The points that a branch can influence: a cylinder, or half of space.
#[derive(Clone, Copy, Debug)]
struct Volume {
    start: DVec3,
    direction: DVec3,
    along: f64,
    across: f64,
}

impl Volume {
    /// Whether the branch may influence a point of the box with this centre and these half sides.
    fn meets(&self, centre: DVec3, half: DVec3) -> bool {
        let from_start = centre - self.start;
        let along = from_start.dot(self.direction);
        let across = (from_start - self.direction * along).length();
        let radius = half.length();
        let margin = ROUNDING * (from_start.length() + radius);
        let spread = self.direction.abs().dot(half) + margin;
        along + spread > 0.0
            && along - spread < self.along
            && across - radius - margin < self.across
    }

    /// A box around a cylinder.
    fn bounds(&self) -> Bounds {
        let end = self.start + self.direction * self.along;
        let radius = (DVec3::ONE - self.direction * self.direction)
            .max(DVec3::ZERO)
            .map(f64::sqrt)
            * self.across;
        let margin = ROUNDING * (self.along + self.across + self.start.abs().max_element());
        let (low, high) = (self.start.min(end) - radius, self.start.max(end) + radius);
        Bounds {
            low: (low - margin).as_vec3(),
            high: (high + margin).as_vec3(),
        }
    }
}

/// The volumes of all branches, found by box.
#[derive(Debug)]
pub(super) struct NearBranches {
    volumes: Vec<Volume>,
    /// Empty if all volumes are looked at.
    tree: Vec<TreeNode>,
    /// The branches in the order of the leaves.
    order: Vec<u32>,
}

/// A node of a tree of boxes, stored before everything below it.
#[derive(Debug)]
struct TreeNode {
    bounds: Bounds,
    /// The node to go on with when the box is missed.
    skip: u32,
    /// The branches of a leaf, as a range of the order; empty for inner nodes.
    leaf: [u32; 2],
}

impl NearBranches {
    pub(super) fn new(model: &GrowthModel) -> NearBranches {
        let reach = model.settings.reach;
        let volume = |branch: &super::GrowingBranch| Volume {
            start: branch.start,
            direction: branch.direction,
            along: reach.map_or(f64::INFINITY, |reach| reach.along),
            across: reach.map_or(f64::INFINITY, |reach| reach.across),
        };
        let volumes: Vec<Volume> = model.branches.iter().map(volume).collect();
        let mut near = NearBranches {
            volumes,
            tree: vec![],
            order: vec![],
        };
        if reach.is_some() && near.volumes.len() > MOST_IN_A_LIST {
            let bounds: Vec<Bounds> = near.volumes.iter().map(Volume::bounds).collect();
            let mut order: Vec<u32> = (0..bounds.len() as u32).collect();
            near.grow(&bounds, &mut order);
        }
        near
    }

    /// Adds the tree over some branches: halves along the longest side until leaves are small.
    fn grow(&mut self, bounds: &[Bounds], branches: &mut [u32]) {
        let of = |branch: &u32| bounds[*branch as usize];
        let all = branches.iter().map(of).reduce(Bounds::joined);
        let Some(all) = all else { return };
        let index = self.tree.len();
        let first = self.order.len() as u32;
        self.tree.push(TreeNode {
            bounds: all,
            skip: 0,
            leaf: [first, first],
        });
        if branches.len() <= LEAF {
            self.order.extend_from_slice(branches);
            self.tree[index].leaf[1] = self.order.len() as u32;
        } else {
            let axis = (all.high - all.low).max_position();
            let middle = |branch: &u32| of(branch).low[axis] + of(branch).high[axis];
            branches.sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
            let (low, high) = branches.split_at_mut(branches.len() / 2);
            self.grow(bounds, low);
            self.grow(bounds, high);
        }
        self.tree[index].skip = self.tree.len() as u32;
    }

    /// Lists the branches that may influence a point of the box, in their order.
    pub(super) fn find(&self, samples: &Bounds, near: &mut Vec<u32>) {
        near.clear();
        let (low, high) = (samples.low.as_dvec3(), samples.high.as_dvec3());
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let meets = |branch: &u32| self.volumes[*branch as usize].meets(centre, half);
        if self.tree.is_empty() {
            near.extend((0..self.volumes.len() as u32).filter(meets));
            return;
        }
        let mut next = 0;
        while let Some(node) = self.tree.get(next) {
            if node.bounds.meets(samples) {
                let [first, end] = node.leaf.map(|index| index as usize);
                near.extend(self.order[first..end].iter().filter(|branch| meets(branch)));
                next += 1;
            } else {
                next = node.skip as usize;
            }
        }
        near.sort_unstable();
    }
}
