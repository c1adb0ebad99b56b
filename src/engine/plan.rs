//! What has to run for some nodes: their ancestors in order, the files these read, and plan keys.

use super::beside::Beside;
use super::{Cancel, RunError};
use crate::diagnostics::{Code, Diagnostic};
use crate::graph::{Arithmetic, Graph, NamedFile, Source};
use crate::key::{Key, KeyHasher};
use crate::value::FileContents;
use crate::world::World;
use petgraph::Direction;
use petgraph::graph::NodeIndex;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The part of a graph that some nodes depend on.
pub(super) struct Plan<'g> {
    pub(super) graph: &'g Graph,
    /// The nodes that have to run, each behind the ones it reads.
    pub(super) order: Vec<NodeIndex>,
    /// Contents of the files that they name.
    pub(super) files: HashMap<NamedFile, FileContents>,
    /// Where these files really lie.
    pub(super) places: Vec<PathBuf>,
    /// For every node in `order` what it is, before anything has run.
    pub(super) keys: HashMap<NodeIndex, Key>,
    /// Stops the run.
    pub(super) cancel: Cancel,
}

impl<'g> Plan<'g> {
    /// Plans what `wanted` needs, and reads the files it names.
    pub(super) fn new(
        graph: &'g Graph,
        wanted: &[NodeIndex],
        world: &dyn World,
        cancel: &Cancel,
    ) -> Result<Plan<'g>, RunError> {
        let order = ancestors(graph, wanted);
        let ReadFiles { files, places } = read_files(graph, &order, world)?;
        let mut plan = Plan {
            graph,
            order,
            files,
            places,
            keys: HashMap::new(),
            cancel: cancel.clone(),
        };
        for index in plan.order.clone() {
            let key = plan.node_key(index);
            if cancel.is_cancelled() {
                return Err(RunError::Cancelled);
            }
            plan.keys.insert(index, key);
        }
        Ok(plan)
    }

    /// The plan for some of the nodes, with the files as they were read: to read them again might give
    /// others than the keys speak of.
    pub(super) fn part(&self, wanted: &[NodeIndex]) -> Plan<'g> {
        Plan {
            graph: self.graph,
            order: ancestors(self.graph, wanted),
            files: self.files.clone(),
            places: self.places.clone(),
            keys: self.keys.clone(),
            cancel: self.cancel.clone(),
        }
    }

    fn node_key(&self, index: NodeIndex) -> Key {
        let node = &self.graph.nodes[index];
        let mut key = KeyHasher::new("node", node.kind.version);
        key.text(node.kind.name);
        if node.kind.draws() {
            key.bytes(&node.origin.seed.to_le_bytes());
        }
        node.inputs
            .iter()
            .for_each(|input| self.add_source(&mut key, &input.source));
        key.finish()
    }

    /// Identifies the literal of an input, or all that it is linked to.
    pub(super) fn source_key(&self, source: &Source) -> Key {
        let mut key = KeyHasher::new("source", 1);
        self.add_source(&mut key, source);
        key.finish()
    }

    fn add_source(&self, key: &mut KeyHasher, source: &Source) {
        match source {
            Source::Absent => {
                key.text("absent");
            }
            Source::Literal(value) => value.add_to_key(key),
            Source::File(file) => {
                self.files[file].add_to_key(key);
            }
            Source::Link(link) => {
                key.text("link")
                    .key(self.keys[&link.node])
                    .whole(link.output as i64);
            }
            Source::Arithmetic(arithmetic) => self.add_arithmetic(key, arithmetic),
            Source::Channels(channels) => {
                key.text("channels").whole(channels.len() as i64);
                for (name, source) in channels {
                    self.add_source(key.text(name), source);
                }
            }
        }
    }

    fn add_arithmetic(&self, key: &mut KeyHasher, arithmetic: &Arithmetic) {
        if self.cancel.is_cancelled() {
            // Expressions may be long; nobody wants the key any more.
            return;
        }
        match arithmetic {
            Arithmetic::Number(number) => {
                key.text("number").number(*number);
            }
            Arithmetic::Link(link) => self.add_source(key, &Source::Link(*link)),
            Arithmetic::Negate(inner) => self.add_arithmetic(key.text("negate"), inner),
            Arithmetic::Binary(operator, sides) => {
                key.text("binary").whole(*operator as i64);
                sides.iter().for_each(|side| self.add_arithmetic(key, side));
            }
            Arithmetic::Call(function, arguments) => {
                key.text("call")
                    .whole(*function as i64)
                    .whole(arguments.len() as i64);
                arguments
                    .iter()
                    .for_each(|argument| self.add_arithmetic(key, argument));
            }
        }
    }
}

/// `wanted` and all they depend on, each node behind the ones it reads.
pub(super) fn ancestors(graph: &Graph, wanted: &[NodeIndex]) -> Vec<NodeIndex> {
    let mut needed = vec![false; graph.nodes.node_count()];
    let mut pending = wanted.to_vec();
    while let Some(node) = pending.pop() {
        if !std::mem::replace(&mut needed[node.index()], true) {
            pending.extend(graph.nodes.neighbors_directed(node, Direction::Incoming));
        }
    }
    petgraph::algo::toposort(&graph.nodes, None)
        .expect("a checked graph has no cycle")
        .into_iter()
        .filter(|node| needed[node.index()])
        .collect()
}

/// What the nodes read, and where it lies.
struct ReadFiles {
    files: HashMap<NamedFile, FileContents>,
    places: Vec<PathBuf>,
}

fn read_files(
    graph: &Graph,
    order: &[NodeIndex],
    world: &dyn World,
) -> Result<ReadFiles, RunError> {
    let mut folders: HashMap<&Path, Beside<'_>> = HashMap::new();
    let mut places = vec![];
    let mut files = HashMap::new();
    let mut errors = vec![];
    for index in order {
        let node = &graph.nodes[*index];
        for (input, binding) in node.kind.inputs.iter().zip(&node.inputs) {
            let Source::File(file) = &binding.source else {
                continue;
            };
            if files.contains_key(file) {
                continue;
            }
            let (folder, path) = (&*file.folder, &file.path);
            let beside = folders
                .entry(folder)
                .or_insert_with(|| Beside::new(world, folder, graph.allow_outside));
            match beside.read(path) {
                Ok((place, bytes)) => {
                    places.push(place);
                    let contents = FileContents {
                        path: path.clone(),
                        bytes: bytes.into(),
                    };
                    files.insert(file.clone(), contents);
                }
                Err(error) => errors.push(
                    Diagnostic::error(
                        Code::FileNotRead,
                        format!("cannot read `{}`: {error}", path.display()),
                    )
                    .at(
                        &node.origin.source,
                        binding.span.clone(),
                        format!("named by `{}`", input.name),
                    )
                    .used_by(node.origin.uses.clone())
                    .in_node(&*node.name)
                    .hint(format!(
                        "files are looked for in `{0}`, in `{0}/assets` and in `{0}/../assets`; links out of \
                         these are followed with `--allow-outside` only",
                        shown(folder)
                    )),
                ),
            }
        }
    }
    if errors.is_empty() {
        Ok(ReadFiles { files, places })
    } else {
        Err(RunError::Files(errors))
    }
}

/// The folder as a person would write it.
fn shown(folder: &Path) -> String {
    if folder.as_os_str().is_empty() {
        ".".to_owned()
    } else {
        folder.display().to_string()
    }
}
