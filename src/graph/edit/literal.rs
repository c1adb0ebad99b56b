//! Values as they are written: their brackets and items, quotation marks, and whether a text is one value.

use super::layout::Container;
use super::place::{Problem, problem};
use crate::diagnostics::{Code, SourceFile, Span};
use crate::graph::report::Report;
use crate::graph::text;
use crate::graph::tree::{Shape, Tree};
use std::sync::Arc;

/// A text as RON writes it.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            letter if letter.is_control() => quoted.extend(letter.escape_unicode()),
            letter => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}

/// The brackets of a value and what is between them.
pub(super) fn container(tree: &Tree) -> Container {
    let to_end = |start: &Span, value: &Tree| start.start..value.span.end;
    let (open, items) = match &tree.shape {
        Shape::Record(word, fields) => {
            let items = fields
                .iter()
                .map(|field| to_end(&field.name.span, &field.value));
            (word.as_ref(), items.collect())
        }
        Shape::Tuple(word, values) => {
            let items = values.iter().map(|value| value.span.clone());
            (word.as_ref(), items.collect())
        }
        Shape::List(values) => {
            let items = values.iter().map(|value| value.span.clone());
            (None, items.collect())
        }
        Shape::Map(entries) => {
            let items = entries
                .iter()
                .map(|entry| to_end(&entry.key.span, &entry.value));
            (None, items.collect())
        }
        _ => (None, vec![]),
    };
    let start = open.map_or(tree.span.start, |word| word.span.end);
    Container {
        span: start..tree.span.end,
        items,
    }
}

/// The only value in a text, without the space around it.
pub(super) fn one_value(literal: &str) -> Result<(&str, Tree), Problem> {
    let literal = literal.trim();
    let source = Arc::new(SourceFile::new("the new value", literal));
    let mut report = Report::new(&source);
    match text::read(&mut report) {
        Some(tree) if tree.span == (0..literal.len()) => Ok((literal, tree)),
        Some(_) => Err(problem(
            Code::Syntax,
            "expected one value, found comments or attributes beside it",
        )),
        None => Err(report.finish().into_iter().next().map_or_else(
            || problem(Code::Syntax, "expected one value, found nothing"),
            Box::new,
        )),
    }
}
