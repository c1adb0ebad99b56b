//! Stones: what is built of cells.

pub mod stones;
