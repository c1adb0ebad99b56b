//! What a compound is, found once however often it is used.

use super::super::names::shown;
use super::super::parameters::Interface;
use super::super::recipe::{self, Recipe, Role};
use super::super::report::Report;
use super::super::{Origin, circles};
use super::layout::Place;
use super::{DEPTH, File, Layout, Library, interface};
use crate::diagnostics::Code;
use crate::node::Kind;
use petgraph::graph::{DiGraph, NodeIndex};
use std::collections::HashMap;
use std::sync::Arc;

/// Names of a circle or a chain of compounds that are printed.
const SHOWN: usize = 10;

/// A file with all that every use of it shares.
#[derive(Debug)]
pub(in crate::graph) struct Definition<'t> {
    /// The file.
    pub(in crate::graph) file: &'t File,
    /// What it declares.
    pub(in crate::graph) recipe: Recipe<'t>,
    /// Its parameters or inputs.
    pub(in crate::graph) interface: Arc<Interface>,
    /// The kind that a compound is; `None` for a recipe, and if something is wrong with it.
    pub(in crate::graph) kind: Option<&'static Kind>,
    /// Where its nodes lie.
    pub(in crate::graph) layout: Layout<'t>,
    /// The places of a compound's outputs; `None` where one is wrong, which is reported.
    pub(in crate::graph) outlets: Vec<Option<Place>>,
}

/// Reads the files, of which the first is loaded and the others are compounds; `None` if compounds contain
/// each other in a circle or are nested too deep, which is reported.
pub(in crate::graph) fn define<'t>(
    report: &mut Report,
    library: &Library<'_>,
    files: &'t [File],
) -> Option<Vec<Definition<'t>>> {
    let mut recipes: Vec<_> = files
        .iter()
        .map(|file| {
            report.enter(&Origin::of_file(file));
            let tree = file.tree.as_ref();
            Some(tree.map_or_else(
                || Recipe::new(file.role),
                |tree| recipe::read(report, file.role, tree),
            ))
        })
        .collect();
    let index_of: HashMap<&str, usize> = files
        .iter()
        .map(|file| &*file.name)
        .zip(0..)
        .skip(1)
        .collect();
    let graph = uses(&recipes, &index_of);
    let order = match circles::sort(&graph) {
        Ok(order) => order,
        Err(circles) => {
            report_circles(report, files, &recipes, &circles);
            return None;
        }
    };
    let mut definitions: Vec<Option<Definition<'t>>> = files.iter().map(|_| None).collect();
    for index in order {
        let index = index.index();
        let recipe = recipes[index].take()?;
        let known = known(&graph, index, files, &definitions);
        report.enter(&Origin::of_file(&files[index]));
        let definition = Definition::new(report, library, &files[index], recipe, &known);
        definitions[index] = Some(definition);
    }
    let definitions: Option<Vec<_>> = definitions.into_iter().collect();
    definitions.filter(|definitions| !report_depth(report, definitions))
}

/// An edge from each compound to the files that use it.
fn uses(recipes: &[Option<Recipe<'_>>], index_of: &HashMap<&str, usize>) -> DiGraph<(), ()> {
    let mut graph = DiGraph::new();
    recipes.iter().for_each(|_| {
        graph.add_node(());
    });
    for (user, recipe) in recipes.iter().enumerate() {
        let words = recipe.iter().flat_map(|recipe| &recipe.nodes);
        let used = words.filter_map(|node| index_of.get(&*node.kind?.text));
        for used in used {
            graph.update_edge(NodeIndex::new(*used), NodeIndex::new(user), ());
        }
    }
    graph
}

/// The definitions that a file uses, by name.
fn known<'d, 't>(
    graph: &DiGraph<(), ()>,
    user: usize,
    files: &'t [File],
    definitions: &'d [Option<Definition<'t>>],
) -> HashMap<&'t str, (usize, &'d Definition<'t>)> {
    let used = graph.neighbors_directed(NodeIndex::new(user), petgraph::Direction::Incoming);
    used.filter_map(|used| {
        let index = used.index();
        let definition = definitions[index].as_ref()?;
        Some((&*files[index].name, (index, definition)))
    })
    .collect()
}

impl<'t> Definition<'t> {
    fn new(
        report: &mut Report,
        library: &Library<'_>,
        file: &'t File,
        recipe: Recipe<'t>,
        known: &HashMap<&str, (usize, &Definition<'t>)>,
    ) -> Definition<'t> {
        let interface = Interface::read(report, recipe.role, &recipe.parameters);
        let layout = Layout::new(report, library, &recipe, known);
        let (mut kind, mut outlets) = (None, vec![]);
        if recipe.role == Role::Compound && file.tree.is_some() {
            let (outputs, places) = interface::outputs(report, library, &recipe, &layout);
            kind = interface::kind(report, library, file, &recipe, &interface, outputs);
            outlets = places;
        }
        Definition {
            file,
            recipe,
            interface: Arc::new(interface),
            kind,
            layout,
            outlets,
        }
    }
}

fn report_circles(
    report: &mut Report,
    files: &[File],
    recipes: &[Option<Recipe<'_>>],
    circles: &[Vec<NodeIndex>],
) {
    for circle in circles {
        // Edges lead from the used to the user; the message goes the way a reader follows.
        let circle: Vec<usize> = circle.iter().rev().map(|index| index.index()).collect();
        let (user, used) = (circle[0], circle[1 % circle.len()]);
        let mut names: Vec<_> = circle
            .iter()
            .take(SHOWN)
            .map(|one| shown(&files[*one].name))
            .collect();
        if circle.len() > SHOWN {
            names.push(format!(".. ({} in all)", circle.len()));
        }
        names.push(shown(&files[user].name));
        let message = format!("a compound contains itself: {}", names.join(" -> "));
        let nodes = recipes[user].iter().flat_map(|recipe| &recipe.nodes);
        let is_use = |kind: Option<&super::super::tree::Word>| {
            kind.is_some_and(|word| word.text == files[used].name)
        };
        let Some(node) = nodes.into_iter().find(|node| is_use(node.kind)) else {
            continue;
        };
        let span = node
            .kind
            .map_or(node.span.clone(), |word| word.span.clone());
        report.enter(&Origin::of_file(&files[user]));
        report.add(
            report
                .error(Code::Cycle, message, span, "the circle begins here")
                .in_node(node.name)
                .hint("a compound is made of its nodes, so it can never hold itself: remove one of the uses"),
        );
    }
}

/// Whether compounds are nested too deep, which is then reported with the longest chain.
fn report_depth(report: &mut Report, definitions: &[Definition<'_>]) -> bool {
    let root = &definitions[0];
    if root.layout.depth <= DEPTH {
        return false;
    }
    let mut names = vec![];
    let mut spans = vec![];
    let mut user = root;
    while let Some((slot, node)) = user
        .layout
        .slots
        .iter()
        .zip(&user.recipe.nodes)
        .filter(|(slot, _)| slot.inside.is_some())
        .max_by_key(|(slot, _)| slot.inside.map(|index| definitions[index].layout.depth))
    {
        let Some(index) = slot.inside else { break };
        names.push(shown(&definitions[index].file.name));
        spans.push((node.name, node.span.clone()));
        user = &definitions[index];
    }
    let count = names.len();
    names.truncate(SHOWN);
    let message = format!(
        "compounds are nested {count} levels deep, more than {DEPTH}: {} -> ..",
        names.join(" -> ")
    );
    report.enter(&Origin::of_file(root.file));
    if let Some((name, span)) = spans.into_iter().next() {
        report.add(
            report
                .error(Code::NestedTooDeep, message, span, "the chain begins here")
                .in_node(name),
        );
    }
    true
}
