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
struct Part {
    corners: Vec<Corner>,
    /// Where the corners of each cell begin, and the end; cells that there are not have no corners.
    starts: Vec<u32>,
    areas: Vec<f64>,
    centres: Vec<DVec2>,
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
    pub(super) fn partition(&self, vertices: &[Option<FixedVertexHandle>]) -> Option<Partition> {
        let count = self.dual.triangles.num_vertices();
        let chunks = (0..count).into_par_iter().step_by(CHUNK);
        let parts: Vec<Part> = chunks
            .map(|first| self.part(first..count.min(first + CHUNK)))
            .collect();
        let found = |vertex: &Option<FixedVertexHandle>| {
            let place = vertex.map(|vertex| [vertex.index() / CHUNK, vertex.index() % CHUNK]);
            place.filter(|[part, cell]| parts[*part].size(*cell) > 0)
        };
        let places: Vec<Option<[usize; 2]>> = vertices.par_iter().map(found).collect();
        gather(&parts, &places, self.scale)
    }

    fn part(&self, vertices: std::ops::Range<usize>) -> Part {
        let mut part = Part::default();
        let (mut around, mut cell) = (vec![], vec![]);
        for vertex in vertices {
            part.starts.push(part.corners.len() as u32);
            cell.clear();
            let at = self.cell(FixedVertexHandle::from_index(vertex), &mut around, &mut cell);
            let (mut area, mut centre) = (0.0, at);
            if cell.len() >= 3 {
                (area, centre) = measure(at, &cell);
                if area > SAME * extent(&cell) {
                    self.into_first_period(&mut centre, &mut cell, &around);
                    part.corners.extend_from_slice(&cell);
                }
            }
            part.areas.push(area);
            part.centres.push(centre);
        }
        part.starts.push(part.corners.len() as u32);
        part
    }

    /// The corners of a vertex's cell, and of each edge the triangles' corner that it begins with and the seed beyond.
    /// Gives where its own seed is.
    fn cell(
        &self,
        vertex: FixedVertexHandle,
        around: &mut Vec<(u32, DVec2)>,
        cell: &mut Vec<Corner>,
    ) -> DVec2 {
        let vertex = self.dual.triangles.vertex(vertex);
        let site = vertex.data();
        around.clear();
        if site.seed == FAR || site.shift != [0; 2] {
            return site.at;
        }
        let Some(edge) = vertex.out_edge() else {
            return site.at;
        };
        let mut is_within = true;
        let mut before = self.corners.index(edge.rev().face().fix().index());
        for edge in vertex.out_edges() {
            let after = self.corners.index(edge.face().fix().index());
            if after != before {
                let at = self.at(before);
                is_within &= self.ground.holds(at);
                let beyond = *edge.to().data();
                around.push((before, beyond.at));
                cell.push((at, beyond.seed));
            }
            before = after;
        }
        if !is_within && !self.scale.repeats {
            self.ground.cut(site.at, around, cell);
        }
        site.at
    }

    fn at(&self, corner: u32) -> DVec2 {
        let at = self.corners.at(corner, [0; 2]);
        if self.scale.repeats { at } else { self.ground.snapped(at) }
    }

    /// Moves a cell by whole periods so that its centre is within the first.
    fn into_first_period(&self, centre: &mut DVec2, cell: &mut [Corner], around: &[(u32, DVec2)]) {
        if !self.scale.repeats || self.ground.holds_within(*centre) {
            return;
        }
        let high = self.scale.high;
        let step = |at: f64, high: f64| i8::from(at < 0.0) - i8::from(at >= high);
        let shift = [step(centre.x, high.x), step(centre.y, high.y)];
        let steps = DVec2::from_array(shift.map(f64::from));
        *centre = (*centre + steps * high).max(DVec2::ZERO);
        for ((at, _), (corner, _)) in cell.iter_mut().zip(around) {
            *at = self.corners.at(*corner, shift);
        }
    }
}

impl Part {
    fn size(&self, cell: usize) -> usize {
        (self.starts[cell + 1] - self.starts[cell]) as usize
    }

    fn cell(&self, cell: usize) -> &[Corner] {
        &self.corners[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

/// Puts the cells of the parts into order, those whose places are known.
fn gather(parts: &[Part], places: &[Option<[usize; 2]>], scale: &Scale) -> Option<Partition> {
    let kept: Vec<u32> = (0..places.len() as u32)
        .filter(|seed| places[*seed as usize].is_some())
        .collect();
    let places: Vec<[usize; 2]> = places.iter().copied().flatten().collect();
    if kept.is_empty() {
        return None;
    }
    let mut rings = Vec::with_capacity(kept.len() + 1);
    let mut end = 0_u32;
    for [part, cell] in &places {
        rings.push(end);
        end += parts[*part].size(*cell) as u32;
    }
    rings.push(end);
    let is_whole = kept.last().is_some_and(|last| *last as usize + 1 == kept.len());
    let number = |seed: u32| match seed {
        FAR => Partition::NONE,
        seed if is_whole => seed,
        seed => kept.binary_search(&seed).map_or(Partition::NONE, |cell| cell as u32),
    };
    let of = |[part, cell]: &[usize; 2]| parts[*part].cell(*cell);
    let all = || places.par_iter().flat_map_iter(of);
    let period = scale.repeats.then_some(scale.high * scale.unit);
    Some(Partition {
        corners: all().map(|(at, _)| scale.place(*at)).collect(),
        neighbours: all().map(|(_, seed)| number(*seed)).collect(),
        rings,
        cells: (0..=kept.len() as u32).collect(),
        centres: places.par_iter().map(|[part, cell]| scale.place(parts[*part].centres[*cell])).collect(),
        frames: vec![DVec2::X; kept.len()],
        areas: places.par_iter().map(|[part, cell]| parts[*part].areas[*cell] * scale.unit * scale.unit).collect(),
        ids: kept,
        period,
        ..Partition::default()
    })
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
