//! The influence of one branch on the growth times of a run of samples.

use super::power::{Power, inverse_root, raise};
use super::{GrowingBranch, GrowthSettings};
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use glam::DVec3;
use std::ops::Range;

/// Nearer to the plane through its start than this, in mm, a branch has no influence: there T_2 is
/// beyond all others, and the quotients below would leave the range of numbers.
const LEAST_ALONG: f32 = 1e-9;

/// A branch, as the kernel needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct BranchConstants {
    /// The start as a sum of two: near it positions keep all their digits.
    start: [[f32; 3]; 2],
    direction: [f32; 3],
    /// v_b.
    speed: f32,
    /// v_b T_alpha.
    speed_time: f32,
    /// v_b / v_e.
    speed_ratio: f32,
    /// The reach along and across.
    reach: [f32; 2],
    inverse_half_reach: [f32; 2],
    /// Where along and across the fade is 0 whatever the rounding.
    surely_beyond: [f32; 2],
    pub(super) starts_below_ground: bool,
}

impl BranchConstants {
    pub(super) fn new(branch: &GrowingBranch, settings: &GrowthSettings) -> BranchConstants {
        let coarse = branch.start.as_vec3();
        let rest = branch.start - DVec3::from(coarse);
        let reach = settings
            .reach
            .map_or([1.0; 2], |reach| [reach.along, reach.across]);
        BranchConstants {
            start: [coarse.to_array(), rest.as_vec3().to_array()],
            direction: branch.direction.as_vec3().to_array(),
            speed: branch.thickening as f32,
            speed_time: (branch.thickening * branch.start_time) as f32,
            speed_ratio: (branch.thickening / settings.elongation) as f32,
            reach: reach.map(|reach| reach as f32),
            inverse_half_reach: reach.map(|reach| (2.0 / reach) as f32),
            surely_beyond: reach.map(|reach| (1.00001 * reach) as f32),
            starts_below_ground: branch.start_time < 0.0,
        }
    }
}

/// Where samples are, seen from a branch.
struct Seen<F> {
    /// Distance along the axis.
    along: F,
    /// Square of the distance from the axis.
    across2: F,
}

#[inline(always)]
fn see<S: Simd>(simd: S, branch: &BranchConstants, [x, y, z]: [&[f32]; 3]) -> Seen<S::f32s> {
    let [coarse, rest] = branch.start;
    let x = S::f32s::from_slice(simd, x) - coarse[0] - rest[0];
    let y = S::f32s::from_slice(simd, y) - coarse[1] - rest[1];
    let z = S::f32s::from_slice(simd, z) - coarse[2] - rest[2];
    let [ux, uy, uz] = branch.direction;
    let along = x * ux + y * uy + z * uz;
    // The foot's distance is taken from a difference: |w|^2 - s^2 would lose it near the axis.
    let (fx, fy, fz) = (x - along * ux, y - along * uy, z - along * uz);
    Seen {
        along,
        across2: fx * fx + fy * fy + fz * fz,
    }
}

/// Whether all samples are behind the start or beyond the reach: saves the rest of the work.
#[inline(always)]
fn none_reached<S: Simd, const REACH: bool>(
    branch: &BranchConstants,
    seen: &Seen<S::f32s>,
) -> bool {
    let mut reached = seen.along.simd_gt(LEAST_ALONG);
    if REACH {
        let [along, across] = branch.surely_beyond;
        reached &= seen.along.simd_lt(along) & seen.across2.simd_lt(across * across);
    }
    reached.all_false()
}

/// `[scale, time]` in mm^2/year and mm^2, whose quotient `time / scale` is T_2.
#[inline(always)]
fn scale_and_time<S: Simd>(branch: &BranchConstants, seen: &Seen<S::f32s>) -> [S::f32s; 2] {
    let (along, across2) = (seen.along, seen.across2);
    let across_by_cosine = (across2 * (across2 + along * along)).sqrt();
    let time = along * (along * branch.speed_ratio + branch.speed_time) + across_by_cosine;
    [along * branch.speed, time]
}

/// What the reach leaves of the influence.
#[inline(always)]
fn fade<S: Simd>(branch: &BranchConstants, seen: &Seen<S::f32s>) -> S::f32s {
    let ([along, across], [by_along, by_across]) = (branch.reach, branch.inverse_half_reach);
    fade_along::<S>(seen.along, along, by_along)
        * fade_along::<S>(seen.across2.sqrt(), across, by_across)
}

/// Smoothstep from 1 at half of a reach to 0 at the reach; counted from there, it is precise there.
#[inline(always)]
fn fade_along<S: Simd>(distance: S::f32s, reach: f32, inverse_half: f32) -> S::f32s {
    let left = ((distance - reach) * -inverse_half).max(0.0).min(1.0);
    left * left * (left * -2.0 + 3.0)
}

/// `f T_1 / T_2`; 0 where there is no influence.
#[inline(always)]
fn ratio<S: Simd, const REACH: bool>(
    simd: S,
    branch: &BranchConstants,
    seen: &Seen<S::f32s>,
    trunk: S::f32s,
) -> S::f32s {
    let [scale, time] = scale_and_time::<S>(branch, seen);
    let mut ratio = trunk * scale / time;
    let mut active = seen.along.simd_gt(LEAST_ALONG);
    if REACH {
        let fade = fade::<S>(branch, seen);
        active &= fade.simd_gt(0.0);
        ratio *= fade;
    }
    active.select(ratio, S::f32s::splat(simd, 0.0))
}

/// Adds `(f T_1 / T_2)^2` to the sums.
#[simd]
pub(super) fn add_squares<S: Simd, const REACH: bool>(
    simd: S,
    branch: &BranchConstants,
    [x, y, z]: [&[f32]; 3],
    trunk: &[f32],
    sums: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let columns = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    let results = trunk.chunks_exact(lanes).zip(sums.chunks_exact_mut(lanes));
    for (((x, y), z), (trunk, sums)) in columns.zip(results) {
        let seen = see(simd, branch, [x, y, z]);
        if none_reached::<S, REACH>(branch, &seen) {
            continue;
        }
        let trunk = S::f32s::from_slice(simd, trunk);
        let ratio = ratio::<S, REACH>(simd, branch, &seen, trunk);
        (S::f32s::from_slice(simd, sums) + ratio * ratio).store_slice(sums);
    }
}

/// From T_1 and `S = sum (f_i T_1 / T_i)^2` to `T = T_1 / sqrt(1 + S)` and `S / (1 + S)`.
#[simd]
pub(super) fn finish_squares<S: Simd>(simd: S, times: &mut [f32], sums: &mut [f32]) {
    let lanes = S::f32s::LEN;
    for (times, sums) in times
        .chunks_exact_mut(lanes)
        .zip(sums.chunks_exact_mut(lanes))
    {
        let sum = S::f32s::from_slice(simd, sums);
        let of_trunk = S::f32s::splat(simd, 1.0) / (sum + 1.0);
        (S::f32s::from_slice(simd, times) * of_trunk.sqrt()).store_slice(times);
        (sum * of_trunk).store_slice(sums);
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, column: &[f32], here: &Range<usize>) -> S::f32s {
    S::f32s::from_slice(simd, &column[here.clone()])
}

/// Sums of powers of ratios, scaled by the largest ratio so far so that none overflows.
pub(super) struct ScaledSums<'a> {
    /// The largest f_i T_1 / T_i, that of the trunk being 1.
    pub(super) largest: &'a mut [f32],
    /// `largest^-k`: the trunk's part.
    pub(super) of_trunk: &'a mut [f32],
    /// `sum (f_i T_1 / T_i / largest)^k`.
    pub(super) of_branches: &'a mut [f32],
}

/// Adds `(f T_1 / T_2)^k` to the scaled sums.
#[simd]
pub(super) fn add_powers<S: Simd, const REACH: bool>(
    simd: S,
    branch: &BranchConstants,
    power: Power,
    [x, y, z]: [&[f32]; 3],
    trunk: &[f32],
    sums: &mut ScaledSums<'_>,
) {
    let lanes = S::f32s::LEN;
    for start in (0..trunk.len()).step_by(lanes) {
        let here = start..start + lanes;
        let seen = see(
            simd,
            branch,
            [&x[here.clone()], &y[here.clone()], &z[here.clone()]],
        );
        if none_reached::<S, REACH>(branch, &seen) {
            continue;
        }
        let trunk = load(simd, trunk, &here);
        let ratio = ratio::<S, REACH>(simd, branch, &seen, trunk);
        let before = load(simd, sums.largest, &here);
        let largest = before.max(ratio);
        let raised = raise(simd, before.min(ratio) / largest, power);
        let of_trunk = load(simd, sums.of_trunk, &here);
        let of_branches = load(simd, sums.of_branches, &here);
        let leads = ratio.simd_gt(before);
        let of_branches = leads.select(of_branches * raised + 1.0, of_branches + raised);
        largest.store_slice(&mut sums.largest[here.clone()]);
        leads
            .select(of_trunk * raised, of_trunk)
            .store_slice(&mut sums.of_trunk[here.clone()]);
        of_branches.store_slice(&mut sums.of_branches[here]);
    }
}

/// From T_1 and the scaled sums to T and the share of the branches, which replaces their sum.
#[simd]
pub(super) fn finish_powers<S: Simd>(
    simd: S,
    power: Power,
    times: &mut [f32],
    sums: &mut ScaledSums<'_>,
) {
    let lanes = S::f32s::LEN;
    for start in (0..times.len()).step_by(lanes) {
        let here = start..start + lanes;
        let of_branches = load(simd, sums.of_branches, &here);
        let sum = load(simd, sums.of_trunk, &here) + of_branches;
        let shortest = load(simd, times, &here) / load(simd, sums.largest, &here);
        let time = shortest * inverse_root(simd, sum, power);
        time.store_slice(&mut times[here.clone()]);
        (of_branches / sum).store_slice(&mut sums.of_branches[here]);
    }
}

/// Lowers `least` to T_2 where the branch has influence, and notes there that it is a branch's.
#[simd]
pub(super) fn take_least<S: Simd, const REACH: bool>(
    simd: S,
    branch: &BranchConstants,
    [x, y, z]: [&[f32]; 3],
    least: &mut [f32],
    of_branch: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    for start in (0..least.len()).step_by(lanes) {
        let here = start..start + lanes;
        let seen = see(
            simd,
            branch,
            [&x[here.clone()], &y[here.clone()], &z[here.clone()]],
        );
        let mut active = seen.along.simd_gt(LEAST_ALONG);
        if REACH {
            active &= fade::<S>(branch, &seen).simd_gt(0.0);
        }
        let [scale, time] = scale_and_time::<S>(branch, &seen);
        let (before, time) = (load(simd, least, &here), time / scale);
        let earlier = active & time.simd_lt(before);
        earlier
            .select(time, before)
            .store_slice(&mut least[here.clone()]);
        let share = load(simd, of_branch, &here);
        earlier
            .select(S::f32s::splat(simd, 1.0), share)
            .store_slice(&mut of_branch[here]);
    }
}
