//! Checks a recipe as far as that is cheap: everything but evaluating samples and writing.

use super::render::{Render, chosen_outputs};
use super::store::{Store, ToldOnce};
use super::{Engine, RunError, files};
use crate::graph::Graph;
use petgraph::graph::NodeIndex;

impl Engine {
    /// Reads the files that a recipe names and builds all its nodes, those that no output reads as well,
    /// or what the outputs named in the request need. Nothing is evaluated, and the folder of the request
    /// is not touched; structures come from the caches and go there.
    ///
    /// # Errors
    /// As [`Engine::render`], all at once: failures of nodes, and outputs over the limit or with a file
    /// in common.
    pub fn check(&self, request: &Render<'_>) -> Result<(), RunError> {
        let _in_use = self.store.as_ref().map(Store::begin);
        let listener = ToldOnce::new(request.listener);
        let request = &listener.request(request);
        let run = self.until(&request.cancel, &self.world);
        self.threads
            .install(|| run.ended(run.check_all(request), request.listener))
    }

    fn check_all(&self, request: &Render<'_>) -> Result<(), RunError> {
        let graph = request.graph;
        if graph.interface.is_some() {
            // Its inputs have no values until a recipe uses it.
            return Ok(());
        }
        let is_whole = request.only.is_empty();
        let wanted = if is_whole && graph.outputs.is_empty() {
            vec![]
        } else {
            chosen_outputs(request)?
        };
        let plan = self.plan(graph, &if is_whole { all(graph) } else { wanted.clone() })?;
        let built = self.build(&plan, request.listener)?;
        let store = self.options.store.as_deref();
        let protected = files::Protected::new(&*self.world, &plan, store);
        let outputs = self.outputs(request, &plan, &protected, &wanted);
        let mut failures = built.failures.clone();
        let names = outputs.iter().flat_map(|it| it.file_names(None, &built));
        if let Err(error) = files::refuse_shared(graph, names) {
            failures.extend_from_slice(error.diagnostics());
        }
        let has_failed = !failures.is_empty();
        for output in outputs.iter().filter(|output| built.has(output.index)) {
            if let Err(error) = output.check_size(output.files(&built)) {
                failures.extend_from_slice(error.diagnostics());
            }
        }
        match failures.is_empty() {
            true => Ok(()),
            false if has_failed => Err(RunError::Nodes(failures)),
            false => Err(RunError::Limit(failures)),
        }
    }
}

fn all(graph: &Graph) -> Vec<NodeIndex> {
    graph.nodes.node_indices().collect()
}
