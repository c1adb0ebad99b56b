//! The bed of stones: what fields say of settlement and wear at each cell.

use crate::node::{Build, Failure, Inputs};
use crate::value::Partition;
use glam::DVec2;

/// What fields say of the ground at each cell.
pub(super) struct Bed {
    /// Settlement in the middle and a quarter of the cell's size right, above, left and below of it.
    pub(super) settled: Vec<f32>,
    pub(super) quarters: Vec<f64>,
    pub(super) wear: Vec<f32>,
}

/// What fields say of the ground at one cell.
pub(super) struct At {
    pub(super) settled: f64,
    pub(super) slope: DVec2,
    pub(super) wear: f64,
}

impl Bed {
    pub(super) fn sample(
        inputs: &Inputs<'_>,
        build: &Build<'_>,
        partition: &Partition,
    ) -> Result<Bed, Failure> {
        let quarters: Vec<f64> = partition
            .areas
            .iter()
            .map(|area| 0.25 * area.abs().sqrt().max(1e-6))
            .collect();
        let around = partition
            .centres
            .iter()
            .zip(&quarters)
            .flat_map(|(centre, quarter)| {
                [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y]
                    .map(|way| *centre + way * *quarter)
            });
        let mut settled = inputs.sample("settle", build, &around.collect::<Vec<_>>())?;
        let mut wear = inputs.sample("wear", build, &partition.centres)?;
        Ok(Bed {
            settled: settled.swap_remove(0),
            quarters,
            wear: wear.swap_remove(0),
        })
    }

    pub(super) fn of_cell(&self, cell: usize) -> At {
        let [middle, right, above, left, below] =
            [0, 1, 2, 3, 4].map(|index| f64::from(self.settled[5 * cell + index]));
        At {
            settled: middle,
            slope: DVec2::new(right - left, above - below) / (2.0 * self.quarters[cell]),
            wear: f64::from(self.wear[cell]).clamp(0.0, 1.0),
        }
    }
}
