//! Looks for structures in the caches without building anything.

use super::build::{Built, Resolver};
use super::memory::Structure;
use super::plan::Plan;
use super::store::Family;
use super::{Engine, content};
use crate::key::Key;
use crate::node::Kind;
use petgraph::graph::NodeIndex;
use std::collections::HashMap;

/// Where a structure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Memory,
    Disk,
    /// In neither.
    Nowhere,
    /// It depends on something that is not there, so what it would be looked up by is not known yet.
    Unknown,
}

impl Engine {
    /// Where each structure of a plan is.
    pub(super) fn look_up(&self, plan: &Plan<'_>) -> HashMap<NodeIndex, Place> {
        let built = Built::empty(plan);
        let mut places = HashMap::new();
        for index in &plan.order {
            let node = &plan.graph.nodes[*index];
            if !node.kind.is_structure() {
                continue;
            }
            let resolver = Resolver {
                plan,
                built: &built,
                node,
            };
            let place = match resolver.inputs() {
                None => Place::Unknown,
                Some(_) => match self.find(node.kind, &resolver.content_key()) {
                    None => Place::Nowhere,
                    Some((structure, place)) => {
                        built.put(*index, structure);
                        place
                    }
                },
            };
            places.insert(*index, place);
        }
        places
    }

    fn find(&self, kind: &Kind, key: &Key) -> Option<(Structure, Place)> {
        if let Some(structure) = self.memory.structure(key) {
            return Some((structure, Place::Memory));
        }
        let bytes = self.store.as_ref()?.get(Family::Structure, key)?;
        content::decode(kind, &bytes).map(|structure| (structure, Place::Disk))
    }
}
