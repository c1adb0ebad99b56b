//! From the triangulation to the lists of a partition.
//!
//! Cells are made chunk by chunk in the order of the vertices, in which neighbours are near each other in memory, and
//! then put into the order of the seeds.

use super::clip::Box;
use super::corners::Corners;
use super::triangulation::{Dual, FAR};
use super::{SAME, Scale};
use crate::value::Partition;
use glam::DVec2;
use rayon::prelude::*;
use spade::Triangulation as _;
use spade::handles::FixedVertexHandle;
use std::ops::Range;

/// Cells in a chunk.
const CHUNK: usize = 8192;

/// A corner of a cell with the seed beyond the edge that begins there.
pub(super) type Corner = (DVec2, u32);

/// What cells are made from.
pub(super) struct Maker<'a> {
    dual: &'a Dual,
    corners: Corners,
    scale: &'a Scale,
    ground: Box,
}

/// Cells of one chunk of vertices.
#[derive(Default)]
pub(super) struct Part {
    corners: Vec<DVec2>,
    across: Vec<u32>,
    /// Where the corners of each cell begin, and the end; cells that there are not have no corners.
    starts: Vec<u32>,
    areas: Vec<f64>,
    centres: Vec<DVec2>,
    /// Whether corners lie at one place that do not stand for each other.
    has_equal: bool,
}

/// The cell that is being made.
#[derive(Default)]
struct Draft {
    cell: Vec<Corner>,
    /// Of each edge the triangles' corner that it begins with, and where the seed beyond is.
    around: Vec<(u32, DVec2)>,
}

impl<'a> Maker<'a> {
    /// Computes the corners.
    pub(super) fn new(dual: &'a Dual, scale: &'a Scale) -> Maker<'a> {
        Maker {
            dual,
            corners: Corners::new(dual),
            scale,
            ground: Box::new(scale.high),
        }
    }

    /// The corners that triangles have, by the index of the triangle.
    pub(super) fn corners(&self) -> &Corners {
        &self.corners
    }

    /// The cells of the seeds with these vertices; `None` if there are none.
    pub(super) fn partition(
        &mut self,
        vertices: &[Option<FixedVertexHandle>],
    ) -> Option<Partition> {
        let mut parts = self.parts();
        if parts.iter().any(|part| part.has_equal) {
            drop(parts);
            self.corners.join(self.dual);
            parts = self.parts();
        }
        gather(&parts, vertices, self.scale)
    }

    fn parts(&self) -> Vec<Part> {
        let count = self.dual.triangles.num_vertices();
        let chunks = (0..count).into_par_iter().step_by(CHUNK);
        let part = |first| self.part(first..count.min(first + CHUNK));
        chunks.map(part).collect()
    }

    fn part(&self, vertices: Range<usize>) -> Part {
        let mut part = Part::default();
        part.corners.reserve(6 * vertices.len());
        part.across.reserve(6 * vertices.len());
        let mut draft = Draft::default();
        for vertex in vertices {
            part.starts.push(part.corners.len() as u32);
            let vertex = FixedVertexHandle::from_index(vertex);
            let at = self.draw(vertex, &mut draft, &mut part.has_equal);
            let (mut area, mut centre) = (0.0, at);
            if draft.cell.len() >= 3 {
                (area, centre) = measure(at, &draft.cell);
                if area > SAME * extent(&draft.cell) {
                    self.move_into_first_period(&mut centre, &mut draft);
                    part.corners
                        .extend(draft.cell.iter().map(|corner| corner.0));
                    part.across.extend(draft.cell.iter().map(|corner| corner.1));
                }
            }
            part.areas.push(area);
            part.centres.push(centre);
        }
        part.starts.push(part.corners.len() as u32);
        part
    }

    /// Draws the cell of a vertex, none if it is a copy. Gives where its seed is.
    fn draw(&self, vertex: FixedVertexHandle, draft: &mut Draft, has_equal: &mut bool) -> DVec2 {
        let vertex = self.dual.triangles.vertex(vertex);
        let site = *vertex.data();
        draft.cell.clear();
        draft.around.clear();
        if site.seed == FAR || site.shift != [0; 2] {
            return site.at;
        }
        let mut is_within = true;
        let Some(first) = vertex.out_edge() else {
            return site.at;
        };
        let mut before = self.corners.index(first.rev().face().fix().index());
        let mut at = self.at(before);
        for edge in vertex.out_edges() {
            let after = self.corners.index(edge.face().fix().index());
            if after == before {
                continue;
            }
            let beyond = *edge.to().data();
            draft.cell.push((at, beyond.seed));
            draft.around.push((before, beyond.at));
            is_within &= self.ground.holds(at);
            let next = self.at(after);
            *has_equal |= (next - at).abs().max_element() <= SAME;
            (before, at) = (after, next);
        }
        if !is_within && !self.scale.repeats {
            self.ground.cut(site.at, &draft.around, &mut draft.cell);
        }
        site.at
    }

    fn at(&self, corner: u32) -> DVec2 {
        let at = self.corners.at(corner, [0; 2]);
        if self.scale.repeats {
            at
        } else {
            self.ground.snapped(at)
        }
    }

    /// Moves a cell by whole periods so that its centre is within the first.
    fn move_into_first_period(&self, centre: &mut DVec2, draft: &mut Draft) {
        if !self.scale.repeats || self.ground.holds_within(*centre) {
            return;
        }
        let high = self.scale.high;
        let step = |at: f64, high: f64| i8::from(at < 0.0) - i8::from(at >= high);
        let shift = [step(centre.x, high.x), step(centre.y, high.y)];
        let steps = DVec2::from_array(shift.map(f64::from));
        *centre = (*centre + steps * high).max(DVec2::ZERO);
        for ((at, _), (corner, _)) in draft.cell.iter_mut().zip(&draft.around) {
            *at = self.corners.at(*corner, shift);
        }
    }
}

impl Part {
    fn range(&self, cell: usize) -> Range<usize> {
        self.starts[cell] as usize..self.starts[cell + 1] as usize
    }
}

/// Puts the cells of the parts into the order of the seeds with these vertices.
fn gather(
    parts: &[Part],
    vertices: &[Option<FixedVertexHandle>],
    scale: &Scale,
) -> Option<Partition> {
    let total = parts.iter().map(|part| part.corners.len()).sum();
    let count = vertices.len();
    let mut partition = Partition {
        corners: Vec::with_capacity(total),
        neighbours: Vec::with_capacity(total),
        rings: Vec::with_capacity(count + 1),
        centres: Vec::with_capacity(count),
        areas: Vec::with_capacity(count),
        ids: Vec::with_capacity(count),
        period: scale.repeats.then_some(scale.high * scale.unit),
        ..Partition::default()
    };
    partition.rings.push(0);
    for (seed, vertex) in (0..).zip(vertices) {
        let Some(vertex) = vertex.map(|vertex| vertex.index()) else {
            continue;
        };
        let (part, cell) = (&parts[vertex / CHUNK], vertex % CHUNK);
        let range = part.range(cell);
        if range.is_empty() {
            continue;
        }
        let corners = part.corners[range.clone()].iter();
        partition.corners.extend(corners.map(|at| scale.place(*at)));
        partition.neighbours.extend(&part.across[range]);
        partition.rings.push(partition.corners.len() as u32);
        partition.centres.push(scale.place(part.centres[cell]));
        partition
            .areas
            .push(part.areas[cell] * scale.unit * scale.unit);
        partition.ids.push(seed);
    }
    let cells = partition.ids.len();
    partition.cells = (0..=cells as u32).collect();
    partition.frames = vec![DVec2::X; cells];
    number_neighbours(&mut partition);
    (cells > 0).then_some(partition)
}

/// From the numbers of seeds to those of cells.
fn number_neighbours(partition: &mut Partition) {
    let Some(last) = partition.ids.last().copied() else {
        return;
    };
    if last as usize + 1 == partition.ids.len() {
        let stays = |seed: &u32| *seed <= last;
        let without = partition.neighbours.iter_mut().filter(|seed| !stays(seed));
        without.for_each(|seed| *seed = Partition::NONE);
        return;
    }
    let mut numbers = vec![Partition::NONE; last as usize + 1];
    for (number, seed) in (0..).zip(&partition.ids) {
        numbers[*seed as usize] = number;
    }
    for neighbour in &mut partition.neighbours {
        let number = numbers.get(*neighbour as usize).copied();
        *neighbour = number.unwrap_or(Partition::NONE);
    }
}

/// Area and centre of gravity of a polygon, seen from a point nearby.
fn measure(from: DVec2, cell: &[Corner]) -> (f64, DVec2) {
    let (mut doubled, mut moment) = (0.0, DVec2::ZERO);
    let mut before = cell[cell.len() - 1].0 - from;
    for (at, _) in cell {
        let at = *at - from;
        let cross = before.perp_dot(at);
        doubled += cross;
        moment += (before + at) * cross;
        before = at;
    }
    (0.5 * doubled, from + moment / (3.0 * doubled))
}

/// Width and height together.
fn extent(cell: &[Corner]) -> f64 {
    let (mut low, mut high) = (cell[0].0, cell[0].0);
    for (at, _) in cell {
        (low, high) = (low.min(*at), high.max(*at));
    }
    (high - low).element_sum()
}
