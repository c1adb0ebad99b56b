//! Planes divided into cells.

pub mod cell_fields;
pub mod cell_value;
mod found;
mod ground;
pub mod per_cell;
