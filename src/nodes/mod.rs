//! The kinds of nodes, in families: one file each, and one line each in the table below.

pub mod cut;
pub mod output;
pub mod surface;
pub mod wood;

use crate::node::Kind;

/// Every kind there is, in the order of the manual.
pub static KINDS: &[&Kind] = &[
    &surface::material::KIND,
    &cut::slice_cut::KIND,
    &output::maps::KIND,
];

/// The kind called `name`.
pub fn kind(name: &str) -> Option<&'static Kind> {
    KINDS.iter().copied().find(|kind| kind.name == name)
}
