//! Polygons of the plane: areas, centres of gravity, what lies inside, and what two have in common.

mod area;
mod edges;
mod overlay;
mod window;

pub(crate) use area::{Measure, doubled_area, measure};
pub(crate) use edges::Edges;
pub(crate) use overlay::{Lattice, Operation};
pub(crate) use window::cut_to_box;
