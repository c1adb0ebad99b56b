//! Cells that become one: of an owner, or too small to be alone.

use super::draft::Draft;
use super::weld::Corner;
use super::{Piece, Ring, assemble_kept};
use crate::geometry::polygon::Measure;
use crate::value::Partition;
use glam::DVec2;
use std::collections::{BTreeMap, VecDeque};

/// How far apart corners of one partition may be that count as one, as a share of its extent.
const NEAR: f64 = 1e-12;

/// Cells looked at between two questions whether to go on.
const AT_ONCE: usize = 1024;

/// Joins cells that have the same number in `owner` into one cell each, whose id, frame and attributes are those of the
/// largest, and in whose place it comes. Parts that do not hang together by an edge stay apart. `go_on` is asked now and
/// then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn dissolve<E>(
    partition: &Partition,
    owner: &[u32],
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Partition, E> {
    let tolerance = NEAR * extent(partition);
    let draft = Draft::of(partition, tolerance, go_on)?;
    let by_area = |a: &usize, b: &usize| {
        let areas = [*a, *b].map(|cell| partition.areas[cell]);
        areas[0].total_cmp(&areas[1]).then(b.cmp(a))
    };
    let mut all = vec![];
    for (number, group) in groups(partition, &draft, owner, go_on)?.iter().enumerate() {
        if number.is_multiple_of(AT_ONCE) {
            go_on()?;
        }
        let members = group.iter().map(|(cell, _)| *cell);
        if let Some(largest) = members.max_by(by_area) {
            all.push((largest, joined(partition, &draft, group, largest)));
        }
    }
    all.sort_by_key(|(largest, _)| *largest);
    let (members, pieces): (Vec<usize>, Vec<Piece>) = all.into_iter().unzip();
    let (mut joined, kept) = assemble_kept(pieces, partition.period, tolerance, go_on)?;
    for (name, numbers) in &partition.attributes {
        let numbers = kept.iter().map(|piece| numbers[members[*piece]]).collect();
        joined.attributes.insert(name.clone(), numbers);
    }
    Ok(joined)
}

/// Joins cells of less than their `least` mm² to the neighbour they share the longest border with, the smallest first, until
/// none is left that has a neighbour; and how many that were. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn merge_slivers<E>(
    partition: &Partition,
    least: impl Fn(usize) -> f64,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(Partition, usize), E> {
    let mut owner: Vec<u32> = (0..partition.len() as u32).collect();
    let mut areas = partition.areas.clone();
    let mut small: Vec<usize> = (0..partition.len())
        .filter(|cell| areas[*cell] < least(*cell))
        .collect();
    small.sort_by(|a, b| areas[*a].total_cmp(&areas[*b]).then(a.cmp(b)));
    let mut count = 0;
    for (number, cell) in small.into_iter().enumerate() {
        if number.is_multiple_of(AT_ONCE) {
            go_on()?;
        }
        let root = root(&owner, cell);
        if areas[root] >= least(root) {
            continue;
        }
        if let Some(other) = longest_border(partition, cell, root, &owner) {
            owner[root] = other as u32;
            areas[other] += areas[root];
            count += 1;
        }
    }
    if count == 0 {
        return Ok((partition.clone(), 0));
    }
    let owner: Vec<u32> = (0..owner.len())
        .map(|cell| root(&owner, cell) as u32)
        .collect();
    Ok((dissolve(partition, &owner, go_on)?, count))
}

/// The owner other than its own that a cell has the longest border with; of equally long borders the first.
fn longest_border(partition: &Partition, cell: usize, own: usize, owner: &[u32]) -> Option<usize> {
    let borders = borders(partition, cell, |other| root(owner, other));
    let others = borders.into_iter().filter(|(other, _)| *other != own);
    let longest = others.fold(None, |best: Option<(usize, f64)>, (other, length)| {
        best.filter(|best| best.1 >= length)
            .or(Some((other, length)))
    });
    longest.map(|(other, _)| other)
}

fn root(owner: &[u32], mut cell: usize) -> usize {
    while owner[cell] as usize != cell {
        cell = owner[cell] as usize;
    }
    cell
}

/// How long the border of a cell is with each of its neighbours, as they are named.
fn borders(
    partition: &Partition,
    cell: usize,
    name: impl Fn(usize) -> usize,
) -> BTreeMap<usize, f64> {
    let mut borders = BTreeMap::new();
    for ring in partition.rings_of(cell) {
        for corner in ring.clone() {
            let next = if corner + 1 == ring.end {
                ring.start
            } else {
                corner + 1
            };
            let beyond = partition.neighbours[corner];
            if beyond != Partition::NONE {
                let length = partition.corners[corner].distance(partition.corners[next]);
                *borders.entry(name(beyond as usize)).or_insert(0.0) += length;
            }
        }
    }
    borders
}

fn extent(partition: &Partition) -> f64 {
    let largest = partition
        .corners
        .iter()
        .map(|corner| corner.abs().max_element());
    largest.fold(f64::MIN_POSITIVE, f64::max)
}

/// Cells of one owner that hang together, each with the periods it must be moved by to lie beside the first.
type Group = Vec<(usize, [i32; 2])>;

fn groups<E>(
    partition: &Partition,
    draft: &Draft,
    owner: &[u32],
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Vec<Group>, E> {
    let mut seen = vec![false; partition.len()];
    let mut groups = vec![];
    for first in 0..partition.len() {
        if first.is_multiple_of(AT_ONCE) {
            go_on()?;
        }
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut group = vec![];
        let mut waiting = VecDeque::from([(first, [0; 2])]);
        while let Some((cell, moved)) = waiting.pop_front() {
            group.push((cell, moved));
            for (from, to, beyond, _) in draft.edges(partition, cell) {
                let other = beyond as usize;
                if beyond == Partition::NONE || owner[other] != owner[cell] || seen[other] {
                    continue;
                }
                let Some(back) = draft.facing(partition, other, from, to) else {
                    continue;
                };
                seen[other] = true;
                let by = [0, 1].map(|axis| moved[axis] + from.period[axis] - back.period[axis]);
                waiting.push_back((other, by));
            }
        }
        groups.push(group);
    }
    Ok(groups)
}

/// The piece of some cells that hang together.
fn joined(partition: &Partition, draft: &Draft, group: &Group, largest: usize) -> Piece {
    let rings = match group[..] {
        [_] => draft.drawn(partition, largest),
        _ => chained(draft, border(partition, draft, group)),
    };
    let moved = group.iter().find(|(cell, _)| *cell == largest);
    let [x, y] = moved.map_or([0; 2], |moved| moved.1).map(f64::from);
    let aside = DVec2::new(x, y) * partition.period.unwrap_or_default();
    let centre = own_middle(partition, draft, largest).map(|centre| centre + aside);
    Piece {
        rings,
        id: partition.ids[largest],
        frame: partition.frames[largest],
        centre: centre.filter(|_| group.len() == 1),
    }
}

/// The middle of a cell if it is not its centre of gravity.
fn own_middle(partition: &Partition, draft: &Draft, cell: usize) -> Option<DVec2> {
    let rings = draft.drawn(partition, cell);
    let whole = rings.iter().map(Ring::measure);
    let whole = whole.fold(Measure::default(), |whole, ring| whole + ring);
    let near = 1e-9 * whole.area.abs().sqrt();
    let centre = partition.centres[cell];
    (centre.distance(whole.centre()) > near).then_some(centre)
}

/// Edges by the corner they begin at: the corners they end at, and their bends.
type Border = BTreeMap<Corner, Vec<(Corner, f64)>>;

/// The edges of a group that do not lie between two of its cells.
fn border(partition: &Partition, draft: &Draft, group: &Group) -> Border {
    let mut border = Border::new();
    for (cell, moved) in group {
        for (from, to, _, bend) in draft.edges(partition, *cell) {
            let [from, to] = [from, to].map(|corner| corner.moved(*moved));
            let against = border.get_mut(&to);
            let facing = against
                .as_ref()
                .and_then(|edges: &&mut Vec<(Corner, f64)>| {
                    edges
                        .iter()
                        .position(|(end, other)| *end == from && (bend + other).abs() < 1e-6)
                });
            match (against, facing) {
                (Some(edges), Some(at)) => {
                    edges.remove(at);
                }
                _ => border.entry(from).or_default().push((to, bend)),
            }
        }
    }
    border
}

/// The rings that edges make, the outline first. Where rings touch, the sharpest turn to the left keeps them apart.
fn chained(draft: &Draft, mut border: Border) -> Vec<Ring> {
    let mut rings = vec![];
    while let Some(start) = border
        .iter()
        .find(|(_, ends)| !ends.is_empty())
        .map(|it| *it.0)
    {
        let mut ring = Ring::straight(vec![]);
        let (mut at, mut from) = (start, None);
        while let Some(edges) = border.get_mut(&at).filter(|edges| !edges.is_empty()) {
            let here = draft.place(at);
            let back = from.map_or(DVec2::X, |from| draft.place(from) - here);
            let turn = |end: Corner| clockwise(back, draft.place(end) - here);
            let best =
                (0..edges.len()).min_by(|a, b| turn(edges[*a].0).total_cmp(&turn(edges[*b].0)));
            let (next, bend) = edges.swap_remove(best.unwrap_or_default());
            ring.corners.push(here);
            ring.bulges.push(bend);
            (from, at) = (Some(at), next);
            if at == start {
                break;
            }
        }
        border.retain(|_, edges| !edges.is_empty());
        rings.push(ring);
    }
    rings.sort_by(|a, b| b.measure().area.total_cmp(&a.measure().area));
    rings
}

/// The angle from one direction clockwise to another, above 0 and up to a whole turn.
fn clockwise(from: DVec2, to: DVec2) -> f64 {
    let angle = -libm::atan2(from.perp_dot(to), from.dot(to));
    if angle <= 0.0 {
        angle + std::f64::consts::TAU
    } else {
        angle
    }
}
