//! Inputs of nodes: what a recipe writes for one, as a literal, a file, a link, arithmetic or channels.

use super::composite::default_literal;
use super::links::Linker;
use super::literal::{Slot, parameter_name};
use super::names::shown;
use super::parameters::Declared;
use super::recipe::{key, report_duplicate_name};
use super::text_literal::TextLiteral;
use super::tree::{Shape, Tree};
use super::{Binding, NamedFile, Source};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::node::{Input, Presence};
use crate::value::{Type, Unit, Value};
use std::collections::HashMap;
use std::path::PathBuf;

impl Linker<'_, '_> {
    /// What an input is bound to; `node` is the place of the node's name, and `declared` what a compound
    /// declares as the input.
    pub(super) fn bind(
        &mut self,
        owner: &str,
        (input, declared): (&'static Input, Option<&Declared>),
        tree: Option<&Tree>,
        node: &Span,
    ) -> Option<Binding> {
        let span = tree.map_or(node, |tree| &tree.span).clone();
        let is_given = |tree: &&Tree| {
            // What a compound was not given counts as not written, where nothing need be.
            input.presence == Presence::Required || !self.is_left_out(tree)
        };
        let source = match (tree.filter(is_given), input.presence) {
            (Some(tree), _) => self.source(tree, input)?,
            (None, Presence::Optional) => Source::Absent,
            (None, Presence::Default(text)) => match declared {
                // Files among the defaults lie beside the compound.
                Some(declared) => declared.default.clone()?,
                None => self.default_source(input, text),
            },
            (None, Presence::Required) => {
                return self.reader.refuse_missing(owner, input, node.clone());
            }
        };
        Some(Binding { span, source })
    }

    fn source(&mut self, tree: &Tree, input: &'static Input) -> Option<Source> {
        let slot = Slot::from(input);
        if let Shape::Text(text) = &tree.shape
            && let Some(name) = parameter_name(&text.value)
        {
            self.may_vary(name, tree.span.clone(), input)?;
        }
        if !matches!(input.value_type, Type::Channels | Type::Materials)
            && let Some(passed) = self.passed(tree, slot)
        {
            return passed;
        }
        match (input.value_type, &tree.shape) {
            (Type::File, _) => self.file(tree, slot),
            (Type::Channels | Type::Materials, Shape::Map(_)) => self.channels(tree, input),
            (Type::Materials, Shape::Text(text)) => {
                let link = self.material(tree, input)?;
                Some(Source::Channels(vec![(text.value.clone(), link)]))
            }
            (Type::Text | Type::Choice(_) | Type::Names, _) => {
                self.reader.literal(tree, slot).map(Source::Literal)
            }
            (_, Shape::Text(text)) => self.text_source(tree, text, input),
            _ => self.reader.literal(tree, slot).map(Source::Literal),
        }
    }

    /// What a string means where it is not text.
    fn text_source(&mut self, tree: &Tree, text: &TextLiteral, input: &Input) -> Option<Source> {
        let slot = Slot::from(input);
        let is_colour = input.value_type == Type::Colour && text.value.starts_with('#');
        if parameter_name(&text.value).is_some() || is_colour {
            return self.reader.literal(tree, slot).map(Source::Literal);
        }
        match (text.value.strip_prefix('='), input.value_type) {
            (None, _) => self.link(&text.value, tree.span.clone(), input),
            (Some(_), Type::Number(_)) => self.arithmetic(tree, text, input, slot),
            (Some(_), Type::Whole) => self.reader.literal(tree, slot).map(Source::Literal),
            (Some(_), expected) => {
                let name = shown(input.name);
                let message = format!("expected {expected} for {name}, found arithmetic");
                let span = tree.span.clone();
                self.reader.refuse(
                    Code::TypeMismatch,
                    message,
                    span,
                    "gives a number",
                    |error| arithmetic_in_parts(error.expected(expected, "arithmetic"), expected),
                )
            }
        }
    }

    /// A path in the recipe's folder, written the same on every system.
    fn file(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<Source> {
        let Value::Text(path) = self.reader.literal(tree, slot)? else {
            return None;
        };
        Some(Source::File(NamedFile::beside(
            &self.reader.report.source,
            PathBuf::from(path),
        )))
    }

    /// A map from names to numbers, colours and, by links, vectors; or to materials.
    fn channels(&mut self, tree: &Tree, input: &Input) -> Option<Source> {
        let Shape::Map(entries) = &tree.shape else {
            return None;
        };
        let mut seen: HashMap<&str, Span> = HashMap::new();
        let mut channels = vec![];
        for entry in entries {
            let Some(name) = key(self.reader.report, entry, "a channel") else {
                continue;
            };
            let span = entry.key.span.clone();
            if let Some(first) = seen.insert(name, span.clone()) {
                report_duplicate_name(self.reader.report, "channel", name, span, first);
            }
            let channel = match input.value_type {
                Type::Materials => self.material(&entry.value, input),
                _ => self.channel(name, &entry.value, input),
            };
            channels.extend(channel.map(|source| (name.to_owned(), source)));
        }
        (channels.len() == entries.len()).then_some(Source::Channels(channels))
    }

    /// A link to a material, one of those that an input takes.
    fn material(&mut self, tree: &Tree, input: &Input) -> Option<Source> {
        let one = Input {
            value_type: Type::Material,
            ..*input
        };
        match &tree.shape {
            Shape::Text(text) if parameter_name(&text.value).is_none() => {
                self.text_source(tree, text, &one)
            }
            _ => self.reader.mismatch(tree, Slot::from(&one)),
        }
    }

    /// A number or a colour, whichever it is, or a link to one or to a vector.
    fn channel(&mut self, name: &str, tree: &Tree, input: &Input) -> Option<Source> {
        let colour = Slot {
            name,
            value_type: Type::Colour,
            range: input.range,
        };
        let number = colour.of(Type::Number(Unit::One));
        let text = match &tree.shape {
            Shape::Text(text) => text,
            Shape::Number | Shape::Name(_) => {
                return self.reader.literal(tree, number).map(Source::Literal);
            }
            Shape::Tuple(None, _) | Shape::List(_) => {
                return self.reader.literal(tree, colour).map(Source::Literal);
            }
            _ => return self.reader.mismatch(tree, number),
        };
        if let Some(parameter) = parameter_name(&text.value) {
            let declared = self.reader.parameters.refer(parameter);
            let (value_type, unit) =
                declared.map_or((None, Unit::One), |(one, _)| (one.value_type, one.unit));
            let slot = if value_type == Some(Type::Colour) {
                colour
            } else {
                number.of(Type::Number(unit))
            };
            if let Some(passed) = self.passed(tree, slot) {
                return passed;
            }
            return self.reader.literal(tree, slot).map(Source::Literal);
        }
        if text.value.starts_with('#') {
            return self.reader.literal(tree, colour).map(Source::Literal);
        }
        if text.value.starts_with('=') {
            return self.arithmetic(tree, text, input, colour.of(input.value_type));
        }
        let found = self.find(&text.value, tree.span.clone())?;
        let fits = matches!(
            found.output.value_type,
            Type::Number(_) | Type::Colour | Type::Vector(Unit::One)
        );
        if !fits {
            return self.refuse_type(&found, &text.value, tree.span.clone(), number);
        }
        self.constant(&found, &text.value, tree.span.clone(), input)?;
        Some(Source::Link(found.link))
    }

    /// A default that a kind declares; the tests of kinds make sure that it is valid.
    fn default_source(&self, input: &'static Input, text: &str) -> Source {
        match (input.value_type, default_literal(input, text)) {
            (Type::File, Value::Text(path)) => {
                let source = &self.reader.report.source;
                Source::File(NamedFile::beside(source, PathBuf::from(path)))
            }
            (_, value) => Source::Literal(value),
        }
    }
}

fn arithmetic_in_parts(error: Diagnostic, expected: Type) -> Diagnostic {
    match expected {
        Type::Vector(_) | Type::Pair(_) | Type::Colour => {
            error.hint("write arithmetic for each part: `(\"= 2 * $x\", ..)`")
        }
        _ => error,
    }
}
