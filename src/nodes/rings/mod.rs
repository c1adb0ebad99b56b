//! From weather to tree rings.

pub mod growth_model;
pub mod ring_plot;
pub mod ring_series;
pub mod weather;
