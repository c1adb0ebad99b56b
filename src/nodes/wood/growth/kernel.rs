//! Growth time and the share of the branches in it, for columns of positions.
//!
//! A block is worked off in runs of samples. For each run the branches whose influence is exactly 0 on
//! all its samples are left out; the others are added in the order of the skeleton. So a sample's bits
//! depend neither on its neighbours nor on where blocks begin.

use super::branches::{self, BranchConstants, ScaledSums};
use super::clock::Clock;
use super::line::TrunkLine;
use super::near::{Bounds, NearBranches};
use super::power::Power;
use super::straight_columns::StraightTimes;
use super::trunk::{TrunkTable, trunk_times};
use super::{GrowthModel, Reach};
use crate::field::{Block, Kernel};
use crate::key::KeyHasher;
use crate::nodes::wood::{growth_field, straight_growth_field};
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use glam::Vec3;
use std::fmt;

/// Samples in a run: they stay in the fastest cache, and few branches are near all of them.
pub(in crate::nodes::wood) const RUN: usize = 128;

/// From the position (x, y, z) in mm to T in years and the share of the branches in it.
pub struct GrowthKernel {
    model: GrowthModel,
    trunk: TrunkColumns,
    branches: Vec<BranchConstants>,
    near: NearBranches,
    power: Power,
}

impl GrowthKernel {
    /// Lays the model out for columns.
    pub fn new(model: GrowthModel) -> GrowthKernel {
        let constants = |branch| BranchConstants::new(branch, &model.settings);
        GrowthKernel {
            trunk: TrunkColumns::new(&model),
            branches: model.branches.iter().map(constants).collect(),
            near: NearBranches::new(&model),
            power: Power::new(model.settings.sharpness),
            model,
        }
    }
}

impl fmt::Debug for GrowthKernel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("GrowthKernel")
            .field("settings", &self.model.settings)
            .field("trunk", &self.model.trunk)
            .field("branches", &self.branches.len())
            .finish_non_exhaustive()
    }
}

impl Kernel for GrowthKernel {
    fn add_to_key(&self, key: &mut KeyHasher) {
        let GrowthModel {
            trunk,
            branches,
            settings,
            rings,
        } = &self.model;
        let (name, version) = match trunk {
            TrunkLine::Curved(_) => ("growth", growth_field::KIND.version),
            TrunkLine::Straight(_) => ("straight_growth", straight_growth_field::KIND.version),
        };
        key.text(name)
            .whole(i64::from(version))
            .whole(branches.len() as i64);
        let mut numbers = |numbers: &[f64]| {
            numbers.iter().for_each(|number| {
                key.number(*number);
            });
        };
        numbers(&[settings.elongation, settings.thickening, settings.sharpness]);
        let reach = settings.reach.unwrap_or(Reach {
            along: 0.0,
            across: 0.0,
        });
        numbers(&[reach.along, reach.across]);
        match trunk {
            TrunkLine::Curved(curve) => {
                for piece in curve.pieces() {
                    numbers(&[piece.start]);
                    piece
                        .coefficients
                        .iter()
                        .for_each(|coefficient| numbers(&coefficient.to_array()));
                }
            }
            TrunkLine::Straight(trunk) => {
                trunk
                    .nodes()
                    .iter()
                    .for_each(|node| numbers(&node.to_array()));
            }
        }
        for branch in branches {
            numbers(&branch.start.to_array());
            numbers(&branch.direction.to_array());
            numbers(&[branch.start_time, branch.thickening]);
        }
        if let Some(rings) = rings {
            numbers(&rings.areas);
            numbers(&rings.heights);
            key.text("rings").whole(rings.years() as i64);
        }
    }

    fn width(&self) -> usize {
        2
    }

    fn nanoseconds(&self) -> f32 {
        // With a reach, few of many branches are near a sample.
        let most = if self.model.settings.reach.is_some() {
            8
        } else {
            1000
        };
        self.trunk.nanoseconds() + self.branches.len().min(most) as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [x, y, z] = [0, 1, 2].map(|column| block.inputs[column].values);
        let (times, shares) = block.outputs.split_at_mut(1);
        let (times, shares) = (&mut times[0][..], &mut shares[0][..]);
        dispatch!(block.level, simd => evaluate_block(simd, self, [x, y, z], times, shares));
    }
}

#[simd]
fn evaluate_block<S: Simd>(
    simd: S,
    kernel: &GrowthKernel,
    [x, y, z]: [&[f32]; 3],
    times: &mut [f32],
    shares: &mut [f32],
) {
    let mut near = Vec::new();
    let runs = times.chunks_mut(RUN).zip(shares.chunks_mut(RUN));
    let positions = x.chunks(RUN).zip(y.chunks(RUN)).zip(z.chunks(RUN));
    for (((x, y), z), (times, shares)) in positions.zip(runs) {
        let position = [x, y, z];
        let bounds = bounds(simd, position);
        kernel.near.find(&bounds, &mut near);
        kernel.trunk.write_times(simd, position, times);
        shares.fill(0.0);
        let run = Run {
            kernel,
            near: &near,
            position,
        };
        let below_ground = run.below_ground(&bounds).then(|| run.least(simd, times));
        match (kernel.power, kernel.model.settings.reach.is_some()) {
            _ if near.is_empty() => {}
            (Power::Square, true) => run.blend_squares::<S, true>(simd, times, shares),
            (Power::Square, false) => run.blend_squares::<S, false>(simd, times, shares),
            (_, true) => run.blend_powers::<S, true>(simd, times, shares),
            (_, false) => run.blend_powers::<S, false>(simd, times, shares),
        }
        if let Some(least) = below_ground {
            least.replace(times, shares);
        }
    }
}

/// The trunk, laid out for columns.
enum TrunkColumns {
    Curved(TrunkTable),
    Straight(StraightTimes),
}

impl TrunkColumns {
    fn new(model: &GrowthModel) -> TrunkColumns {
        match &model.trunk {
            TrunkLine::Curved(curve) => {
                TrunkColumns::Curved(TrunkTable::new(curve, Clock::new(model)))
            }
            TrunkLine::Straight(trunk) => {
                TrunkColumns::Straight(StraightTimes::new(trunk, Clock::new(model)))
            }
        }
    }

    fn nanoseconds(&self) -> f32 {
        match self {
            TrunkColumns::Curved(table) => table.nanoseconds(),
            TrunkColumns::Straight(times) => times.nanoseconds(),
        }
    }

    /// Writes T_1 in years.
    #[simd]
    fn write_times<S: Simd>(&self, simd: S, position: [&[f32]; 3], times: &mut [f32]) {
        match self {
            TrunkColumns::Curved(table) => trunk_times(simd, table, position, times),
            TrunkColumns::Straight(straight) => straight.write_times(simd, position, times),
        }
    }
}

/// The smallest and largest coordinates.
#[inline(always)]
fn bounds<S: Simd>(simd: S, [x, y, z]: [&[f32]; 3]) -> Bounds {
    let ends = [ends(simd, x), ends(simd, y), ends(simd, z)];
    Bounds {
        low: Vec3::new(ends[0][0], ends[1][0], ends[2][0]),
        high: Vec3::new(ends[0][1], ends[1][1], ends[2][1]),
    }
}

#[inline(always)]
fn ends<S: Simd>(simd: S, column: &[f32]) -> [f32; 2] {
    let mut low = S::f32s::splat(simd, column[0]);
    let mut high = low;
    for values in column.chunks_exact(S::f32s::LEN) {
        let values = S::f32s::from_slice(simd, values);
        low = low.min_precise(values);
        high = high.max_precise(values);
    }
    [low.reduce_min_precise(), high.reduce_max_precise()]
}

/// Samples with the branches near them.
struct Run<'a> {
    kernel: &'a GrowthKernel,
    near: &'a [u32],
    position: [&'a [f32]; 3],
}

impl Run<'_> {
    fn near(&self) -> impl Iterator<Item = &BranchConstants> {
        self.near
            .iter()
            .map(|index| &self.kernel.branches[*index as usize])
    }

    /// Whether a time may be 0 or less.
    fn below_ground(&self, bounds: &Bounds) -> bool {
        bounds.low.z <= 0.0 || self.near().any(|branch| branch.starts_below_ground)
    }

    #[simd]
    fn blend_squares<S: Simd, const REACH: bool>(
        &self,
        simd: S,
        times: &mut [f32],
        shares: &mut [f32],
    ) {
        for branch in self.near() {
            branches::add_squares::<S, REACH>(simd, branch, self.position, times, shares);
        }
        branches::finish_squares(simd, times, shares);
    }

    #[simd]
    fn blend_powers<S: Simd, const REACH: bool>(
        &self,
        simd: S,
        times: &mut [f32],
        shares: &mut [f32],
    ) {
        let length = times.len();
        let (mut largest, mut of_trunk) = ([1.0; RUN], [1.0; RUN]);
        let mut sums = ScaledSums {
            largest: &mut largest[..length],
            of_trunk: &mut of_trunk[..length],
            of_branches: shares,
        };
        let power = self.kernel.power;
        for branch in self.near() {
            branches::add_powers::<S, REACH>(simd, branch, power, self.position, times, &mut sums);
        }
        branches::finish_powers(simd, power, times, &mut sums);
    }

    /// The smallest of all times of each sample, given T_1.
    #[simd]
    fn least<S: Simd>(&self, simd: S, trunk: &[f32]) -> Least {
        let mut least = Least {
            times: [f32::INFINITY; RUN],
            of_branch: [0.0; RUN],
        };
        let length = trunk.len();
        least.times[..length].copy_from_slice(trunk);
        let reach = self.kernel.model.settings.reach.is_some();
        for branch in self.near() {
            let (times, of_branch) = (&mut least.times[..length], &mut least.of_branch[..length]);
            if reach {
                branches::take_least::<S, true>(simd, branch, self.position, times, of_branch);
            } else {
                branches::take_least::<S, false>(simd, branch, self.position, times, of_branch);
            }
        }
        least
    }
}

/// The smallest times of a run, and whether they are a branch's.
struct Least {
    times: [f32; RUN],
    of_branch: [f32; RUN],
}

impl Least {
    /// Puts the smallest time where it is 0 or less: there nothing can be blended.
    fn replace(&self, times: &mut [f32], shares: &mut [f32]) {
        let least = self.times.iter().zip(&self.of_branch);
        for ((time, share), (least, of_branch)) in times.iter_mut().zip(shares).zip(least) {
            if *least <= 0.0 {
                (*time, *share) = (*least, *of_branch);
            }
        }
    }
}
