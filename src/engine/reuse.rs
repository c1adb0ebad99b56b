//! What need not be made again: structures from memory or the store, decoded files from memory.

use super::build::Builder;
use super::content;
use super::event::{Event, From, tell_store_failed};
use super::memory::Structure;
use super::store::Family;
use crate::graph::{Node, Source};
use crate::key::{Key, KeyHasher};
use crate::node::Failure;
use std::time::Instant;

impl Builder<'_> {
    /// Fields over a decoded file from memory, or made. They are too large for the store.
    pub(super) fn decoded(
        &self,
        node: &Node,
        content_key: Key,
        make: impl FnOnce() -> Result<Structure, Failure>,
    ) -> Result<Structure, Failure> {
        let mut key = KeyHasher::new("decoded", 1);
        // The fields report what they did under the node's name.
        let key = key.key(content_key).text(&node.name).finish();
        if self.verification.is_none()
            && let Some(structure) = self.memory.structure(&key)
            && self.budget.take(structure.taken)
        {
            self.listener.hear(Event::StructureReused {
                node: node.name.to_string(),
                from: From::Memory,
            });
            return Ok(structure);
        }
        let start = Instant::now();
        let structure = self.whole(make)?;
        self.verify_decoded(node, key, &structure);
        let bytes = usize::try_from(structure.taken).unwrap_or(usize::MAX);
        self.memory
            .put_structure(key, structure.clone(), bytes, nanoseconds(start));
        self.listener.hear(Event::StructureBuilt {
            node: node.name.to_string(),
            milliseconds: nanoseconds(start) * 1e-6,
        });
        Ok(structure)
    }

    /// A structure from memory, from the store, or made.
    pub(super) fn structure(
        &self,
        node: &Node,
        key: Key,
        make: impl FnOnce() -> Result<Structure, Failure>,
    ) -> Result<Structure, Failure> {
        let name = node.name.to_string();
        let start = Instant::now();
        if self.verification.is_none()
            && let Some((structure, from)) = self.known_structure(node, key)
        {
            let reused = Event::StructureReused { node: name, from };
            self.listener.hear(reused);
            return Ok(structure);
        }
        let structure = self.whole(make)?;
        let bytes = content::encode(&structure.values, &structure.warnings);
        self.verify_structure(node, key, &bytes);
        self.memory
            .put_structure(key, structure.clone(), bytes.len(), nanoseconds(start));
        if let Some(Err(error)) = self
            .store
            .map(|store| store.put(Family::Structure, &key, &bytes))
        {
            tell_store_failed(self.listener, self.cancel, &error);
        }
        let milliseconds = nanoseconds(start) * 1e-6;
        self.listener.hear(Event::StructureBuilt {
            node: name,
            milliseconds,
        });
        Ok(structure)
    }

    /// What `make` gives, unless the run was cancelled meanwhile: then it may have broken off, and must not be
    /// remembered.
    fn whole(
        &self,
        make: impl FnOnce() -> Result<Structure, Failure>,
    ) -> Result<Structure, Failure> {
        let structure = make()?;
        if self.cancel.is_cancelled() {
            return Err(Failure::new("the run was cancelled"));
        }
        Ok(structure)
    }

    /// A structure from memory or from the store, which memory keeps then.
    fn known_structure(&self, node: &Node, key: Key) -> Option<(Structure, From)> {
        if let Some(structure) = self.memory.structure(&key) {
            return Some((structure, From::Memory));
        }
        let start = Instant::now();
        let bytes = self.store?.get(Family::Structure, &key)?;
        let structure = content::decode(node.kind, &bytes)?;
        self.memory
            .put_structure(key, structure.clone(), bytes.len(), nanoseconds(start));
        Some((structure, From::Disk))
    }
}

/// Whether the node is made of a file.
pub(super) fn reads_files(node: &Node) -> bool {
    let sources = node.inputs.iter().map(|binding| &binding.source);
    sources
        .into_iter()
        .any(|source| matches!(source, Source::File(_)))
}

fn nanoseconds(start: Instant) -> f64 {
    start.elapsed().as_nanos() as f64
}
