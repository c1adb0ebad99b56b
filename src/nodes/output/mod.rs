//! Where a recipe ends: what is written.

pub mod maps;
mod normal;
pub mod packing_table;
pub mod ring_table;

pub(crate) use normal::normal_from_height;
