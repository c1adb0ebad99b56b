//! Sorting a graph, and the shortest circles of one that cannot be sorted.

use petgraph::Direction;
use petgraph::graph::{DiGraph, NodeIndex};
use std::collections::VecDeque;

/// Edges that are followed to find the shortest circle; beyond, the shortest so far is given.
const STEPS: usize = 4_000_000;
/// Circles that are given.
const CIRCLES: usize = 20;

/// The nodes so that each comes after those that lead to it.
///
/// # Errors
/// The shortest circles, none of which shares a node with another.
pub(super) fn sort(graph: &DiGraph<(), ()>) -> Result<Vec<NodeIndex>, Vec<Vec<NodeIndex>>> {
    if let Ok(order) = petgraph::algo::toposort(graph, None) {
        return Ok(order);
    }
    let mut is_left = vec![true; graph.node_count()];
    let mut steps = STEPS;
    let mut circles = vec![];
    for _ in 0..CIRCLES {
        peel(graph, &mut is_left);
        let Some(circle) = shortest_circle(graph, &is_left, &mut steps) else {
            break;
        };
        circle.iter().for_each(|node| is_left[node.index()] = false);
        circles.push(circle);
    }
    Err(circles)
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
