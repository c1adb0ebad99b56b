//! Cells of a plane that repeats: seeds near the border are copied to beyond the opposite one.
//!
//! How far the copies must reach is not known before: the cells are right once all circles around their corners, through
//! the seeds next to them, lie where there are copies. If they do not, the copies reach as far as the circles do.

use super::cells::Maker;
use super::triangulation::Dual;
use super::{Cells, Scale, Site, on_grid};
use glam::DVec2;
use rayon::prelude::*;
use spade::Triangulation as _;
use spade::handles::FixedVertexHandle;

/// Copies reach this many mean distances between seeds at first.
const REACH: f64 = 6.0;

/// The cells of seeds in mm.
pub(super) fn cells<E>(
    seeds: &[DVec2],
    scale: &Scale,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Option<Cells>, E> {
    let period = on_grid(scale.high);
    let sites = first_period(seeds, scale, period);
    let mean = (period.x * period.y / sites.len().max(1) as f64).sqrt();
    let mut reach = DVec2::splat(REACH * mean).min(period);
    loop {
        let copies = with_copies(&sites, period, reach);
        let dual = Dual::new(&copies, Some(period), go_on)?;
        let mut maker = Maker::new(&dual, scale);
        let vertices = dual.vertices(seeds.len());
        let needed = needed(&dual, &maker, &vertices, period);
        if (0..2).all(|axis| needed[axis] <= reach[axis] || reach[axis] >= period[axis]) {
            let partition = maker.partition(&vertices);
            return Ok(partition.map(|partition| Cells {
                equal: sites.len() - partition.len(),
                outside: seeds.len() - sites.len(),
                partition,
            }));
        }
        reach = needed.max(1.5 * reach).min(period);
    }
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

/// How far the circles around the corners of cells reach beyond the sides.
fn needed(
    dual: &Dual,
    maker: &Maker<'_>,
    vertices: &[Option<FixedVertexHandle>],
    period: DVec2,
) -> DVec2 {
    let of_vertex = |vertex: &FixedVertexHandle| {
        let vertex = dual.triangles.vertex(*vertex);
        let at = vertex.data().at;
        let mut needed = DVec2::ZERO;
        for edge in vertex.out_edges() {
            let corner = maker.corners().index(edge.face().fix().index());
            let centre = maker.corners().at(corner, [0; 2]);
            let radius = centre.distance(at);
            let beyond = (radius - centre).max(centre + radius - period);
            needed = needed.max(beyond);
        }
        needed
    };
    let all = vertices.par_iter().flatten().map(of_vertex);
    all.reduce(|| DVec2::ZERO, DVec2::max)
}
