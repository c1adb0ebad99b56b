//! Compounds: kinds of nodes that are written as recipes.
//!
//! A recipe is read together with the files of all compounds that it uses, directly or inside others. Each
//! becomes a [`Definition`] once: its interface as a kind, and a layout that gives every node inside an
//! offset. Expansion then puts the nodes of each use in its place, so that nothing behind it knows of
//! compounds, and equal nodes have equal keys wherever they come from.

mod definition;
mod interface;
mod layout;
mod library;

pub(super) use definition::{Definition, define};
pub(super) use interface::{inputs_kind, stand_in};
pub(super) use layout::{Layout, Slot};
pub use library::{Compound, compounds, kinds};
pub(super) use library::{File, Library, gather};

/// Compounds inside compounds.
pub(super) const DEPTH: usize = 64;
/// Files of compounds that one recipe can use.
const FILES: usize = 1000;
