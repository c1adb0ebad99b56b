//! Parts of the plane: drawn, read, combined, and as fields.

pub mod combine_regions;
pub mod grow_region;
mod mended;
#[expect(clippy::module_inception, reason = "each kind's file has its name")]
pub mod region;
pub mod region_field;
pub mod region_from_file;
pub mod region_from_mesh;
pub mod region_shape;
