//! Samples fields of any node at points of the caller's own, unfiltered and on all threads.

use super::event::Listener;
use super::{Engine, RunError};
use crate::diagnostics::{Code, Diagnostic, nearest};
use crate::field::{Field, at_points};
use crate::graph::{Graph, Link};
use crate::node::{Output, field_of};
use crate::value::{Type, Value};
use petgraph::graph::NodeIndex;

/// A field with the names of its components.
#[derive(Clone, Debug)]
pub struct SampledField {
    /// The field.
    pub field: Field,
    /// A name for each of its columns, for example `colour.r`.
    pub columns: Vec<String>,
}

impl Engine {
    /// The fields that a node gives: `name` is a node, `node.output`, or for a material `node.channel`.
    /// The use of a compound counts as a node; nodes inside are behind its name, `board/planks`.
    ///
    /// # Errors
    /// If there is no such node or it gives no fields, or if nodes cannot be built.
    pub fn fields(
        &self,
        graph: &Graph,
        name: &str,
        listener: &dyn Listener,
    ) -> Result<Vec<SampledField>, RunError> {
        let (node, part) = name
            .split_once('.')
            .map_or((name, None), |(node, part)| (node, Some(part)));
        let outputs = outputs(graph, node)?;
        let nodes: Vec<NodeIndex> = outputs.iter().map(|(_, link)| link.node).collect();
        let plan = self.plan(graph, &nodes)?;
        let built = self.threads.install(|| self.build(&plan, listener))?;
        built.complete()?;
        let value = |link: &Link| &built.values(link.node)[link.output];
        let values = outputs.iter().map(|(output, link)| (*output, value(link)));
        let fields = fields_of(values);
        let chosen: Vec<SampledField> = fields
            .iter()
            .filter(|(name, _)| part.is_none_or(|part| part == name))
            .map(|(_, field)| field.clone())
            .collect();
        if chosen.is_empty() {
            Err(no_fields(graph, node, part, &fields))
        } else {
            Ok(chosen)
        }
    }

    /// The values of fields at `points`: for each field its columns, for each column its values.
    pub fn sample(&self, fields: &[SampledField], points: &[[f64; 3]]) -> Vec<Vec<Vec<f32>>> {
        let plain: Vec<Field> = fields.iter().map(|sampled| sampled.field.clone()).collect();
        let mut context = self.context();
        context.cache = None;
        self.threads.install(|| at_points(&plain, points, &context))
    }
}

/// The outputs of a node or of the use of a compound, and where they come from.
fn outputs(graph: &Graph, name: &str) -> Result<Vec<(&'static Output, Link)>, RunError> {
    if let Some(used) = graph.uses.get(name) {
        let outputs = used.kind.outputs.iter();
        return Ok(outputs.zip(used.outputs.iter().copied()).collect());
    }
    let found = graph.by_name.get(name).map(|node| {
        let outputs = graph.nodes[*node].kind.outputs.iter().zip(0..);
        let link = |output| Link {
            node: *node,
            output,
        };
        outputs.map(|(one, output)| (one, link(output))).collect()
    });
    found.ok_or_else(|| {
        let names = graph.by_name.keys().chain(graph.uses.keys());
        let names = names.map(String::as_str);
        RunError::Request(vec![
            Diagnostic::error(
                Code::UnknownNode,
                format!("the recipe has no node `{name}`"),
            )
            .nearest(nearest(name, names)),
        ])
    })
}

/// The fields among the outputs of a node; those of a material by channel.
fn fields_of<'v>(
    values: impl Iterator<Item = (&'static Output, &'v Value)>,
) -> Vec<(String, SampledField)> {
    let mut fields = vec![];
    for (output, value) in values {
        if let Value::Material(material) = value {
            for (channel, field) in &material.channels {
                let is_colour = field.width() == 3;
                fields.push((channel.clone(), sampled(channel, field.clone(), is_colour)));
            }
        } else if let Some(field) = field_of(value) {
            let is_colour = output.value_type == Type::Colour;
            fields.push((
                output.name.to_owned(),
                sampled(output.name, field, is_colour),
            ));
        }
    }
    fields
}

fn sampled(name: &str, field: Field, is_colour: bool) -> SampledField {
    let parts: &[&str] = match (field.width(), is_colour) {
        (1, _) => {
            return SampledField {
                field,
                columns: vec![name.to_owned()],
            };
        }
        (_, true) => &["r", "g", "b"],
        (_, false) => &["x", "y", "z"],
    };
    SampledField {
        field,
        columns: parts.iter().map(|part| format!("{name}.{part}")).collect(),
    }
}

fn no_fields(
    graph: &Graph,
    node: &str,
    part: Option<&str>,
    fields: &[(String, SampledField)],
) -> RunError {
    let names: Vec<&str> = fields.iter().map(|(name, _)| name.as_str()).collect();
    let message = match part {
        Some(part) if !names.is_empty() => format!("`{node}` gives no field `{part}`"),
        _ => format!("`{node}` gives no field to sample"),
    };
    let mut diagnostic = Diagnostic::error(Code::UnknownOutput, message)
        .in_node(node)
        .nearest(nearest(part.unwrap_or_default(), names.iter().copied()));
    if let Some(node) = graph.node(node) {
        let (origin, span) = (&node.origin, node.span.clone());
        diagnostic = diagnostic
            .at(&origin.source, span, "this node")
            .used_by(origin.uses.clone());
    }
    if !names.is_empty() {
        diagnostic = diagnostic.hint(format!("it gives {}", names.join(", ")));
    }
    RunError::Request(vec![diagnostic])
}
