//! Names of map files: no two outputs of a run share one, none is that of something that is read, and which
//! are left from earlier runs.

use super::RunError;
use super::plan::Plan;
use crate::diagnostics::{Code, Diagnostic};
use crate::graph::Graph;
use crate::output;
use crate::value::MapFormat;
use crate::world::{Listed, World};
use petgraph::graph::NodeIndex;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The file of a channel of an output.
pub(super) fn file_name(output: &str, channel: &str, format: MapFormat) -> String {
    format!("{output}_{channel}.{}", format.extension())
}

/// What events and the store call the table of an output, as they call maps after their channels.
pub(super) const TABLE: &str = "table";

/// The file of an output that is a table.
pub(super) fn table_name(output: &str) -> String {
    format!("{output}.csv")
}

/// Refuses two outputs that would write the same file: `board` with the channel `pale_old`, and
/// `board_pale` with the channel `old`.
pub(super) fn refuse_shared(
    graph: &Graph,
    files: impl Iterator<Item = (NodeIndex, String)>,
) -> Result<(), RunError> {
    let mut owner_of = HashMap::new();
    for (index, file) in files {
        let Some(other) = owner_of.insert(file.clone(), index) else {
            continue;
        };
        let (node, other) = (&graph.nodes[index], &graph.nodes[other]);
        let message = format!("`{file}` would be written by `{}` as well", other.name);
        return Err(RunError::Nodes(vec![
            Diagnostic::error(Code::NodeFailed, message)
                .at(&graph.source, node.span.clone(), "this output")
                .in_node(&*node.name)
                .hint("rename one of the outputs"),
        ]));
    }
    Ok(())
}

/// Maps in `folder` that were written for `output` and are not among the files of this run, with their
/// channels: a file is one if it carries a key of ours and the channel that its name says.
pub(super) fn stale(
    world: &dyn World,
    folder: &[Listed],
    output: &str,
    written: &HashSet<&str>,
) -> Vec<(String, PathBuf)> {
    let mut stale = vec![];
    for listed in folder {
        let Some(name) = listed.path.file_name().and_then(|name| name.to_str()) else {
            continue;
        };
        let channel = name.strip_prefix(output).and_then(|rest| {
            let (channel, _) = rest.strip_prefix('_')?.rsplit_once('.')?;
            Some(channel.to_owned())
        });
        if let Some(channel) = channel
            && !written.contains(name)
            && output::read_key(world, &listed.path).is_some()
            && output::read_channel(world, &listed.path).as_deref() == Some(&*channel)
        {
            stale.push((channel, listed.path.clone()));
        }
    }
    stale
}

/// What no map may replace: the recipe, the files that it reads, and the store.
pub(super) struct Protected {
    files: Vec<PathBuf>,
    store: Option<PathBuf>,
}

impl Protected {
    /// Of a run that reads the recipe and the files of `plan`.
    pub(super) fn new(world: &dyn World, plan: &Plan<'_>, store: Option<&Path>) -> Protected {
        let recipes = plan
            .graph
            .files
            .iter()
            .map(|file| real_path(world, &file.path));
        let store = store.map(|folder| real_path(world, folder));
        Protected {
            files: plan.places.iter().cloned().chain(recipes).collect(),
            store,
        }
    }

    /// What a map at `path` would replace.
    fn replaced(&self, world: &dyn World, path: &Path) -> Option<&'static str> {
        let path = real_path(world, path);
        let is_in_store = || {
            self.store
                .as_ref()
                .is_some_and(|store| path.starts_with(store))
        };
        if self.files.contains(&path) {
            Some("the recipe or a file that it reads")
        } else if is_in_store() {
            Some("a file in the store of earlier results")
        } else {
            None
        }
    }

    /// Whether a map may be written at `path`.
    pub(super) fn allows(&self, world: &dyn World, path: &Path) -> bool {
        self.replaced(world, path).is_none()
    }

    /// Refuses outputs with a map that may not be written.
    pub(super) fn refuse<'f>(
        &self,
        world: &dyn World,
        graph: &Graph,
        mut files: impl Iterator<Item = (NodeIndex, &'f Path)>,
    ) -> Result<(), RunError> {
        let wrong =
            files.find_map(|(index, path)| Some((index, path, self.replaced(world, path)?)));
        let Some((index, path, replaced)) = wrong else {
            return Ok(());
        };
        let node = &graph.nodes[index];
        let message = format!("the map `{}` would replace {replaced}", path.display());
        Err(RunError::Request(vec![
            Diagnostic::error(Code::OutputOverInput, message)
                .at(&graph.source, node.span.clone(), "this output")
                .in_node(&*node.name)
                .hint("choose another folder for the maps, with `--output`, or rename the output"),
        ]))
    }
}

/// Where a file really lies or would lie.
fn real_path(world: &dyn World, path: &Path) -> PathBuf {
    let in_real_folder = || {
        let folder = world.real_path(path.parent()?).ok()?;
        Some(folder.join(path.file_name()?))
    };
    let real = world.real_path(path).ok();
    real.or_else(in_real_folder)
        .unwrap_or_else(|| path.to_owned())
}
