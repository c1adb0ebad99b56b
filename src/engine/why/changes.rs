//! What has changed in a recipe since its last run.

use super::Cause;
use super::record::{NodeRecord, RunRecord};
use crate::engine::plan::Plan;
use crate::graph::{Binding, Source};
use petgraph::graph::NodeIndex;

/// The nodes of a plan against the record of the last run.
pub(super) struct Changes<'a> {
    record: Option<RunRecord>,
    plan: &'a Plan<'a>,
    pixels: Option<[u32; 2]>,
}

impl<'a> Changes<'a> {
    pub(super) fn new(
        record: Option<RunRecord>,
        plan: &'a Plan<'a>,
        pixels: Option<[u32; 2]>,
    ) -> Changes<'a> {
        Changes {
            record,
            plan,
            pixels,
        }
    }

    /// Whether an earlier run is known.
    pub(super) fn has_record(&self) -> bool {
        self.record.is_some()
    }

    /// What has changed in a node; `None` if nothing has, or no run is known.
    pub(super) fn of(&self, index: NodeIndex) -> Option<Cause> {
        self.record.as_ref()?;
        let Some(before) = self.before(index) else {
            return Some(Cause::New);
        };
        let now = self.now(index);
        if before.kind != now.kind {
            let (from, to) = (before.kind.clone(), now.kind);
            return Some(Cause::KindChanged { from, to });
        }
        if before.version != now.version {
            let (from, to) = (before.version, now.version);
            return Some(Cause::VersionChanged { from, to });
        }
        if before.plan != now.plan {
            return self
                .seed(index, before, &now)
                .or_else(|| self.input(index, before, &now));
        }
        let (from, to) = (before.pixels, now.pixels);
        (from != to).then_some(Cause::SizeChanged { from, to })
    }

    /// The node at which the change of a node began.
    pub(super) fn origin(&self, index: NodeIndex) -> Option<NodeIndex> {
        let mut cause = self.of(index)?;
        let mut at = index;
        while let Cause::NodeChanged { node, .. } = &cause
            && let Some(next) = self.plan.graph.by_name.get(node)
            && let Some(earlier) = self.of(*next)
        {
            (at, cause) = (*next, earlier);
        }
        Some(at)
    }

    fn is_output(&self, index: NodeIndex) -> bool {
        self.plan.graph.outputs.contains(&index)
    }

    fn now(&self, index: NodeIndex) -> NodeRecord {
        NodeRecord::new(
            self.plan,
            index,
            self.pixels.filter(|_| self.is_output(index)),
        )
    }

    fn before(&self, index: NodeIndex) -> Option<&NodeRecord> {
        let record = self.record.as_ref()?;
        let name = &*self.plan.graph.nodes[index].name;
        if self.is_output(index) {
            return record.outputs.get(name);
        }
        let key = &self.plan.keys[&index];
        let renamed = || record.nodes.values().find(|before| before.plan == *key);
        record.nodes.get(name).or_else(renamed)
    }

    fn has_changed(&self, index: NodeIndex) -> bool {
        let before = self.before(index);
        before.is_none_or(|before| before.plan != self.plan.keys[&index])
    }

    fn seed(&self, index: NodeIndex, before: &NodeRecord, now: &NodeRecord) -> Option<Cause> {
        let draws = self.plan.graph.nodes[index].kind.draws();
        let (from, to) = (before.seed, now.seed);
        (draws && from != to).then_some(Cause::SeedChanged { from, to })
    }

    /// The first input that is another.
    fn input(&self, index: NodeIndex, before: &NodeRecord, now: &NodeRecord) -> Option<Cause> {
        let bindings = now.inputs.iter().zip(&self.plan.graph.nodes[index].inputs);
        bindings
            .into_iter()
            .find_map(|(new, Binding { source, .. })| {
                let input = new.name.clone();
                let Some(old) = before.inputs.iter().find(|old| old.name == new.name) else {
                    return Some(Cause::InputNew { input });
                };
                let (from, to) = (old.shown.clone(), new.shown.clone());
                if old.key == new.key {
                    return None;
                }
                if from != to {
                    return Some(Cause::InputChanged { input, from, to });
                }
                Some(match self.changed_link(source) {
                    Some(node) => Cause::NodeChanged { input, node },
                    None if matches!(source, Source::File(_)) => {
                        Cause::FileChanged { input, file: to }
                    }
                    None => Cause::InputChanged { input, from, to },
                })
            })
    }

    /// The first node that a source links to and that has changed.
    fn changed_link(&self, source: &Source) -> Option<String> {
        let mut links = source.links().into_iter();
        let link = links.find(|link| self.has_changed(link.node))?;
        Some(self.plan.graph.nodes[link.node].name.to_string())
    }
}
