//! The record of a recipe's last run: what every node was made from, so that `why` can say what changed.
//!
//! It lies in the store as an entry of its own, so a damaged one is a miss. No result depends on it.

use super::shown;
use crate::engine::Engine;
use crate::engine::content::is_plain;
use crate::engine::plan::Plan;
use crate::engine::store::Family;
use crate::graph::Graph;
use crate::key::{Key, KeyHasher};
use petgraph::graph::NodeIndex;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io;
use std::path::{Component, Path, PathBuf};

/// Raised when the layout of the record changes: an older one is then not found.
const LAYOUT: u32 = 1;

/// What the nodes and the outputs of a recipe were when they last ran.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct RunRecord {
    pub(super) nodes: BTreeMap<String, NodeRecord>,
    pub(super) outputs: BTreeMap<String, NodeRecord>,
}

/// What a node was made from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct NodeRecord {
    pub(super) kind: String,
    pub(super) version: u32,
    /// The recipe's seed.
    pub(super) seed: u64,
    /// The size that the caller asked for; of outputs only.
    pub(super) pixels: Option<[u32; 2]>,
    pub(super) plan: Key,
    pub(super) inputs: Vec<InputRecord>,
}

/// What an input was.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct InputRecord {
    pub(super) name: String,
    /// Identifies its literal, or all that it is linked to.
    pub(super) key: Key,
    /// In words.
    pub(super) shown: String,
}

impl NodeRecord {
    /// What a node of the plan is made from.
    pub(super) fn new(plan: &Plan<'_>, index: NodeIndex, pixels: Option<[u32; 2]>) -> NodeRecord {
        let node = &plan.graph.nodes[index];
        let bindings = node.kind.inputs.iter().zip(&node.inputs);
        let inputs = bindings.map(|(input, binding)| InputRecord {
            name: input.name.to_owned(),
            key: plan.source_key(&binding.source),
            shown: shown::source(plan.graph, &binding.source),
        });
        NodeRecord {
            kind: node.kind.name.to_owned(),
            version: node.kind.version,
            seed: node.origin.seed,
            pixels,
            plan: plan.keys[&index],
            inputs: inputs.collect(),
        }
    }
}

impl Engine {
    /// The record of the last run of a recipe.
    pub(super) fn run_record(&self, graph: &Graph) -> Option<RunRecord> {
        let bytes = self.store.as_ref()?.get(Family::Run, &record_key(graph))?;
        let record: Option<RunRecord> = postcard::from_bytes(&bytes).ok();
        record.filter(RunRecord::is_sound)
    }

    /// Remembers what ran: the nodes of the plan anew, the recipe's others as they were.
    ///
    /// # Errors
    /// Whatever the store says.
    pub(in crate::engine) fn record_run(
        &self,
        plan: &Plan<'_>,
        pixels: Option<[u32; 2]>,
    ) -> io::Result<()> {
        let Some(store) = &self.store else {
            return Ok(());
        };
        let known = self.run_record(plan.graph);
        let mut record = known.clone().unwrap_or_default();
        for index in &plan.order {
            let name = plan.graph.nodes[*index].name.to_string();
            if plan.graph.outputs.contains(index) {
                let output = NodeRecord::new(plan, *index, pixels);
                record.outputs.insert(name, output);
            } else {
                record
                    .nodes
                    .insert(name, NodeRecord::new(plan, *index, None));
            }
        }
        record.forget_others(plan.graph);
        if known.as_ref() == Some(&record) {
            return Ok(());
        }
        let bytes = postcard::to_stdvec(&record).map_err(io::Error::other)?;
        store.put(Family::Run, &record_key(plan.graph), &bytes)
    }
}

impl RunRecord {
    /// Whether its texts can be shown.
    fn is_sound(&self) -> bool {
        let mut nodes = self.nodes.values().chain(self.outputs.values());
        nodes.all(|node| {
            let mut inputs = node.inputs.iter();
            is_plain(&node.kind) && inputs.all(|it| is_plain(&it.name) && is_plain(&it.shown))
        })
    }

    /// Forgets what the recipe no longer has.
    fn forget_others(&mut self, graph: &Graph) {
        self.nodes
            .retain(|name, _| graph.by_name.contains_key(name));
        let is_output = |name: &str| {
            let mut outputs = graph.outputs.iter();
            outputs.any(|index| *graph.nodes[*index].name == *name)
        };
        self.outputs.retain(|name, _| is_output(name));
    }
}

/// Where the record of a recipe lies: it is known by its path.
fn record_key(graph: &Graph) -> Key {
    let path = &graph.source.path;
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.clone());
    KeyHasher::new("run", LAYOUT)
        .text(&plain(&whole).to_string_lossy())
        .finish()
}

/// The path without `..`. Behind a symbolic link that may be another recipe's: the comparison is then
/// with that one, and nothing worse.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        if part == Component::ParentDir {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}
