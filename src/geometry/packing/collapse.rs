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

/// Edges looked at between two questions whether to go on.
const AT_ONCE: usize = 1024;

/// The partition with short edges turned into corners. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn collapse<E>(
    partition: &Partition,
    limits: &Collapse,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Partition, E> {
    let mut net = Net::new(partition, limits, go_on)?;
    go_on()?;
    let mut edges = net.short_edges(&limits.short);
    edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    for (number, (_, from, to)) in edges.into_iter().enumerate() {
        if number.is_multiple_of(AT_ONCE) {
            go_on()?;
        }
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
    let pieces = pieces.collect();
    assemble(pieces, partition.period, limits.tolerance, go_on)
}

impl Net {
    fn new<E>(
        partition: &Partition,
        limits: &Collapse,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Net, E> {
        let (drawn, tolerance) = (&partition.corners, limits.tolerance);
        let (points, corners) = weld(drawn, partition.period, tolerance, go_on)?;
        let mut net = Net {
            holds: vec![Hold::Free; points.len()],
            cells: vec![vec![]; points.len()],
            points,
            rings: vec![],
            period: partition.period.unwrap_or(DVec2::ZERO),
        };
        for cell in 0..partition.len() {
            let rings = partition
                .rings_of(cell)
                .map(|range| corners[range].to_vec());
            net.rings.push(rings.collect());
            for corner in net.rings[cell].iter().flatten() {
                let cells = &mut net.cells[corner.point as usize];
                if cells.last() != Some(&(cell as u32)) {
                    cells.push(cell as u32);
                }
            }
        }
        go_on()?;
        net.hold(partition);
        Ok(net)
    }

    /// Holds the points at borders: of the region, and of cells within others.
    fn hold(&mut self, partition: &Partition) {
        let mut borders: Vec<Vec<DVec2>> = vec![vec![]; self.points.len()];
        for (cell, rings) in self.rings.iter().enumerate() {
            let ranges = partition.rings_of(cell);
            for (number, (ring, range)) in rings.iter().zip(ranges).enumerate() {
                for (index, corner) in ring.iter().enumerate() {
                    let next = ring[(index + 1) % ring.len()];
                    let beyond = partition.neighbours[range.start + index];
                    if beyond == Partition::NONE || number > 0 {
                        let along = self.place(next) - self.place(*corner);
                        let along = along.normalize_or(DVec2::X);
                        for end in [corner, &next] {
                            borders[end.point as usize].push(along);
                        }
                    }
                }
            }
        }
        for (hold, border) in self.holds.iter_mut().zip(borders) {
            *hold = match border[..] {
                [] => Hold::Free,
                [a, b] if a.dot(b) > 0.0 && a.perp_dot(b).abs() < STRAIGHT => Hold::Border(a),
                _ => Hold::Fixed,
            };
        }
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
        let rings = |cell: &u32| &self.rings[*cell as usize];
        let areas: Vec<f64> = cells.iter().map(|cell| self.area(rings(cell))).collect();
        let kept = std::mem::replace(&mut self.points[a], merged);
        let changed = cells.iter().zip(areas);
        let changed = changed.map(|(cell, area)| {
            let rings = &self.rings[*cell as usize];
            self.renamed(rings, from, to, KEPT * area)
        });
        let Some(changed) = changed.collect::<Option<Vec<_>>>() else {
            self.points[a] = kept;
            return;
        };
        for (cell, rings) in cells.iter().zip(changed) {
            self.rings[*cell as usize] = rings;
        }
        if self.holds[a] == Hold::Free || self.holds[b] == Hold::Fixed {
            self.holds[a] = self.holds[b];
        }
        self.cells[a] = cells;
        self.cells[b].clear();
    }

    /// The rings of a cell with `from` instead of `to`; `None` if the cell is not sound then, or has no more than `least` as its
    /// doubled area.
    fn renamed(
        &self,
        rings: &[Vec<Corner>],
        from: Corner,
        to: Corner,
        least: f64,
    ) -> Option<Vec<Vec<Corner>>> {
        let away = [0, 1].map(|axis| from.period[axis] - to.period[axis]);
        let renamed = |corner: &Corner| match corner.point == to.point {
            true => Corner {
                point: from.point,
                ..corner.moved(away)
            },
            false => *corner,
        };
        let is_quad = rings[0].len() >= 4;
        let mut rings: Vec<Vec<Corner>> = rings
            .iter()
            .map(|ring| ring.iter().map(renamed).collect())
            .collect();
        rings.iter_mut().for_each(tidy);
        let is_sound = rings.iter().all(|ring| ring.len() >= 3)
            && (rings[0].len() >= 4 || !is_quad)
            && self.area(&rings) > least
            && is_simple(&self.drawn(&rings[0]));
        is_sound.then_some(rings)
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
