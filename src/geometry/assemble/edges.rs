//! Which cell lies beyond each edge.

use super::draft::Draft;
use super::weld::Corner;
use crate::value::Partition;
use rayon::prelude::*;
use std::cmp::Ordering;

/// How much the bends of two sides of one edge may differ.
const BEND: f64 = 1e-6;

/// An edge as seen from its first end, whichever way the ring runs.
#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [u32; 2],
    /// Periods from the first end to the second.
    away: [i32; 2],
    bend: f64,
    is_forward: bool,
    piece: u32,
    /// Its place among all edges.
    index: u32,
}

impl Edge {
    fn new(from: Corner, to: Corner, bend: f64, piece: usize, index: usize) -> Edge {
        let away = [0, 1].map(|axis| to.period[axis] - from.period[axis]);
        let is_forward = (from.point, [0; 2]) < (to.point, away);
        let edge = Edge {
            ends: [from.point, to.point],
            away,
            bend,
            is_forward,
            piece: piece as u32,
            index: index as u32,
        };
        if is_forward {
            return edge;
        }
        Edge {
            ends: [to.point, from.point],
            away: away.map(|periods| -periods),
            bend: -bend,
            ..edge
        }
    }

    fn is_between_the_ends_of(&self, other: &Edge) -> bool {
        self.ends == other.ends && self.away == other.away
    }

    fn order(&self, other: &Edge) -> Ordering {
        let by_ends = (self.ends, self.away).cmp(&(other.ends, other.away));
        let by_bend = by_ends.then(self.bend.total_cmp(&other.bend));
        by_bend.then(self.index.cmp(&other.index))
    }
}

/// The piece beyond each edge, in the order of the pieces' corners.
pub(super) fn neighbours(draft: &Draft) -> Vec<u32> {
    let mut edges = vec![];
    for (piece, rings) in draft.pieces.iter().enumerate() {
        for ring in rings {
            let next = ring.corners.iter().cycle().skip(1);
            for ((from, to), bulge) in ring.corners.iter().zip(next).zip(&ring.bulges) {
                edges.push(Edge::new(*from, *to, *bulge, piece, edges.len()));
            }
        }
    }
    edges.par_sort_unstable_by(Edge::order);
    let mut neighbours = vec![Partition::NONE; edges.len()];
    for group in edges.chunk_by(Edge::is_between_the_ends_of) {
        pair(group, &mut neighbours);
    }
    neighbours
}

/// Pairs the sides of edges that lie on each other.
fn pair(group: &[Edge], neighbours: &mut [u32]) {
    let mut backward = group.iter().filter(|edge| !edge.is_forward).peekable();
    for forward in group.iter().filter(|edge| edge.is_forward) {
        while backward
            .next_if(|edge| edge.bend < forward.bend - BEND)
            .is_some()
        {}
        if let Some(other) = backward.next_if(|edge| edge.bend <= forward.bend + BEND) {
            neighbours[forward.index as usize] = other.piece;
            neighbours[other.index as usize] = forward.piece;
        }
    }
}
