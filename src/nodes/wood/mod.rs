//! Wood.
