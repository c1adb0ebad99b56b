//! Divides cubes into tetrahedra and these by the surface.

use super::{Corner, Grid};
use std::collections::HashMap;

/// The triangles so far, and the edges on which their corners lie.
#[derive(Default)]
pub(super) struct Crossings {
    /// The corner inside and the one outside; the corner inside twice where the edge leads into a flat layer.
    pub(super) edges: Vec<[Corner; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) sides: Vec<u8>,
    known: HashMap<[Corner; 2], u32>,
}

/// Kuhn's tetrahedra: paths along the axes from corner 0 to corner 7 of a cube, those with an even order of axes first.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 2, 6, 7],
    [0, 4, 5, 7],
    [0, 1, 5, 7],
    [0, 2, 3, 7],
    [0, 4, 6, 7],
];

/// Even orders of four corners that begin with each of them.
const ONE: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];

/// Even orders of four corners that begin with each pair.
const TWO: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 3, 0, 1],
];

impl Crossings {
    /// Adds the triangles in a cube; bit k of a corner's number says whether it is the further one along axis k.
    pub(super) fn add_cube(&mut self, grid: &Grid, cube: Corner, inside: [bool; 8]) {
        if inside.iter().all(|it| *it == inside[0]) {
            return;
        }
        let side = grid.side(cube);
        for (number, corners) in TETRAHEDRA.iter().enumerate() {
            let triangles = crossed(corners.map(|corner| inside[corner]));
            for triangle in triangles.into_iter().flatten() {
                let mut points = triangle.map(|[a, b]| {
                    let corner = |end: usize| {
                        let number = corners[end];
                        [0, 1, 2].map(|axis| cube[axis] + (number >> axis & 1) as i32)
                    };
                    self.point(grid, corner(a), corner(b))
                });
                if number >= 3 {
                    points.swap(1, 2);
                }
                let [a, b, c] = points;
                if a != b && b != c && a != c {
                    self.triangles.push(points);
                    self.sides.push(side);
                }
            }
        }
    }

    fn point(&mut self, grid: &Grid, inside: Corner, outside: Corner) -> u32 {
        let edge = match grid.is_outside(outside) {
            true => [inside, inside],
            false => [inside, outside],
        };
        let next = self.edges.len() as u32;
        let index = *self.known.entry(edge).or_insert(next);
        if index == next {
            self.edges.push(edge);
        }
        index
    }
}

/// The triangles between the corners inside and those outside, as edges from inside to outside; seen from outside
/// they run counterclockwise if the corners are in even order.
fn crossed(inside: [bool; 4]) -> [Option<[[usize; 2]; 3]>; 2] {
    let is = |corner: usize| inside[corner];
    match inside.iter().filter(|it| **it).count() {
        1 => {
            let [a, b, c, d] = first(&ONE, |order| is(order[0]));
            [Some([[a, b], [a, c], [a, d]]), None]
        }
        2 => {
            let [a, b, c, d] = first(&TWO, |order| is(order[0]) && is(order[1]));
            [
                Some([[a, c], [a, d], [b, d]]),
                Some([[a, c], [b, d], [b, c]]),
            ]
        }
        3 => {
            let [a, b, c, d] = first(&ONE, |order| !is(order[0]));
            [Some([[d, a], [c, a], [b, a]]), None]
        }
        _ => [None, None],
    }
}

fn first(orders: &[[usize; 4]], suits: impl Fn(&[usize; 4]) -> bool) -> [usize; 4] {
    let found = orders.iter().copied().find(suits);
    found.expect("the orders begin with all choices of corners")
}
