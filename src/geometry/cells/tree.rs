//! The edges of a cell that has many, in a tree.

use super::edge::Edge;
use crate::geometry::box_tree::BoxTree;
use glam::DVec2;
use std::convert::Infallible;

/// Edges with the corners before them, found by place.
#[derive(Debug)]
pub(super) struct EdgeTree {
    edges: Vec<(Edge, u32)>,
    tree: BoxTree,
}

impl EdgeTree {
    pub(super) fn new(edges: Vec<(Edge, u32)>) -> EdgeTree {
        let boxes: Vec<[DVec2; 2]> = edges.iter().map(|(edge, _)| edge.around()).collect();
        let Ok(tree) = BoxTree::new(&boxes, &mut || Ok::<(), Infallible>(()));
        EdgeTree { edges, tree }
    }

    /// Whether a point is inside, the square of its distance to the nearest edge, and the corner before that edge.
    pub(super) fn meet(&self, point: DVec2) -> (bool, f64, u32) {
        let ray = [point, DVec2::new(f64::INFINITY, point.y)];
        let mut is_inside = false;
        self.tree.visit(ray, &mut |edge| {
            is_inside ^= self.edges[edge as usize].0.turns_over(point);
        });
        let distance = |edge: u32| self.edges[edge as usize].0.distance_squared(point);
        let nearest = self.tree.nearest(point, distance);
        let nearest = nearest.expect("a cell has edges");
        (is_inside, distance(nearest), self.edges[nearest as usize].1)
    }
}
