//! Packs stones.
pub(crate) mod cells;
pub(crate) mod collapse;
pub(crate) mod direction;
pub(crate) mod dual;
pub(crate) mod force;
pub(crate) mod guide;
pub(crate) mod lattice;
pub(crate) mod neighbours;
pub(crate) mod position;
pub(crate) mod relax;
pub(crate) mod settle;
pub(crate) mod start;
pub(crate) mod walls;

use glam::DVec2;

/// A stone, or the particle that stands for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stone {
    /// Its middle.
    pub(crate) point: DVec2,
    /// The direction of its length, of length 1.
    pub(crate) frame: DVec2,
    /// Its size as a factor.
    pub(crate) scale: f64,
    /// Whether it stays where it is.
    pub(crate) is_fixed: bool,
}

impl Stone {
    /// An offset in the stone's own frame.
    pub(crate) fn within(&self, offset: DVec2) -> DVec2 {
        DVec2::new(self.frame.dot(offset), self.frame.perp_dot(offset))
    }
}

