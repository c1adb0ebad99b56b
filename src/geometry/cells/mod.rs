//! Finds the cell of a partition at a point, and how far its border is.

mod edge;
mod grid;
mod tree;

use self::edge::Edge;
use self::grid::Grid;
use self::tree::EdgeTree;
use super::box_tree::BoxTree;
use crate::value::Partition;
use glam::DVec2;
use std::convert::Infallible;
use std::sync::Arc;

/// The cells of a partition, made ready to be found.
///
/// Which side of an edge a point is on is decided alike for both of its cells, so a point belongs to exactly one cell of
/// those that tile, wherever the search began.
#[derive(Debug)]
pub(crate) struct CellIndex {
    partition: Arc<Partition>,
    copies: Vec<Copy>,
    grid: Grid,
    tree: BoxTree,
    /// Cells with many edges.
    large: Vec<(u32, EdgeTree)>,
}

/// A cell with more edges has them in a tree.
const MANY: usize = 32;

/// A cell, or one of its repetitions.
#[derive(Clone, Copy, Debug)]
struct Copy {
    cell: u32,
    /// How far it is moved from where the partition has it.
    shift: DVec2,
    low: DVec2,
    high: DVec2,
}

/// A cell at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    /// The cell; where there is none, the nearest one.
    pub(crate) cell: u32,
    /// From the cell's centre to the point, in mm.
    pub(crate) offset: DVec2,
    /// Distance to the cell's border in mm, below 0 outside.
    pub(crate) border: f64,
    /// The corner before the nearest edge.
    pub(crate) edge: u32,
    /// How far the cell is moved from where the partition has it.
    shift: DVec2,
    /// Outside of all cells: a point, and how far around it this cell is the nearest.
    sure: Option<(DVec2, f64)>,
}

impl CellIndex {
    /// Makes the cells of a partition ready.
    pub(crate) fn new(partition: &Arc<Partition>) -> CellIndex {
        let copies = copies(partition);
        let boxes: Vec<[DVec2; 2]> = copies.iter().map(|it| [it.low, it.high]).collect();
        let Ok(tree) = BoxTree::new(&boxes, &mut || Ok::<(), Infallible>(()));
        CellIndex {
            partition: Arc::clone(partition),
            grid: Grid::new(&boxes, partition.len()),
            large: large(partition),
            copies,
            tree,
        }
    }

    /// What is at a point; `last` is what was at a point nearby, if that is known.
    pub(crate) fn find(&self, point: DVec2, last: Option<&Spot>) -> Spot {
        let point = match self.partition.period {
            None => point,
            Some(period) => point - (point / period).floor() * period,
        };
        if let Some(last) = last {
            let again = self.spot(last.cell, last.shift, point);
            if again.border >= 0.0 {
                return again;
            }
            // The others are nearer by no more than the way to the point, and it is farther by no more.
            let is_near =
                |(from, radius): (DVec2, f64)| point.distance_squared(from) < radius * radius;
            if last.sure.is_some_and(is_near) {
                return Spot {
                    sure: last.sure,
                    ..again
                };
            }
            // Across the nearest edge is where the point is most often.
            let beyond = self.partition.neighbours[again.edge as usize];
            if beyond != Partition::NONE && self.partition.period.is_none() {
                let next = self.spot(beyond, DVec2::ZERO, point);
                if next.border >= 0.0 {
                    return next;
                }
            }
        }
        let inside = self.grid.at(point).iter().find_map(|index| {
            let copy = &self.copies[*index as usize];
            let is_near = point.cmpge(copy.low).all() && point.cmple(copy.high).all();
            let spot = is_near.then(|| self.spot(copy.cell, copy.shift, point))?;
            (spot.border >= 0.0).then_some(spot)
        });
        inside.unwrap_or_else(|| self.nearest(point))
    }

    /// The cell that is nearest to a point outside all.
    fn nearest(&self, point: DVec2) -> Spot {
        let spot = |index: u32| {
            let copy = &self.copies[index as usize];
            self.spot(copy.cell, copy.shift, point)
        };
        let square = |index: u32| {
            let border = spot(index).border;
            border * border
        };
        // Nothing is nearest to what is no point.
        let (nearest, next) = self.tree.nearest_two(point, square).unwrap_or((0, 0.0));
        let nearest = spot(nearest);
        Spot {
            sure: Some((point, 0.499 * (next.sqrt() + nearest.border))),
            ..nearest
        }
    }

    /// The edges of a cell that has many.
    fn tree_of(&self, cell: u32) -> &EdgeTree {
        let place = self.large.binary_search_by_key(&cell, |(cell, _)| *cell);
        &self.large[place.expect("such cells have trees")].1
    }

    /// A cell as seen from a point.
    fn spot(&self, cell: u32, shift: DVec2, point: DVec2) -> Spot {
        let at = point - shift;
        let (is_inside, nearest, edge) = match has_many(&self.partition, cell) {
            true => self.tree_of(cell).meet(at),
            false => meet(&self.partition, cell, at),
        };
        let distance = nearest.sqrt();
        Spot {
            cell,
            offset: at - self.partition.centres[cell as usize],
            border: if is_inside { distance } else { -distance },
            edge,
            shift,
            sure: None,
        }
    }
}

/// Whether a point is inside a cell, the square of its distance to the nearest edge, and the corner before that edge.
fn meet(partition: &Partition, cell: u32, point: DVec2) -> (bool, f64, u32) {
    let mut met = (false, f64::INFINITY, 0);
    for_edges(partition, cell, |edge, corner| {
        met.0 ^= edge.turns_over(point);
        let distance = edge.distance_squared(point);
        if distance < met.1 {
            (met.1, met.2) = (distance, corner);
        }
    });
    met
}

/// Calls `each` with the edges of a cell and the corners before them.
#[inline(always)]
fn for_edges(partition: &Partition, cell: u32, mut each: impl FnMut(Edge, u32)) {
    for ring in partition.rings_of(cell as usize) {
        let corners = &partition.corners[ring.clone()];
        let mut from = corners[corners.len() - 1];
        let mut index = ring.end - 1;
        for (offset, to) in corners.iter().enumerate() {
            let edge = Edge {
                from,
                to: *to,
                bulge: partition.bulge(index),
            };
            each(edge, index as u32);
            (from, index) = (*to, ring.start + offset);
        }
    }
}

/// Whether a cell has so many edges that they are kept in a tree.
fn has_many(partition: &Partition, cell: u32) -> bool {
    let rings = [0, 1].map(|end| partition.cells[cell as usize + end] as usize);
    let [first, last] = rings.map(|ring| partition.rings[ring] as usize);
    last - first > MANY
}

/// The edges of cells that have many, by the cells.
fn large(partition: &Partition) -> Vec<(u32, EdgeTree)> {
    let cells = (0..partition.len() as u32).filter(|cell| has_many(partition, *cell));
    let tree = |cell: u32| {
        let mut edges = vec![];
        for_edges(partition, cell, |edge, corner| edges.push((edge, corner)));
        (cell, EdgeTree::new(edges))
    };
    cells.map(tree).collect()
}

/// All cells, and of a periodic partition those of their repetitions that are in the first period or near it.
fn copies(partition: &Partition) -> Vec<Copy> {
    let boxes: Vec<[DVec2; 2]> = (0..partition.len())
        .map(|cell| partition.box_of(cell))
        .collect();
    let shifts = match partition.period {
        None => vec![DVec2::ZERO],
        Some(period) => {
            let steps = [0.0, -1.0, 1.0];
            let steps = steps.map(|y| steps.map(|x| DVec2::new(x, y) * period));
            steps.concat()
        }
    };
    let size = boxes.iter().map(|[low, high]| *high - *low);
    let margin = size.fold(DVec2::ZERO, DVec2::max);
    let is_near = |low: DVec2, high: DVec2| {
        let Some(period) = partition.period else {
            return true;
        };
        high.cmpge(-margin).all() && low.cmple(period + margin).all()
    };
    let mut copies = vec![];
    for shift in shifts {
        for (cell, [low, high]) in boxes.iter().enumerate() {
            let (low, high) = (*low + shift, *high + shift);
            if is_near(low, high) {
                let cell = cell as u32;
                copies.push(Copy {
                    cell,
                    shift,
                    low,
                    high,
                });
            }
        }
    }
    copies
}

#[cfg(test)]
mod tests;
