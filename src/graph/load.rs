//! Reading a recipe: from its path or its text to a checked graph.

use super::check::{self, Draft, UseDraft};
use super::compound::{self, Definition, Library, Slot};
use super::parameters::Parameters;
use super::recipe::Role;
use super::report::Report;
use super::{Graph, Node, Origin, domains, edit, order, text};
use crate::cancel::Cancel;
use crate::diagnostics::{Code, Diagnostic, SourceFile};
use crate::node::Kind;
use crate::nodes::KINDS;
use crate::value::Domain;
use crate::world::{Memory, World};
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
    /// Takes the place of the limit on nodes, 200,000 with those inside compounds.
    pub largest_graph: Option<usize>,
    /// Lets the recipe name files anywhere, and not only below its folder and its assets.
    pub allow_outside: bool,
}

/// Nodes of a recipe that uses compounds.
const LARGEST_GRAPH: usize = 200_000;

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
    load_file(world, path, settings, &Cancel::new())
}

/// As [`load`]; `None` if `cancel` is thrown before the recipe is read and checked.
pub fn load_until(
    world: &dyn World,
    path: &Path,
    settings: &Settings,
    cancel: &Cancel,
) -> Option<Result<Loaded, Vec<Diagnostic>>> {
    let loaded = load_file(world, path, settings, cancel);
    (!cancel.is_cancelled()).then_some(loaded)
}

fn load_file(
    world: &dyn World,
    path: &Path,
    settings: &Settings,
    cancel: &Cancel,
) -> Result<Loaded, Vec<Diagnostic>> {
    // Not more than shows that it is too large, so that nothing endless is read.
    let bytes = world.read_start(path, text::LARGEST + 1).map_err(|error| {
        let message = format!("`{}` could not be read: {error}", path.display());
        let mut diagnostic = Diagnostic::error(Code::FileNotRead, message);
        diagnostic.source = Some(Arc::new(SourceFile::new(path, "")));
        vec![diagnostic]
    })?;
    let source = text::decode(path, bytes).map_err(|diagnostic| vec![*diagnostic])?;
    let library = Library::new(KINDS, world, folder_of(path)).allowing(settings.allow_outside);
    load_source(&library, &source, settings, cancel)
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
    let path = path.as_ref();
    let world = Memory::default();
    let library = Library::new(kinds, &world, folder_of(path));
    let source = Arc::new(SourceFile::new(path, text));
    load_source(&library, &source, settings, &Cancel::new())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

fn load_source(
    library: &Library<'_>,
    source: &Arc<SourceFile>,
    settings: &Settings,
    cancel: &Cancel,
) -> Result<Loaded, Vec<Diagnostic>> {
    let mut report = Report::new(source);
    report.cancel = cancel.clone();
    report.allow_outside = settings.allow_outside;
    let Some(files) = compound::gather(&mut report, library, source) else {
        return Err(report.finish());
    };
    if files[0].tree.is_none() {
        if !report.has_errors() {
            report_empty(&mut report);
        }
        return Err(report.finish());
    }
    let mut set_problems = vec![];
    let graph = compound::define(&mut report, library, &files)
        .filter(|definitions| !report_size(&mut report, definitions, settings))
        .and_then(|definitions| {
            graph(
                &mut report,
                library,
                &definitions,
                settings,
                &mut set_problems,
            )
        });
    let has_errors = report.has_errors() || !set_problems.is_empty();
    let mut diagnostics = report.finish();
    match graph {
        Some(graph) if !has_errors => Ok(Loaded {
            graph,
            warnings: diagnostics,
        }),
        _ => {
            diagnostics.splice(0..0, set_problems);
            Err(diagnostics)
        }
    }
}

/// The kind that the compound in `source` is; `None` if something is wrong with it.
pub(super) fn interface(library: &Library<'_>, source: &Arc<SourceFile>) -> Option<&'static Kind> {
    let mut report = Report::new(source);
    let mut files = compound::gather(&mut report, library, source)?;
    files[0].role = Role::Compound;
    compound::define(&mut report, library, &files)?
        .first()?
        .kind
}

/// Whether there are too many nodes, which is then reported: compounds inside compounds multiply.
fn report_size(report: &mut Report, definitions: &[Definition<'_>], settings: &Settings) -> bool {
    let limit = settings.largest_graph.unwrap_or(LARGEST_GRAPH);
    let Definition { layout, recipe, .. } = &definitions[0];
    if layout.size <= limit || layout.depth == 0 {
        return false;
    }
    let size_of = |slot: &Slot| {
        slot.inside
            .map_or(1, |inside| definitions[inside].layout.size)
    };
    let nodes = recipe.nodes.iter().zip(&layout.slots);
    let Some((node, slot)) = nodes.max_by_key(|(_, slot)| size_of(slot)) else {
        return false;
    };
    let counted = |size: usize| match size {
        usize::MAX => "more nodes than can be counted".to_owned(),
        size => format!("{size} nodes"),
    };
    let (found, largest) = (counted(layout.size), counted(size_of(slot)));
    let message = format!("the recipe has {found} with those inside its compounds");
    report.enter(&Origin::of_file(definitions[0].file));
    report.add(
        report
            .error(
                Code::TooMuch,
                message,
                node.span.clone(),
                format!("holds {largest}"),
            )
            .in_node(node.name)
            .expected(format!("at most {limit} nodes"), found)
            .hint("use fewer compounds, or allow it with `--max-nodes NUMBER`"),
    );
    true
}

/// The graph of the first definition; `None` if something is wrong with it, which is reported.
fn graph(
    report: &mut Report,
    library: &Library<'_>,
    definitions: &[Definition<'_>],
    settings: &Settings,
    set_problems: &mut Vec<Diagnostic>,
) -> Option<Graph> {
    let Definition { file, recipe, .. } = &definitions[0];
    let seed = settings.seed.unwrap_or(recipe.seed);
    let origin = Arc::new(Origin {
        seed,
        ..Origin::of_file(file)
    });
    let (parameters, problems) = bound(&definitions[0], settings);
    *set_problems = problems;
    let mut expanded = check::check(report, definitions, parameters.clone(), Arc::clone(&origin));
    if report.is_full() {
        return None;
    }
    expanded.drafts.extend(stand_ins(&definitions[0], &origin));
    let edges = order::edges(&expanded.drafts);
    if let Some(order) = order::sort(report, &expanded.drafts, &edges) {
        domains::resolve(report, &mut expanded, &order);
    }
    if report.has_errors() || !set_problems.is_empty() {
        return None;
    }
    order::report_unused(report, &expanded, &outlets(&definitions[0]));
    for (definition, used) in definitions.iter().zip(&expanded.used) {
        report.enter(&Origin::of_file(definition.file));
        definition.interface.report_unused(report, used);
    }
    report_native(report, &definitions[0], library);
    let drafts = &expanded.drafts;
    Some(Graph {
        source: Arc::clone(&file.source),
        about: recipe.about.clone(),
        seed,
        allow_outside: settings.allow_outside,
        parameters: parameters.finish(),
        outputs: indices(drafts, true).map(|(index, _)| index).collect(),
        by_name: indices(drafts, false)
            .map(|(index, draft)| (draft.name.to_string(), index))
            .collect(),
        uses: expanded.uses.iter().filter_map(UseDraft::finish).collect(),
        files: definitions
            .iter()
            .map(|one| Arc::clone(&one.file.source))
            .collect(),
        interface: definitions[0].kind,
        nodes: with_nodes(&edges, expanded.drafts)?,
    })
}

/// Warns about a compound that no recipe can use, since a kind written in Rust has its name.
fn report_native(report: &mut Report, definition: &Definition<'_>, library: &Library<'_>) {
    let name = &definition.file.name;
    if definition.recipe.role == Role::Recipe || library.native(name).is_none() {
        return;
    }
    let message =
        format!("a kind written in Rust is called `{name}`, so no recipe can use this one");
    report.enter(&Origin::of_file(definition.file));
    let warning = report.warning(Code::DuplicateName, message, 0..1, "rename this file");
    report.add(warning);
}

/// What the parameters of a recipe are, or stand-ins for the inputs of a compound that is loaded by itself.
fn bound(definition: &Definition<'_>, settings: &Settings) -> (Parameters, Vec<Diagnostic>) {
    let interface = Arc::clone(&definition.interface);
    let sources = match definition.recipe.role {
        Role::Recipe => interface
            .declared
            .iter()
            .map(|one| one.default.clone())
            .collect(),
        Role::Compound => {
            // Without an interface there is no node that could stand for the inputs.
            let inputs = definition
                .kind
                .map(|_| NodeIndex::new(definition.layout.size));
            let declared = interface.declared.iter().enumerate();
            declared
                .map(|(position, one)| compound::stand_in(one, position, inputs))
                .collect()
        }
    };
    let mut parameters = Parameters::bound(interface, sources);
    parameters.are_stand_ins = definition.recipe.role == Role::Compound;
    let problems = parameters.set_all(&settings.set);
    (parameters, problems)
}

/// The node that stands for what a compound is given, if it is loaded by itself.
fn stand_ins(definition: &Definition<'_>, origin: &Arc<Origin>) -> Option<Draft> {
    Some(Draft {
        // No node of a file has such a name.
        name: "$inputs".into(),
        kind: Some(compound::inputs_kind(definition.kind?)),
        domain: Some(Domain::Everywhere),
        ..Draft::empty(origin)
    })
}

/// The nodes that the outputs of a compound come from, if it is loaded by itself.
fn outlets(definition: &Definition<'_>) -> Vec<usize> {
    let places = definition
        .outlets
        .iter()
        .flatten()
        .map(|place| place.offset);
    let inputs = definition.kind.map(|_| definition.layout.size);
    places.chain(inputs).collect()
}

/// The outputs, or the nodes that are none.
fn indices(drafts: &[Draft], are_outputs: bool) -> impl Iterator<Item = (NodeIndex, &Draft)> {
    let all = drafts.iter().enumerate();
    all.filter(move |(_, draft)| draft.is_output == are_outputs)
        .map(|(index, draft)| (NodeIndex::new(index), draft))
}

fn with_nodes(edges: &DiGraph<(), ()>, drafts: Vec<Draft>) -> Option<DiGraph<Node, ()>> {
    let nodes: Option<Vec<Node>> = drafts.into_iter().map(Draft::finish).collect();
    let mut nodes = nodes?.into_iter();
    Some(edges.map(
        |_, ()| nodes.next().expect("there is one for each draft"),
        |_, ()| (),
    ))
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
    if graph.interface.is_some() {
        let message = "this is a compound: it is rendered where a recipe uses it";
        let mut diagnostic = Diagnostic::error(Code::NoOutput, message)
            .hint("use it by the name of its file in a recipe beside its folder `nodes`");
        diagnostic.source = Some(Arc::clone(&graph.source));
        return diagnostic;
    }
    let (place, label) = edit::outputs_place(&graph.source);
    Diagnostic::error(
        Code::NoOutput,
        "the recipe has no output, so there is nothing to render",
    )
    .at(&graph.source, place, label)
    .hint("add `outputs: { \"name\": maps(of: \"node\") }`")
}
