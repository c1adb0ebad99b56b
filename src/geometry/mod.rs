//! Geometry in double precision: curves that structures and kernels are built from.

pub mod spline;
mod tangents;
