//! Shapes: meshes and curved patches that materials are cut for.

pub mod block;
pub mod log;
pub mod mesh_from_file;
pub mod mesh_from_patches;
pub mod nurbs_surface;
pub mod patches_from_file;
mod scan;
pub mod subdivide;
