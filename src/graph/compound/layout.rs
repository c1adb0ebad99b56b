//! Where the nodes of a file lie: every use of it has them in the same order, one behind another.

use super::super::names::{look_alike, shown};
use super::super::recipe::{Declaration, Recipe};
use super::super::report::Report;
use super::{Definition, Library};
use crate::diagnostics::Code;
use crate::node::Kind;
use std::collections::HashMap;

/// The nodes and outputs of a file, in its order.
#[derive(Debug, Default)]
pub(in crate::graph) struct Layout<'t> {
    /// One for each declaration: the nodes, then the outputs.
    pub(in crate::graph) slots: Vec<Slot>,
    /// The names of the nodes, in the order of the file.
    pub(in crate::graph) names: Vec<&'t str>,
    /// The names of the outputs of a recipe, to which no link leads.
    pub(in crate::graph) output_names: Vec<&'t str>,
    /// Nodes with those inside compounds.
    pub(in crate::graph) size: usize,
    /// Levels of compounds, 0 without any.
    pub(in crate::graph) depth: usize,
    by_name: HashMap<&'t str, usize>,
}

/// A declaration in its place.
#[derive(Debug)]
pub(in crate::graph) struct Slot {
    /// The kind, which of a compound is its interface; `None` if there is none, which is reported.
    pub(in crate::graph) kind: Option<&'static Kind>,
    /// The place of the node, or of the first node inside, behind the first node of the file.
    pub(in crate::graph) offset: usize,
    /// The definition, if it is the use of a compound.
    pub(in crate::graph) inside: Option<usize>,
    /// The places of a compound's outputs; `None` where an output is wrong, which is reported.
    pub(in crate::graph) outputs: Vec<Option<Place>>,
}

/// An output of a node.
#[derive(Clone, Copy, Debug)]
pub(in crate::graph) struct Place {
    /// The place of the node behind the first node of the file.
    pub(in crate::graph) offset: usize,
    /// Which of its outputs.
    pub(in crate::graph) output: usize,
}

impl Slot {
    /// The place of an output.
    pub(in crate::graph) fn output(&self, output: usize) -> Option<Place> {
        match self.inside {
            Some(_) => *self.outputs.get(output)?,
            None => Some(Place {
                offset: self.offset,
                output,
            }),
        }
    }
}

impl<'t> Layout<'t> {
    /// Lays out a file; `definitions` holds those of the compounds that it uses.
    pub(super) fn new(
        report: &mut Report,
        library: &Library<'_>,
        recipe: &Recipe<'t>,
        definitions: &HashMap<&str, (usize, &Definition<'t>)>,
    ) -> Layout<'t> {
        let mut layout = Layout::default();
        for node in &recipe.nodes {
            layout.by_name.insert(node.name, layout.slots.len());
            layout.names.push(node.name);
            let inside = node.kind.and_then(|word| definitions.get(&*word.text));
            layout.push(report, library, node, inside);
        }
        for output in &recipe.outputs {
            layout.output_names.push(output.name);
            layout.push_native(report, library, output, true);
        }
        layout
    }

    /// The node called `name`.
    pub(in crate::graph) fn slot(&self, name: &str) -> Option<&Slot> {
        Some(&self.slots[*self.by_name.get(name)?])
    }

    fn push(
        &mut self,
        report: &mut Report,
        library: &Library<'_>,
        node: &Declaration<'t>,
        inside: Option<&(usize, &Definition<'t>)>,
    ) {
        let Some((index, definition)) = inside else {
            return self.push_native(report, library, node, false);
        };
        let offset = self.size;
        let shifted = |place: &Place| Place {
            offset: offset.saturating_add(place.offset),
            ..*place
        };
        let places = definition.outlets.iter();
        self.slots.push(Slot {
            kind: definition.kind,
            offset,
            inside: Some(*index),
            outputs: places.map(|place| place.as_ref().map(shifted)).collect(),
        });
        self.size = self.size.saturating_add(definition.layout.size);
        self.depth = self.depth.max(definition.layout.depth + 1);
    }

    fn push_native(
        &mut self,
        report: &mut Report,
        library: &Library<'_>,
        node: &Declaration<'_>,
        is_output: bool,
    ) {
        self.slots.push(Slot {
            kind: find_kind(report, library, node, is_output),
            offset: self.size,
            inside: None,
            outputs: vec![],
        });
        self.size = self.size.saturating_add(1);
    }
}

/// The kind of a node or an output; an output gives maps and a node does not.
fn find_kind(
    report: &mut Report,
    library: &Library<'_>,
    declaration: &Declaration<'_>,
    is_output: bool,
) -> Option<&'static Kind> {
    let word = declaration.kind?;
    let Some(kind) = library.native(&word.text) else {
        if is_output && library.has_compound(&word.text) {
            report_place(report, declaration, "gives no maps", "nodes");
            return None;
        }
        let message = format!("there is no kind {}", shown(&word.text));
        let label = look_alike(&word.text, "no kind has this name");
        report.add(
            report
                .error(Code::UnknownKind, message, word.span.clone(), label)
                .in_node(declaration.name)
                .nearest(library.nearest(&word.text, is_output))
                .hint(
                    "run `yosegi nodes` for the list of kinds; compounds of your own lie in `nodes` beside the recipe",
                ),
        );
        return None;
    };
    if kind.gives_maps() != is_output {
        let (is, belongs) = if is_output {
            ("gives no maps", "nodes")
        } else {
            ("gives maps", "outputs")
        };
        report_place(report, declaration, is, belongs);
    }
    Some(kind)
}

/// Reports a node among the outputs, or an output among the nodes.
fn report_place(report: &mut Report, declaration: &Declaration<'_>, is: &str, belongs: &str) {
    let Some(word) = declaration.kind else { return };
    let message = format!("`{}` {is}, so it belongs under `{belongs}`", word.text);
    report.add(
        report
            .error(Code::NotAnOutput, message, word.span.clone(), is)
            .in_node(declaration.name)
            .hint(format!("move it to `{belongs}`")),
    );
}
