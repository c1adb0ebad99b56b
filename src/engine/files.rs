//! Names of map files, that no two outputs of a run share one, and which are left from earlier runs.

use super::RunError;
use crate::diagnostics::{Code, Diagnostic};
use crate::graph::Graph;
use crate::output;
use crate::value::MapFormat;
use crate::world::World;
use petgraph::graph::NodeIndex;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The file of a channel of an output.
pub(super) fn file_name(output: &str, channel: &str, format: MapFormat) -> String {
    format!("{output}_{channel}.{}", format.extension())
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
    folder: &Path,
    output: &str,
    written: &[&str],
) -> Vec<(String, PathBuf)> {
    let mut stale = vec![];
    // A folder that cannot be listed has nothing to warn of.
    for listed in world.list(folder).unwrap_or_default() {
        let Some(name) = listed.path.file_name().and_then(|name| name.to_str()) else {
            continue;
        };
        let channel = name.strip_prefix(output).and_then(|rest| {
            let (channel, _) = rest.strip_prefix('_')?.rsplit_once('.')?;
            Some(channel.to_owned())
        });
        if let Some(channel) = channel
            && !written.contains(&name)
            && output::read_key(world, &listed.path).is_some()
            && output::read_channel(world, &listed.path).as_deref() == Some(&*channel)
        {
            stale.push((channel, listed.path));
        }
    }
    stale
}
