//! Wood.

pub mod colour_pattern;
pub mod pattern_lookup;
