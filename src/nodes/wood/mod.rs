//! Wood.

pub mod colour_pattern;
pub mod pattern_lookup;
pub mod sample_pattern;
