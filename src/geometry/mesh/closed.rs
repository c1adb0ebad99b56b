//! Tells whether a mesh bounds a space, with its outside where its triangles run counterclockwise.

use super::numbered;
use crate::value::{Mesh, Triangle};
use glam::DVec3;
use std::collections::HashMap;

/// Why a mesh does not bound a space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Open {
    /// Some edges are run through more often in one direction than in the other.
    Edges {
        /// How many.
        count: usize,
        /// The middle of one of them, in mm.
        place: DVec3,
    },
    /// Its triangles run clockwise, seen from outside.
    InsideOut,
}

/// Points of one cell of a grid, as a part of the largest coordinate, count as one: seams of files are off by rounding.
const NEAR: f64 = 1e-6;

/// Whether a mesh bounds a space; points at almost the same place count as one.
///
/// # Errors
/// [`Open`].
pub(crate) fn check_closed(mesh: &Mesh) -> Result<(), Open> {
    let largest = |largest: f64, point: &DVec3| largest.max(point.abs().max_element());
    let step = NEAR * mesh.points.iter().fold(f64::MIN_POSITIVE, largest);
    let cell = |point: &DVec3| (*point / step).to_array().map(|part| part.round() as i64);
    let numbers = numbered(mesh.points.iter().map(cell), &mut HashMap::new());
    let mut edges: Vec<u64> = mesh.triangles.iter().flat_map(edges(&numbers)).collect();
    edges.sort_unstable();
    let is_uneven = |of_edge: &&[u64]| {
        let back = of_edge.iter().filter(|edge| **edge & 1 == 1).count();
        2 * back != of_edge.len()
    };
    let mut uneven = edges.chunk_by(|a, b| a >> 1 == b >> 1).filter(is_uneven);
    if let Some(edge) = uneven.next() {
        return Err(Open::Edges {
            count: 1 + uneven.count(),
            place: middle(mesh, &numbers, edge[0]),
        });
    }
    match volume(mesh) > 0.0 {
        true => Ok(()),
        false => Err(Open::InsideOut),
    }
}

/// The edges of a triangle: both numbers, the lower one first, and in the last bit whether they are turned. Those
/// whose ends count as one are none.
fn edges(numbers: &[u32]) -> impl Fn(&Triangle) -> Vec<u64> {
    |triangle| {
        let [a, b, c] = triangle.points.map(|index| numbers[index as usize]);
        let edge = |(from, to): (u32, u32)| {
            let (low, high) = (u64::from(from.min(to)), u64::from(from.max(to)));
            // A mesh has fewer than 2^31 points.
            low << 32 | high << 1 | u64::from(from > to)
        };
        let ends = [(a, b), (b, c), (c, a)].into_iter();
        ends.filter(|(from, to)| from != to).map(edge).collect()
    }
}

fn middle(mesh: &Mesh, numbers: &[u32], edge: u64) -> DVec3 {
    let place = |number: u64| {
        let index = numbers.iter().position(|it| u64::from(*it) == number);
        index.map_or(DVec3::ZERO, |index| mesh.points[index])
    };
    place(edge >> 32).midpoint(place(edge >> 1 & 0x7fff_ffff))
}

/// Six times the space that a mesh bounds.
fn volume(mesh: &Mesh) -> f64 {
    // Seen from a point of its own, so that a mesh far away loses no digits.
    let origin = mesh.points.first().copied().unwrap_or_default();
    let part = |triangle: &Triangle| {
        let [a, b, c] = triangle
            .points
            .map(|index| mesh.points[index as usize] - origin);
        a.dot(b.cross(c))
    };
    mesh.triangles.iter().map(part).sum()
}
