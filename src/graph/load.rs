//! Reading a recipe: from its path or its text to a checked graph.

use super::check::{self, Draft};
use super::parameters::Parameters;
use super::report::Report;
use super::{Graph, Node, domains, edit, order, recipe, text};
use crate::diagnostics::{Code, Diagnostic, SourceFile};
use crate::node::Kind;
use crate::nodes::KINDS;
use crate::world::World;
use petgraph::graph::{DiGraph, NodeIndex};
use std::path::Path;
use std::sync::Arc;

/// What a caller changes in a recipe, as the command line does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Names of parameters and what they are set to, as RON literals in the parameter's unit.
    pub set: Vec<(String, String)>,
    /// Takes the place of the recipe's seed.
    pub seed: Option<u64>,
    /// Lets the recipe name files anywhere, and not only below its folder and its assets.
    pub allow_outside: bool,
}

/// A recipe that can be rendered.
#[derive(Debug)]
pub struct Loaded {
    /// The checked graph.
    pub graph: Graph,
    /// What is worth knowing, sorted by place.
    pub warnings: Vec<Diagnostic>,
}

/// Reads and checks the recipe at `path`.
///
/// # Errors
/// Everything that is wrong with it, sorted by place, with the warnings among it.
pub fn load(
    world: &dyn World,
    path: &Path,
    settings: &Settings,
) -> Result<Loaded, Vec<Diagnostic>> {
    // Not more than shows that it is too large, so that nothing endless is read.
    let bytes = world.read_start(path, text::LARGEST + 1).map_err(|error| {
        let message = format!("`{}` could not be read: {error}", path.display());
        let mut diagnostic = Diagnostic::error(Code::FileNotRead, message);
        diagnostic.source = Some(Arc::new(SourceFile::new(path, "")));
        vec![diagnostic]
    })?;
    let source = text::decode(path, bytes).map_err(|diagnostic| vec![*diagnostic])?;
    load_source(KINDS, &source, settings)
}

/// Reads and checks `text` as if it had been read from `path`.
///
/// # Errors
/// As [`load`].
pub fn load_text(
    path: impl AsRef<Path>,
    text: impl Into<String>,
    settings: &Settings,
) -> Result<Loaded, Vec<Diagnostic>> {
    load_text_with(KINDS, path, text, settings)
}

/// Reads and checks `text` with other kinds than Yosegi's own.
///
/// # Errors
/// As [`load`].
pub fn load_text_with(
    kinds: &[&'static Kind],
    path: impl AsRef<Path>,
    text: impl Into<String>,
    settings: &Settings,
) -> Result<Loaded, Vec<Diagnostic>> {
    load_source(
        kinds,
        &Arc::new(SourceFile::new(path.as_ref(), text)),
        settings,
    )
}

fn load_source(
    kinds: &[&'static Kind],
    source: &Arc<SourceFile>,
    settings: &Settings,
) -> Result<Loaded, Vec<Diagnostic>> {
    let mut report = Report::new(source);
    let Some(tree) = text::read(&mut report) else {
        if !report.has_errors() {
            report_empty(&mut report);
        }
        return Err(report.finish());
    };
    let recipe = recipe::read(&mut report, &tree);
    let (mut parameters, set_problems) =
        Parameters::read(&mut report, &recipe.parameters, &settings.set);
    parameters.allow_outside = settings.allow_outside;
    let mut drafts = check::check(&mut report, &recipe, &mut parameters, kinds);
    let edges = order::edges(&drafts);
    if let Some(order) = order::sort(&mut report, &drafts, &edges) {
        domains::resolve(&mut report, &mut drafts, &order);
    }
    let has_errors = report.has_errors() || !set_problems.is_empty();
    if !has_errors {
        order::report_unused(&mut report, &drafts);
        parameters.report_unused(&mut report);
    }
    let mut diagnostics = report.finish();
    if has_errors {
        diagnostics.splice(0..0, set_problems);
        return Err(diagnostics);
    }
    let graph = Graph {
        source: Arc::clone(source),
        about: recipe.about,
        seed: settings.seed.unwrap_or(recipe.seed),
        allow_outside: settings.allow_outside,
        parameters: parameters.finish(),
        outputs: indices(&drafts, true).map(|(index, _)| index).collect(),
        by_name: indices(&drafts, false)
            .map(|(index, draft)| (draft.name.to_string(), index))
            .collect(),
        nodes: with_nodes(&edges, drafts),
    };
    Ok(Loaded {
        graph,
        warnings: diagnostics,
    })
}

/// The outputs, or the nodes that are none.
fn indices(drafts: &[Draft], are_outputs: bool) -> impl Iterator<Item = (NodeIndex, &Draft)> {
    let all = drafts.iter().enumerate();
    all.filter(move |(_, draft)| draft.is_output == are_outputs)
        .map(|(index, draft)| (NodeIndex::new(index), draft))
}

fn with_nodes(edges: &DiGraph<(), ()>, drafts: Vec<Draft>) -> DiGraph<Node, ()> {
    let mut nodes = drafts.into_iter().filter_map(Draft::finish);
    edges.map(
        |_, ()| nodes.next().expect("a draft without errors is a node"),
        |_, ()| (),
    )
}

fn report_empty(report: &mut Report) {
    let message = "the file holds no recipe";
    report.add(
        report
            .error(
                Code::NotARecipe,
                message,
                0..0,
                "nothing but space and comments",
            )
            .expected("a recipe in parentheses", "nothing")
            .hint("write `(nodes: { .. }, outputs: { .. })`"),
    );
}

/// The mistake of a recipe that is to be rendered and has no output.
pub fn no_output(graph: &Graph) -> Diagnostic {
    let (place, label) = edit::outputs_place(&graph.source);
    Diagnostic::error(
        Code::NoOutput,
        "the recipe has no output, so there is nothing to render",
    )
    .at(&graph.source, place, label)
    .hint("add `outputs: { \"name\": maps(of: \"node\") }`")
}
