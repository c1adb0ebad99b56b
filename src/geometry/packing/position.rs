//! A position field: of every place in a region the nearest point of a lattice that follows the direction field (Jakob,
//! Tarini, Panozzo & Sorkine-Hornung 2015), with the outer rows held along the border.

use super::guide::Guide;
use super::lattice::Lattice;
use super::walls::Walls;
use glam::DVec2;
use rayon::prelude::*;

/// Samples to a row of stones.
const DENSITY: f64 = 3.0;

/// Rounds on the finest level, and on each of the others.
const ROUNDS: [usize; 2] = [6, 12];

/// Levels, each with half as many samples to a side as the one before.
const LEVELS: usize = 7;

/// Samples in a square grid, of which those in the region count.
#[derive(Debug)]
pub(crate) struct Level {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    wraps: bool,
    pub(crate) samples: Vec<Option<Sample>>,
}

/// A place in the region, and what is known of the lattice there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) point: DVec2,
    frame: DVec2,
    scale: f64,
    /// The normals of at most two borders nearby, of length 1 or 0, and how far along them a row of the lattice lies.
    walls: [(DVec2, f64); 2],
    /// The nearest lattice point.
    pub(crate) origin: DVec2,
    /// How many samples of the finest level it stands for.
    count: f64,
}

/// What a position field is made from.
pub(crate) struct Field<'a> {
    pub(crate) lattice: Lattice,
    pub(crate) guide: &'a Guide,
    pub(crate) walls: Option<&'a Walls>,
    /// From the lowest corner on, width and height.
    pub(crate) bounds: [DVec2; 2],
    pub(crate) period: Option<DVec2>,
    /// Smallest size factor anywhere.
    pub(crate) least: f64,
    /// How far from the border the first row lies, in mm for a size of 1.
    pub(crate) first: f64,
    /// In how many parts of a turn the lattice looks the same.
    pub(crate) symmetry: u32,
}

impl Field<'_> {
    /// The finest level, solved.
    ///
    /// # Errors
    /// What `go_on` says.
    pub(crate) fn solve<E>(&self, go_on: &mut dyn FnMut() -> Result<(), E>) -> Result<Level, E> {
        let mut levels = vec![self.finest()];
        while levels.len() < LEVELS && levels[levels.len() - 1].samples.len() > 64 {
            let coarser = levels[levels.len() - 1].coarser();
            levels.push(coarser);
        }
        let mut level = levels.pop().expect("there is a finest level");
        self.spread(&mut level);
        loop {
            let rounds = ROUNDS[usize::from(!levels.is_empty())];
            for _ in 0..rounds {
                go_on()?;
                self.round(&mut level);
            }
            match levels.pop() {
                None => return Ok(level),
                Some(mut finer) => {
                    self.inherit(&level, &mut finer);
                    level = finer;
                }
            }
        }
    }

    fn finest(&self) -> Level {
        let [low, extent] = self.bounds;
        let step = self.least * self.lattice.step.min_element() / DENSITY;
        let count = |length: f64| ((length / step).ceil() as usize).max(1);
        let (columns, rows) = (count(extent.x), count(extent.y));
        let steps = extent / DVec2::new(columns as f64, rows as f64);
        let indices: Vec<usize> = (0..columns * rows).collect();
        let sample = |index: &usize| {
            let (x, y) = (index % columns, index / columns);
            self.sample(low + steps * DVec2::new(x as f64 + 0.5, y as f64 + 0.5))
        };
        Level {
            columns,
            rows,
            wraps: self.period.is_some(),
            samples: indices.par_iter().map(sample).collect(),
        }
    }

    /// A sample at a point, if it is in the region.
    fn sample(&self, point: DVec2) -> Option<Sample> {
        if let Some(walls) = self.walls
            && !walls.contains(point)
        {
            return None;
        }
        let wish = self.guide.at(point);
        let mut sample = Sample {
            point,
            frame: wish.frame,
            scale: wish.scale,
            walls: [(DVec2::ZERO, 0.0); 2],
            origin: point,
            count: 1.0,
        };
        if let Some(walls) = self.walls {
            self.hold(walls, &mut sample);
        }
        sample.origin = self.held(&sample, sample.origin);
        Some(sample)
    }

    /// Holds a sample near the border to rows along it.
    fn hold(&self, walls: &Walls, sample: &mut Sample) {
        let half = sample.scale * self.first;
        let mut near: Vec<_> = walls
            .feet(sample.point)
            .filter(|foot| {
                foot.distance < 2.2 * half && foot.height(sample.point) > 0.98 * foot.distance
            })
            .collect();
        near.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut held = 0;
        for foot in near {
            let across = sample.walls[0].0.dot(foot.inward).abs();
            if held == 0 || (held == 1 && across < 0.3) {
                sample.walls[held] = (foot.inward, foot.point.dot(foot.inward) + half);
                held += 1;
            }
        }
    }

    /// A lattice point moved onto the rows that the border asks for.
    fn held(&self, sample: &Sample, origin: DVec2) -> DVec2 {
        let mut origin = origin;
        for (normal, height) in sample.walls {
            if normal != DVec2::ZERO {
                let step = self.step_along(sample, normal);
                let off = origin.dot(normal) - height;
                origin -= normal * (off - step * (off / step).round());
            }
        }
        origin
    }

    /// Distance between rows across a direction.
    fn step_along(&self, sample: &Sample, normal: DVec2) -> f64 {
        let is_along = sample.frame.dot(normal).abs() > std::f64::consts::FRAC_1_SQRT_2;
        let Lattice { step, shift } = self.lattice;
        // Staggered rows end in whole and half stones by turns; hexagons have rows in all three directions.
        let step = match (self.symmetry, is_along) {
            (6, _) | (_, false) => step.y,
            (_, true) if shift == 0.0 => step.x,
            (_, true) => 0.5 * step.x,
        };
        sample.scale * step
    }

    /// The lattice through a sample's origin: its point nearest to `point`.
    fn nearest(&self, sample: &Sample, point: DVec2) -> DVec2 {
        let offset = point - sample.origin;
        let (cos, sin) = (sample.frame.x, sample.frame.y);
        let within = DVec2::new(offset.dot(sample.frame), cos * offset.y - sin * offset.x);
        let nearest = self.lattice.scaled(sample.scale).nearest(within);
        sample.origin + sample.frame.rotate(nearest)
    }

    /// One round: every sample takes the mean of its neighbours' lattices.
    fn round(&self, level: &mut Level) {
        for colour in 0..4 {
            let (x0, y0) = (colour % 2, colour / 2);
            let rows: Vec<usize> = (y0..level.rows).step_by(2).collect();
            let moved: Vec<Vec<DVec2>> = rows
                .par_iter()
                .map(|y| {
                    let columns = (x0..level.columns).step_by(2);
                    columns.map(|x| self.moved(level, x, *y)).collect()
                })
                .collect();
            for (y, origins) in rows.into_iter().zip(moved) {
                for (index, origin) in origins.into_iter().enumerate() {
                    if let Some(sample) = &mut level.samples[y * level.columns + x0 + 2 * index] {
                        sample.origin = origin;
                    }
                }
            }
        }
    }

    fn moved(&self, level: &Level, x: usize, y: usize) -> DVec2 {
        let Some(sample) = &level.samples[y * level.columns + x] else {
            return DVec2::ZERO;
        };
        let (mut sum, mut weights) = (sample.origin, 0.0);
        for (dx, dy) in [
            (1, 0),
            (0, 1),
            (-1, 0),
            (0, -1),
            (1, 1),
            (-1, 1),
            (-1, -1),
            (1, -1),
        ] {
            let Some(other) = level.at(x as i64 + dx, y as i64 + dy) else {
                continue;
            };
            // Beyond the edge of a period the neighbour is the same sample moved by it.
            let across = self.across(sample.point, other.point);
            let nearest = self.nearest(other, sum - across) + across;
            let weight = other.count;
            weights += weight;
            sum += weight / weights * (nearest - sum);
        }
        let origin = self.held(sample, sum);
        let mut at = *sample;
        at.origin = origin;
        self.nearest(&at, sample.point)
    }

    /// What has to be added to a neighbour's coordinates to be beside `point`.
    fn across(&self, point: DVec2, other: DVec2) -> DVec2 {
        match self.period {
            None => DVec2::ZERO,
            Some(period) => period * ((point - other) / period).round(),
        }
    }

    /// Lays one lattice from the place that is held most over all that hangs together with it.
    fn spread(&self, level: &mut Level) {
        let held = |sample: &Sample| {
            sample
                .walls
                .iter()
                .filter(|wall| wall.0 != DVec2::ZERO)
                .count()
        };
        let mut order: Vec<usize> = (0..level.samples.len()).collect();
        order
            .sort_by_key(|index| std::cmp::Reverse(level.samples[*index].as_ref().map_or(0, held)));
        let mut is_laid = vec![false; level.samples.len()];
        for first in order {
            if is_laid[first] {
                continue;
            }
            let mut waiting = std::collections::VecDeque::from([first]);
            while let Some(index) = waiting.pop_front() {
                let (columns, rows) = (level.columns as i64, level.rows as i64);
                let (x, y) = (index as i64 % columns, index as i64 / columns);
                let Some(from) = level.samples[index] else {
                    continue;
                };
                is_laid[index] = true;
                for (dx, dy) in [(1, 0), (0, 1), (-1, 0), (0, -1)] {
                    if level.at(x + dx, y + dy).is_none() {
                        continue;
                    }
                    let beside = (y + dy).rem_euclid(rows) * columns + (x + dx).rem_euclid(columns);
                    if !std::mem::replace(&mut is_laid[beside as usize], true)
                        && let Some(to) = &mut level.samples[beside as usize]
                    {
                        let across = self.across(from.point, to.point);
                        let nearest = self.nearest(&from, to.point + across) - across;
                        to.origin = self.held(to, nearest);
                        waiting.push_back(beside as usize);
                    }
                }
            }
        }
    }

    /// Gives each sample of a finer level the lattice of the one that stands for it.
    fn inherit(&self, coarse: &Level, fine: &mut Level) {
        let (columns, coarse_columns) = (fine.columns, coarse.columns);
        fine.samples
            .par_iter_mut()
            .enumerate()
            .for_each(|(index, slot)| {
                let (x, y) = (index % columns, index / columns);
                let above = &coarse.samples[y / 2 * coarse_columns + x / 2];
                if let (Some(sample), Some(above)) = (slot, above) {
                    let across = self.across(sample.point, above.point);
                    sample.origin = above.origin + across;
                    sample.origin = self.held(sample, sample.origin);
                    sample.origin = self.nearest(sample, sample.point);
                }
            });
    }
}

impl Level {
    pub(crate) fn at(&self, x: i64, y: i64) -> Option<&Sample> {
        let (columns, rows) = (self.columns as i64, self.rows as i64);
        let (x, y) = if self.wraps {
            (x.rem_euclid(columns), y.rem_euclid(rows))
        } else {
            (x, y)
        };
        let is_within = (0..columns).contains(&x) && (0..rows).contains(&y);
        is_within.then(|| self.samples[(y * columns + x) as usize].as_ref())?
    }

    /// A level with half as many samples to a side.
    fn coarser(&self) -> Level {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let one = |index: usize| {
            let (x, y) = (index % columns * 2, index / columns * 2);
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| {
                let (x, y) = (x + dx, y + dy);
                let is_within = x < self.columns && y < self.rows;
                is_within.then(|| self.samples[y * self.columns + x])?
            });
            let there = four.iter().flatten();
            let count = there.clone().map(|sample| sample.count).sum();
            // The one that is held most says where the lattice is.
            let best = there
                .max_by_key(|it| it.walls.iter().filter(|wall| wall.0 != DVec2::ZERO).count())?;
            Some(Sample { count, ..*best })
        };
        let samples = (0..columns * rows).into_par_iter().map(one).collect();
        Level {
            columns,
            rows,
            wraps: self.wraps,
            samples,
        }
    }
}

/// Where stones lie: lattice points that many samples agree on, and how many do.
pub(crate) fn stones(field: &Field<'_>, level: &Level) -> Vec<(DVec2, f64)> {
    let mut parents: Vec<u32> = (0..level.samples.len() as u32).collect();
    for index in 0..level.samples.len() {
        let Some(sample) = &level.samples[index] else {
            continue;
        };
        let (x, y) = (
            (index % level.columns) as i64,
            (index / level.columns) as i64,
        );
        for (dx, dy) in [(1, 0), (0, 1), (1, 1), (-1, 1)] {
            let Some(other) = level.at(x + dx, y + dy) else {
                continue;
            };
            let across = field.across(sample.point, other.point);
            let near = 0.35 * sample.scale.min(other.scale) * field.lattice.step.min_element();
            if (other.origin + across).distance_squared(sample.origin) < near * near {
                let (x, y) = (x + dx, y + dy);
                let (columns, rows) = (level.columns as i64, level.rows as i64);
                let other = (y.rem_euclid(rows) * columns + x.rem_euclid(columns)) as u32;
                let (a, b) = (root(&mut parents, index as u32), root(&mut parents, other));
                parents[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut sums = vec![(DVec2::ZERO, 0.0); level.samples.len()];
    let mut order = vec![];
    for index in 0..level.samples.len() {
        let Some(sample) = &level.samples[index] else {
            continue;
        };
        let first = root(&mut parents, index as u32) as usize;
        if first == index {
            order.push(index);
        }
        let base = level.samples[first].as_ref().expect("a root is a sample");
        let across = field.across(base.point, sample.point);
        sums[first].0 += sample.origin + across;
        sums[first].1 += 1.0;
    }
    order
        .into_iter()
        .map(|index| (sums[index].0 / sums[index].1, sums[index].1))
        .collect()
}

fn root(parents: &mut [u32], index: u32) -> u32 {
    let mut index = index;
    while parents[index as usize] != index {
        parents[index as usize] = parents[parents[index as usize] as usize];
        index = parents[index as usize];
    }
    index
}
