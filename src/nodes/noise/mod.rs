//! Noise: irregularity that looks grown, and what it does to materials.

pub mod distort;
mod filter;
mod form;
mod interface;
mod lattice;
mod lost;
mod octaves;
mod period;
pub mod plane_noise;
pub mod solid_noise;

#[cfg(test)]
mod tests;
