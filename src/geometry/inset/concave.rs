//! Cells that are not convex, or have holes: what lies within the moved distance of a side is taken away.

use super::sides::Side;
use crate::geometry::polygon::{Lattice, Operation, area};
use crate::value::Polygon;
use glam::DVec2;

/// A pointed corner goes so many times the distance off, at most.
const FARTHEST: f64 = 4.0;

/// A ring as its corners, and the side that each edge is on.
type Sided = (Vec<DVec2>, Vec<usize>);

/// The largest part that is left of a cell, ring by ring, and how many parts there are.
pub(super) fn cut(rings: &[&[DVec2]], sides: &[Side]) -> (Vec<Sided>, usize) {
    let corners = rings.iter().copied().flatten();
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    let [low, high] = corners.fold(none, |[low, high], at| [low.min(*at), high.max(*at)]);
    let most = sides.iter().map(|side| side.off).fold(0.0, f64::max);
    let away: Vec<Vec<DVec2>> = sides
        .iter()
        .filter(|side| side.off > 0.0)
        .map(strip)
        .collect();
    let corners = sides.iter().flat_map(|before| {
        let behind = sides.iter().filter(move |next| next.from == before.to);
        behind.filter_map(move |next| {
            let ends = [before, next].map(|side| (side.along, side.off));
            corner(before.to, ends)
        })
    });
    let away: Vec<Vec<DVec2>> = away.into_iter().chain(corners).collect();
    let away: Vec<&[DVec2]> = away.iter().map(|ring| &ring[..]).collect();
    let lattice = Lattice::around([low - FARTHEST * most, high + FARTHEST * most]);
    let parts = lattice.overlay(Operation::Difference, rings, &away);
    let (left, count) = largest(&parts, lattice);
    let rings = left.iter().map(|ring| joined(ring, &sides_of(ring, sides)));
    (rings.collect(), count)
}

/// The rings of the largest part, without edges that are no longer than rounding, and how many parts there are that
/// are more than rounding.
pub(super) fn largest(parts: &[Polygon], lattice: Lattice) -> (Vec<Vec<DVec2>>, usize) {
    let size = |part: &Polygon| area(std::slice::from_ref(part));
    let largest = parts
        .iter()
        .reduce(|best, next| if size(next) > size(best) { next } else { best });
    let near = 64.0 * lattice.step();
    let is_part = |part: &&Polygon| size(part) > near * perimeter(&part.outline);
    let rings = largest.into_iter().flat_map(Polygon::rings);
    let rings = rings.map(|ring| without_points(ring, near));
    (rings.collect(), parts.iter().filter(is_part).count())
}

fn perimeter(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
}

/// A ring without the edges that are no longer than rounding.
fn without_points(ring: &[DVec2], near: f64) -> Vec<DVec2> {
    let before = |index: usize| ring[(index + ring.len() - 1) % ring.len()];
    let is_apart = |index: &usize| before(*index).distance(ring[*index]) > near;
    let kept = (0..ring.len()).filter(is_apart);
    kept.map(|index| ring[index]).collect()
}

/// A ring without the corners between two edges of one side, which rounding leaves.
fn joined(ring: &[DVec2], of: &[usize]) -> (Vec<DVec2>, Vec<usize>) {
    let before = |index: usize| of[(index + of.len() - 1) % of.len()];
    let kept = (0..ring.len()).filter(|index| before(*index) != of[*index]);
    kept.map(|index| (ring[index], of[index])).unzip()
}

/// What a side sweeps over.
fn strip(side: &Side) -> Vec<DVec2> {
    let off = side.along.perp() * side.off;
    vec![side.from, side.to, side.to + off, side.from + off]
}

/// What lies between the strips of two sides with a corner between them where the ring turns right; of each its direction there
/// and how far it moves.
pub(super) fn corner(at: DVec2, sides: [(DVec2, f64); 2]) -> Option<Vec<DVec2>> {
    let [(before, first), (next, second)] = sides;
    let sine = before.perp_dot(next);
    let farther = first.max(second);
    if sine >= 0.0 || farther <= 0.0 {
        return None;
    }
    let [a, b] = sides.map(|(along, off)| along.perp() * off);
    // Where both moved lines meet.
    let point = a + before * ((b - a).perp_dot(next) / sine);
    let is_near = point.length() <= FARTHEST * farther;
    let point = is_near.then_some(at + point);
    let ring = [Some(at), Some(at + b), point, Some(at + a)];
    Some(ring.into_iter().flatten().collect())
}

/// The side that each edge of a ring is nearest to in place and direction.
fn sides_of(ring: &[DVec2], sides: &[Side]) -> Vec<usize> {
    let next = ring.iter().cycle().skip(1);
    let edges = ring.iter().zip(next);
    edges
        .map(|(from, to)| {
            let along = (*to - *from).normalize_or_zero();
            let middle = 0.5 * (*from + *to);
            let off = |side: &Side| {
                let beside = (middle - side.from).dot(side.along);
                let beyond = (-beside).max(beside - side.from.distance(side.to)).max(0.0);
                let aside = side.along.distance(along) * from.distance(*to);
                side.inside(middle).abs() + 0.1 * beyond + aside
            };
            let best = (0..sides.len()).min_by(|a, b| off(&sides[*a]).total_cmp(&off(&sides[*b])));
            best.unwrap_or_default()
        })
        .collect()
}
