//! Short edges become corners: where two corners of cells are close together, four stones meet.

use super::simple::is_simple;
use crate::geometry::assemble::{Corner, Piece, Ring, assemble, weld};
use crate::geometry::polygon::doubled_area;
use crate::value::Partition;
use glam::DVec2;

/// What counts as short.
pub(crate) struct Collapse {
    /// Of each cell: edges shorter than this become corners, in mm; the least of the cells that meet there counts.
    pub(crate) short: Vec<f64>,
    /// How near corners are that count as one, in mm.
    pub(crate) tolerance: f64,
}

/// Most cells that meet in a corner, unless they almost do before.
const MOST: usize = 4;

/// Edges shorter than this share of a short one become corners however many cells meet there.
const TINY: f64 = 0.3;

/// Sine of the angle by which a straight border may bend.
const STRAIGHT: f64 = 1e-6;

/// How much of its area a cell must keep.
const KEPT: f64 = 0.6;

/// How corners at the border of a region may move.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Hold {
    Free,
    /// Along a straight border of this direction.
    Border(DVec2),
    Fixed,
}

struct Net {
    points: Vec<DVec2>,
    holds: Vec<Hold>,
    rings: Vec<Vec<Vec<Corner>>>,
    /// The cells at each point.
    cells: Vec<Vec<u32>>,
    period: DVec2,
}

/// The partition with short edges turned into corners.
pub(crate) fn collapse(partition: &Partition, limits: &Collapse) -> Partition {
    let mut net = Net::new(partition, limits);
    let mut edges = net.short_edges(&limits.short);
    edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    for (_, from, to) in edges {
        net.join(from, to, net.short(&limits.short, from, to));
    }
    let pieces = net.rings.iter().enumerate().map(|(cell, rings)| {
        let ring = |ring: &Vec<Corner>| {
            Ring::straight(ring.iter().map(|corner| net.place(*corner)).collect())
        };
        Piece {
            rings: rings.iter().map(ring).collect(),
            id: partition.ids[cell],
            frame: partition.frames[cell],
            centre: None,
        }
    });
    assemble(pieces.collect(), partition.period, limits.tolerance)
}

impl Net {
    fn new(partition: &Partition, limits: &Collapse) -> Net {
        let (points, corners) = weld(&partition.corners, partition.period, limits.tolerance);
        let mut net = Net {
            holds: vec![Hold::Free; points.len()],
            cells: vec![vec![]; points.len()],
            points,
            rings: vec![],
            period: partition.period.unwrap_or(DVec2::ZERO),
        };
        let mut borders: Vec<Vec<DVec2>> = vec![vec![]; net.points.len()];
        for cell in 0..partition.len() {
            let mut rings = vec![];
            for (number, range) in partition.rings_of(cell).enumerate() {
                let ring = corners[range.clone()].to_vec();
                for (index, corner) in ring.iter().enumerate() {
                    let next = ring[(index + 1) % ring.len()];
                    let cells = &mut net.cells[corner.point as usize];
                    if cells.last() != Some(&(cell as u32)) {
                        cells.push(cell as u32);
                    }
                    let neighbour = partition.neighbours[range.start + index];
                    if neighbour == Partition::NONE || number > 0 {
                        let along = (net.place(next) - net.place(*corner)).normalize_or(DVec2::X);
                        borders[corner.point as usize].push(along);
                        borders[next.point as usize].push(along);
                    }
                }
                rings.push(ring);
            }
            net.rings.push(rings);
        }
        for (hold, border) in net.holds.iter_mut().zip(borders) {
            *hold = match border[..] {
                [] => Hold::Free,
                [a, b] if a.dot(b) > 0.0 && a.perp_dot(b).abs() < STRAIGHT => Hold::Border(a),
                _ => Hold::Fixed,
            };
        }
        net
    }

    fn place(&self, corner: Corner) -> DVec2 {
        let [x, y] = corner.period.map(f64::from);
        self.points[corner.point as usize] + DVec2::new(x, y) * self.period
    }

    /// What is short between two corners.
    fn short(&self, short: &[f64], from: Corner, to: Corner) -> f64 {
        let cells = [from, to].map(|corner| self.cells[corner.point as usize].iter());
        let short = cells
            .into_iter()
            .flatten()
            .map(|cell| short[*cell as usize]);
        short.fold(f64::INFINITY, f64::min)
    }

    /// Edges between different points, each once, with their lengths.
    fn short_edges(&self, short: &[f64]) -> Vec<(f64, Corner, Corner)> {
        let mut edges = vec![];
        let most = short.iter().copied().fold(0.0, f64::max);
        for ring in self.rings.iter().flatten() {
            for (index, from) in ring.iter().enumerate() {
                let to = ring[(index + 1) % ring.len()];
                let length = self.place(*from).distance(self.place(to));
                if length < most && length < self.short(short, *from, to) {
                    let (a, b) = if from.point < to.point {
                        (*from, to)
                    } else {
                        (to, *from)
                    };
                    let base = a.period;
                    let moved = |corner: Corner| corner.moved(base.map(|periods| -periods));
                    edges.push((length, moved(a), moved(b)));
                }
            }
        }
        edges
    }

    /// Makes one corner of two, if they are still short of each other and all cells stay sound.
    fn join(&mut self, from: Corner, to: Corner, short: f64) {
        let (a, b) = (from.point as usize, to.point as usize);
        if a == b || self.cells[a].is_empty() || self.cells[b].is_empty() {
            return;
        }
        let (at, other) = (self.place(from), self.place(to));
        let length = at.distance(other);
        let Some(merged) = self.middle(a, b, at, other) else {
            return;
        };
        let mut cells = [&self.cells[a][..], &self.cells[b][..]].concat();
        cells.sort_unstable();
        cells.dedup();
        let outside = usize::from(self.holds[a] != Hold::Free || self.holds[b] != Hold::Free);
        if length > short || (cells.len() + outside > MOST && length > TINY * short) {
            return;
        }
        let away = [0, 1].map(|axis| from.period[axis] - to.period[axis]);
        let renamed = |corner: &Corner| {
            if corner.point == to.point {
                Corner {
                    point: from.point,
                    ..corner.moved(away)
                }
            } else {
                *corner
            }
        };
        let kept = self.points[a];
        let mut changed = vec![];
        for cell in &cells {
            let rings = &self.rings[*cell as usize];
            let before = self.area(rings);
            let is_quad = rings[0].len() >= 4;
            let mut rings: Vec<Vec<Corner>> = rings
                .iter()
                .map(|ring| ring.iter().map(renamed).collect())
                .collect();
            rings.iter_mut().for_each(tidy);
            self.points[a] = merged;
            let is_sound = rings.iter().all(|ring| ring.len() >= 3)
                && (rings[0].len() >= 4 || !is_quad)
                && self.area(&rings) > KEPT * before
                && is_simple(&self.drawn(&rings[0]));
            self.points[a] = kept;
            if !is_sound {
                return;
            }
            changed.push(rings);
        }
        self.points[a] = merged;
        for (cell, rings) in cells.iter().zip(changed) {
            self.rings[*cell as usize] = rings;
        }
        if self.holds[a] == Hold::Free || self.holds[b] == Hold::Fixed {
            self.holds[a] = self.holds[b];
        }
        self.cells[a] = cells;
        self.cells[b].clear();
    }

    /// Where two points meet: in the middle, or where the border holds one of them. Two that are held stay apart.
    fn middle(&self, a: usize, b: usize, at: DVec2, other: DVec2) -> Option<DVec2> {
        let is_along =
            |along: DVec2| (other - at).normalize_or(along).perp_dot(along).abs() < STRAIGHT;
        match (self.holds[a], self.holds[b]) {
            (Hold::Free, Hold::Free) => Some(0.5 * (at + other)),
            (_, Hold::Free) => Some(at),
            (Hold::Free, _) => Some(other),
            (Hold::Border(_) | Hold::Fixed, Hold::Border(along)) if is_along(along) => Some(at),
            (Hold::Border(along), Hold::Fixed) if is_along(along) => Some(other),
            _ => None,
        }
    }

    fn drawn(&self, ring: &[Corner]) -> Vec<DVec2> {
        ring.iter().map(|corner| self.place(*corner)).collect()
    }

    fn area(&self, rings: &[Vec<Corner>]) -> f64 {
        rings
            .iter()
            .map(|ring| doubled_area(&self.drawn(ring)))
            .sum()
    }
}

/// Takes out corners that come twice in a row, and edges that turn back on themselves.
fn tidy(ring: &mut Vec<Corner>) {
    loop {
        let count = ring.len();
        if count < 3 {
            return;
        }
        let repeated = (0..count).find(|index| ring[*index] == ring[(index + 1) % count]);
        let spike = (0..count).find(|index| ring[*index] == ring[(index + 2) % count]);
        match (repeated, spike) {
            (Some(index), _) => drop(ring.remove(index)),
            (None, Some(index)) => drop(ring.remove((index + 1) % count)),
            (None, None) => return,
        }
    }
}
