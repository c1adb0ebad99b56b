//! Yosegi turns a text recipe into the maps of a material.
//!
//! A recipe is a RON file: named, typed nodes, wired to each other. [`graph`] reads and checks it,
//! [`node`] and [`nodes`] say what kinds there are, [`value`] is what flows between them. [`field`]
//! compiles what is defined at every point into column programs. [`engine`] builds structures, runs
//! programs tile by tile, keeps both in caches and reports events; [`output`] writes the maps.
//! Everything that is wrong is a [`diagnostics::Diagnostic`]. Files are reached only through [`world`].
//!
//! `ARCHITECTURE.md` has the map, the glossary, the life of an edit and the invariants.

#![forbid(unsafe_code)]

mod cancel;
pub mod colour;
pub mod diagnostics;
pub mod engine;
pub mod field;
pub mod geometry;
pub mod graph;
pub mod key;
mod lanes;
pub mod node;
pub mod nodes;
pub mod output;
pub mod value;
pub mod watch;
pub mod world;
