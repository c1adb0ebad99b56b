//! Surfaces: what a material is made of, and how materials are blended.

pub mod blend;
pub mod inlay;
pub mod material;
pub mod mix;
