//! Whether a file is a recipe or a compound, and what that changes.

use super::super::tree::{Field, Shape, Tree};

/// What a file is: it decides which fields it has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::graph) enum Role {
    /// A recipe: its parameters are literals, its outputs are maps.
    #[default]
    Recipe,
    /// A kind written as a recipe: it has inputs, and its outputs are outputs of its nodes.
    Compound,
}

impl Role {
    /// The fields of such a file.
    pub(super) fn fields(self) -> &'static [&'static str] {
        match self {
            Role::Recipe => &["about", "seed", "parameters", "nodes", "outputs"],
            Role::Compound => &["about", "source", "version", "inputs", "nodes", "outputs"],
        }
    }

    /// The fields of a parameter or an input.
    pub(in crate::graph) fn declaration_fields(self) -> &'static [&'static str] {
        const ALL: &[&str] = &[
            "default",
            "range",
            "unit",
            "about",
            "of",
            "per_point",
            "domain",
            "optional",
        ];
        match self {
            Role::Recipe => &ALL[..4],
            Role::Compound => ALL,
        }
    }

    /// What such a file is called.
    pub(in crate::graph) fn name(self) -> &'static str {
        match self {
            Role::Recipe => "recipe",
            Role::Compound => "compound",
        }
    }

    /// What one of the values is called that it exposes.
    pub(in crate::graph) fn declared(self) -> &'static str {
        match self {
            Role::Recipe => "parameter",
            Role::Compound => "input",
        }
    }
}

/// What a file says it is: only compounds have inputs, or a version and outputs that are links.
pub(in crate::graph) fn role_of(tree: &Tree) -> Role {
    let Shape::Record(None, fields) = &tree.shape else {
        return Role::Recipe;
    };
    let has = |name: &str| fields.iter().any(|field| field.name.text == name);
    if has("inputs") || has("version") && fields.iter().any(holds_links) {
        Role::Compound
    } else {
        Role::Recipe
    }
}

/// Whether it is the field `outputs` of a compound.
fn holds_links(field: &Field) -> bool {
    let is_link = |tree: &Tree| match &tree.shape {
        Shape::Text(_) => true,
        Shape::Record(Some(word), _) => word.text == "output",
        _ => false,
    };
    match &field.value.shape {
        Shape::Map(entries) if field.name.text == "outputs" => {
            entries.iter().any(|entry| is_link(&entry.value))
        }
        _ => false,
    }
}
