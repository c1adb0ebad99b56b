//! How values of a recipe are described in messages.

use super::names::shown;
use super::tree::{Shape, Tree, Word};
use crate::value::Unit;

impl Tree {
    /// What the value is, for "expected X, found Y"; `text` is the whole recipe.
    pub(super) fn described(&self, text: &str) -> String {
        let counted = |number: usize, what: &str| match number {
            0 => format!("an empty {what}"),
            number => format!("a {what} of {number}"),
        };
        match &self.shape {
            Shape::Number => format!("number {}", shown(&text[self.span.clone()])),
            Shape::Text(_) => format!("text {}", shown(&text[self.span.clone()])),
            Shape::Name(name) if name == "true" || name == "false" => {
                format!("toggle {}", shown(name))
            }
            Shape::Name(name) => format!("name {}", shown(name)),
            Shape::Record(Some(Word { text, .. }), _)
            | Shape::Tuple(Some(Word { text, .. }), _) => {
                format!("an instance of {}", shown(text))
            }
            Shape::Record(None, fields) => {
                let first = fields.first().map_or("", |field| &field.name.text);
                format!("a record with {}", shown(first))
            }
            Shape::Tuple(None, values) => counted(values.len(), "tuple"),
            Shape::List(values) => counted(values.len(), "list"),
            Shape::Map(entries) => counted(entries.len(), "map"),
            Shape::Other | Shape::Missing => shown(&text[self.span.clone()]),
        }
    }
}

/// A number, in powers of ten where it would be long.
pub(super) fn described_number(number: f64) -> String {
    match number.abs() {
        0.0 | 1e-5..1e15 => number.to_string(),
        _ => format!("{number:e}"),
    }
}

/// The unit of a number, in words.
pub(super) fn described_unit(unit: Unit) -> String {
    match unit {
        Unit::One => "a plain number".to_owned(),
        unit => format!("in {}", unit.symbol()),
    }
}

/// The numbers that a range allows, in words.
pub(super) fn described_range((low, high): (f64, f64)) -> String {
    let is_open = |end: f64| end.abs() == f64::MAX || end.is_infinite();
    match (is_open(low), is_open(high)) {
        (true, true) => "a finite number".to_owned(),
        (false, true) => format!("at least {low}"),
        (true, false) => format!("at most {high}"),
        (false, false) => format!("from {low} to {high}"),
    }
}
