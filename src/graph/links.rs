//! Links: finding the node and the output, and whether the input takes what it gives.

use super::compound::Layout;
use super::described::described_unit;
use super::instead::instead_of_text;
use super::literal::{Reader, Slot};
use super::names::{look_alike, shown};
use super::{Link, Source};
use crate::diagnostics::{Code, Diagnostic, Span, nearest};
use crate::node::{Input, Kind, Output, Varies};
use crate::value::{Type, Unit};
use petgraph::graph::NodeIndex;

/// Nodes that are looked at for one that gives what an input takes.
const COMPARED: usize = 5000;

/// What links can lead to: the nodes of one file, from an index on.
#[derive(Debug)]
pub(super) struct Scope<'t> {
    /// The nodes.
    pub(super) layout: &'t Layout<'t>,
    /// The index of the first.
    pub(super) base: usize,
}

/// An output that a link leads to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// The link.
    pub(super) link: Link,
    /// What the kind declares.
    pub(super) output: &'static Output,
    /// The kind of the node that the link names.
    kind: &'static Kind,
}

/// Checks the links of one node.
#[derive(Debug)]
pub(super) struct Linker<'c, 's> {
    /// Reads literals and keeps mistakes.
    pub(super) reader: Reader<'c>,
    /// What links can lead to.
    pub(super) scope: &'s Scope<'s>,
    /// The node or output that is checked.
    pub(super) index: NodeIndex,
}

impl Linker<'_, '_> {
    /// The output that `node` or `node.output` names.
    pub(super) fn find(&mut self, text: &str, span: Span) -> Option<Found> {
        self.find_for(text, span, None)
    }

    /// The same, for the input that it is linked to.
    fn find_for(&mut self, text: &str, span: Span, input: Option<&Input>) -> Option<Found> {
        let (node, output) = match text.split_once('.') {
            Some((node, output)) => (node, Some(output)),
            None => (text, None),
        };
        let Some(slot) = self.scope.layout.slot(node) else {
            return self.refuse_unknown_node(text, node, span, input);
        };
        let index = |offset| NodeIndex::new(self.scope.base + offset);
        if slot.inside.is_none() && index(slot.offset) == self.index {
            let message = format!("node {} takes its own output", shown(node));
            return self
                .reader
                .refuse(Code::SelfLink, message, span, "this node itself", |e| e);
        }
        let kind = slot.kind?;
        let position = match output {
            None => 0,
            Some(name) => match kind.output(name) {
                Some((position, _)) => position,
                None => return self.refuse_unknown_output(node, kind, name, span),
            },
        };
        let place = slot.output(position)?;
        Some(Found {
            link: Link {
                node: index(place.offset),
                output: place.output,
            },
            output: kind.outputs.get(position)?,
            kind,
        })
    }

    /// The link, if the input takes what it leads to.
    pub(super) fn link(&mut self, text: &str, span: Span, input: &Input) -> Option<Source> {
        let found = self.find_for(text, span.clone(), Some(input))?;
        self.accept(&found, text, span.clone(), input)?;
        self.constant(&found, text, span, input)?;
        Some(Source::Link(found.link))
    }

    /// Whether the types match.
    fn accept(&mut self, found: &Found, text: &str, span: Span, input: &Input) -> Option<()> {
        let (expected, given) = (input.value_type, found.output.value_type);
        if expected == given {
            return Some(());
        }
        if let Some((expected, given)) = units(expected, given) {
            let (name, text) = (shown(input.name), shown(text));
            let label = format!("is {}", described_unit(given));
            let message = format!("{name} is {}, {text} {label}", described_unit(expected));
            return self
                .reader
                .refuse(Code::UnitMismatch, message, span, label, |error| {
                    error
                        .expected(expected.symbol(), given.symbol())
                        .hint(conversion(given))
                });
        }
        self.refuse_type(found, text, span, Slot::from(input))
    }

    /// Reports an output of another type than the input takes.
    pub(super) fn refuse_type<T>(
        &mut self,
        found: &Found,
        text: &str,
        span: Span,
        slot: Slot<'_>,
    ) -> Option<T> {
        let (expected, given) = (slot.value_type, found.output.value_type);
        let message = format!(
            "expected {expected} for {}, {} gives {given}",
            shown(slot.name),
            shown(text)
        );
        let node = text.split('.').next().unwrap_or(text);
        let suits = |output: &&Output| output.value_type == expected;
        let is_number = |output: &&Output| expected.is_number() && output.value_type.is_number();
        let outputs = || found.kind.outputs.iter();
        let other = outputs().find(suits).or_else(|| outputs().find(is_number));
        let mut near: Vec<_> = other
            .map(|output| format!("{node}.{}", output.name))
            .into_iter()
            .collect();
        if near.is_empty() {
            near = self.giving(expected);
        }
        let label = format!("gives {given}");
        self.reader
            .refuse(Code::LinkMismatch, message, span, label, |error| {
                let is_colour = matches!((expected, given), (Type::Number(_), Type::Colour));
                let mut error = error.expected(expected, given).nearest(near);
                if is_colour && error.nearest.is_empty() {
                    error = error.hint(
                        "make a number of a colour by arithmetic: `\"= luminance(node.colour)\"`",
                    );
                }
                error
            })
    }

    /// Up to three links that give `wanted`, of the nodes above this one, the nearest first.
    fn giving(&self, wanted: Type) -> Vec<String> {
        let layout = self.scope.layout;
        let nodes = layout.names.iter().zip(&layout.slots);
        let own = self.index.index();
        let above = nodes.take_while(|(_, slot)| self.scope.base + slot.offset < own);
        let above: Vec<_> = above.collect();
        let links = above
            .into_iter()
            .rev()
            .take(COMPARED)
            .filter_map(|(name, slot)| {
                let outputs = slot.kind?.outputs;
                let position = outputs.iter().position(|o| o.value_type == wanted)?;
                Some(match position {
                    0 => (*name).to_owned(),
                    position => format!("{name}.{}", outputs[position].name),
                })
            });
        links.take(3).collect()
    }

    /// Whether the input may vary if the output does.
    pub(super) fn constant(
        &mut self,
        found: &Found,
        text: &str,
        span: Span,
        input: &Input,
    ) -> Option<()> {
        let varies = found.output.varies == Varies::PerPoint;
        if !varies || input.varies == Varies::PerPoint || input.value_type == Type::Material {
            return Some(());
        }
        let message = format!(
            "{} must be constant, {} differs from point to point",
            shown(input.name),
            shown(text)
        );
        self.reader.refuse(
            Code::NotConstant,
            message,
            span,
            "differs from point to point",
            |error| {
                error
                    .expected("a constant", "a field")
                    .hint("write a literal or a parameter; of a compound of yours, declare the input with `per_point: true`")
            },
        )
    }

    fn refuse_unknown_node<T>(
        &mut self,
        text: &str,
        node: &str,
        span: Span,
        input: Option<&Input>,
    ) -> Option<T> {
        let message = format!("there is no node {}", shown(node));
        let layout = self.scope.layout;
        let names = nearest(node, layout.names.iter().copied());
        let written = input.filter(|_| names.is_empty());
        let instead = written.and_then(|input| instead_of_text(text, input.name, input.value_type));
        let is_output = layout.output_names.contains(&node);
        let is_number = text.parse::<f64>().is_ok();
        let label = look_alike(node, "no node has this name");
        self.reader
            .refuse(Code::UnknownNode, message, span, label, |error| {
                let error = error.nearest(names);
                match (is_output, is_number) {
                    (true, _) => {
                        error.hint("it is an output of the recipe, and links lead to nodes")
                    }
                    (_, true) => error.hint("write numbers without quotes"),
                    _ => instead.into_iter().fold(error, Diagnostic::hint),
                }
            })
    }

    fn refuse_unknown_output<T>(
        &mut self,
        node: &str,
        kind: &'static Kind,
        name: &str,
        span: Span,
    ) -> Option<T> {
        let names: Vec<_> = kind.outputs.iter().map(|output| output.name).collect();
        let message = format!(
            "node {} ({}) has no output {}",
            shown(node),
            kind.name,
            shown(name)
        );
        self.reader.refuse(
            Code::UnknownOutput,
            message,
            span,
            "no such output",
            |error| {
                error
                    .nearest(nearest(name, names.iter().copied()))
                    .hint(format!(
                        "the outputs of `{}` are {}",
                        kind.name,
                        names.join(", ")
                    ))
            },
        )
    }
}

/// How to get from a unit to that of an input.
fn conversion(given: Unit) -> &'static str {
    match given {
        Unit::One => {
            "arithmetic without units such as `\"= 2 * node.output\"` is in the input's unit"
        }
        _ => {
            "units are not converted; multiply or divide by a number with a unit, in arithmetic such as \
             `\"= node.output / 20 mm\"` or `\"= 3 mm/year * node.output\"`"
        }
    }
}

/// The units of two types that differ in nothing else.
pub(super) fn units(expected: Type, given: Type) -> Option<(Unit, Unit)> {
    match (expected, given) {
        (Type::Number(expected), Type::Number(given))
        | (Type::Vector(expected), Type::Vector(given))
        | (Type::Pair(expected), Type::Pair(given)) => Some((expected, given)),
        _ => None,
    }
}
