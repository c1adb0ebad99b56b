//! Shapes: meshes that materials are cut for.

pub mod mesh_from_file;
