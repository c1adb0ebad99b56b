//! Builds nodes in parallel, each as soon as the ones it reads are there.

use super::event::{self, Event, Listener};
use super::memory::{Memory, Structure};
use super::plan::Plan;
use super::progress::Quiet;
use super::store::Store;
use super::verify::Verification;
use super::{Cancel, RunError, arithmetic, content, reuse};
use crate::diagnostics::{Code, Diagnostic};
use crate::field::Field;
use crate::graph::edit::item_span;
use crate::graph::{Binding, Link, Node, Source};
use crate::key::{Key, KeyHasher};
use crate::node::{Budget, Build, Failure, Inputs, field_of};
use crate::value::Value;
use petgraph::Direction;
use petgraph::graph::NodeIndex;
use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// What surrounds the building of nodes.
pub(super) struct Builder<'a> {
    pub(super) memory: &'a Memory,
    pub(super) store: Option<&'a Store>,
    pub(super) listener: &'a dyn Listener,
    pub(super) cancel: &'a Cancel,
    /// Memory for decoded files that the run has left.
    pub(super) budget: Arc<Budget>,
    /// Compares what is made with what the caches have, if that is asked for.
    pub(super) verification: Option<Verification>,
}

/// The built nodes of a plan.
pub(super) struct Built {
    cells: HashMap<NodeIndex, Cell>,
    /// What is wrong with the nodes that could not be built; nodes that read them are left out.
    pub(super) failures: Vec<Diagnostic>,
    /// How many results were compared with those in the caches.
    pub(super) compared: usize,
}

struct Cell {
    /// Nodes that it reads and that are not there yet.
    waiting: AtomicUsize,
    result: OnceLock<Option<Structure>>,
}

impl Built {
    /// Nothing of a plan.
    pub(super) fn empty(plan: &Plan<'_>) -> Built {
        let cell = |node: &NodeIndex| (*node, Cell::new(plan, *node));
        Built {
            cells: plan.order.iter().map(cell).collect(),
            failures: vec![],
            compared: 0,
        }
    }

    /// Puts a structure in its place, which must be empty.
    pub(super) fn put(&self, node: NodeIndex, structure: Structure) {
        let stored = self.cells[&node].result.set(Some(structure));
        debug_assert!(stored.is_ok(), "a node is built once");
    }

    /// Whether everything is there.
    ///
    /// # Errors
    /// What could not be built.
    pub(super) fn complete(&self) -> Result<(), RunError> {
        if self.failures.is_empty() {
            Ok(())
        } else {
            Err(RunError::Nodes(self.failures.clone()))
        }
    }

    /// Whether the node is there.
    pub(super) fn has(&self, node: NodeIndex) -> bool {
        self.structure(node).is_some()
    }

    /// The values of a node, in the order of its outputs.
    pub(super) fn values(&self, node: NodeIndex) -> &[Value] {
        &self
            .structure(node)
            .expect("only nodes that are there are asked for")
            .values
    }

    /// The content key of one output of a node.
    pub(super) fn key(&self, node: NodeIndex, output: usize) -> Key {
        self.structure(node)
            .expect("only nodes that are there are asked for")
            .keys[output]
    }

    /// What a node warned of, if it is there.
    pub(super) fn warnings(&self, node: NodeIndex) -> &[String] {
        self.structure(node)
            .map_or(&[], |structure| &structure.warnings)
    }

    fn structure(&self, node: NodeIndex) -> Option<&Structure> {
        self.cells.get(&node)?.result.get()?.as_ref()
    }
}

impl Builder<'_> {
    /// Builds every node of the plan; what could not be built is in [`Built::failures`].
    ///
    /// # Errors
    /// [`RunError::Cancelled`].
    pub(super) fn build(&self, plan: &Plan<'_>) -> Result<Built, RunError> {
        let mut built = Built::empty(plan);
        let failures = Failures::default();
        // Looked up before anything runs: later a node may be ready because another has started it.
        let ready: Vec<NodeIndex> = plan
            .order
            .iter()
            .copied()
            .filter(|node| built.cells[node].is_ready())
            .collect();
        rayon::scope(|scope| {
            for node in ready {
                let (built, failures) = (&built, &failures);
                scope.spawn(move |scope| self.run(plan, built, failures, node, scope));
            }
        });
        if self.cancel.is_cancelled() {
            return Err(RunError::Cancelled);
        }
        built.failures = failures.sorted();
        if let Some(verification) = &self.verification {
            built.failures.extend(verification.differences());
            built.compared = verification.compared();
        }
        Ok(built)
    }

    fn run<'s>(
        &'s self,
        plan: &'s Plan<'_>,
        built: &'s Built,
        failures: &'s Failures,
        index: NodeIndex,
        scope: &rayon::Scope<'s>,
    ) {
        if self.cancel.is_cancelled() {
            // Nothing is asked of what was built.
            return;
        }
        let result = self
            .build_node(plan, built, index)
            .unwrap_or_else(|failure| {
                failures.push(diagnose(plan, index, failure));
                None
            });
        let stored = built.cells[&index].result.set(result);
        debug_assert!(stored.is_ok(), "a node is built once");
        for reader in plan
            .graph
            .nodes
            .neighbors_directed(index, Direction::Outgoing)
        {
            let Some(cell) = built.cells.get(&reader) else {
                continue;
            };
            if cell.waiting.fetch_sub(1, Ordering::AcqRel) == 1 {
                scope.spawn(move |scope| self.run(plan, built, failures, reader, scope));
            }
        }
    }

    /// Builds one node, or finds it; `None` if something it reads has failed.
    fn build_node(
        &self,
        plan: &Plan<'_>,
        built: &Built,
        index: NodeIndex,
    ) -> Result<Option<Structure>, Failure> {
        let node = &plan.graph.nodes[index];
        let resolver = Resolver { plan, built, node };
        let Some(inputs) = resolver.inputs() else {
            return Ok(None);
        };
        let make = || {
            let build = Build {
                node: &node.name,
                seed: node.origin.seed,
                cancel: Some(self.cancel),
            };
            let quiet = Quiet::default();
            let tell = |fraction: f64| {
                if quiet.is_over() {
                    let node = node.name.to_string();
                    self.listener
                        .hear(Event::StructureProgress { node, fraction });
                }
            };
            let inputs = Inputs::within(node.kind, &inputs, Arc::clone(&self.budget));
            let inputs = inputs.telling(&tell);
            let values = call(|| (node.kind.build)(&inputs, &build))?;
            let keys = values.iter().map(content::key).collect();
            let (warnings, taken) = inputs.close();
            Ok(Structure {
                values,
                keys,
                warnings,
                taken,
            })
        };
        let built = if node.kind.is_structure() {
            self.structure(node, resolver.content_key(), make)?
        } else if reuse::reads_files(node) {
            self.decoded(node, resolver.content_key(), make)?
        } else {
            make()?
        };
        for message in &built.warnings {
            self.listener.hear(event::warning(node, message));
        }
        Ok(Some(built))
    }
}

impl Cell {
    fn new(plan: &Plan<'_>, node: NodeIndex) -> Cell {
        let waiting = plan
            .graph
            .nodes
            .edges_directed(node, Direction::Incoming)
            .count();
        Cell {
            waiting: AtomicUsize::new(waiting),
            result: OnceLock::new(),
        }
    }

    /// Whether it reads nothing that has to be built before.
    fn is_ready(&self) -> bool {
        self.waiting.load(Ordering::Acquire) == 0
    }
}

/// What could not be built, reported from any thread.
#[derive(Default)]
struct Failures(Mutex<Vec<Diagnostic>>);

impl Failures {
    fn push(&self, diagnostic: Diagnostic) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(diagnostic);
    }

    /// All failures in the order of the recipe.
    fn sorted(self) -> Vec<Diagnostic> {
        let mut failures = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        failures.sort_by_key(|failure| failure.label.as_ref().map(|label| label.span.start));
        failures
    }
}

/// Finds the values of a node's inputs.
pub(super) struct Resolver<'a> {
    pub(super) plan: &'a Plan<'a>,
    pub(super) built: &'a Built,
    pub(super) node: &'a Node,
}

impl Resolver<'_> {
    /// The inputs in order; `None` if something they link to has failed, or the run was cancelled.
    pub(super) fn inputs(&self) -> Option<Vec<Option<Value>>> {
        self.node
            .inputs
            .iter()
            .map(|binding| self.value(&binding.source))
            .collect()
    }

    /// `None` if a link leads to a failed node or the run was cancelled, `Some(None)` for an absent input.
    fn value(&self, source: &Source) -> Option<Option<Value>> {
        Some(match source {
            Source::Absent => None,
            Source::Literal(value) => Some(value.clone()),
            Source::File(file) => Some(Value::File(self.plan.files[file].clone())),
            Source::Link(link) => {
                Some(self.built.structure(link.node)?.values[link.output].clone())
            }
            Source::Arithmetic(expression) => {
                let is_built = |link: &Link| self.built.structure(link.node).is_some();
                if !source.links().iter().all(is_built) {
                    return None;
                }
                if let Some(number) = expression.constant(&|link| self.number(link)) {
                    return Some(Some(Value::Number(number)));
                }
                let linked = |link: &Link| self.field(link);
                let cancel = &self.plan.cancel;
                let field = arithmetic::field(&self.node.name, expression, &linked, cancel);
                Some(Value::Field(field?))
            }
            Source::Channels(channels) => {
                let mut values = vec![];
                for (name, source) in channels {
                    values.extend(self.value(source)?.map(|value| (name.clone(), value)));
                }
                Some(Value::Channels(values))
            }
        })
    }

    fn field(&self, link: &Link) -> Field {
        field_of(&self.built.values(link.node)[link.output])
            .expect("checking the recipe has ruled out other links in arithmetic")
    }

    /// What a link gives if it is the same everywhere.
    fn number(&self, link: &Link) -> Option<f64> {
        match &self.built.values(link.node)[link.output] {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// What the node is made of: its kind, its literals, and the content of what it links to.
    pub(super) fn content_key(&self) -> Key {
        let mut key = KeyHasher::new("structure", self.node.kind.version);
        key.text(self.node.kind.name);
        if self.node.kind.draws() {
            key.bytes(&self.node.origin.seed.to_le_bytes());
        }
        for Binding { source, .. } in &self.node.inputs {
            match source {
                Source::Link(link) => {
                    key.text("link").key(self.built.key(link.node, link.output));
                }
                other => match self.value(other).flatten() {
                    Some(value) => value.add_to_key(&mut key),
                    None => {
                        key.text("absent");
                    }
                },
            }
        }
        key.finish()
    }
}

/// Calls a build function; a panic in it is a failure of the node, not of the program.
fn call(make: impl FnOnce() -> Result<Vec<Value>, Failure>) -> Result<Vec<Value>, Failure> {
    catch_unwind(AssertUnwindSafe(make)).unwrap_or_else(|panic| {
        let reason = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied())
            .unwrap_or("unknown reason");
        Err(Failure::new(format!("a fault in Yosegi itself: {reason}"))
            .with_hint("report this with the recipe"))
    })
}

fn diagnose(plan: &Plan<'_>, index: NodeIndex, failure: Failure) -> Diagnostic {
    let node = &plan.graph.nodes[index];
    let blamed = failure.input.and_then(|name| node.kind.input(name));
    let span = match blamed {
        Some((position, _)) => {
            let span = &node.inputs[position].span;
            let item = failure
                .item
                .and_then(|item| item_span(&node.origin.source, span, item));
            item.unwrap_or_else(|| span.clone())
        }
        None => node.span.clone(),
    };
    let mut diagnostic = Diagnostic::error(Code::NodeFailed, failure.message)
        .at(&node.origin.source, span, "")
        .used_by(node.origin.uses.clone())
        .in_node(&*node.name);
    diagnostic.hints.extend(failure.hint);
    diagnostic
}
