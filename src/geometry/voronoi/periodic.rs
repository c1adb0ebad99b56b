//! Cells of a plane that repeats: seeds near the border are copied to beyond the opposite one.
//!
//! How far the copies must reach is not known before: the cells are right once no copy that is left out lies in a circle
//! around one of their corners, through the seeds next to it. As long as one does, the copies reach as far as it lies.

use super::cells::Maker;
use super::triangulation::Dual;
use super::{Cells, Scale, Site, on_grid};
use crate::geometry::box_tree::BoxTree;
use glam::DVec2;
use rayon::prelude::*;
use spade::Triangulation as _;
use spade::handles::FixedVertexHandle;
use std::convert::Infallible;
use std::sync::OnceLock;

/// Copies reach this many mean distances between seeds at first.
const REACH: f64 = 6.0;

/// Along an axis whose strips in a row are empty for this share of the period, copies reach as far as they can at once.
const STRIPS: usize = 64;
const EMPTY: usize = 16;

/// How much farther copies reach than the last one that was left out.
const FARTHER: f64 = 1.25;

/// By how much of its radius a copy must lie within a circle to count.
const WITHIN: f64 = 1e-9;

/// The cells of seeds in mm.
pub(super) fn cells<E>(
    seeds: &[DVec2],
    scale: &Scale,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Option<Cells>, E> {
    let period = on_grid(scale.high);
    let sites = first_period(seeds, scale, period);
    let around = Around::new(&sites, period);
    let mut reach = around.first_reach();
    for round in 0.. {
        let copies = with_copies(&sites, period, reach);
        let dual = Dual::new(&copies, Some(period), go_on)?;
        let mut maker = Maker::new(&dual, scale);
        let vertices = dual.vertices(seeds.len());
        go_on()?;
        let needed = around.needed(&dual, &maker, &vertices, reach);
        go_on()?;
        if needed.cmple(reach).all() {
            let partition = maker.partition(&vertices);
            return Ok(partition.map(|partition| Cells {
                equal: sites.len() - partition.len(),
                outside: seeds.len() - sites.len(),
                partition,
            }));
        }
        // What was not enough twice would grow again and again.
        reach = match round {
            0 => reach.max(FARTHER * needed).min(period),
            _ => period,
        };
    }
    Ok(None)
}

/// All seeds, moved into the first period.
pub(super) fn first_period(seeds: &[DVec2], scale: &Scale, period: DVec2) -> Vec<Site> {
    let site = |(seed, position): (usize, &DVec2)| {
        let at = (*position - scale.low) / scale.unit;
        let at = at - (at / period).floor() * period;
        at.is_finite().then(|| {
            let at = on_grid(at);
            let wrapped = |at: f64, high: f64| if at >= high || at < 0.0 { 0.0 } else { at };
            Site {
                at: DVec2::new(wrapped(at.x, period.x), wrapped(at.y, period.y)),
                seed: seed as u32,
                shift: [0; 2],
            }
        })
    };
    seeds.iter().enumerate().filter_map(site).collect()
}

/// The sites and those of their copies that are at most `reach` beyond a side.
fn with_copies(sites: &[Site], period: DVec2, reach: DVec2) -> Vec<Site> {
    let shifts = |at: f64, axis: usize| {
        let (period, reach) = (period[axis], reach[axis]);
        [0, 1, -1].into_iter().filter(move |shift| match shift {
            0 => true,
            1 => at <= reach,
            _ => at >= period - reach,
        })
    };
    let copies = |site: &Site| {
        let site = *site;
        shifts(site.at.x, 0).flat_map(move |x| {
            shifts(site.at.y, 1).map(move |y| Site {
                at: site.at + DVec2::new(f64::from(x), f64::from(y)) * period,
                shift: [x, y],
                ..site
            })
        })
    };
    sites.iter().flat_map(copies).collect()
}

/// The sites of the first period, to ask which of their copies lie in a circle.
struct Around<'a> {
    sites: &'a [Site],
    period: DVec2,
    /// The lowest and the highest coordinates of sites.
    low: DVec2,
    high: DVec2,
    /// Made when it is asked for.
    tree: OnceLock<BoxTree>,
}

impl Around<'_> {
    fn new(sites: &[Site], period: DVec2) -> Around<'_> {
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = sites.iter().fold(none, |(low, high), site| {
            (low.min(site.at), high.max(site.at))
        });
        Around {
            sites,
            period,
            low,
            high,
            tree: OnceLock::new(),
        }
    }

    /// How far copies reach at first.
    fn first_reach(&self) -> DVec2 {
        let area = self.period.x * self.period.y;
        let mean = (area / self.sites.len().max(1) as f64).sqrt();
        let along = |axis: usize| match self.has_gap(axis) {
            true => self.period[axis],
            false => (REACH * mean).min(self.period[axis]),
        };
        DVec2::new(along(0), along(1))
    }

    /// Whether there are many empty strips in a row across an axis.
    fn has_gap(&self, axis: usize) -> bool {
        let mut is_empty = [true; STRIPS];
        for site in self.sites {
            let strip = (site.at[axis] / self.period[axis] * STRIPS as f64) as usize;
            is_empty[strip.min(STRIPS - 1)] = false;
        }
        let mut row = 0;
        (0..2 * STRIPS).any(|strip| {
            row = if is_empty[strip % STRIPS] { row + 1 } else { 0 };
            row >= EMPTY
        })
    }

    /// How far beyond the sides the farthest copy lies that is in a circle around a corner of a cell; no farther than `reach` if
    /// there is none that is left out.
    fn needed(
        &self,
        dual: &Dual,
        maker: &Maker<'_>,
        vertices: &[Option<FixedVertexHandle>],
        reach: DVec2,
    ) -> DVec2 {
        let of_vertex = |vertex: &FixedVertexHandle| {
            let vertex = dual.triangles.vertex(*vertex);
            let at = vertex.data().at;
            let mut needed = DVec2::ZERO;
            for edge in vertex.out_edges() {
                let corner = maker.corners().index(edge.face().fix().index());
                let centre = maker.corners().at(corner, [0; 2]);
                needed = needed.max(self.left_out(centre, centre.distance(at), reach));
            }
            needed
        };
        let all = vertices.par_iter().flatten().map(of_vertex);
        all.reduce(|| DVec2::ZERO, DVec2::max)
    }

    /// How far beyond the sides copies in a circle lie of which some are left out.
    fn left_out(&self, centre: DVec2, radius: f64, reach: DVec2) -> DVec2 {
        let mut needed = DVec2::ZERO;
        let shifts = |axis: usize| {
            let (low, high) = (centre[axis] - radius, centre[axis] + radius);
            let is_whole = reach[axis] >= self.period[axis];
            let below = !is_whole && low < -reach[axis];
            let above = !is_whole && high > self.period[axis] + reach[axis];
            (below, above)
        };
        let beyond = [0, 1].map(shifts);
        if beyond == [(false, false); 2] {
            return needed;
        }
        for y in [-1.0, 0.0, 1.0] {
            for x in [-1.0, 0.0, 1.0] {
                let steps: [f64; 2] = [x, y];
                let is_beyond = (0..2).any(|axis| match steps[axis] {
                    -1.0 => beyond[axis].0,
                    1.0 => beyond[axis].1,
                    _ => false,
                });
                let shift = DVec2::from_array(steps) * self.period;
                let found = is_beyond
                    .then(|| self.within(centre - shift, radius))
                    .flatten();
                if let Some(found) = found {
                    let copy = found + shift;
                    needed = needed.max((-copy).max(copy - self.period));
                }
            }
        }
        needed
    }

    /// The site nearest to the middle of a circle, if it lies within.
    fn within(&self, centre: DVec2, radius: f64) -> Option<DVec2> {
        let most = (1.0 - WITHIN) * radius;
        let nearest = centre.clamp(self.low, self.high);
        if nearest.distance(centre) >= most {
            return None;
        }
        let tree = self.tree.get_or_init(|| {
            let boxes: Vec<[DVec2; 2]> = self.sites.iter().map(|site| [site.at; 2]).collect();
            let Ok(tree) = BoxTree::new(&boxes, &mut || Ok::<(), Infallible>(()));
            tree
        });
        let square = |site: u32| self.sites[site as usize].at.distance_squared(centre);
        let site = tree.nearest_within(centre, most * most, square)?;
        Some(self.sites[site as usize].at)
    }
}
