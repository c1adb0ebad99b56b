//! Fields: arithmetic on numbers, vectors and colours, and where they are evaluated.

pub mod adjust_colour;
pub mod combine;
pub mod math;
pub mod position;
mod profile;
pub mod ramp;
pub mod remap;
pub mod separate;
pub mod threshold;
pub mod vector_math;
