//! Wood.

pub mod colour_pattern;
pub mod energy;
pub mod fibre_field;
pub mod growth;
pub mod growth_field;
pub mod pattern_lookup;
mod ring_time;
pub mod sample_pattern;
pub mod skeleton;
pub mod skeleton_from_file;
pub mod straight_growth_field;
mod tree_file;
pub mod virtual_energy;
