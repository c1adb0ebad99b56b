//! Renaming, and what refers to a name.

use super::literal::quoted;
use super::place::{Finder, Problem, entries, key, problem};
use super::references::{self, Reference};
use super::{Change, Section};
use crate::diagnostics::{Code, Diagnostic};
use crate::graph::names::shown;
use std::collections::BTreeMap;

impl<'t> Finder<'t> {
    pub(super) fn rename(
        &self,
        section: Section,
        from: &str,
        to: &str,
    ) -> Result<Vec<Change>, Problem> {
        let (_, _, entry) = self.entry(section, from)?;
        if from == to {
            return Ok(vec![]);
        }
        self.check_new_name(section, to)?;
        let mut changes = vec![Change::new(entry.key.span.clone(), format!("\"{to}\""))];
        if section != Section::Outputs {
            let references = self.references(section, from)?;
            changes.extend(renamed(references.iter().map(|(_, one)| one), to));
        }
        Ok(changes)
    }

    /// Refuses to go on if something refers to the node or the parameter.
    pub(super) fn refuse_used(&self, section: Section, name: &str) -> Result<(), Problem> {
        let references = self.references(section, name)?;
        let users = references
            .iter()
            .filter(|(user, _)| section != Section::Nodes || *user != Some(name));
        let Some((user, reference)) = users.into_iter().next() else {
            return Ok(());
        };
        let user = user.unwrap_or_default();
        let message = format!(
            "{} {} is used by {}",
            section.item(),
            shown(name),
            shown(user)
        );
        let span = reference.tree.span.clone();
        Err(Box::new(
            Diagnostic::error(Code::InvalidEdit, message)
                .at(self.source, span, "used here")
                .in_node(user)
                .hint("change what uses it first"),
        ))
    }

    /// What refers to a node or a parameter, each with the name of the node or output it is in.
    fn references(
        &self,
        section: Section,
        name: &str,
    ) -> Result<Vec<(Option<&'t str>, Reference<'t>)>, Problem> {
        let mut found = vec![];
        for of in [Section::Nodes, Section::Outputs] {
            let Some(tree) = self.section(of)? else {
                continue;
            };
            for entry in entries(tree) {
                let Some(kind) = self.kind(&entry.value) else {
                    return Err(self.unknown_kind(entry));
                };
                let references = references::of_instance(kind, &entry.value).into_iter();
                let of_name = references.filter(|one| {
                    one.is_parameter == (section == Section::Parameters)
                        && one.text.value[one.bytes.clone()] == *name
                });
                found.extend(of_name.map(|one| (key(entry), one)));
            }
        }
        Ok(found)
    }

    fn unknown_kind(&self, entry: &crate::graph::tree::Entry) -> Problem {
        let name = key(entry).unwrap_or_default();
        let message = format!(
            "{} is of no known kind, so what it refers to is not known",
            shown(name)
        );
        let mut problem = problem(Code::UnknownKind, message);
        *problem = problem.at(self.source, entry.value.span.clone(), "");
        problem
    }
}

/// The names replaced; a text with escapes is written anew, since its letters have no places of their own.
fn renamed<'r>(references: impl Iterator<Item = &'r Reference<'r>>, to: &str) -> Vec<Change> {
    let mut by_text: BTreeMap<usize, Vec<&Reference<'_>>> = BTreeMap::new();
    for reference in references {
        let start = reference.tree.span.start;
        by_text.entry(start).or_default().push(reference);
    }
    let mut changes = vec![];
    for references in by_text.into_values() {
        let (tree, text) = (references[0].tree, references[0].text);
        match text.verbatim {
            Some(start) => changes.extend(
                references
                    .iter()
                    .map(|one| Change::new(start + one.bytes.start..start + one.bytes.end, to)),
            ),
            None => {
                let inner = references
                    .iter()
                    .map(|one| Change::new(one.bytes.clone(), to));
                let inner: Vec<_> = inner.collect();
                let value = super::applied(&text.value, &inner);
                changes.push(Change::new(tree.span.clone(), quoted(&value)));
            }
        }
    }
    changes
}
