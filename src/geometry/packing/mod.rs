//! Packing: stones that fill a region, follow a direction and leave no gaps.
//!
//! Two ways lead there. Particles that push and pull each other settle (Miyata, Itoh & Shimada); what they leave at faults is
//! left, as in the paper. A position field (Jakob and others 2015) gives every place its nearest point of a lattice that
//! follows the direction, and stones stand where many places agree; then they are evened out, and mended.

pub(crate) mod attributes;
mod cells;
mod collapse;
pub(crate) mod direction;
mod dual;
mod force;
mod guide;
mod lattice;
mod mend;
mod neighbours;
mod plan;
mod position;
mod relax;
mod settle;
mod simple;
mod start;
pub(crate) mod statistics;
mod walls;

pub(crate) use force::Law;
pub(crate) use guide::Guide;
pub(crate) use lattice::area_share;
pub(crate) use plan::{Method, Plan, pack};
pub(crate) use start::Start;
pub(crate) use walls::bounds;

use glam::DVec2;

/// A stone, or the particle that stands for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stone {
    /// Its middle.
    point: DVec2,
    /// The direction of its length, of length 1.
    frame: DVec2,
    /// Its size as a factor.
    scale: f64,
    /// Whether it stays where it is.
    is_fixed: bool,
}

impl Stone {
    /// An offset in the stone's own frame.
    fn within(&self, offset: DVec2) -> DVec2 {
        DVec2::new(self.frame.dot(offset), self.frame.perp_dot(offset))
    }
}
