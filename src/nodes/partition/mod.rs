//! Planes divided into cells.

pub mod cell_attribute;
pub mod cell_fields;
pub mod cell_table;
pub mod cell_value;
mod division;
pub(in crate::nodes) mod found;
mod ground;
pub mod inset_cells;
pub mod per_cell;
pub mod region_cells;
pub mod split_cells;
pub mod square_packing;
pub mod voronoi_split;
