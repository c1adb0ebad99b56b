//! The top level of a recipe or a compound: which nodes, outputs and parameters it declares.

mod declarations;
mod outlets;
mod role;

pub(super) use declarations::{Declaration, key, report_duplicate_name};
pub(super) use outlets::Outlet;
pub(super) use role::{Role, role_of};

use declarations::{check_output_names, declarations};
use outlets::outlets;

use super::names::{look_alike, shown};
use super::report::Report;
use super::tree::{Field, Shape, Tree, Word};
use crate::diagnostics::{Code, Span, nearest};
use std::collections::HashMap;
use std::str::FromStr;

/// What a recipe or a compound declares; nothing in it is checked yet.
#[derive(Debug)]
pub(super) struct Recipe<'t> {
    /// Which of the two it is.
    pub(super) role: Role,
    /// What it says it is for.
    pub(super) about: String,
    /// The seed of a recipe, 0 if it has none.
    pub(super) seed: u64,
    /// What a compound states as its source.
    pub(super) source: String,
    /// The version of a compound, 1 if it states none.
    pub(super) version: u32,
    /// The parameters or inputs in the order of the file.
    pub(super) parameters: Vec<Declaration<'t>>,
    /// The nodes in the order of the file.
    pub(super) nodes: Vec<Declaration<'t>>,
    /// The outputs of a recipe in the order of the file.
    pub(super) outputs: Vec<Declaration<'t>>,
    /// The outputs of a compound in the order of the file.
    pub(super) outlets: Vec<Outlet<'t>>,
}

impl Recipe<'_> {
    /// A file that declares nothing.
    pub(super) fn new(role: Role) -> Self {
        Recipe {
            role,
            about: String::new(),
            seed: 0,
            source: String::new(),
            version: 1,
            parameters: vec![],
            nodes: vec![],
            outputs: vec![],
            outlets: vec![],
        }
    }
}

/// Reads the top level.
pub(super) fn read<'t>(report: &mut Report, role: Role, tree: &'t Tree) -> Recipe<'t> {
    let mut recipe = Recipe::new(role);
    let fields = match &tree.shape {
        Shape::Record(None, fields) => fields.as_slice(),
        Shape::Tuple(None, values) if values.is_empty() => &[],
        _ => {
            refuse_root(report, role, tree);
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
        let message = format!("the {} has no field `nodes`", role.name());
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

fn refuse_root(report: &mut Report, role: Role, tree: &Tree) {
    let found = tree.described(&report.source.text);
    let what = role.name();
    let message = format!("expected a {what} in parentheses, found {found}");
    let label = format!("not a {what}");
    report.add(
        report
            .error(Code::NotARecipe, message, tree.span.clone(), label)
            .expected(format!("a {what} in parentheses"), found)
            .hint("write `(nodes: { .. }, outputs: { .. })`"),
    );
}

fn read_field<'t>(report: &mut Report, recipe: &mut Recipe<'t>, field: &'t Field) {
    let (role, value) = (recipe.role, &field.value);
    match (field.name.text.as_str(), role) {
        (name, _) if !role.fields().contains(&name) => refuse_field(report, role, field),
        ("about", _) => recipe.about = read_text(report, field),
        ("source", _) => recipe.source = read_text(report, field),
        ("seed", _) => recipe.seed = read_whole(report, field, "2^64 - 1").unwrap_or(0),
        ("version", _) => recipe.version = read_whole(report, field, "2^32 - 1").unwrap_or(1),
        ("nodes", _) => recipe.nodes = declarations(report, value, "node"),
        ("outputs", Role::Recipe) => {
            recipe.outputs = declarations(report, value, "output");
            check_output_names(report, &recipe.outputs);
        }
        ("outputs", Role::Compound) => recipe.outlets = outlets(report, value),
        _ => recipe.parameters = declarations(report, value, role.declared()),
    }
}

fn read_text(report: &mut Report, field: &Field) -> String {
    match &field.value.shape {
        Shape::Text(text) => text.value.clone(),
        _ => {
            let expected = format!("text for `{}`", field.name.text);
            mismatch(report, &expected, &field.value);
            String::new()
        }
    }
}

fn read_whole<T: FromStr>(report: &mut Report, field: &Field, largest: &str) -> Option<T> {
    let number = report.source.text[field.value.span.clone()].parse().ok();
    if number.is_none() {
        let name = &field.name.text;
        let expected = format!("a whole number from 0 to {largest} for `{name}`");
        mismatch(report, &expected, &field.value);
    }
    number
}

fn refuse_field(report: &mut Report, role: Role, field: &Field) {
    let (unknown, what) = (field.name.text.as_str(), role.name());
    let message = format!("a {what} has no field {}", shown(unknown));
    let span = field.name.span.clone();
    let label = look_alike(unknown, &format!("not a field of a {what}"));
    let fields = role.fields();
    let mut error = report
        .error(Code::UnknownField, message, span, label)
        .nearest(nearest(unknown, fields.iter().copied()));
    error = match (role, unknown) {
        (Role::Compound, "parameters") => error.hint("what a compound exposes are its `inputs`"),
        _ => error.hint(format!("the fields of a {what} are {}", fields.join(", "))),
    };
    report.add(error);
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
