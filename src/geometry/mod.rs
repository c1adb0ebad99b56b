//! Geometry in double precision: curves and meshes that structures and kernels are built from.

pub(crate) mod assemble;
mod box_tree;
pub(crate) mod cells;
pub(crate) mod heights;
pub(crate) mod hierarchy;
pub(crate) mod level_surface;
pub(crate) mod mesh;
pub(crate) mod nurbs;
pub(crate) mod patch_grid;
pub(crate) mod polygon;
pub mod spline;
pub(crate) mod subdivision;
mod tangents;
pub(crate) mod voronoi;
