//! How good a packing is: order, gaps, joints, overlaps.

use super::direction::{power, unturned};
use glam::DVec2;

/// The direction that the edges of an outline agree on best, of length 1, if they agree on any.
pub(crate) fn axis(outline: &[DVec2], symmetry: u32) -> Option<DVec2> {
    let next = outline.iter().cycle().skip(1);
    let edges = outline.iter().zip(next).map(|(from, to)| *to - *from);
    let turned = edges.filter_map(|edge| {
        let length = edge.length();
        (length > 0.0).then(|| length * power(edge / length, symmetry))
    });
    let sum: DVec2 = turned.sum();
    (sum != DVec2::ZERO).then(|| unturned(sum, symmetry))
}
