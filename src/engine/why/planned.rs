//! What a run would do with each node, as far as that is known before it.

use super::changes::Changes;
use super::{Cause, Explained, Fate, ancestors};
use crate::engine::Engine;
use crate::engine::files::Protected;
use crate::engine::known::map_path;
use crate::engine::look_up::Place;
use crate::engine::plan::Plan;
use crate::engine::render::{Output, Render};
use petgraph::graph::NodeIndex;
use std::collections::{HashMap, HashSet};

/// A run that has not begun.
pub(super) struct PlannedRun<'a> {
    engine: &'a Engine,
    request: &'a Render<'a>,
    plan: &'a Plan<'a>,
    pub(super) changes: Changes<'a>,
    places: HashMap<NodeIndex, Place>,
    outputs: Vec<PlannedOutput>,
}

/// One of the outputs that are asked for.
struct PlannedOutput {
    index: NodeIndex,
    fate: Fate,
    /// Itself and all it depends on.
    reads: HashSet<NodeIndex>,
}

impl<'a> PlannedRun<'a> {
    pub(super) fn new(
        engine: &'a Engine,
        request: &'a Render<'a>,
        plan: &'a Plan<'a>,
        chosen: &[NodeIndex],
    ) -> PlannedRun<'a> {
        let record = engine.run_record(plan.graph);
        let output = |output: Output<'_>| PlannedOutput {
            index: output.index,
            fate: fate_of(&output, record.is_some()),
            reads: ancestors(plan.graph, &[output.index]),
        };
        let store = engine.options.store.as_deref();
        let protected = Protected::new(&*engine.world, plan, store);
        let outputs = engine.outputs(request, plan, &protected, chosen);
        PlannedRun {
            engine,
            request,
            plan,
            outputs: outputs.into_iter().map(output).collect(),
            changes: Changes::new(record, plan, request.pixels),
            places: engine.look_up(plan),
        }
    }

    pub(super) fn explain(&self, index: NodeIndex) -> Explained {
        let node = &self.plan.graph.nodes[index];
        let fate = self.fate(index);
        Explained {
            name: node.name.to_string(),
            kind: node.kind.name.to_owned(),
            is_output: self.plan.graph.outputs.contains(&index),
            fate,
            cause: self.cause(index, fate),
        }
    }

    /// The outputs that read a node; an output does not read itself.
    pub(super) fn readers(&self, index: NodeIndex) -> Vec<NodeIndex> {
        let others = self.outputs.iter().filter(|output| output.index != index);
        let readers = others.filter(|output| output.reads.contains(&index));
        readers.map(|output| output.index).collect()
    }

    /// The node at which a change began that leads to `index`, if that is going to run.
    pub(super) fn first_cause(&self, index: NodeIndex) -> Option<NodeIndex> {
        let runs = !matches!(self.fate(index), Fate::NotNeeded | Fate::UpToDate);
        runs.then(|| self.changes.origin(index)).flatten()
    }

    fn painted(&self) -> impl Iterator<Item = &PlannedOutput> {
        let outputs = self.outputs.iter();
        outputs.filter(|output| matches!(output.fate, Fate::Painted | Fate::PaintedUnlessKnown))
    }

    fn fate(&self, index: NodeIndex) -> Fate {
        if let Some(output) = self.outputs.iter().find(|output| output.index == index) {
            return output.fate;
        }
        if !self.painted().any(|output| output.reads.contains(&index)) {
            return Fate::NotNeeded;
        }
        match self.places.get(&index) {
            None => Fate::Evaluated,
            Some(Place::Memory) => Fate::ReusedFromMemory,
            Some(Place::Disk) => Fate::ReusedFromDisk,
            Some(Place::Nowhere) => Fate::Built,
            Some(Place::Unknown) => Fate::BuiltUnlessKnown,
        }
    }

    fn cause(&self, index: NodeIndex, fate: Fate) -> Option<Cause> {
        let change = || self.changes.of(index);
        match fate {
            Fate::UpToDate => None,
            Fate::Restored => Some(Cause::FileNotThere),
            Fate::NotNeeded if self.readers(index).is_empty() => Some(Cause::NotRead),
            Fate::NotNeeded => Some(Cause::OutputsUpToDate),
            Fate::ReusedFromMemory | Fate::ReusedFromDisk => change(),
            Fate::Evaluated => change().or_else(|| self.painted_reader(index)),
            Fate::Built | Fate::BuiltUnlessKnown => change().or_else(|| Some(self.not_stored())),
            Fate::Painted | Fate::PaintedUnlessKnown => {
                let lost = self.lost_map(index).or_else(change);
                lost.or_else(|| Some(self.not_stored()))
            }
        }
    }

    fn not_stored(&self) -> Cause {
        if self.engine.store.is_none() {
            Cause::NoStore
        } else if self.changes.has_record() {
            Cause::NotInStore
        } else {
            Cause::NothingKnown
        }
    }

    /// The first output that is painted and reads the node.
    fn painted_reader(&self, index: NodeIndex) -> Option<Cause> {
        let reader = self
            .painted()
            .find(|output| output.reads.contains(&index))?;
        let output = self.plan.graph.nodes[reader.index].name.to_string();
        Some(Cause::OutputPainted { output })
    }

    /// The first map of an output that has been written before and is neither there nor in the store.
    fn lost_map(&self, index: NodeIndex) -> Option<Cause> {
        let (name, node) = (&self.plan.graph.nodes[index].name, self.plan.keys[&index]);
        let key = self.engine.output_key(name, node, self.request.pixels);
        let maps = self.engine.planned(name, &key)?.maps;
        let path = maps.iter().find_map(|map| {
            let path = map_path(&self.request.folder, map);
            let known = self.engine.known_map(map, path.clone());
            known.is_none().then_some(path)
        })?;
        Some(Cause::MapLost { path })
    }
}

fn fate_of(output: &Output<'_>, has_record: bool) -> Fate {
    match output.known() {
        Some(known) if known.maps.iter().all(|map| map.is_there) => Fate::UpToDate,
        Some(_) => Fate::Restored,
        // Under its present plan it has been made before: some map is gone.
        None if output
            .engine
            .planned(output.name(), &output.plan_key())
            .is_some() =>
        {
            Fate::Painted
        }
        None if has_record => Fate::PaintedUnlessKnown,
        None => Fate::Painted,
    }
}
