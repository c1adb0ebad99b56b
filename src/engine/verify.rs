//! Verification of the caches: what they would have given is made again and compared.
//!
//! A difference means that the results of a kind have changed without a new version, or that the store was
//! tampered with. It is an error that names the node or output; what the cache holds is replaced.

use super::build::{Builder, Built};
use super::content;
use super::event::{Event, Listener};
use super::memory::{Memory, Structure};
use super::render::{Output, WantedMap};
use super::store::Family;
use super::write::Written;
use super::{Engine, RunError, known::OutputRecord};
use crate::diagnostics::{Code, Diagnostic};
use crate::field::{ColumnCache, Columns};
use crate::graph::Node;
use crate::key::Key;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// What a run has compared so far.
#[derive(Default)]
pub(super) struct Verification {
    compared: AtomicUsize,
    differences: Mutex<Vec<Diagnostic>>,
}

impl Verification {
    fn compare(&self, is_same: bool, difference: impl FnOnce() -> Diagnostic) {
        self.compared.fetch_add(1, Ordering::Relaxed);
        if !is_same {
            let differences = self.differences.lock();
            let mut differences = differences.unwrap_or_else(PoisonError::into_inner);
            differences.push(difference());
        }
    }

    /// How many results were compared.
    pub(super) fn compared(&self) -> usize {
        self.compared.load(Ordering::Relaxed)
    }

    /// What is wrong, in the order of the recipe.
    pub(super) fn differences(&self) -> Vec<Diagnostic> {
        let differences = self.differences.lock();
        let mut differences = differences.unwrap_or_else(PoisonError::into_inner).clone();
        let place = |it: &Diagnostic| it.label.as_ref().map(|label| label.span.start);
        differences.sort_by(|a, b| (place(a), &a.message).cmp(&(place(b), &b.message)));
        // The tiles of a column differ in nothing but their keys.
        differences.dedup_by(|a, b| a.label == b.label && a.hints == b.hints);
        differences
    }
}

/// `what` is "the structure", "the map `height`" and the like.
fn difference(node: &Node, what: &str, cache: &str, key: &Key) -> Diagnostic {
    let (name, kind) = (&node.name, node.kind.name);
    let message = format!(
        "{what} of `{name}` ({kind}) is not what {cache} has under the key {}",
        key.hexadecimal()
    );
    Diagnostic::error(Code::CacheMismatch, message)
        .at(
            &node.origin.source,
            node.span.clone(),
            "made again, this differs",
        )
        .used_by(node.origin.uses.clone())
        .in_node(&*node.name)
        .hint(format!(
            "{what} was replaced; a kind whose results change needs a new version"
        ))
}

impl Builder<'_> {
    /// Compares a structure that was made with those that the caches have.
    pub(super) fn verify_structure(&self, node: &Node, key: Key, made: &[u8]) {
        let Some(verification) = &self.verification else {
            return;
        };
        let in_memory = self.memory.structure(&key);
        let on_disk = self.store.and_then(|it| it.get(Family::Structure, &key));
        let on_disk = on_disk.and_then(|bytes| content::decode(node.kind, &bytes));
        for (cache, structure) in [("the memory", in_memory), ("the store", on_disk)] {
            let Some(Structure {
                values, warnings, ..
            }) = structure
            else {
                continue;
            };
            let is_same = content::encode(&values, &warnings) == made;
            verification.compare(is_same, || difference(node, "the structure", cache, &key));
        }
    }

    /// Compares fields over a decoded file with those in memory.
    pub(super) fn verify_decoded(&self, node: &Node, key: Key, made: &Structure) {
        if let Some(verification) = &self.verification
            && let Some(known) = self.memory.structure(&key)
        {
            let is_same = known.keys == made.keys && known.warnings == made.warnings;
            verification.compare(is_same, || {
                difference(node, "what was read", "the memory", &key)
            });
        }
    }
}

impl Output<'_> {
    /// Compares maps that were painted, and what is known of the output, with what the store has.
    pub(super) fn verify<'m>(
        &self,
        made: &OutputRecord,
        painted: impl Iterator<Item = (&'m WantedMap, Written)>,
    ) {
        let Some((verification, store)) =
            self.verification.as_ref().zip(self.engine.store.as_ref())
        else {
            return;
        };
        let node = &self.request.graph.nodes[self.index];
        let plan = self.plan_key();
        if let Some(known) = self.engine.planned(self.name(), &plan) {
            verification.compare(known == *made, || {
                difference(node, "what is known", "the store", &plan)
            });
        }
        for (map, written) in painted {
            let Some(known) = store.map(&map.key) else {
                continue;
            };
            let is_same = written.record() == Some(known);
            let what = format!("the map `{}`", map.channel);
            verification.compare(is_same, || difference(node, &what, "the store", &map.key));
        }
    }

    /// The columns in memory, to be compared with those that are computed.
    pub(super) fn verified_columns(&self) -> Option<VerifiedColumns<'_>> {
        let memory = self
            .engine
            .memory
            .is_enabled()
            .then_some(&self.engine.memory);
        Some(VerifiedColumns {
            output: self,
            verification: self.verification.as_ref()?,
            memory: memory?,
        })
    }
}

/// Gives no columns, and compares what is computed with what is in memory.
pub(super) struct VerifiedColumns<'a> {
    output: &'a Output<'a>,
    verification: &'a Verification,
    memory: &'a Memory,
}

impl ColumnCache for VerifiedColumns<'_> {
    fn get(&self, _: &Key) -> Option<Columns> {
        None
    }

    fn put(&self, node: &str, key: Key, columns: Columns, nanoseconds: f64) {
        if let Some(known) = self.memory.get(&key) {
            let graph = self.output.request.graph;
            let index = graph.by_name.get(node).unwrap_or(&self.output.index);
            self.verification.compare(are_same(&known, &columns), || {
                difference(&graph.nodes[*index], "a column", "the memory", &key)
            });
        }
        self.memory.put(node, key, columns, nanoseconds);
    }
}

/// Whether columns are the same bit by bit.
fn are_same(known: &Columns, made: &Columns) -> bool {
    let bits = |columns: &Columns| -> Vec<Vec<u32>> {
        let column = |column: &Vec<f32>| column.iter().map(|it| it.to_bits()).collect();
        columns.iter().map(column).collect()
    };
    bits(known) == bits(made)
}

impl Engine {
    /// Ends a run: says what was compared.
    ///
    /// # Errors
    /// What could not be built, and all differences.
    pub(super) fn judge(
        &self,
        built: &Built,
        outputs: &[Output<'_>],
        listener: &dyn Listener,
    ) -> Result<(), RunError> {
        let verifications = || outputs.iter().filter_map(|it| it.verification.as_ref());
        if self.options.verify {
            let compared = verifications().map(Verification::compared);
            listener.hear(Event::CacheVerified {
                compared: built.compared + compared.sum::<usize>(),
            });
        }
        let mut wrong = built.failures.clone();
        wrong.extend(verifications().flat_map(Verification::differences));
        match wrong.is_empty() {
            true => Ok(()),
            false => Err(RunError::Nodes(wrong)),
        }
    }
}
