//! Noise: irregularity that looks grown, and what it does to materials.

pub mod distort;
mod lattice;
mod octaves;
pub mod plane_noise;
mod random;
pub mod solid_noise;

#[cfg(test)]
mod tests;
