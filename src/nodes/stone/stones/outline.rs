//! Outlines of stones: from cells, narrower by the joint, with rounded corners.

use crate::value::Partition;
use glam::DVec2;
use std::f64::consts::PI;

/// Arcs are drawn with a corner at least every so many radians.
const ARC: f64 = 0.3;

/// The corners of a cell around its centre, counterclockwise: arcs as short edges, and no corner within a straight edge.
pub(super) fn of_cell(partition: &Partition, cell: usize) -> Vec<DVec2> {
    let Some(ring) = partition.rings_of(cell).next() else {
        return vec![];
    };
    let centre = partition.centres[cell];
    let mut corners = vec![];
    for corner in ring.clone() {
        let next = if corner + 1 < ring.end {
            corner + 1
        } else {
            ring.start
        };
        let [from, to] = [corner, next].map(|index| partition.corners[index] - centre);
        add_arc(&mut corners, from, to, partition.bulge(corner));
    }
    without_straight_corners(corners)
}

/// Adds the points of an edge without its end.
fn add_arc(corners: &mut Vec<DVec2>, from: DVec2, to: DVec2, bulge: f64) {
    let angle = 4.0 * libm::atan(bulge);
    let steps = (angle.abs() / ARC).ceil().max(1.0);
    corners.push(from);
    if bulge == 0.0 {
        return;
    }
    // The centre lies on the perpendicular of the chord's middle.
    let chord = to - from;
    let centre = 0.5 * (from + to) + chord.perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
    for step in 1..steps as usize {
        let (sine, cosine) = libm::sincos(angle * step as f64 / steps);
        corners.push(centre + DVec2::new(cosine, sine).rotate(from - centre));
    }
}

/// Drops corners that lie on the line between their neighbours, where cells meet the middle of an edge.
fn without_straight_corners(mut corners: Vec<DVec2>) -> Vec<DVec2> {
    let is_corner = |before: DVec2, here: DVec2, after: DVec2| {
        let (one, other) = (here - before, after - here);
        one.perp_dot(other).abs() > 1e-6 * (one.length_squared() + other.length_squared())
    };
    let mut index = 0;
    while index < corners.len() && corners.len() > 2 {
        let count = corners.len();
        let [before, after] = [count - 1, 1].map(|step| corners[(index + step) % count]);
        match is_corner(before, corners[index], after) {
            true => index += 1,
            false => {
                corners.remove(index);
                index = index.saturating_sub(1);
            }
        }
    }
    corners
}

/// Twice the area.
fn doubled_area(corners: &[DVec2]) -> f64 {
    edges(corners).map(|[from, to]| from.perp_dot(to)).sum()
}

pub(super) fn edges(corners: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + Clone {
    let count = corners.len();
    (0..count).map(move |index| [corners[index], corners[(index + 1) % count]])
}

pub(super) fn is_convex(corners: &[DVec2]) -> bool {
    let count = corners.len();
    edges(corners)
        .enumerate()
        .all(|(index, [from, to])| (to - from).perp_dot(corners[(index + 2) % count] - to) > 0.0)
}

/// An outline whose edges are moved inwards, each by a length of its own; `None` if nothing is left.
pub(super) fn inset(corners: &[DVec2], by: &mut dyn FnMut() -> f64) -> Option<Vec<DVec2>> {
    let lengths = along_arcs(corners, corners.iter().map(|_| by()).collect());
    let size = doubled_area(corners).abs().sqrt();
    let left = match is_convex(corners) {
        true => clipped(corners, &lengths),
        false => mitred(corners, &lengths)?,
    };
    let mut left: Vec<DVec2> = without_straight_corners(left);
    left.dedup_by(|one, other| one.distance(*other) < 1e-3 * size);
    (left.len() > 2 && doubled_area(&left) > 1e-3 * size * size).then_some(left)
}

/// Edges that turn by less than this, in radians, belong to one arc or are one side.
const SMOOTH: f64 = 0.35;

/// The same lengths, but one for all the edges of an arc.
fn along_arcs(corners: &[DVec2], mut lengths: Vec<f64>) -> Vec<f64> {
    let count = corners.len();
    let along: Vec<DVec2> = edges(corners).map(|[from, to]| to - from).collect();
    // Twice around, since the first edge may go on the last.
    for index in 1..2 * count {
        let (before, here) = ((index - 1) % count, index % count);
        if along[before].angle_to(along[here]).abs() < SMOOTH {
            lengths[here] = lengths[before];
        }
    }
    lengths
}

/// A convex outline less the strips along its edges (Sutherland & Hodgman 1974).
fn clipped(corners: &[DVec2], lengths: &[f64]) -> Vec<DVec2> {
    let mut left = corners.to_vec();
    for ([from, to], length) in edges(corners).zip(lengths) {
        let inwards = (to - from).normalize_or_zero().perp();
        let depth = |point: DVec2| (point - from).dot(inwards) - length;
        let cut = |[one, other]: [DVec2; 2]| {
            let (a, b) = (depth(one), depth(other));
            let crossing = (a > 0.0) != (b > 0.0);
            let kept = (a > 0.0).then_some(one);
            kept.into_iter()
                .chain(crossing.then(|| one + (other - one) * (a / (a - b))))
        };
        left = edges(&left).flat_map(cut).collect();
    }
    left
}

/// An outline whose corners move to where the moved edges meet. Edges that would turn round are left out; `None` if that
/// leaves nothing.
fn mitred(corners: &[DVec2], lengths: &[f64]) -> Option<Vec<DVec2>> {
    let line = |([from, to], length): ([DVec2; 2], &f64)| {
        let along = (to - from).normalize_or_zero();
        (from + along.perp() * *length, along)
    };
    let mut lines: Vec<(DVec2, DVec2)> = edges(corners).zip(lengths).map(line).collect();
    while lines.len() > 2 {
        let count = lines.len();
        let meet = |index: usize| meeting(lines[(index + count - 1) % count], lines[index]);
        let moved: Vec<DVec2> = (0..count).map(meet).collect();
        let turned = edges(&moved)
            .zip(&lines)
            .position(|([from, to], (_, along))| (to - from).dot(*along) <= 0.0);
        match turned {
            Some(edge) => lines.remove(edge),
            None => return Some(moved),
        };
    }
    None
}

/// Where two lines meet, each a point and a direction; on the second if they are parallel.
fn meeting((one, along): (DVec2, DVec2), (other, across): (DVec2, DVec2)) -> DVec2 {
    let turn = along.perp_dot(across);
    match turn.abs() < 1e-3 {
        true => other,
        false => one + along * ((other - one).perp_dot(across) / turn),
    }
}

/// For each corner the radius to which it can be rounded, where edges are short less than the one that is wanted.
pub(super) fn radii(corners: &[DVec2], radius: f64) -> Vec<f64> {
    let count = corners.len();
    let of_corner = |index: usize| {
        let [before, after] =
            [count - 1, 1].map(|step| corners[(index + step) % count] - corners[index]);
        let [short, long] = [before.length(), after.length()];
        let turn = PI - libm::acos((before.dot(after) / (short * long)).clamp(-1.0, 1.0));
        let reach = libm::tan(0.5 * turn);
        radius.min(0.45 * short.min(long) / reach.max(1e-9))
    };
    (0..count).map(of_corner).collect()
}

/// An outline with corners rounded to a radius, or less where edges are short.
pub(super) fn rounded(corners: &[DVec2], radius: f64) -> Vec<DVec2> {
    let count = corners.len();
    let mut rounded = vec![];
    for (index, corner) in corners.iter().enumerate() {
        let [before, after] = [count - 1, 1].map(|step| corners[(index + step) % count] - *corner);
        let [short, long] = [before.length(), after.length()];
        let (back, ahead) = (before / short, after / long);
        let turn = PI - libm::acos(back.dot(ahead).clamp(-1.0, 1.0));
        let reach = libm::tan(0.5 * turn);
        let tangent = (radius * reach).min(0.45 * short.min(long));
        let steps = (turn / ARC).ceil();
        if radius <= 0.0 || tangent < 1e-6 || steps < 1.0 {
            rounded.push(*corner);
            continue;
        }
        let bulge = libm::tan(0.25 * turn)
            * if back.perp_dot(ahead) < 0.0 {
                1.0
            } else {
                -1.0
            };
        let (from, to) = (*corner + back * tangent, *corner + ahead * tangent);
        add_arc(&mut rounded, from, to, bulge);
        rounded.push(to);
    }
    rounded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_keep_one_width_and_leave_a_stone() {
        // A cell of a fan: its long sides are arcs, one bent inwards.
        let arc = |radius: f64| {
            (0..=8).map(move |step| {
                let (sine, cosine) = libm::sincos(0.1 * f64::from(step));
                DVec2::new(cosine, sine) * radius
            })
        };
        let mut back: Vec<DVec2> = arc(100.0).collect();
        back.reverse();
        let corners: Vec<DVec2> = arc(180.0).chain(back).collect();
        assert!(!is_convex(&corners));
        let mut widths = (0..).map(|edge| 4.0 + f64::from(edge % 3));
        let left = inset(&corners, &mut || widths.next().unwrap()).unwrap();
        let radii = left.iter().map(|corner| corner.length());
        let (low, high) = radii.fold((f64::MAX, 0.0f64), |(low, high), radius| {
            (low.min(radius), high.max(radius))
        });
        assert!((103.5..107.0).contains(&low), "{low}");
        assert!((173.0..176.5).contains(&high), "{high}");
        assert!(doubled_area(&left) > 0.7 * doubled_area(&corners));
    }

    #[test]
    fn edges_that_would_turn_round_are_left_out() {
        let notched = [
            (0.0, 0.0),
            (100.0, 0.0),
            (100.0, 100.0),
            (51.0, 100.0),
            (50.0, 99.0),
            (49.0, 100.0),
            (0.0, 100.0),
        ];
        let corners: Vec<DVec2> = notched.map(DVec2::from).to_vec();
        let left = inset(&corners, &mut || 5.0).unwrap();
        let area = 0.5 * doubled_area(&left);
        assert!((7900.0..8150.0).contains(&area), "{area}");
    }
}
