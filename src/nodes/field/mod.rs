//! Fields: arithmetic on numbers, vectors and colours, and where they are evaluated.

pub mod adjust_colour;
pub mod combine;
pub mod image_from_file;
pub mod math;
pub(in crate::nodes) mod placement;
pub mod position;
pub(in crate::nodes) mod profile;
pub mod ramp;
pub mod remap;
pub mod sample_at;
pub mod separate;
pub mod threshold;
pub mod transform;
pub mod transform_field;
pub mod vector_math;
