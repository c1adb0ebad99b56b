//! Edges are split where a corner of another piece lies on them.

use super::draft::{Draft, Ring};
use super::edges::neighbours;
use super::weld::{Corner, SEAM};
use crate::value::Partition;
use glam::{DVec2, I64Vec2};
use rayon::prelude::*;

/// Splits straight edges without a neighbour at the corners that lie on them, up to `tolerance` mm off. `go_on` is asked now and
/// then.
///
/// # Errors
/// What `go_on` says.
pub(super) fn split_edges<E>(
    draft: &mut Draft,
    tolerance: f64,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(), E> {
    let neighbours = neighbours(draft);
    go_on()?;
    let mut alone = neighbours.iter().map(|cell| *cell == Partition::NONE);
    let flags: Vec<Vec<Vec<bool>>> = draft
        .pieces
        .iter()
        .map(|rings| {
            let of = |ring: &Ring| alone.by_ref().take(ring.corners.len()).collect();
            rings.iter().map(of).collect()
        })
        .collect();
    let Some(grid) = Grid::new(draft, &flags, tolerance) else {
        return Ok(());
    };
    go_on()?;
    let pieces: Vec<Vec<Ring>> = draft
        .pieces
        .par_iter()
        .zip(&flags)
        .map(|(rings, flags)| {
            let pairs = rings.iter().zip(flags);
            pairs
                .map(|(ring, alone)| grid.split(draft, ring, alone, tolerance))
                .collect()
        })
        .collect();
    draft.pieces = pieces;
    go_on()
}

/// Corners by place.
struct Grid {
    low: DVec2,
    /// Extent of a field of the grid, in mm.
    field: DVec2,
    fields: I64Vec2,
    /// The first corner of each field, and behind them the number of corners.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl Grid {
    /// The ends of edges that have no neighbour; `None` if there are none.
    fn new(draft: &Draft, alone: &[Vec<Vec<bool>>], tolerance: f64) -> Option<Grid> {
        let mut points = vec![];
        for (ring, alone) in draft.pieces.iter().flatten().zip(alone.iter().flatten()) {
            let count = alone.len();
            let is_end = |index: &usize| alone[*index] || alone[(index + count - 1) % count];
            points.extend(
                (0..count)
                    .filter(is_end)
                    .map(|index| ring.corners[index].point),
            );
        }
        points.sort_unstable();
        points.dedup();
        let mut places = points.iter().map(|point| draft.points[*point as usize]);
        let first = places.next()?;
        let (low, high) = places.fold((first, first), |(low, high), at| {
            (low.min(at), high.max(at))
        });
        // Without a period a little more, so that what lies on the upper border is in a field.
        let more = 1e-6 * (high - low) + 8.0 * tolerance;
        let (low, extent) = match draft.period {
            Some(period) => (DVec2::splat(-SEAM * tolerance), period),
            None => (low, high - low + more),
        };
        let fields = fields(extent, points.len());
        let mut grid = Grid {
            low,
            field: extent / fields.as_dvec2(),
            fields,
            starts: vec![],
            points: vec![],
        };
        grid.fill(draft, &points);
        Some(grid)
    }

    fn fill(&mut self, draft: &Draft, points: &[u32]) {
        let number = |point: u32| {
            let at = self.field_at(draft.points[point as usize]);
            let at = at.clamp(I64Vec2::ZERO, self.fields - 1);
            (at.y * self.fields.x + at.x) as usize
        };
        let mut sorted: Vec<(usize, u32)> = points
            .iter()
            .map(|point| (number(*point), *point))
            .collect();
        sorted.par_sort_unstable();
        let mut starts = vec![0; (self.fields.x * self.fields.y) as usize + 1];
        sorted.iter().for_each(|(field, _)| starts[field + 1] += 1);
        for field in 1..starts.len() {
            starts[field] += starts[field - 1];
        }
        self.starts = starts;
        self.points = sorted.into_iter().map(|(_, point)| point).collect();
    }

    /// The field of a point; beyond the grid the count goes on.
    fn field_at(&self, point: DVec2) -> I64Vec2 {
        ((point - self.low) / self.field).floor().as_i64vec2()
    }

    /// The ring with the corners of others on its straight edges.
    fn split(&self, draft: &Draft, ring: &Ring, alone: &[bool], tolerance: f64) -> Ring {
        let mut whole = Ring::default();
        for (index, corner) in ring.corners.iter().enumerate() {
            whole.corners.push(*corner);
            whole.bulges.push(ring.bulges[index]);
            if alone[index] && ring.bulges[index] == 0.0 {
                let next = ring.corners[(index + 1) % ring.corners.len()];
                let on_edge = self.on_edge(draft, *corner, next, tolerance);
                whole.bulges.extend(on_edge.iter().map(|_| 0.0));
                whole.corners.extend(on_edge);
            }
        }
        whole
    }

    /// The corners between the ends of an edge, in their order.
    fn on_edge(&self, draft: &Draft, from: Corner, to: Corner, tolerance: f64) -> Vec<Corner> {
        let [a, b] = [from, to].map(|corner| draft.place(corner));
        let length = a.distance(b);
        let direction = (b - a) / length;
        let mut found = vec![];
        self.along(draft.period, [a, b], tolerance, &mut |corner| {
            let off = draft.place(corner) - a;
            let along = off.dot(direction);
            let is_between = along > tolerance && along < length - tolerance;
            if is_between && off.perp_dot(direction).abs() <= tolerance {
                found.push((along, corner));
            }
        });
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.dedup_by_key(|(_, corner)| *corner);
        found.into_iter().map(|(_, corner)| corner).collect()
    }

    /// Shows the corners of all fields that an edge passes, column by column.
    fn along(
        &self,
        period: Option<DVec2>,
        [a, b]: [DVec2; 2],
        tolerance: f64,
        show: &mut dyn FnMut(Corner),
    ) {
        let (left, right) = if a.x <= b.x { (a, b) } else { (b, a) };
        let margin = DVec2::splat(tolerance);
        let [first, last] = [left - margin, right + margin].map(|end| self.field_at(end).x);
        let slope = (right.y - left.y) / (right.x - left.x).max(f64::MIN_POSITIVE);
        for column in first..=last {
            let edge_at = |column: i64| {
                let x = self.low.x + column as f64 * self.field.x;
                let x = x.clamp(left.x, right.x);
                let y = left.y + slope * (x - left.x);
                y.clamp(a.y.min(b.y), a.y.max(b.y))
            };
            let (mut one, mut other) = (edge_at(column), edge_at(column + 1));
            if last - first < 2 {
                (one, other) = (a.y, b.y);
            }
            let steep = 4.0 * tolerance * (1.0 + slope.abs());
            let reach = steep.min((a.y - b.y).abs() + tolerance);
            let [low, high] = [one.min(other) - reach, one.max(other) + reach]
                .map(|y| self.field_at(DVec2::new(0.0, y)).y);
            for row in low..=high {
                self.show(I64Vec2::new(column, row), period.is_some(), show);
            }
        }
    }

    fn show(&self, at: I64Vec2, is_periodic: bool, show: &mut dyn FnMut(Corner)) {
        let periods = at.div_euclid(self.fields);
        if !is_periodic && periods != I64Vec2::ZERO {
            return;
        }
        let at = at.rem_euclid(self.fields);
        let field = (at.y * self.fields.x + at.x) as usize;
        let points = self.starts[field] as usize..self.starts[field + 1] as usize;
        for point in &self.points[points] {
            show(Corner {
                point: *point,
                period: [periods.x as i32, periods.y as i32],
            });
        }
    }
}

/// How a box is divided so that each field has about one of `count` points.
fn fields(extent: DVec2, count: usize) -> I64Vec2 {
    let side = (extent.x * extent.y / count as f64).sqrt();
    let most = (2 * count) as f64;
    (extent / side)
        .ceil()
        .clamp(DVec2::ONE, DVec2::splat(most))
        .as_i64vec2()
}
