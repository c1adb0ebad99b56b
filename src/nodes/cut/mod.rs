//! Cuts: they make a flat piece out of a solid.

mod placed;
pub mod rotary_cut;
pub mod slice_cut;
