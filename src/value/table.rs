//! Tables: text files that a recipe's output asks for.

/// A table to be written as CSV.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// What the file holds: a header and rows, with line feeds.
    pub text: String,
}
