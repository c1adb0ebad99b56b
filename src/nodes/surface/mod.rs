//! Surfaces: what a material is made of, and how it is cut.

pub mod material;
pub mod mix;
