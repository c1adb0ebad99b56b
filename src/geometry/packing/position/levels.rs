//! Levels of samples from fine to coarse, and back.

use super::{Field, Level, Sample};
use glam::DVec2;
use rayon::prelude::*;

impl Field<'_> {
    /// Gives each sample of a finer level the lattice of the one that stands for it.
    pub(super) fn inherit(&self, coarse: &Level, fine: &mut Level) {
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
    pub(super) fn coarser(&self) -> Level {
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
