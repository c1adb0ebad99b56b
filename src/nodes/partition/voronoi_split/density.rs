//! Densities: where seeds are drawn, and the weighted middles of cells.
//!
//! Seeds that are drawn are as dense as the density says. Relaxation with a weight puts seeds as dense as its root says in
//! the plane (Gersho 1979; Du, Faber & Gunzburger 1999), so the weight is the square of the density.

use super::super::division::Plot;
use crate::field::Field;
use crate::node::{Build, Failure, Inputs};
use crate::nodes::random::Random;
use crate::value::Partition;
use glam::DVec2;

/// Draws for one seed in a region before the region is taken as too thin.
const DRAWS: usize = 10_000;

/// Squares along the longer side of a plot for each seed along it, and at least and at most.
const SQUARES: f64 = 4.0;
const SIDE: [f64; 2] = [16.0, 1024.0];

/// How dense seeds are to be; alike everywhere if there is no field.
pub(super) struct Density<'a> {
    field: Option<Field>,
    build: &'a Build<'a>,
}

impl<'a> Density<'a> {
    /// What the inputs state.
    pub(super) fn read(inputs: &Inputs<'_>, build: &'a Build<'a>) -> Density<'a> {
        let field = inputs.get("density").map(|_| inputs.field("density"));
        Density { field, build }
    }

    /// So many seeds anywhere in a plot.
    ///
    /// # Errors
    /// If the density is nowhere above 0 or not finite, or the run was cancelled.
    pub(super) fn seeds(
        &self,
        plot: &Plot,
        count: usize,
        random: &mut Random,
    ) -> Result<Vec<DVec2>, Failure> {
        let raster = match &self.field {
            Some(field) => Some(Raster::new(field, plot, count, self.build)?),
            None => None,
        };
        let [low, high] = plot.bounds();
        let mut draw = || {
            let (low, size) = match &raster {
                Some(raster) => raster.draw(random),
                None => (low, high - low),
            };
            low + DVec2::new(f64::from(random.share()), f64::from(random.share())) * size
        };
        if plot.is_rectangle() {
            return Ok((0..count).map(|_| draw()).collect());
        }
        let edges = plot.edges();
        let mut inside = || {
            let mut draws = (0..DRAWS).map(|_| draw());
            draws.find(|at| edges.enclose(*at))
        };
        Ok((0..count).map_while(|_| inside()).collect())
    }

    /// The middles of cells, weighted by the square of the density.
    ///
    /// # Errors
    /// If the run was cancelled.
    pub(super) fn middles(&self, cells: &Partition) -> Result<Vec<DVec2>, Failure> {
        let Some(field) = &self.field else {
            return Ok(cells.centres.clone());
        };
        let (mut points, mut shares, mut starts) = (vec![], vec![], vec![0]);
        for cell in 0..cells.len() {
            add_points(cells, cell, &mut |point, share| {
                points.push(point);
                shares.push(share);
            });
            starts.push(points.len());
        }
        let asked = points.iter().map(|at| first_period(*at, cells.period));
        let found = self.build.sample(field, &asked.collect::<Vec<_>>())?;
        let middle = |cell: usize| {
            let of_cell = starts[cell]..starts[cell + 1];
            let densities = &found[0][of_cell.clone()];
            let shares = shares[of_cell.clone()].iter().zip(densities);
            let (mut sum, mut moment) = (0.0, DVec2::ZERO);
            for (point, (share, density)) in points[of_cell].iter().zip(shares) {
                let density = f64::from(density.max(0.0));
                let weight = share * density * density;
                sum += weight;
                moment += weight * (*point - cells.centres[cell]);
            }
            let off = moment / sum;
            let is_some = sum > 0.0 && off.is_finite();
            cells.centres[cell] + if is_some { off } else { DVec2::ZERO }
        };
        Ok((0..cells.len()).map(middle).collect())
    }
}

/// A point as it is seen in the first period.
fn first_period(at: DVec2, period: Option<DVec2>) -> DVec2 {
    period.map_or(at, |period| at - (at / period).floor() * period)
}

/// Shows points of a cell and the areas they stand for: three in each triangle between the middle and an edge, exact for squares
/// of positions.
fn add_points(cells: &Partition, cell: usize, show: &mut dyn FnMut(DVec2, f64)) {
    let middle = cells.centres[cell];
    for ring in cells.rings_of(cell) {
        let corners = &cells.corners[ring];
        let next = corners.iter().cycle().skip(1);
        for (from, to) in corners.iter().zip(next) {
            let area = 0.5 * (*from - middle).perp_dot(*to - middle);
            let sum = middle + *from + *to;
            for corner in [middle, *from, *to] {
                show((sum + 3.0 * corner) / 6.0, area / 3.0);
            }
        }
    }
}

/// A density in squares.
struct Raster {
    low: DVec2,
    size: DVec2,
    columns: usize,
    /// Of each square what it and all before it hold.
    sums: Vec<f64>,
}

impl Raster {
    fn new(field: &Field, plot: &Plot, count: usize, build: &Build<'_>) -> Result<Raster, Failure> {
        let [low, high] = plot.bounds();
        let extent = high - low;
        let along = (SQUARES * (count as f64).sqrt()).clamp(SIDE[0], SIDE[1]);
        let squares = (along * extent / extent.max_element())
            .ceil()
            .max(DVec2::ONE);
        let size = extent / squares;
        let [columns, rows] = squares.to_array().map(|count| count as usize);
        let middle = |square: usize| {
            let at = DVec2::new((square % columns) as f64, (square / columns) as f64);
            low + (at + 0.5) * size
        };
        let middles: Vec<DVec2> = (0..columns * rows).map(middle).collect();
        let found = build.sample_finite("density", field, &middles)?;
        let mut sum = 0.0;
        let mut sums = vec![];
        for density in &found[0] {
            sum += f64::from(density.max(0.0));
            sums.push(sum);
        }
        if sum <= 0.0 {
            let failure = Failure::of_input("density", "the density is nowhere above 0");
            return Err(failure.with_hint("seeds are where the density is above 0"));
        }
        Ok(Raster {
            low,
            size,
            columns,
            sums,
        })
    }

    /// A square by chance, as its lowest corner and its size.
    fn draw(&self, random: &mut Random) -> (DVec2, DVec2) {
        // Two draws, since one has no more steps than there may be squares.
        let fine = f64::from(random.share()) / 16_777_216.0;
        let share = f64::from(random.share()) + fine;
        let most = self.sums[self.sums.len() - 1];
        let square = self.sums.partition_point(|sum| *sum <= share * most);
        let square = square.min(self.sums.len() - 1);
        let at = DVec2::new(
            (square % self.columns) as f64,
            (square / self.columns) as f64,
        );
        (self.low + at * self.size, self.size)
    }
}
