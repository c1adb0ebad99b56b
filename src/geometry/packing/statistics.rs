//! How good a packing is: order, joints, empty places, overlaps, stones across the outline.

use super::attributes::{aspect, bond, corners, own_axis, symmetry};
use super::direction::{power, unturned};
use super::lattice::area_share;
use crate::geometry::assemble::{Piece, Ring, clip};
use crate::geometry::box_tree::BoxTree;
use crate::geometry::polygon::{Lattice, Operation, doubled_area};
use crate::value::{Partition, Region};
use glam::DVec2;
use rayon::prelude::*;
use std::convert::Infallible;

/// Places along each edge from which the next stone is looked for.
const PLACES: usize = 3;

/// How far it is looked for, in stones.
const FAR: f64 = 1.5;

/// From a place that sees nothing for this share of a stone, places that far to both sides look as well: what runs on between
/// two stones beyond is a joint, and no empty place.
const BESIDE: f64 = 0.05;

/// Joints narrower than this share of a stone are none.
const NO_JOINT: f64 = 1e-6;

/// A joint wider than this many medians is an empty place as to what is beyond.
const WIDE: f64 = 3.0;

/// How many times its usual area a stone may have.
const ROOMY: f64 = 1.5;

/// What can be said of a packing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Statistics {
    pub(crate) stones: usize,
    /// Between the stones' axes and the field, in radians: half of the angles are smaller; nine in ten are.
    pub(crate) angles: [f64; 2],
    /// 1 if neighbours lie at points of the stones' lattice, 0 if they lie anywhere; none if the stones have no lattice with
    /// one of them to a point.
    pub(crate) order: Option<f64>,
    /// Share of stones with four corners.
    pub(crate) quads: f64,
    /// Standard deviation of the areas over their mean.
    pub(crate) area_variation: f64,
    /// Share of the region that stones of their size cover, with joints of up to three medians.
    pub(crate) occupancy: f64,
    /// Mean width of the joints between facing edges in mm, empty places counted, and its standard deviation over the mean.
    pub(crate) joint: f64,
    pub(crate) joint_variation: f64,
    /// Largest overlap, as a share of a stone.
    pub(crate) overlap: f64,
    /// Stones that reach across the outline.
    pub(crate) across: usize,
}

/// The direction that the edges of an outline agree on best, of length 1, if they agree on any.
pub(crate) fn axis(outline: &[DVec2], symmetry: u32) -> Option<DVec2> {
    let next = outline.iter().cycle().skip(1);
    let edges = outline
        .iter()
        .zip(next)
        .map(|(from, to)| (*to - *from).perp());
    let turned = edges.filter_map(|edge| {
        let length = edge.length();
        (length > 0.0).then(|| length * power(edge / length, symmetry))
    });
    let sum: DVec2 = turned.sum();
    (sum != DVec2::ZERO).then(|| unturned(sum, symmetry))
}

/// Measures stones in a region; `field` are the directions that they should have, of length 1, at their centres. None if no
/// stone lies in the region.
pub(crate) fn measure(
    partition: &Partition,
    region: &Region,
    field: &[DVec2],
) -> Option<Statistics> {
    let count = partition.len();
    let whole = 0.5 * region.rings().map(doubled_area).sum::<f64>();
    let mean = partition.areas.iter().sum::<f64>() / count as f64;
    let square = |area: &f64| (area - mean) * (area - mean);
    let variance = partition.areas.iter().map(square).sum::<f64>() / count as f64;
    let quads = (0..count).filter(|cell| partition.outline(*cell).len() == 4);
    let across = across(partition, region)?;
    let ground = Ground::new(partition, region, mean.sqrt());
    let joints = ground.joints();
    let [joint, joint_variation, empty] = summary(&joints, mean.sqrt());
    Some(Statistics {
        stones: count,
        angles: angles(partition, field),
        order: order(partition),
        quads: quads.count() as f64 / count as f64,
        area_variation: variance.sqrt() / mean,
        occupancy: (1.0 - (empty + too_large(partition)) / whole).max(0.0),
        joint,
        joint_variation,
        overlap: ground.overlap(),
        across,
    })
}

/// The area by which stones are larger than half as much again as their size asks for, in mm²: room for others.
fn too_large(partition: &Partition) -> f64 {
    let Some(sizes) = partition.attributes.get("size") else {
        return 0.0;
    };
    let usual = aspect(partition) * area_share(corners(partition));
    let pairs = partition.areas.iter().zip(sizes);
    let more = pairs.map(|(area, size)| (area - ROOMY * usual * size * size).max(0.0));
    more.sum()
}

/// The median of the angles between stones and field, and what nine in ten are below.
fn angles(partition: &Partition, field: &[DVec2]) -> [f64; 2] {
    let symmetry = symmetry(partition);
    let angle = |cell: usize| {
        let own = own_axis(partition, cell);
        let between = DVec2::new(own.dot(field[cell]), own.perp_dot(field[cell]));
        let turned = power(between, symmetry);
        libm::atan2(turned.y, turned.x).abs() / f64::from(symmetry)
    };
    let mut angles: Vec<f64> = (0..partition.len()).map(angle).collect();
    angles.sort_unstable_by(f64::total_cmp);
    [angles[angles.len() / 2], angles[angles.len() * 9 / 10]]
}

/// How well neighbours keep to the lattice of their stones.
fn order(partition: &Partition) -> Option<f64> {
    let (apart, shift) = match corners(partition) {
        5 => return None,
        6 => (0.75_f64.sqrt(), 0.5),
        _ => (1.0, bond(partition)),
    };
    let aspect = aspect(partition);
    let sizes = partition.attributes.get("size");
    let size = |cell: usize| sizes.map_or(partition.areas[cell].sqrt(), |sizes| sizes[cell]);
    let (mut sums, mut count) = ([DVec2::ZERO; 2], 0.0);
    for cell in 0..partition.len() {
        let frame = partition.frames[cell];
        for other in partition.neighbours_of(cell) {
            let other = other as usize;
            let mut offset = partition.centres[other] - partition.centres[cell];
            if let Some(period) = partition.period {
                offset -= period * (offset / period).round();
            }
            let step = 0.5 * (size(cell) + size(other));
            let rows = frame.perp_dot(offset) / (apart * step);
            // Each row is moved against the one before.
            let along = [
                frame.dot(offset) / (aspect * step) - shift * rows.round(),
                rows,
            ];
            for (sum, along) in sums.iter_mut().zip(along) {
                let (sine, cosine) = libm::sincos(std::f64::consts::TAU * along);
                *sum += DVec2::new(cosine, sine);
            }
            count += 1.0;
        }
    }
    let count = f64::max(count, 1.0);
    Some(0.5 * (sums[0].length() + sums[1].length()) / count)
}

/// Mean width, its variation, and the area of what is too wide; `size` is that of a stone.
fn summary(joints: &[Joint], size: f64) -> [f64; 3] {
    let length: f64 = joints
        .iter()
        .filter(|it| !it.is_outer)
        .map(|it| it.length)
        .sum();
    let inner = || joints.iter().filter(|joint| !joint.is_outer);
    let mean = inner().map(|it| it.length * it.width).sum::<f64>() / length.max(f64::MIN_POSITIVE);
    let square = |it: &Joint| it.length * (it.width - mean) * (it.width - mean);
    let variance = inner().map(square).sum::<f64>() / length.max(f64::MIN_POSITIVE);
    let mut widths: Vec<f64> = inner().map(|joint| joint.width).collect();
    widths.sort_unstable_by(f64::total_cmp);
    let median = widths.get(widths.len() / 2).copied().unwrap_or_default();
    let empty = |it: &Joint| {
        let share = if it.is_outer { 1.0 } else { 0.5 };
        share * it.length * (it.width - WIDE * median).max(0.0)
    };
    let variation = if mean > NO_JOINT * size {
        variance.sqrt() / mean
    } else {
        0.0
    };
    [mean, variation, joints.iter().map(empty).sum()]
}

/// What is in front of a part of an edge.
struct Joint {
    /// Of the part, in mm.
    length: f64,
    /// To what is in front of it.
    width: f64,
    /// Whether that is the outline of the region.
    is_outer: bool,
}

/// Outlines of stones, found by place; behind them the edges of the region.
struct Ground<'a> {
    partition: &'a Partition,
    outlines: Vec<(u32, Vec<DVec2>)>,
    stones: usize,
    tree: BoxTree,
    size: f64,
}

impl<'a> Ground<'a> {
    fn new(partition: &'a Partition, region: &Region, size: f64) -> Ground<'a> {
        let of = |cell: usize| (cell as u32, partition.outline(cell).to_vec());
        let mut outlines: Vec<(u32, Vec<DVec2>)> = (0..partition.len()).map(of).collect();
        if let Some(period) = partition.period {
            for (x, y) in [
                (-1, -1),
                (0, -1),
                (1, -1),
                (-1, 0),
                (1, 0),
                (-1, 1),
                (0, 1),
                (1, 1),
            ] {
                let by = period * DVec2::new(f64::from(x), f64::from(y));
                let image = |cell: usize| {
                    let moved = partition.outline(cell).iter().map(|corner| *corner + by);
                    (cell as u32, moved.collect::<Vec<DVec2>>())
                };
                outlines.extend((0..partition.len()).map(image));
            }
        }
        let stones = outlines.len();
        if partition.period.is_none() {
            for ring in region.rings() {
                let next = ring.iter().cycle().skip(1);
                outlines.extend(
                    ring.iter()
                        .zip(next)
                        .map(|(a, b)| (Partition::NONE, vec![*a, *b])),
                );
            }
        }
        let boxes: Vec<[DVec2; 2]> = outlines
            .iter()
            .map(|(_, outline)| around(outline))
            .collect();
        let Ok(tree) = BoxTree::new(&boxes, &mut || Ok::<(), Infallible>(()));
        Ground {
            partition,
            outlines,
            stones,
            tree,
            size,
        }
    }

    /// What is in front of all edges, in parts.
    fn joints(&self) -> Vec<Joint> {
        let of_cell = |cell: usize| {
            let outline = self.partition.outline(cell);
            let next = outline.iter().cycle().skip(1);
            let edges = outline.iter().zip(next).map(|(from, to)| (*from, *to));
            let parts = edges.flat_map(move |(from, to)| {
                (0..PLACES).map(move |place| (from, to, (place as f64 + 0.5) / PLACES as f64))
            });
            parts.filter_map(move |(from, to, share)| {
                let outward = -(to - from).perp().try_normalize()?;
                let (width, is_outer) = self.facing(cell as u32, from.lerp(to, share), outward);
                let length = from.distance(to) / PLACES as f64;
                Some(Joint {
                    length,
                    width,
                    is_outer,
                })
            })
        };
        (0..self.partition.len())
            .into_par_iter()
            .flat_map_iter(of_cell)
            .collect()
    }

    /// How far the next stone or the outline is across the joint, and whether it is the outline.
    fn facing(&self, cell: u32, from: DVec2, outward: DVec2) -> (f64, bool) {
        let aside = BESIDE * self.size * outward.perp();
        let found = self.beyond(cell, from, outward);
        if found.0 < BESIDE * self.size {
            return found;
        }
        let sides = [-aside, aside].map(|aside| self.beyond(cell, from + aside, outward));
        let nearer = |best: (f64, bool), it: (f64, bool)| if it.0 < best.0 { it } else { best };
        sides.into_iter().fold(found, nearer)
    }

    /// How far the next stone or the outline is straight ahead, and whether it is the outline.
    fn beyond(&self, cell: u32, from: DVec2, outward: DVec2) -> (f64, bool) {
        let (far, near) = (FAR * self.size, -1e-6 * self.size);
        let to = from + far * outward;
        let mut best = (far, false);
        self.tree
            .visit([from.min(to) + near, from.max(to) - near], &mut |item| {
                let (owner, outline) = &self.outlines[item as usize];
                if *owner == cell && (item as usize) < self.partition.len() {
                    return;
                }
                let next = outline.iter().cycle().skip(1);
                for (a, b) in outline.iter().zip(next) {
                    let along = *b - *a;
                    let steep = outward.perp_dot(along);
                    if steep == 0.0 {
                        continue;
                    }
                    let width = (*a - from).perp_dot(along) / steep;
                    let share = (*a - from).perp_dot(outward) / steep;
                    if (0.0..=1.0).contains(&share) && width >= near && width.max(0.0) < best.0 {
                        best = (width.max(0.0), *owner == Partition::NONE);
                    }
                }
            });
        best
    }

    /// The largest overlap of two stones as a share of the smaller.
    fn overlap(&self) -> f64 {
        let of_cell = |cell: usize| {
            let outline = self.partition.outline(cell);
            let [low, high] = around(outline);
            let lattice = Lattice::around([low, high]);
            let mut largest: f64 = 0.0;
            self.tree.visit([low, high], &mut |item| {
                let (owner, other) = &self.outlines[item as usize];
                if (item as usize) < self.stones && *owner > cell as u32 {
                    let common = lattice.overlay(Operation::Intersection, &[outline], &[other]);
                    let rings = common.iter().flat_map(|polygon| polygon.rings());
                    let area = 0.5 * rings.map(doubled_area).sum::<f64>();
                    let areas = &self.partition.areas;
                    largest = largest.max(area / areas[cell].min(areas[*owner as usize]));
                }
            });
            largest
        };
        let overlaps = (0..self.partition.len()).into_par_iter().map(of_cell);
        overlaps.reduce(|| 0.0, f64::max)
    }
}

/// How many stones lie partly outside of the region; none if all lie outside.
fn across(partition: &Partition, region: &Region) -> Option<usize> {
    let piece = |cell: usize| Piece {
        rings: vec![Ring::straight(partition.outline(cell).to_vec())],
        id: cell as u32,
        frame: DVec2::X,
        centre: None,
    };
    let pieces: Vec<Piece> = (0..partition.len()).map(piece).collect();
    let area = |piece: &Piece| {
        0.5 * piece
            .rings
            .iter()
            .map(|ring| doubled_area(&ring.corners))
            .sum::<f64>()
    };
    let before: Vec<f64> = pieces.iter().map(area).collect();
    let mut within = vec![0.0; pieces.len()];
    let Ok(parts) = clip(pieces, region, &mut || Ok::<(), Infallible>(()));
    for part in parts {
        if let Some(sum) = within.get_mut(part.id as usize) {
            *sum += area(&part);
        }
    }
    let is_across = |(before, within): &(&f64, &f64)| *before - *within > 1e-6 * *before;
    let count = before.iter().zip(&within).filter(is_across).count();
    let lies_within = within.iter().sum::<f64>() > 0.0;
    // What repeats has no outline.
    lies_within.then_some(if partition.period.is_some() { 0 } else { count })
}

/// Lowest and highest coordinates.
fn around(outline: &[DVec2]) -> [DVec2; 2] {
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    outline.iter().fold(none, |[low, high], corner| {
        [low.min(*corner), high.max(*corner)]
    })
}
