//! Shapes: meshes that materials are cut for.

pub mod block;
pub mod log;
pub mod mesh_from_file;
