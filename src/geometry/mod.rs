//! Geometry in double precision: curves and triangles that structures and kernels are built from.

pub(crate) mod hierarchy;
pub(crate) mod level_surface;
pub mod spline;
mod tangents;
