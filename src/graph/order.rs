//! The order of nodes: which depends on which, circles, and nodes that no output needs.

use super::check::Draft;
use super::names::shown;
use super::report::Report;
use super::{Arithmetic, Link, Source};
use crate::diagnostics::Code;
use petgraph::Direction;
use petgraph::graph::{DiGraph, NodeIndex};
use std::collections::VecDeque;

/// Names of a circle that are printed.
const SHOWN: usize = 10;
/// Edges that are followed to find the shortest circle; beyond, the shortest so far is reported.
const STEPS: usize = 4_000_000;
/// Circles that are reported.
const CIRCLES: usize = 20;

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
    if let Ok(order) = petgraph::algo::toposort(graph, None) {
        return Some(order);
    }
    let mut is_left = vec![true; drafts.len()];
    let mut steps = STEPS;
    for _ in 0..CIRCLES {
        peel(graph, &mut is_left);
        let Some(circle) = shortest_circle(graph, &is_left, &mut steps) else {
            break;
        };
        report_circle(report, drafts, &circle);
        circle.iter().for_each(|node| is_left[node.index()] = false);
    }
    None
}

/// Takes away what is in no circle because nothing leads to it or nothing leads from it.
fn peel(graph: &DiGraph<(), ()>, is_left: &mut [bool]) {
    for direction in [Direction::Incoming, Direction::Outgoing] {
        let count = |node: NodeIndex, is_left: &[bool]| {
            graph
                .neighbors_directed(node, direction)
                .filter(|next| is_left[next.index()])
                .count()
        };
        let mut counts: Vec<_> = graph
            .node_indices()
            .map(|node| count(node, is_left))
            .collect();
        let is_end = |node: &NodeIndex| is_left[node.index()] && counts[node.index()] == 0;
        let mut ends: Vec<_> = graph.node_indices().filter(is_end).collect();
        while let Some(node) = ends.pop() {
            is_left[node.index()] = false;
            for next in graph.neighbors_directed(node, direction.opposite()) {
                if is_left[next.index()] {
                    counts[next.index()] -= 1;
                    if counts[next.index()] == 0 {
                        ends.push(next);
                    }
                }
            }
        }
    }
}

/// The shortest circle among the nodes that are left, the first in the file if there are several.
fn shortest_circle(
    graph: &DiGraph<(), ()>,
    is_left: &[bool],
    steps: &mut usize,
) -> Option<Vec<NodeIndex>> {
    let mut best: Option<Vec<NodeIndex>> = None;
    let mut search = Search {
        reached_from: vec![None; is_left.len()],
        reached: vec![],
    };
    for start in graph.node_indices().filter(|node| is_left[node.index()]) {
        let longest = best.as_ref().map_or(usize::MAX, |circle| circle.len() - 1);
        if best.is_some() && *steps == 0 {
            break;
        }
        if let Some(circle) = search.circle(graph, is_left, start, longest, steps) {
            best = Some(circle);
        }
    }
    best
}

/// A search in breadth; what it remembers is used again.
struct Search {
    reached_from: Vec<Option<NodeIndex>>,
    reached: Vec<NodeIndex>,
}

impl Search {
    /// The shortest circle through `start`, if it has at most `longest` nodes.
    fn circle(
        &mut self,
        graph: &DiGraph<(), ()>,
        is_left: &[bool],
        start: NodeIndex,
        longest: usize,
        steps: &mut usize,
    ) -> Option<Vec<NodeIndex>> {
        for node in self.reached.drain(..) {
            self.reached_from[node.index()] = None;
        }
        let mut pending = VecDeque::from([(start, 1)]);
        while let Some((node, length)) = pending.pop_front() {
            for next in graph.neighbors(node).filter(|next| is_left[next.index()]) {
                *steps = steps.saturating_sub(1);
                if next == start {
                    return Some(self.path(start, node));
                }
                if self.reached_from[next.index()].is_none() && length < longest {
                    self.reached_from[next.index()] = Some(node);
                    self.reached.push(next);
                    pending.push_back((next, length + 1));
                }
            }
        }
        None
    }

    /// The nodes from `start` to `end`.
    fn path(&self, start: NodeIndex, end: NodeIndex) -> Vec<NodeIndex> {
        let mut path = vec![end];
        let mut node = end;
        while node != start {
            let Some(before) = self.reached_from[node.index()] else {
                break;
            };
            path.push(before);
            node = before;
        }
        path.reverse();
        path
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

/// Warns about nodes that no output needs, if there are outputs.
pub(super) fn report_unused(report: &mut Report, drafts: &[Draft]) {
    let mut is_needed: Vec<_> = drafts.iter().map(|draft| draft.is_output).collect();
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
    for (draft, _) in drafts
        .iter()
        .zip(is_needed)
        .filter(|(_, is_needed)| !is_needed)
    {
        let message = format!("no output needs node {}", shown(&draft.name));
        report.add(
            report
                .warning(
                    Code::UnusedNode,
                    message,
                    draft.span.clone(),
                    "never evaluated",
                )
                .in_node(&*draft.name),
        );
    }
}
