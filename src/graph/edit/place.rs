//! Finding what an edit speaks of, and what it changes.

use super::layout::Container;
use super::literal::{container, one_value, quoted};
use super::{Change, Edit, Place, Section, Step};
use crate::diagnostics::{Code, Diagnostic, SourceFile, nearest};
use crate::graph::names::{check_name, shown};
use crate::graph::report::Report;
use crate::graph::tree::{Entry, Field, Shape, Tree, Word};
use crate::node::Kind;
use std::sync::Arc;

/// A reason not to edit.
pub(super) type Problem = Box<Diagnostic>;

/// Finds places in one recipe.
pub(super) struct Finder<'t> {
    pub(super) source: &'t Arc<SourceFile>,
    pub(super) root: &'t Tree,
    pub(super) kinds: &'t [&'static Kind],
}

/// Where a value is, or would be.
pub(super) enum Slot<'t> {
    /// The value, what it is in, and which of its items it is.
    There(&'t Tree, Container, usize),
    /// It would be the last item of the container, written with this before it.
    Missing(Container, String),
}

impl<'t> Slot<'t> {
    pub(super) fn value(&self) -> Option<&'t Tree> {
        match self {
            Slot::There(value, ..) => Some(value),
            Slot::Missing(..) => None,
        }
    }
}

impl<'t> Finder<'t> {
    pub(super) fn changes(&self, edit: &Edit) -> Result<Vec<Change>, Problem> {
        match edit {
            Edit::Set { place, literal } => self.set(place, literal),
            Edit::Remove { place } => match self.slot(place)? {
                Slot::There(_, container, index) => Ok(container.remove(self.text(), index)),
                Slot::Missing(..) => Err(problem(
                    Code::InvalidEdit,
                    "there is nothing to remove: what is not written has its default",
                )),
            },
            Edit::Rename { section, from, to } => self.rename(*section, from, to),
            Edit::Add {
                section,
                name,
                instance,
            } => self.add(*section, name, instance),
            Edit::Delete { section, name } => self.delete(*section, name),
        }
    }

    pub(super) fn text(&self) -> &'t str {
        &self.source.text
    }

    fn set(&self, place: &Place, literal: &str) -> Result<Vec<Change>, Problem> {
        let (literal, _) = one_value(literal)?;
        Ok(match self.slot(place)? {
            Slot::There(value, ..) => vec![Change::new(value.span.clone(), literal)],
            Slot::Missing(container, key) => {
                container.append(self.text(), &format!("{key}{literal}"))
            }
        })
    }

    fn add(&self, section: Section, name: &str, instance: &str) -> Result<Vec<Change>, Problem> {
        self.check_new_name(section, name)?;
        let (instance, tree) = one_value(instance)?;
        let is_instance = match &tree.shape {
            Shape::Record(Some(_), _) => true,
            Shape::Tuple(Some(_), values) => values.is_empty(),
            _ => false,
        };
        if !is_instance {
            let message = format!(
                "expected an instance such as `mix(amount: 0.5)`, found {}",
                shown(instance)
            );
            return Err(problem(Code::NotANode, message));
        }
        let item = format!("\"{name}\": {instance}");
        Ok(match self.section(section)? {
            Some(tree) => container(tree).append(self.text(), &item),
            None => {
                let field = format!("{}: {{ {item} }}", section.name());
                container(self.root).append(self.text(), &field)
            }
        })
    }

    fn delete(&self, section: Section, name: &str) -> Result<Vec<Change>, Problem> {
        let (map, index, _) = self.entry(section, name)?;
        if section != Section::Outputs {
            self.refuse_used(section, name)?;
        }
        Ok(container(map).remove(self.text(), index))
    }

    /// Whether `name` can be given to something new.
    pub(super) fn check_new_name(&self, section: Section, name: &str) -> Result<(), Problem> {
        let source = Arc::new(SourceFile::new("", name));
        let mut report = Report::new(&source);
        check_name(&mut report, section.item(), name, 0..name.len());
        if let Some(mut wrong) = report.finish().pop() {
            (wrong.source, wrong.label) = (None, None);
            return Err(Box::new(wrong));
        }
        let is_taken = match self.section(section)? {
            Some(tree) => entries(tree).iter().any(|entry| key_is(entry, name)),
            None => false,
        };
        if is_taken {
            let message = format!(
                "there is a {} called {} already",
                section.item(),
                shown(name)
            );
            return Err(problem(Code::DuplicateName, message));
        }
        Ok(())
    }

    /// Where a value is, or would be.
    pub(super) fn slot(&self, place: &Place) -> Result<Slot<'t>, Problem> {
        match place {
            Place::Recipe(field) if ["about", "seed"].contains(&field.as_str()) => {
                self.part(self.root, field)
            }
            Place::Recipe(field) => Err(problem(
                Code::UnknownField,
                format!("expected `about` or `seed`, found {}", shown(field)),
            )),
            Place::Field {
                section,
                name,
                field,
                path,
            } => {
                let (_, _, entry) = self.entry(*section, name)?;
                self.check_field(*section, &entry.value, field)?;
                let mut slot = self.part(&entry.value, field)?;
                for step in path {
                    let Slot::There(value, ..) = slot else {
                        return Err(problem(
                            Code::MissingInput,
                            format!("{} is not written, so it has no parts", shown(field)),
                        ));
                    };
                    slot = self.step(value, step)?;
                }
                Ok(slot)
            }
        }
    }

    fn step(&self, value: &'t Tree, step: &Step) -> Result<Slot<'t>, Problem> {
        match step {
            Step::Item(index) => self.item(value, *index),
            Step::Part(name) => self.part(value, name),
            Step::Entry(name) => match &value.shape {
                Shape::Map(entries) => {
                    let of_name = |(_, entry): &(usize, &'t Entry)| key_is(entry, name);
                    let found = entries.iter().enumerate().filter(of_name);
                    let found = found.map(|(index, entry)| (index, &entry.value));
                    self.only(value, found.collect(), name, format!("{}: ", quoted(name)))
                }
                _ => Err(self.no_such(value, "a map in braces")),
            },
        }
    }

    fn item(&self, value: &'t Tree, index: usize) -> Result<Slot<'t>, Problem> {
        let (Shape::List(items) | Shape::Tuple(None, items)) = &value.shape else {
            return Err(self.no_such(value, "a list or a tuple"));
        };
        match items.get(index) {
            Some(item) => Ok(Slot::There(item, container(value), index)),
            None if index == items.len() => Ok(Slot::Missing(container(value), String::new())),
            None => {
                let message = format!("there is no item {index}, only {}", items.len());
                let problem = Diagnostic::error(Code::WrongLength, message);
                Err(Box::new(problem.at(
                    self.source,
                    value.span.clone(),
                    "this",
                )))
            }
        }
    }

    /// A field of a record, of an instance or of the recipe.
    fn part(&self, value: &'t Tree, name: &str) -> Result<Slot<'t>, Problem> {
        let fields: &[Field] = match &value.shape {
            Shape::Record(_, fields) => fields,
            Shape::Tuple(_, items) if items.is_empty() => &[],
            _ => return Err(self.no_such(value, "fields in parentheses")),
        };
        let of_name = |(_, field): &(usize, &'t Field)| field.name.text == name;
        let found = fields.iter().enumerate().filter(of_name);
        let found = found.map(|(index, field)| (index, &field.value));
        let found: Vec<_> = found.collect();
        if found.is_empty() && !is_bare_name(name) {
            let message = format!("{} is no name for a field", shown(name));
            return Err(problem(Code::InvalidName, message));
        }
        self.only(value, found, name, format!("{name}: "))
    }

    fn only(
        &self,
        value: &'t Tree,
        found: Vec<(usize, &'t Tree)>,
        name: &str,
        key: String,
    ) -> Result<Slot<'t>, Problem> {
        match found.as_slice() {
            [] => Ok(Slot::Missing(container(value), key)),
            [(index, found)] => Ok(Slot::There(found, container(value), *index)),
            [_, (_, second), ..] => {
                let message = format!("{} is written twice", shown(name));
                let problem = Diagnostic::error(Code::DuplicateField, message);
                Err(Box::new(problem.at(
                    self.source,
                    second.span.clone(),
                    "again here",
                )))
            }
        }
    }

    fn no_such(&self, value: &Tree, expected: &str) -> Problem {
        let found = value.described(self.text());
        let message = format!("expected {expected}, found {found}");
        let problem = Diagnostic::error(Code::TypeMismatch, message);
        let problem = problem.at(self.source, value.span.clone(), "");
        Box::new(problem.expected(expected, found))
    }

    /// The braces of a section; `None` if the recipe does not have it.
    pub(super) fn section(&self, section: Section) -> Result<Option<&'t Tree>, Problem> {
        match self.part(self.root, section.name())? {
            Slot::There(tree, ..) if matches!(tree.shape, Shape::Map(_)) => Ok(Some(tree)),
            Slot::There(tree, ..) => Err(self.no_such(tree, "entries in braces")),
            Slot::Missing(..) => Ok(None),
        }
    }

    /// An entry of a section, with the section and its position there.
    pub(super) fn entry(
        &self,
        section: Section,
        name: &str,
    ) -> Result<(&'t Tree, usize, &'t Entry), Problem> {
        let tree = self.section(section)?;
        let entries = tree.map_or(&[][..], entries);
        let found = entries.iter().enumerate();
        let mut found = found.filter(|(_, entry)| key_is(entry, name));
        match (tree, found.next(), found.next()) {
            (Some(tree), Some((index, entry)), None) => Ok((tree, index, entry)),
            (_, _, Some((_, second))) => {
                let message = format!("there are two {}s called {}", section.item(), shown(name));
                let problem = Diagnostic::error(Code::DuplicateName, message);
                let span = second.key.span.clone();
                Err(Box::new(problem.at(self.source, span, "again here")))
            }
            _ => {
                let message = format!("the recipe has no {} {}", section.item(), shown(name));
                let names = entries.iter().filter_map(key);
                let problem = Diagnostic::error(section.unknown(), message);
                Err(Box::new(problem.nearest(nearest(name, names))))
            }
        }
    }

    /// Refuses inputs that the kind does not have, if the kind is known.
    fn check_field(&self, section: Section, instance: &Tree, field: &str) -> Result<(), Problem> {
        let known: Vec<&str> = match (section, self.kind(instance)) {
            (Section::Parameters, _) => vec!["default", "range", "unit", "about"],
            (_, Some(kind)) => kind.inputs.iter().map(|input| input.name).collect(),
            (_, None) => return Ok(()),
        };
        if known.contains(&field) {
            return Ok(());
        }
        let message = format!("{} is not one of {}", shown(field), known.join(", "));
        let problem = Diagnostic::error(Code::UnknownInput, message);
        Err(Box::new(problem.nearest(nearest(field, known))))
    }

    /// The kind of an instance, if it is known.
    pub(super) fn kind(&self, instance: &Tree) -> Option<&'static Kind> {
        let (Shape::Record(Some(Word { text, .. }), _) | Shape::Tuple(Some(Word { text, .. }), _)) =
            &instance.shape
        else {
            return None;
        };
        self.kinds.iter().copied().find(|kind| kind.name == text)
    }
}

pub(super) fn problem(code: Code, message: impl Into<String>) -> Problem {
    Box::new(Diagnostic::error(code, message))
}

pub(super) fn entries(tree: &Tree) -> &[Entry] {
    match &tree.shape {
        Shape::Map(entries) => entries,
        _ => &[],
    }
}

pub(super) fn key(entry: &Entry) -> Option<&str> {
    match &entry.key.shape {
        Shape::Text(text) => Some(&text.value),
        _ => None,
    }
}

fn key_is(entry: &Entry, name: &str) -> bool {
    key(entry) == Some(name)
}

/// Whether a field can be called so without quotes.
fn is_bare_name(name: &str) -> bool {
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    name.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_')
        && name.chars().all(is_letter)
}
