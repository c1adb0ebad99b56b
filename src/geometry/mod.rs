//! Geometry in double precision: curves and meshes that structures and kernels are built from.

mod box_tree;
pub(crate) mod heights;
pub(crate) mod hierarchy;
pub(crate) mod level_surface;
pub(crate) mod mesh;
pub(crate) mod nurbs;
pub(crate) mod patch_grid;
pub mod spline;
mod tangents;
