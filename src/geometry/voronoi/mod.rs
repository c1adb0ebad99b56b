//! Voronoi cells: for each seed the part of the plane that is nearer to it than to the others.
//!
//! The cells are read off the Delaunay triangulation of `spade`, their dual. Everything is done in coordinates where
//! the ground measures about 1, so that results do not depend on the unit or the place; seeds are inserted in an order
//! that follows from where they are, so that they do not depend on the order of the list either.

mod cells;
mod clip;
mod corners;
mod laplace;
mod order;
mod periodic;
mod power;
mod triangulation;

pub(crate) use laplace::{Link, potentials};
pub(crate) use power::power_cells;

use crate::value::Partition;
use glam::DVec2;

/// Seeds nearer to each other than this, and corners, count as one: a share of the ground's larger side.
const SAME: f64 = 1.0 / (1_u64 << 44) as f64;

/// The rectangle that cells are made in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    /// Its lowest and highest corner in mm.
    pub(crate) low: DVec2,
    pub(crate) high: DVec2,
    /// Whether it repeats: then the cells go on beyond its sides.
    pub(crate) repeats: bool,
}

/// Cells, and the seeds that have none.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    /// The cells in the order of the seeds, whose numbers they have as ids.
    pub(crate) partition: Partition,
    /// Seeds that lie where another does that comes before them.
    pub(crate) equal: usize,
    /// Seeds outside of the bounds whose cells do not reach into them, or that lie too far away to be regarded.
    pub(crate) outside: usize,
}

/// The Voronoi cells of seeds in mm, cut off at the bounds. Seeds may lie outside, up to the width of the ground away; of
/// equal ones the first keeps the cell. `None` if no seed has a cell. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn voronoi<E>(
    seeds: &[DVec2],
    bounds: Bounds,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Option<Cells>, E> {
    let scale = Scale::new(bounds);
    if bounds.repeats {
        return periodic::cells(seeds, &scale, go_on);
    }
    let sites = scale.sites(seeds);
    let dual = triangulation::Dual::new(&sites, None, go_on)?;
    let vertices = dual.vertices(seeds.len());
    go_on()?;
    let partition = cells::Maker::new(&dual, &scale).partition(&vertices);
    Ok(partition.map(|partition| {
        let without = seeds.len() - partition.len();
        Cells {
            partition,
            equal: dual.equal,
            outside: without - dual.equal,
        }
    }))
}

/// The place and the size of the ground: from mm to coordinates where it lies between 0 and 1.
#[derive(Clone, Copy, Debug)]
struct Scale {
    low: DVec2,
    /// A power of two, so that nothing is rounded.
    unit: f64,
    /// The highest corner in these coordinates.
    high: DVec2,
    repeats: bool,
}

/// What one seed gives to the triangulation.
#[derive(Clone, Copy, Debug)]
struct Site {
    at: DVec2,
    seed: u32,
    /// By how many periods it is moved.
    shift: [i8; 2],
}

impl Scale {
    fn new(bounds: Bounds) -> Scale {
        let size = bounds.high - bounds.low;
        let mut unit = 1.0;
        while unit < size.max_element() {
            unit *= 2.0;
        }
        while 0.5 * unit >= size.max_element() {
            unit *= 0.5;
        }
        Scale {
            low: bounds.low,
            unit,
            high: size / unit,
            repeats: bounds.repeats,
        }
    }

    /// The seeds that are near enough to be regarded, on a grid so fine that no number is too small for `spade`.
    fn sites(&self, seeds: &[DVec2]) -> Vec<Site> {
        let is_near = |at: DVec2| at.is_finite() && (at - 0.5).abs().max_element() <= 1.5;
        let site = |(seed, position): (usize, &DVec2)| {
            let at = (*position - self.low) / self.unit;
            is_near(at).then(|| Site {
                at: on_grid(at),
                seed: seed as u32,
                shift: [0; 2],
            })
        };
        seeds.iter().enumerate().filter_map(site).collect()
    }

    /// Back to mm.
    fn place(&self, at: DVec2) -> DVec2 {
        at * self.unit + self.low
    }
}

/// Rounds coordinates from -2 to 2 to multiples of 2^-50.
fn on_grid(at: DVec2) -> DVec2 {
    (at + 6.0) - 6.0
}
