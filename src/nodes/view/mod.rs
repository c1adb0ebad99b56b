//! Shaded pictures of things: rays on the processor, in pure kernels.

mod camera;
mod light;
mod picture;
mod rays;
mod record;
mod scene;
mod shade;
pub mod view;
