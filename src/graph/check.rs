//! Every node against its kind.

use super::links::{Linker, Scope};
use super::literal::Reader;
use super::names::{look_alike, shown};
use super::parameters::Parameters;
use super::recipe::{Declaration, Recipe};
use super::report::Report;
use super::{Binding, Node};
use crate::diagnostics::{Code, Span, nearest};
use crate::node::Kind;
use crate::value::{Domain, Type};
use petgraph::graph::NodeIndex;
use std::sync::Arc;

/// A node or an output while it is checked.
#[derive(Debug)]
pub(super) struct Draft {
    /// The name.
    pub(super) name: Arc<str>,
    /// Where the name is.
    pub(super) span: Span,
    /// The kind; `None` if there is none by that name, which is reported.
    pub(super) kind: Option<&'static Kind>,
    /// One entry for each input; `None` where something is wrong, which is reported.
    pub(super) bindings: Vec<Option<Binding>>,
    /// Where the outputs are defined; `None` until it is known.
    pub(super) domain: Option<Domain>,
    /// Whether it stands under `outputs`.
    pub(super) is_output: bool,
}

impl Draft {
    /// The node, if nothing is wrong with it.
    pub(super) fn finish(self) -> Option<Node> {
        Some(Node {
            name: self.name,
            kind: self.kind?,
            span: self.span,
            inputs: self.bindings.into_iter().collect::<Option<_>>()?,
            domain: self.domain?,
        })
    }
}

/// Checks the nodes, then the outputs, in the order of the file.
pub(super) fn check(
    report: &mut Report,
    recipe: &Recipe<'_>,
    parameters: &mut Parameters,
    kinds: &[&'static Kind],
) -> Vec<Draft> {
    let mut scope = Scope::default();
    for (index, node) in recipe.nodes.iter().enumerate() {
        scope.nodes.insert(node.name, NodeIndex::new(index));
        scope.names.push(node.name);
    }
    scope.outputs = recipe.outputs.iter().map(|output| output.name).collect();
    let declarations = || {
        let nodes = recipe.nodes.iter().map(|node| (node, false));
        nodes.chain(recipe.outputs.iter().map(|output| (output, true)))
    };
    for (declaration, is_output) in declarations() {
        let kind = find_kind(report, declaration, is_output, kinds);
        scope.kinds.push(kind);
    }
    let mut drafts = vec![];
    for (index, (declaration, is_output)) in declarations().enumerate() {
        let reader = Reader::new(parameters, report, Some(declaration.name));
        let mut linker = Linker {
            reader,
            scope: &scope,
            index: NodeIndex::new(index),
        };
        // What comes after too many mistakes is not reported anyway.
        let kind = scope.kinds[index].filter(|_| !linker.reader.report.is_full());
        let bindings = kind.map(|kind| bind_inputs(&mut linker, declaration, kind));
        drafts.push(Draft {
            name: declaration.name.into(),
            span: declaration.span.clone(),
            kind,
            bindings: bindings.unwrap_or_default(),
            domain: None,
            is_output,
        });
    }
    drafts
}

fn bind_inputs(
    linker: &mut Linker<'_, '_>,
    declaration: &Declaration<'_>,
    kind: &'static Kind,
) -> Vec<Option<Binding>> {
    let owner = format!("an input of `{}`", kind.name);
    let found = linker
        .reader
        .assign(&owner, kind.inputs, declaration.fields);
    let inputs = kind.inputs.iter().zip(found);
    inputs
        .map(|(input, tree)| linker.bind(&owner, input, tree, &declaration.span))
        .collect()
}

/// The kind of a node or an output; an output gives maps and a node does not.
fn find_kind(
    report: &mut Report,
    declaration: &Declaration<'_>,
    is_output: bool,
    kinds: &[&'static Kind],
) -> Option<&'static Kind> {
    let word = declaration.kind?;
    let gives_maps = |kind: &Kind| {
        kind.outputs
            .first()
            .is_some_and(|o| o.value_type == Type::Maps)
    };
    let Some(kind) = kinds.iter().copied().find(|kind| kind.name == word.text) else {
        let fitting = kinds.iter().filter(|kind| gives_maps(kind) == is_output);
        let message = format!("there is no kind {}", shown(&word.text));
        let label = look_alike(&word.text, "no kind has this name");
        report.add(
            report
                .error(Code::UnknownKind, message, word.span.clone(), label)
                .in_node(declaration.name)
                .nearest(nearest(&word.text, fitting.map(|kind| kind.name)))
                .hint("run `yosegi nodes` for the list of kinds"),
        );
        return None;
    };
    if gives_maps(kind) != is_output {
        let (is, belongs) = if is_output {
            ("gives no maps", "nodes")
        } else {
            ("gives maps", "outputs")
        };
        let message = format!("`{}` {is}, so it belongs under `{belongs}`", kind.name);
        report.add(
            report
                .error(Code::NotAnOutput, message, word.span.clone(), is)
                .in_node(declaration.name)
                .hint(format!("move it to `{belongs}`")),
        );
    }
    Some(kind)
}
