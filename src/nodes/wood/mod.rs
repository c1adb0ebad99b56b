//! Wood.

pub mod growth;
pub mod growth_field;
pub mod skeleton;
pub mod skeleton_from_file;
pub mod colour_pattern;
pub mod pattern_lookup;
pub mod sample_pattern;
