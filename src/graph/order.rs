//! The order of nodes: which depends on which, circles, and nodes that no output needs.

use super::check::{Draft, Expanded, UseDraft};
use super::names::shown;
use super::report::Report;
use super::{Arithmetic, Link, Source, circles};
use crate::diagnostics::Code;
use petgraph::graph::{DiGraph, NodeIndex};

/// Names of a circle that are printed.
const SHOWN: usize = 10;

impl Source {
    /// Every link, in the order of the recipe.
    pub fn links(&self) -> Vec<Link> {
        let mut links = vec![];
        self.add_links(&mut links);
        links
    }

    fn add_links(&self, links: &mut Vec<Link>) {
        match self {
            Source::Absent | Source::Literal(_) | Source::File(_) => {}
            Source::Link(link) => links.push(*link),
            Source::Arithmetic(arithmetic) => arithmetic.add_links(links),
            Source::Channels(channels) => {
                channels
                    .iter()
                    .for_each(|(_, source)| source.add_links(links));
            }
        }
    }
}

impl Arithmetic {
    fn add_links(&self, links: &mut Vec<Link>) {
        match self {
            Arithmetic::Number(_) => {}
            Arithmetic::Link(link) => links.push(*link),
            Arithmetic::Negate(of) => of.add_links(links),
            Arithmetic::Binary(_, parts) => parts.iter().for_each(|part| part.add_links(links)),
            Arithmetic::Call(_, parts) => parts.iter().for_each(|part| part.add_links(links)),
        }
    }
}

impl Draft {
    /// Every link that is valid, with the input it belongs to.
    pub(super) fn links(&self) -> impl Iterator<Item = (usize, Link)> {
        self.bindings
            .iter()
            .enumerate()
            .flat_map(|(input, binding)| {
                let links = binding.as_ref().map(|binding| binding.source.links());
                links
                    .unwrap_or_default()
                    .into_iter()
                    .map(move |link| (input, link))
            })
    }
}

/// One edge from each node to each that reads it.
pub(super) fn edges(drafts: &[Draft]) -> DiGraph<(), ()> {
    let mut graph = DiGraph::with_capacity(drafts.len(), drafts.len());
    drafts.iter().for_each(|_| {
        graph.add_node(());
    });
    for (index, draft) in drafts.iter().enumerate() {
        let mut sources: Vec<_> = draft.links().map(|(_, link)| link.node).collect();
        sources.sort_unstable();
        sources.dedup();
        for source in sources {
            graph.add_edge(source, NodeIndex::new(index), ());
        }
    }
    graph
}

/// The nodes so that each comes after those it reads; circles are reported.
pub(super) fn sort(
    report: &mut Report,
    drafts: &[Draft],
    graph: &DiGraph<(), ()>,
) -> Option<Vec<NodeIndex>> {
    match circles::sort(graph) {
        Ok(order) => Some(order),
        Err(circles) => {
            circles
                .iter()
                .for_each(|circle| report_circle(report, drafts, circle));
            None
        }
    }
}

fn report_circle(report: &mut Report, drafts: &[Draft], circle: &[NodeIndex]) {
    let Some(first) = circle.first().map(|node| &drafts[node.index()]) else {
        return;
    };
    let mut names: Vec<_> = circle
        .iter()
        .take(SHOWN)
        .map(|node| shown(&drafts[node.index()].name))
        .collect();
    if circle.len() > SHOWN {
        names.push(format!(".. ({} nodes in all)", circle.len()));
    }
    names.push(shown(&first.name));
    report.enter(&first.origin);
    let message = format!(
        "nodes depend on each other in a circle: {}",
        names.join(" -> ")
    );
    report.add(
        report
            .error(
                Code::Cycle,
                message,
                first.span.clone(),
                "the circle begins here",
            )
            .in_node(&*first.name)
            .hint("remove one of the links"),
    );
}

/// Warns about nodes that neither an output nor one of `wanted` needs, if there are any of these.
pub(super) fn report_unused(report: &mut Report, expanded: &Expanded, wanted: &[usize]) {
    let drafts = &expanded.drafts;
    let mut is_needed: Vec<_> = drafts.iter().map(|draft| draft.is_output).collect();
    wanted.iter().for_each(|index| is_needed[*index] = true);
    let mut pending: Vec<_> = (0..drafts.len())
        .filter(|index| is_needed[*index])
        .collect();
    if pending.is_empty() {
        return;
    }
    while let Some(index) = pending.pop() {
        for (_, link) in drafts[index].links() {
            if !std::mem::replace(&mut is_needed[link.node.index()], true) {
                pending.push(link.node.index());
            }
        }
    }
    // Of what lies inside compounds each use needs a part.
    let nodes = drafts.iter().zip(&is_needed);
    let nodes = nodes.filter(|(draft, is_needed)| !**is_needed && draft.origin.uses.is_none());
    let nodes = nodes.map(|(draft, _)| (&draft.name, &draft.span, &draft.origin));
    let is_unused = |one: &&UseDraft| {
        one.origin.uses.is_none() && !is_needed[one.nodes.clone()].contains(&true)
    };
    let uses = expanded.uses.iter().filter(is_unused);
    for (name, span, origin) in nodes.chain(uses.map(|one| (&one.name, &one.span, &one.origin))) {
        report.enter(origin);
        let message = format!("no output needs node {}", shown(name));
        let warning = report.warning(Code::UnusedNode, message, span.clone(), "never evaluated");
        report.add(warning.in_node(&**name));
    }
}
