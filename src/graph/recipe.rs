//! The top level of a recipe: which nodes, outputs and parameters it declares.

use super::names::{check_name, is_reserved, look_alike, shown};
use super::report::Report;
use super::tree::{Entry, Field, Shape, Tree, Word};
use crate::diagnostics::{Code, Span, nearest};
use std::collections::HashMap;

/// The fields of a recipe.
const FIELDS: [&str; 5] = ["about", "seed", "parameters", "nodes", "outputs"];

/// What a recipe declares; nothing in it is checked yet.
#[derive(Debug, Default)]
pub(super) struct Recipe<'t> {
    /// What it says it is for.
    pub(super) about: String,
    /// The seed, 0 if it has none.
    pub(super) seed: u64,
    /// The parameters in the order of the file.
    pub(super) parameters: Vec<Declaration<'t>>,
    /// The nodes in the order of the file.
    pub(super) nodes: Vec<Declaration<'t>>,
    /// The outputs in the order of the file.
    pub(super) outputs: Vec<Declaration<'t>>,
}

/// `"name": kind(field: value)`
#[derive(Debug)]
pub(super) struct Declaration<'t> {
    /// The name.
    pub(super) name: &'t str,
    /// Where the name is.
    pub(super) span: Span,
    /// The kind; `None` if what follows the name is something else, which is reported.
    pub(super) kind: Option<&'t Word>,
    /// The fields.
    pub(super) fields: &'t [Field],
}

/// Reads the top level.
pub(super) fn read<'t>(report: &mut Report, tree: &'t Tree) -> Recipe<'t> {
    let mut recipe = Recipe::default();
    let fields = match &tree.shape {
        Shape::Record(None, fields) => fields.as_slice(),
        Shape::Tuple(None, values) if values.is_empty() => &[],
        _ => {
            refuse_root(report, tree);
            return recipe;
        }
    };
    let mut seen: HashMap<&str, Span> = HashMap::new();
    for field in fields {
        if let Some(first) = seen.insert(&field.name.text, field.name.span.clone()) {
            report_duplicate_field(report, &field.name, first);
            continue;
        }
        read_field(report, &mut recipe, field);
    }
    if !seen.contains_key("nodes") {
        let message = "the recipe has no field `nodes`";
        let start = tree.span.start;
        report.add(
            report
                .error(
                    Code::MissingField,
                    message,
                    start..start + 1,
                    "`nodes` is missing here",
                )
                .hint("add `nodes: { \"name\": kind(..) }`"),
        );
    }
    recipe
}

fn refuse_root(report: &mut Report, tree: &Tree) {
    let found = tree.described(&report.source.text);
    let message = format!("expected a recipe in parentheses, found {found}");
    report.add(
        report
            .error(Code::NotARecipe, message, tree.span.clone(), "not a recipe")
            .expected("a recipe in parentheses", found)
            .hint("write `(nodes: { .. }, outputs: { .. })`"),
    );
}

fn read_field<'t>(report: &mut Report, recipe: &mut Recipe<'t>, field: &'t Field) {
    match field.name.text.as_str() {
        "about" => match &field.value.shape {
            Shape::Text(text) => recipe.about.clone_from(&text.value),
            _ => mismatch(report, "text for `about`", &field.value),
        },
        "seed" => match report.source.text[field.value.span.clone()].parse() {
            Ok(seed) => recipe.seed = seed,
            Err(_) => mismatch(
                report,
                "a whole number from 0 to 2^64 - 1 for `seed`",
                &field.value,
            ),
        },
        "parameters" => recipe.parameters = declarations(report, &field.value, "parameter"),
        "nodes" => recipe.nodes = declarations(report, &field.value, "node"),
        "outputs" => {
            recipe.outputs = declarations(report, &field.value, "output");
            check_output_names(report, &recipe.outputs);
        }
        unknown => {
            let message = format!("a recipe has no field {}", shown(unknown));
            let span = field.name.span.clone();
            report.add(
                report
                    .error(
                        Code::UnknownField,
                        message,
                        span,
                        look_alike(unknown, "not a field of a recipe"),
                    )
                    .nearest(nearest(unknown, FIELDS))
                    .hint(format!("the fields of a recipe are {}", FIELDS.join(", "))),
            );
        }
    }
}

fn mismatch(report: &mut Report, expected: &str, tree: &Tree) {
    let found = tree.described(&report.source.text);
    let message = format!("expected {expected}, found {found}");
    let error = report.error(Code::TypeMismatch, message, tree.span.clone(), "");
    report.add(error.expected(expected, found));
}

/// Reports a field that is written twice.
pub(super) fn report_duplicate_field(report: &mut Report, name: &Word, first: Span) {
    let message = format!("{} is written twice", shown(&name.text));
    report.add(
        report
            .error(
                Code::DuplicateField,
                message,
                name.span.clone(),
                "again here",
            )
            .and_at(first, "first here"),
    );
}

fn declarations<'t>(report: &mut Report, tree: &'t Tree, what: &str) -> Vec<Declaration<'t>> {
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
pub(super) fn key<'t>(report: &mut Report, entry: &'t Entry, what: &str) -> Option<&'t str> {
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
pub(super) fn report_duplicate_name(
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
fn check_output_names(report: &mut Report, outputs: &[Declaration<'_>]) {
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
