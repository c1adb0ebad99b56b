//! Cuts: they make a flat piece out of a solid.

pub mod slice_cut;
