//! Convex cells: what is left lies inside of all sides.

use super::sides::Side;
use glam::DVec2;

/// What lies inside of all sides where they come to lie: corners, and the side that each edge is on (Sutherland & Hodgman 1974).
pub(super) fn cut(sides: &[Side]) -> (Vec<DVec2>, Vec<usize>) {
    let mut corners: Vec<DVec2> = sides.iter().map(|side| side.from).collect();
    let mut of: Vec<usize> = (0..sides.len()).collect();
    for (number, side) in sides.iter().enumerate() {
        if side.off > 0.0 {
            (corners, of) = beyond(&corners, &of, side, number);
        }
    }
    (corners, of)
}

/// The part of a convex ring inside of a side.
fn beyond(corners: &[DVec2], of: &[usize], side: &Side, number: usize) -> (Vec<DVec2>, Vec<usize>) {
    let inside: Vec<f64> = corners.iter().map(|corner| side.inside(*corner)).collect();
    let (mut kept, mut kept_of) = (vec![], vec![]);
    for index in 0..corners.len() {
        let next = (index + 1) % corners.len();
        let (here, there) = (inside[index], inside[next]);
        if here >= 0.0 {
            kept.push(corners[index]);
            // An edge that leaves the inside where it begins is on the cut.
            kept_of.push(if here == 0.0 && there < 0.0 {
                number
            } else {
                of[index]
            });
        }
        if here > 0.0 && there < 0.0 || here < 0.0 && there > 0.0 {
            kept.push(corners[index] + (corners[next] - corners[index]) * (here / (here - there)));
            kept_of.push(if here > 0.0 { number } else { of[index] });
        }
    }
    (kept, kept_of)
}
