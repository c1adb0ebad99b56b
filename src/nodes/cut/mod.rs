//! Cuts: they make a flat piece out of a solid.

pub mod mesh_cut;
pub mod patch_cut;
pub(in crate::nodes) mod placed;
pub mod rotary_cut;
pub mod slice_cut;
mod surface;
