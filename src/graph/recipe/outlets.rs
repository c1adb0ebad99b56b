//! The outputs of a compound: `{ "wood": "spruce", "age": output(of: "time.age", about: "..") }`.

use super::super::names::shown;
use super::super::report::Report;
use super::super::tree::{Entry, Field, Shape, Tree};
use super::{key, mismatch, report_duplicate_field, report_duplicate_name};
use crate::diagnostics::{Code, Span, nearest};
use std::collections::HashMap;

/// An output of a compound: `"name": "node.output"`, or `"name": output(of: "node.output", about: "..")`.
#[derive(Debug)]
pub(in crate::graph) struct Outlet<'t> {
    /// The name.
    pub(in crate::graph) name: &'t str,
    /// The node and the output that it is.
    pub(in crate::graph) of: &'t str,
    /// Where that is written.
    pub(in crate::graph) span: Span,
    /// What it means.
    pub(in crate::graph) about: &'t str,
}

/// The fields of an output that is written out.
const FIELDS: [&str; 2] = ["of", "about"];

/// Reads the outputs.
pub(super) fn outlets<'t>(report: &mut Report, tree: &'t Tree) -> Vec<Outlet<'t>> {
    let Shape::Map(entries) = &tree.shape else {
        mismatch(
            report,
            "outputs in braces, `{ \"name\": \"node.output\" }`",
            tree,
        );
        return vec![];
    };
    let mut seen: HashMap<&str, Span> = HashMap::new();
    let mut outlets = vec![];
    for entry in entries {
        let Some(name) = key(report, entry, "an output") else {
            continue;
        };
        let span = entry.key.span.clone();
        if let Some(first) = seen.get(name) {
            report_duplicate_name(report, "output", name, span, first.clone());
            continue;
        }
        seen.insert(name, span);
        outlets.extend(outlet(report, name, entry));
    }
    outlets
}

fn outlet<'t>(report: &mut Report, name: &'t str, entry: &'t Entry) -> Option<Outlet<'t>> {
    let (of, about) = match &entry.value.shape {
        Shape::Text(_) => (&entry.value, ""),
        Shape::Record(Some(word), fields) if word.text == "output" => {
            written_out(report, fields, &entry.value)?
        }
        _ => return refuse(report, &entry.value),
    };
    let Shape::Text(text) = &of.shape else {
        return refuse(report, of);
    };
    Some(Outlet {
        name,
        of: &text.value,
        span: of.span.clone(),
        about,
    })
}

/// The link and the help of `output(of: "..", about: "..")`.
fn written_out<'t>(
    report: &mut Report,
    fields: &'t [Field],
    whole: &Tree,
) -> Option<(&'t Tree, &'t str)> {
    let mut seen: HashMap<&str, Span> = HashMap::new();
    let (mut of, mut about) = (None, "");
    for field in fields {
        if let Some(first) = seen.insert(&field.name.text, field.name.span.clone()) {
            report_duplicate_field(report, &field.name, first);
        }
        match (field.name.text.as_str(), &field.value.shape) {
            ("of", _) => of = Some(&field.value),
            ("about", Shape::Text(text)) => about = &text.value,
            ("about", _) => mismatch(report, "text for `about`", &field.value),
            _ => refuse_field(report, field),
        }
    }
    match of {
        Some(of) => Some((of, about)),
        None => refuse(report, whole),
    }
}

fn refuse_field(report: &mut Report, field: &Field) {
    let name = &field.name.text;
    let message = format!("an output has no field {}", shown(name));
    let span = field.name.span.clone();
    report.add(
        report
            .error(
                Code::UnknownField,
                message,
                span,
                "not a field of an output",
            )
            .nearest(nearest(name, FIELDS))
            .hint(format!("the fields of an output are {}", FIELDS.join(", "))),
    );
}

fn refuse<T>(report: &mut Report, tree: &Tree) -> Option<T> {
    let found = tree.described(&report.source.text);
    let expected = "`\"node.output\"` or `output(of: \"node.output\", about: \"..\")`";
    let message = format!("expected {expected}, found {found}");
    let error = report.error(Code::NotANode, message, tree.span.clone(), "not an output");
    report.add(error.expected(expected, found));
    None
}
