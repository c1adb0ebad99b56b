//! Power cells: Voronoi cells whose borders are moved by weights.
//!
//! A point belongs to the seed with the least `|x - p|^2 - w` (Aurenhammer 1987). Each cell starts as the whole ground, and
//! the seeds around cut off their parts, ring by ring over a grid, until what is left is so near to its own seed
//! that none farther away can reach it (Ray, Sokolov, Lefebvre & Levy 2018, section 3). Neighbours find their
//! common corners on their own, so that corners of these cells are yet to be welded.

use super::{Bounds, SAME, Scale};
use crate::geometry::assemble::{Piece, Ring};
use glam::{DVec2, I64Vec2};
use rayon::prelude::*;

/// Seeds in a field of the grid, on average.
const PER_FIELD: f64 = 2.0;

/// Cells made between two questions whether to go on.
const AT_ONCE: usize = 65_536;

/// The power cells of seeds in mm with weights in mm², cut off at the bounds, in the order of the seeds, whose numbers they
/// have as ids; seeds whose cells vanish are left out. Seeds of a ground that repeats may be anywhere, others within
/// the bounds or the width of the ground away.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn power_cells<E>(
    seeds: &[DVec2],
    weights: &[f64],
    bounds: Bounds,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Vec<Piece>, E> {
    let grid = Grid::new(seeds, weights, bounds);
    let mut pieces = vec![];
    for first in (0..grid.sites.len()).step_by(AT_ONCE) {
        go_on()?;
        let sites = first..grid.sites.len().min(first + AT_ONCE);
        let some = sites.into_par_iter().filter_map(|site| grid.cell(site));
        pieces.par_extend(some);
    }
    pieces.sort_unstable_by_key(|piece| piece.id);
    Ok(pieces)
}

#[derive(Clone, Copy, Debug)]
struct Site {
    at: DVec2,
    weight: f64,
    seed: u32,
}

/// Sites by the fields of a grid that they lie in.
struct Grid {
    scale: Scale,
    sites: Vec<Site>,
    /// The first site of each field, row after row, and the number of sites.
    starts: Vec<u32>,
    low: DVec2,
    /// Width and height of a field.
    field: DVec2,
    fields: I64Vec2,
    heaviest: f64,
}

impl Grid {
    fn new(seeds: &[DVec2], weights: &[f64], bounds: Bounds) -> Grid {
        let scale = Scale::new(bounds);
        let mut sites = sites(seeds, weights, &scale);
        let (low, high) = extent(&sites, &scale);
        let size = high - low;
        let side = (size.x * size.y * PER_FIELD / sites.len().max(1) as f64).sqrt();
        let fields = (size / side).floor().clamp(DVec2::ONE, DVec2::splat(1e4));
        let mut grid = Grid {
            heaviest: sites
                .iter()
                .map(|site| site.weight)
                .fold(f64::NEG_INFINITY, f64::max),
            low,
            field: size / fields,
            fields: fields.as_i64vec2(),
            starts: vec![],
            sites: vec![],
            scale,
        };
        sites.sort_unstable_by_key(|site| (grid.number(grid.field_of(site.at)), site.seed));
        let count = (grid.fields.x * grid.fields.y) as usize;
        grid.starts = vec![0; count + 1];
        for site in &sites {
            let number = grid.number(grid.field_of(site.at));
            grid.starts[number + 1] += 1;
        }
        for field in 0..count {
            grid.starts[field + 1] += grid.starts[field];
        }
        grid.sites = sites;
        grid
    }

    fn field_of(&self, at: DVec2) -> I64Vec2 {
        let field = ((at - self.low) / self.field).floor().as_i64vec2();
        field.clamp(I64Vec2::ZERO, self.fields - 1)
    }

    fn number(&self, field: I64Vec2) -> usize {
        (field.y * self.fields.x + field.x) as usize
    }

    /// The cell of a site, unless nothing is left of it.
    fn cell(&self, index: usize) -> Option<Piece> {
        let own = self.sites[index];
        let mut cell = Cut::new(self.first_outline(own.at));
        let home = self.field_of(own.at);
        let farthest = if self.scale.repeats {
            2 * self.fields
        } else {
            self.fields
        };
        let side = self.field.min_element();
        for ring in 0..=farthest.max_element() {
            let away = (ring - 1).max(0) as f64 * side;
            let reach = 0.5 * (away + (own.weight - self.heaviest) / away);
            if cell.corners.is_empty() || (away > 0.0 && reach > cell.radius()) {
                break;
            }
            self.around(home, ring, &mut |site: &Site, moved: DVec2| {
                let aside = (site.at - own.at) + moved;
                if aside.abs().max_element() >= SAME {
                    cell.cut(
                        aside,
                        0.5 * (aside.length_squared() + (own.weight - site.weight)),
                    );
                } else if is_before(site, &own) {
                    cell.corners.clear();
                }
            });
        }
        if cell.corners.len() < 3 {
            return None;
        }
        let place = |corner: &DVec2| self.scale.place(own.at + *corner);
        Some(Piece {
            rings: vec![Ring::straight(cell.corners.iter().map(place).collect())],
            id: own.seed,
            frame: DVec2::X,
            centre: None,
        })
    }

    /// The ground, seen from a site; of one that repeats what is nearer to the site than to its own copies.
    fn first_outline(&self, from: DVec2) -> Vec<DVec2> {
        let high = self.scale.high;
        let [low, high] = if self.scale.repeats {
            [-0.5 * high, 0.5 * high]
        } else {
            [-from, high - from]
        };
        vec![
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ]
    }

    /// Visits the sites of all fields that are `ring` fields away, with how far each is moved.
    fn around(&self, home: I64Vec2, ring: i64, visit: &mut dyn FnMut(&Site, DVec2)) {
        for y in -ring..=ring {
            let step = if y.abs() == ring { 1 } else { 2 * ring };
            let mut x = -ring;
            while x <= ring {
                self.visit(home + I64Vec2::new(x, y), visit);
                x += step.max(1);
            }
        }
    }

    fn visit(&self, field: I64Vec2, visit: &mut dyn FnMut(&Site, DVec2)) {
        let periods = field.div_euclid(self.fields);
        if !self.scale.repeats && periods != I64Vec2::ZERO {
            return;
        }
        let number = self.number(field.rem_euclid(self.fields));
        let moved = periods.as_dvec2() * self.scale.high;
        let sites = self.starts[number] as usize..self.starts[number + 1] as usize;
        self.sites[sites].iter().for_each(|site| visit(site, moved));
    }
}

/// The seeds with their weights; on a ground that repeats moved into the first period.
fn sites(seeds: &[DVec2], weights: &[f64], scale: &Scale) -> Vec<Site> {
    let mut sites = scale.sites(seeds);
    if scale.repeats {
        sites = super::periodic::first_period(seeds, scale, scale.high);
    }
    let site = |site: &super::Site| Site {
        at: site.at,
        weight: weights[site.seed as usize] / (scale.unit * scale.unit),
        seed: site.seed,
    };
    sites.iter().map(site).collect()
}

/// What the grid covers: one period, or all sites.
fn extent(sites: &[Site], scale: &Scale) -> (DVec2, DVec2) {
    if scale.repeats {
        return (DVec2::ZERO, scale.high);
    }
    let (mut low, mut high) = (DVec2::ZERO, scale.high);
    for site in sites {
        (low, high) = (low.min(site.at), high.max(site.at));
    }
    (low, high)
}

/// Whether a site at the place of another has the cell.
fn is_before(site: &Site, own: &Site) -> bool {
    site.weight > own.weight || (site.weight == own.weight && site.seed < own.seed)
}

/// What is left of a cell, seen from its site.
struct Cut {
    corners: Vec<DVec2>,
    /// Room for the next cut.
    next: Vec<DVec2>,
}

impl Cut {
    fn new(corners: Vec<DVec2>) -> Cut {
        let next = vec![];
        Cut { corners, next }
    }

    /// How far the farthest corner is from the site.
    fn radius(&self) -> f64 {
        let squares = self.corners.iter().map(|corner| corner.length_squared());
        squares.fold(0.0, f64::max).sqrt()
    }

    /// Keeps what has at most this product with `aside`.
    fn cut(&mut self, aside: DVec2, most: f64) {
        let over = |corner: &DVec2| corner.dot(aside) - most;
        if self.corners.iter().all(|corner| over(corner) <= 0.0) {
            return;
        }
        self.next.clear();
        for (index, corner) in self.corners.iter().enumerate() {
            let following = self.corners[(index + 1) % self.corners.len()];
            let (here, there) = (over(corner), over(&following));
            if here <= 0.0 {
                self.next.push(*corner);
            }
            if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
                let share = here / (here - there);
                self.next.push(*corner + (following - *corner) * share);
            }
        }
        std::mem::swap(&mut self.corners, &mut self.next);
    }
}
