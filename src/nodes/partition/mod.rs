//! Planes divided into cells.

pub mod cell_fields;
pub mod cell_value;
mod division;
pub(in crate::nodes) mod found;
mod ground;
pub mod per_cell;
pub mod region_cells;
pub mod split_cells;
pub mod voronoi_split;
