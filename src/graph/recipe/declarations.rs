//! Maps of declarations: `{ "name": kind(field: value) }`.

use super::super::names::{check_name, is_reserved, shown};
use super::super::report::Report;
use super::super::tree::{Entry, Field, Shape, Tree, Word};
use super::mismatch;
use crate::diagnostics::{Code, Span};
use std::collections::HashMap;

/// `"name": kind(field: value)`
#[derive(Debug)]
pub(in crate::graph) struct Declaration<'t> {
    /// The name.
    pub(in crate::graph) name: &'t str,
    /// Where the name is.
    pub(in crate::graph) span: Span,
    /// The kind; `None` if what follows the name is something else, which is reported.
    pub(in crate::graph) kind: Option<&'t Word>,
    /// The fields.
    pub(in crate::graph) fields: &'t [Field],
}

pub(super) fn declarations<'t>(
    report: &mut Report,
    tree: &'t Tree,
    what: &str,
) -> Vec<Declaration<'t>> {
    let Shape::Map(entries) = &tree.shape else {
        mismatch(
            report,
            &format!("{what}s in braces, `{{ \"name\": .. }}`"),
            tree,
        );
        return vec![];
    };
    let mut seen: HashMap<&str, Span> = HashMap::new();
    let mut declarations = vec![];
    for entry in entries {
        let Some(name) = key(report, entry, &with_article(what)) else {
            continue;
        };
        let span = entry.key.span.clone();
        if let Some(first) = seen.get(name) {
            report_duplicate_name(report, what, name, span, first.clone());
            continue;
        }
        seen.insert(name, span.clone());
        let (kind, fields) = instance(report, &entry.value, what).unzip();
        declarations.push(Declaration {
            name,
            span,
            kind,
            fields: fields.unwrap_or_default(),
        });
    }
    declarations
}

/// The name that a key holds; anything but a valid one is reported.
pub(in crate::graph) fn key<'t>(
    report: &mut Report,
    entry: &'t Entry,
    what: &str,
) -> Option<&'t str> {
    match &entry.key.shape {
        Shape::Text(text) => {
            check_name(report, what, &text.value, entry.key.span.clone());
            Some(&text.value)
        }
        _ => {
            let found = entry.key.described(&report.source.text);
            let message = format!("expected the name of {what} in quotes, found {found}");
            let span = entry.key.span.clone();
            report.add(
                report
                    .error(Code::InvalidName, message, span, "not in quotes")
                    .expected("a name in quotes", found),
            );
            None
        }
    }
}

/// Reports a name that is taken.
pub(in crate::graph) fn report_duplicate_name(
    report: &mut Report,
    what: &str,
    name: &str,
    span: Span,
    first: Span,
) {
    let message = format!("there are two {what}s called {}", shown(name));
    report.add(
        report
            .error(Code::DuplicateName, message, span, "again here")
            .and_at(first, "first here")
            .hint("rename one of them"),
    );
}

/// The parts of `kind(field: value)`.
fn instance<'t>(
    report: &mut Report,
    tree: &'t Tree,
    what: &str,
) -> Option<(&'t Word, &'t [Field])> {
    let found = match &tree.shape {
        Shape::Record(Some(word), fields) => return Some((word, fields)),
        Shape::Tuple(Some(word), values) if values.is_empty() => return Some((word, &[])),
        Shape::Tuple(Some(word), _) => {
            format!("{} with values that have no name", shown(&word.text))
        }
        _ => tree.described(&report.source.text),
    };
    let expected = format!("{} `kind(name: value)`", with_article(what));
    let message = format!("expected {expected}, found {found}");
    let error = report.error(
        Code::NotANode,
        message,
        tree.span.clone(),
        format!("not {}", with_article(what)),
    );
    report.add(error.expected(expected, found));
    None
}

fn with_article(what: &str) -> String {
    let article = if what.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {what}")
}

/// Names of outputs become names of files.
pub(super) fn check_output_names(report: &mut Report, outputs: &[Declaration<'_>]) {
    let mut seen: HashMap<String, &Declaration<'_>> = HashMap::new();
    for output in outputs {
        if is_reserved(output.name) {
            let message = format!("no output can be called {}", shown(output.name));
            report.add(
                report
                    .error(
                        Code::ReservedName,
                        message,
                        output.span.clone(),
                        "a device on Windows",
                    )
                    .hint("choose another name"),
            );
        }
        if let Some(first) = seen.insert(output.name.to_lowercase(), output) {
            let (name, other) = (shown(output.name), shown(first.name));
            let message =
                format!("outputs {other} and {name} would be the same file on some systems");
            report.add(
                report
                    .error(
                        Code::DuplicateName,
                        message,
                        output.span.clone(),
                        "again here",
                    )
                    .and_at(first.span.clone(), "first here"),
            );
        }
    }
}
