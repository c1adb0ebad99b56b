//! Why nodes run: what a run would do, and what has changed since the last one. Evaluates nothing.

mod changes;
mod planned;
mod reason;
mod record;
mod shown;

pub use reason::{Cause, Fate};

use super::render::{Render, chosen_outputs};
use super::{Engine, RunError};
use crate::diagnostics::{Code, Diagnostic, nearest};
use crate::graph::Graph;
use petgraph::Direction;
use petgraph::graph::NodeIndex;
use planned::PlannedRun;
use serde::Serialize;
use std::collections::HashSet;

/// What a run would do with a node and with all that is about it, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Why {
    /// Whether the store knows an earlier run of the recipe, with which this one is compared.
    pub earlier_run: bool,
    /// The node or output that was asked about.
    pub of: Explained,
    /// Where the change began that makes it run: a node it depends on, or itself; `None` if it does not
    /// run or nothing has changed.
    pub first_cause: Option<Explained>,
    /// The outputs that read it, in the order of the recipe.
    pub outputs: Vec<Explained>,
    /// The nodes that it depends on, each before those that it reads.
    pub inputs: Vec<Explained>,
}

/// One node or output: what would happen to it, and the first cause found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explained {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: String,
    /// Whether it stands under `outputs`.
    pub is_output: bool,
    /// What a run would do with it.
    pub fate: Fate,
    /// Why; `None` for what is only reused.
    pub cause: Option<Cause>,
}

impl Engine {
    /// What [`Engine::render`] would do with the node or output `name`, and why. Files are read and the
    /// caches looked into; nothing is built, evaluated or written.
    ///
    /// # Errors
    /// If there is no such node or output, or files that the recipe names cannot be read.
    pub fn why(&self, request: &Render<'_>, name: &str) -> Result<Why, RunError> {
        let graph = request.graph;
        let target = find(graph, name)?;
        let chosen = if graph.outputs.is_empty() {
            vec![]
        } else {
            chosen_outputs(request)?
        };
        let wanted: Vec<NodeIndex> = chosen.iter().copied().chain([target]).collect();
        let plan = self.plan(graph, &wanted)?;
        let run = PlannedRun::new(self, request, &plan, &chosen);
        let explain = |index: NodeIndex| run.explain(index);
        let above = ancestors(graph, &[target]);
        let inputs = plan.order.iter().rev().copied();
        let inputs = inputs.filter(|index| *index != target && above.contains(index));
        Ok(Why {
            earlier_run: run.changes.has_record(),
            of: explain(target),
            first_cause: run.first_cause(target).map(explain),
            outputs: run.readers(target).into_iter().map(explain).collect(),
            inputs: inputs.map(explain).collect(),
        })
    }
}

fn find(graph: &Graph, name: &str) -> Result<NodeIndex, RunError> {
    let output = |name: &str| {
        let mut outputs = graph.outputs.iter().copied();
        outputs.find(|index| *graph.nodes[*index].name == *name)
    };
    // Of a compound what its first output comes from.
    let inside = |name: &str| Some(graph.uses.get(name)?.outputs.first()?.node);
    let found = graph.by_name.get(name).copied();
    let found = found.or_else(|| output(name)).or_else(|| inside(name));
    found.ok_or_else(|| {
        let message = format!("the recipe has no node or output `{name}`");
        let names = graph.nodes.node_weights().map(|node| &*node.name);
        let names = names.chain(graph.uses.keys().map(String::as_str));
        let diagnostic = Diagnostic::error(Code::UnknownNode, message);
        RunError::Request(vec![diagnostic.nearest(nearest(name, names))])
    })
}

/// The nodes and all they depend on.
fn ancestors(graph: &Graph, nodes: &[NodeIndex]) -> HashSet<NodeIndex> {
    let mut found = HashSet::new();
    let mut pending = nodes.to_vec();
    while let Some(node) = pending.pop() {
        if found.insert(node) {
            pending.extend(graph.nodes.neighbors_directed(node, Direction::Incoming));
        }
    }
    found
}
