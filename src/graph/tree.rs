//! The tree of a recipe: every name, key and value with the bytes it covers.

use super::text_literal::TextLiteral;
use crate::diagnostics::Span;

/// A value and the bytes it covers.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// What it is.
    pub(super) shape: Shape,
    /// Where it is, from its first to its last letter.
    pub(super) span: Span,
}

/// What a value looks like; types come later.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// A number with its sign and suffix.
    Number,
    /// Text in quotes.
    Text(TextLiteral),
    /// A bare name: `base_color`, `true`.
    Name(String),
    /// Values in parentheses, perhaps with a name before: `(1, 2)`.
    Tuple(Option<Word>, Vec<Tree>),
    /// Fields in parentheses, perhaps with a name before: `noise(scale: 2)`.
    Record(Option<Word>, Vec<Field>),
    /// Values in brackets.
    List(Vec<Tree>),
    /// Keys and values in braces.
    Map(Vec<Entry>),
    /// Valid RON that no recipe uses: characters, bytes, ranges.
    Other,
    /// A value was expected and is missing; reported.
    Missing,
}

/// A bare name and where it is.
#[derive(Clone, Debug)]
pub(super) struct Word {
    /// The name.
    pub(super) text: String,
    /// Where it is.
    pub(super) span: Span,
}

/// `name: value`
#[derive(Clone, Debug)]
pub(super) struct Field {
    /// The name.
    pub(super) name: Word,
    /// The value.
    pub(super) value: Tree,
}

/// `key: value`
#[derive(Clone, Debug)]
pub(super) struct Entry {
    /// The key.
    pub(super) key: Tree,
    /// The value.
    pub(super) value: Tree,
}
