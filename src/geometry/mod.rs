//! Geometry in double precision: curves and meshes that structures and kernels are built from.

pub(crate) mod mesh;
pub mod spline;
mod tangents;
