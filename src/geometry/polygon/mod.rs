//! Polygons of the plane: areas, centres of gravity, what lies inside, what two have in common, and repair.

mod area;
mod edges;
mod mend;
mod overlay;
mod round;
mod window;

pub(crate) use area::{Measure, doubled_area, measure};
pub(crate) use edges::Edges;
pub(crate) use mend::{Fault, Nothing, Wrong, area, mend, rings_of};
pub(crate) use overlay::{Lattice, Operation};
pub(crate) use round::{Bent, arc_points, chorded, flatten, round_corners, steps};
pub(crate) use window::cut_to_box;

#[cfg(test)]
mod tests;
