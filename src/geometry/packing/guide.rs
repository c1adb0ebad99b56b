//! Direction and size of stones at every place, read from a grid.

use super::direction::{power, unturned};
use glam::DVec2;
use rayon::prelude::*;

/// What stones are to be like at the points of a grid.
#[derive(Debug)]
pub(crate) struct Guide {
    low: DVec2,
    step: DVec2,
    columns: usize,
    rows: usize,
    symmetry: u32,
    /// Directions, turned to as many times their angle as the symmetry says, and the size as a factor.
    samples: Vec<(DVec2, f64)>,
}

/// Direction and size at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wish {
    /// Of length 1.
    pub(crate) frame: DVec2,
    /// A factor to the size.
    pub(crate) scale: f64,
}

/// Most points of a side.
const MOST: f64 = 2048.0;

impl Guide {
    /// The points that a guide between two corners needs, about `step` mm apart, row by row from below; with them the
    /// number of columns.
    pub(crate) fn points([low, high]: [DVec2; 2], step: f64) -> (Vec<DVec2>, usize) {
        let extent = high - low;
        let count = |length: f64| (length / step).ceil().clamp(1.0, MOST) as usize + 1;
        let (columns, rows) = (count(extent.x), count(extent.y));
        let steps = extent / DVec2::new((columns - 1) as f64, (rows - 1) as f64);
        let row =
            |y: usize| (0..columns).map(move |x| low + DVec2::new(x as f64, y as f64) * steps);
        ((0..rows).flat_map(row).collect(), columns)
    }

    /// A guide from directions (of any length, turned already) and size factors at [`Guide::points`].
    pub(crate) fn new(
        [low, high]: [DVec2; 2],
        columns: usize,
        symmetry: u32,
        turned: &[DVec2],
        scales: &[f64],
    ) -> Guide {
        let rows = turned.len() / columns;
        let samples = turned.par_iter().zip(scales);
        Guide {
            low,
            step: (high - low) / DVec2::new((columns - 1) as f64, (rows - 1) as f64),
            columns,
            rows,
            symmetry,
            samples: samples
                .map(|(turned, scale)| (turned.try_normalize().unwrap_or(DVec2::X), *scale))
                .collect(),
        }
    }

    /// Turned direction (not of length 1) and size factor at a point.
    fn turned(&self, point: DVec2) -> (DVec2, f64) {
        let at = ((point - self.low) / self.step).max(DVec2::ZERO);
        let column = (at.x as usize).min(self.columns - 2);
        let row = (at.y as usize).min(self.rows - 2);
        let share = (at - DVec2::new(column as f64, row as f64)).min(DVec2::ONE);
        let first = row * self.columns + column;
        let mix =
            |a: (DVec2, f64), b: (DVec2, f64), t: f64| (a.0.lerp(b.0, t), a.1 + t * (b.1 - a.1));
        let below = mix(self.samples[first], self.samples[first + 1], share.x);
        let next = first + self.columns;
        let above = mix(self.samples[next], self.samples[next + 1], share.x);
        mix(below, above, share.y)
    }

    /// Direction and size at a point.
    pub(crate) fn at(&self, point: DVec2) -> Wish {
        let (turned, scale) = self.turned(point);
        Wish {
            frame: unturned(turned, self.symmetry),
            scale,
        }
    }

    /// Size factor at a point.
    pub(crate) fn scale(&self, point: DVec2) -> f64 {
        self.turned(point).1
    }

    /// The mean over all places of how many stones take the area of one of size 1.
    pub(crate) fn density(&self) -> f64 {
        let stones = self
            .samples
            .iter()
            .map(|sample| 1.0 / (sample.1 * sample.1));
        stones.sum::<f64>() / self.samples.len() as f64
    }

    /// The smallest size factor anywhere.
    pub(crate) fn least(&self) -> f64 {
        self.samples
            .iter()
            .map(|sample| sample.1)
            .fold(f64::INFINITY, f64::min)
    }

    /// The largest size factor anywhere.
    pub(crate) fn largest(&self) -> f64 {
        self.samples
            .iter()
            .map(|sample| sample.1)
            .fold(0.0, f64::max)
    }
}

/// Of the directions that are as good as `direction` the one nearest to `frame`.
pub(crate) fn nearest_turn(direction: DVec2, frame: DVec2, symmetry: u32) -> DVec2 {
    let turn = DVec2::new(frame.dot(direction), frame.perp_dot(direction));
    match symmetry {
        2 if turn.x < 0.0 => -direction,
        2 => direction,
        4 if turn.x.abs() >= turn.y.abs() => direction * turn.x.signum(),
        4 => -direction.perp() * turn.y.signum(),
        _ => {
            let turned = power(turn.normalize_or(DVec2::X), symmetry);
            frame.rotate(unturned(turned, symmetry))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_turn_means_the_same_and_is_near() {
        let turned = |by: f64| DVec2::new(libm::cos(by), libm::sin(by));
        for symmetry in [2, 4, 6] {
            let part = std::f64::consts::TAU / f64::from(symmetry);
            for at in 0..100 {
                let direction = turned(0.37 * f64::from(at));
                let frame = turned(0.83 * f64::from(at));
                let found = nearest_turn(direction, frame, symmetry);
                assert!(frame.angle_to(found).abs() <= 0.5 * part + 1e-9);
                let turns = direction.angle_to(found) / part;
                assert!((turns - turns.round()).abs() < 1e-9, "{symmetry}: {turns}");
            }
        }
    }
}
