//! Shapes: meshes of things that materials are seen on.

pub mod block;
pub mod log;
