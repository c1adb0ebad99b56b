//! Names of map files, and that no two outputs of a run share one.

use super::RunError;
use crate::diagnostics::{Code, Diagnostic};
use crate::graph::Graph;
use crate::value::MapFormat;
use petgraph::graph::NodeIndex;
use std::collections::HashMap;

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
