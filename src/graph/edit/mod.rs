//! Edits of a recipe's text that leave every other byte as it is.
//!
//! A recipe belongs to its author: layout, comments and the way numbers are written stay. So an edit is a
//! list of [`Change`]s, each a range of bytes and what takes its place, found through the same tree that
//! recipes are read from; the file is never printed anew. Recipes with mistakes can be edited as well, as
//! long as they are valid RON. The files of compounds cannot be edited yet, the recipes that use them can.
//!
//! ```
//! use std::sync::Arc;
//! use yosegi::diagnostics::SourceFile;
//! use yosegi::graph::edit::{Edit, Place, Section, apply};
//! use yosegi::nodes::KINDS;
//!
//! let text = "(nodes: { \"w\": material(roughness: 0.6 /* matt */) })";
//! let source = Arc::new(SourceFile::new("board.ron", text));
//! let place = Place::input(Section::Nodes, "w", "roughness");
//! let edit = Edit::Set { place, literal: "0.35".into() };
//! let edited = apply(KINDS, &source, &edit).expect("the input is there");
//! assert_eq!(edited, text.replace("0.6", "0.35"));
//! ```

mod layout;
mod literal;
mod place;
mod references;
mod rename;

use super::report::Report;
use super::text;
use super::tree::Tree;
use crate::diagnostics::{Code, Diagnostic, SourceFile, Span};
use crate::node::Kind;
use place::Finder;
use std::sync::Arc;

/// What stands in braces at the top of a recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Section {
    /// `parameters`
    Parameters,
    /// `nodes`
    Nodes,
    /// `outputs`
    Outputs,
}

/// Where in a recipe something is written.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// A field of the recipe itself: `about` or `seed`.
    Recipe(String),
    /// A field of a parameter, an input of a node or of an output, or a part of it.
    Field {
        /// Where the parameter, node or output stands.
        section: Section,
        /// Its name.
        name: String,
        /// The field or the input.
        field: String,
        /// From the value of the field to a part of it; empty for the whole.
        path: Vec<Step>,
    },
}

/// A step into a value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// An item of a list, a tuple, a vector or a colour, counted from 0.
    Item(usize),
    /// A field of a record.
    Part(String),
    /// An entry of a map.
    Entry(String),
}

/// What is to be changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edit {
    /// Writes a value, in place of the one that is there or as a new field, entry or last item.
    Set {
        /// Where.
        place: Place,
        /// One RON value, with nothing but space around it.
        literal: String,
    },
    /// Takes a field, an entry or an item away, so that its default holds.
    Remove {
        /// What.
        place: Place,
    },
    /// Gives another name; links to a node and references to a parameter follow, in arithmetic as well.
    Rename {
        /// Where it stands.
        section: Section,
        /// The name that it has.
        from: String,
        /// The name that it gets.
        to: String,
    },
    /// Adds a parameter, a node or an output behind the others.
    Add {
        /// Where it is to stand.
        section: Section,
        /// Its name.
        name: String,
        /// What it is, for example `mix(a: "look", b: "#7a4524", amount: 0.5)`.
        instance: String,
    },
    /// Takes away a parameter, a node or an output that nothing refers to.
    Delete {
        /// Where it stands.
        section: Section,
        /// Its name.
        name: String,
    },
}

/// Bytes of a recipe and what takes their place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// The bytes; empty where something is inserted.
    pub span: Span,
    /// What takes their place.
    pub text: String,
}

impl Change {
    fn new(span: Span, text: impl Into<String>) -> Change {
        Change {
            span,
            text: text.into(),
        }
    }

    fn insert(at: usize, text: impl Into<String>) -> Change {
        Change::new(at..at, text)
    }
}

impl Section {
    /// Every section.
    pub const ALL: [Section; 3] = [Section::Parameters, Section::Nodes, Section::Outputs];

    /// The field of the recipe.
    pub fn name(self) -> &'static str {
        ["parameters", "nodes", "outputs"][self as usize]
    }

    /// What stands in it, for messages.
    fn item(self) -> &'static str {
        ["parameter", "node", "output"][self as usize]
    }

    /// The mistake of naming something that is not there.
    fn unknown(self) -> Code {
        [Code::UnknownParameter, Code::UnknownNode, Code::NoOutput][self as usize]
    }
}

impl Place {
    /// The whole value of a field or an input.
    pub fn input(section: Section, name: impl Into<String>, field: impl Into<String>) -> Place {
        Place::Field {
            section,
            name: name.into(),
            field: field.into(),
            path: vec![],
        }
    }
}

/// The recipe after an edit.
///
/// # Errors
/// As [`changes`].
pub fn apply(
    kinds: &[&'static Kind],
    source: &Arc<SourceFile>,
    edit: &Edit,
) -> Result<String, Vec<Diagnostic>> {
    let changes = changes(kinds, source, edit)?;
    Ok(applied(&source.text, &changes))
}

/// What an edit changes, in the order of the file and without overlaps.
///
/// # Errors
/// If the recipe is not valid RON, if what is to be changed is not there or is there twice, if the value or
/// the name is not valid, or if something still refers to what is to be deleted. Nothing is checked beyond
/// that: a value of the wrong type is reported when the recipe is loaded.
pub fn changes(
    kinds: &[&'static Kind],
    source: &Arc<SourceFile>,
    edit: &Edit,
) -> Result<Vec<Change>, Vec<Diagnostic>> {
    let tree = read(source)?;
    let finder = Finder {
        source,
        root: &tree,
        kinds,
    };
    let mut changes = finder.changes(edit).map_err(|problem| vec![*problem])?;
    changes.sort_by_key(|change| (change.span.start, change.span.end));
    changes.retain(|change| source.text[change.span.clone()] != change.text);
    // Depth and size have limits that only the whole can meet.
    if !changes.is_empty() {
        let edited = applied(&source.text, &changes);
        read(&Arc::new(SourceFile::new(&*source.path, edited)))?;
    }
    Ok(changes)
}

/// The bytes of a value; `None` if it is not written.
///
/// # Errors
/// As [`changes`].
pub fn find(source: &Arc<SourceFile>, place: &Place) -> Result<Option<Span>, Vec<Diagnostic>> {
    let tree = read(source)?;
    let finder = Finder {
        source,
        root: &tree,
        kinds: &[],
    };
    let slot = finder.slot(place).map_err(|problem| vec![*problem])?;
    Ok(slot.value().map(|value| value.span.clone()))
}

/// The bytes of an item of the list that is written at `span`, if one is.
pub fn item_span(source: &SourceFile, span: &Span, item: usize) -> Option<Span> {
    let literal = SourceFile::new(&*source.path, source.text.get(span.clone())?);
    let tree = read(&Arc::new(literal)).ok()?;
    let item = &tree.items()?.get(item)?.span;
    Some(span.start + item.start..span.start + item.end)
}

/// Where outputs are missing, and what a label says there: the empty braces, or the end of the recipe.
pub(super) fn outputs_place(source: &Arc<SourceFile>) -> (Span, &'static str) {
    let nothing = (0..0, "");
    let Ok(tree) = read(source) else {
        return nothing;
    };
    let finder = Finder {
        source,
        root: &tree,
        kinds: &[],
    };
    match finder.section(Section::Outputs) {
        Ok(Some(braces)) => (braces.span.clone(), "`outputs` is empty"),
        _ => (
            tree.span.end - 1..tree.span.end,
            "`outputs` is missing here",
        ),
    }
}

fn read(source: &Arc<SourceFile>) -> Result<Tree, Vec<Diagnostic>> {
    let mut report = Report::new(source);
    match text::read(&mut report) {
        Some(tree) => Ok(tree),
        None if report.has_errors() => Err(report.finish()),
        None => Err(vec![Diagnostic::error(
            Code::NotARecipe,
            "the file holds no recipe",
        )]),
    }
}

fn applied(text: &str, changes: &[Change]) -> String {
    let mut edited = String::with_capacity(text.len() + 64);
    let mut end = 0;
    for change in changes {
        edited.push_str(&text[end..change.span.start]);
        edited.push_str(&change.text);
        end = change.span.end;
    }
    edited.push_str(&text[end..]);
    edited
}
