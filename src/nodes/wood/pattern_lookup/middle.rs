//! Middles of spans of growth time, folded into a pattern's table, and the widths of their boxes.
//!
//! Folding is done in f64, so a texel is hit as well at year 100 as at year 0. From there on whole pieces
//! and what is left of them are kept apart: both are exact in f32.

use super::span::BLOCK;
use super::table::Table;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// Spans shorter than this part of a piece are points.
const POINT: f32 = 1e-5;

/// Half of the widest span, in pieces: tens of periods even of the longest table.
const WIDEST: f32 = (1 << 20) as f32;

/// Further beyond its ends, in pieces, no span reaches a table that does not repeat.
const BEYOND: f64 = (1 << 21) as f64;

/// Largest number of tables between time 0 and a sample: no f32 has a fraction there any more.
const FARTHEST: f64 = 1e9;

/// Smaller spread, as a share of the larger one, from which on two boxes are used.
const SKEWED: f32 = 0.2;

/// Distance of the Gauss points from the middle of a box of width 1.
const GAUSS: f32 = 0.288_675_13;

/// Middles of spans, in pieces.
pub(super) struct Middles {
    /// Start of the piece.
    piece: [f32; BLOCK],
    along: [f32; BLOCK],
    /// Half the width of a box; 0 for points.
    half: [f32; BLOCK],
    /// Distance of the boxes from the middle.
    apart: [f32; BLOCK],
}

impl Middles {
    /// Middles that are nowhere yet.
    pub(super) fn new() -> Middles {
        let none = [0.0; BLOCK];
        Middles {
            piece: none,
            along: none,
            half: none,
            apart: none,
        }
    }

    /// Finds the widths of the boxes and how far they are apart; gives how many boxes are needed.
    #[simd]
    pub(super) fn widths<S: Simd>(
        &mut self,
        simd: S,
        table: &Table,
        count: usize,
        [across, along]: [&[f32]; 2],
    ) -> usize {
        let (pieces_per_year, lanes) = (table.pieces_per_year as f32, S::f32s::LEN);
        let zero = S::f32s::splat(simd, 0.0);
        let [mut any_wide, mut any_skewed] = [zero.simd_gt(0.0); 2];
        for at in (0..count).step_by(lanes) {
            let across = S::f32s::from_slice(simd, &across[at..at + lanes]).abs();
            let along = S::f32s::from_slice(simd, &along[at..at + lanes]).abs();
            let order = across.simd_gt(along);
            let (large, small) = (order.select(across, along), order.select(along, across));
            let is_skewed = small.simd_gt(large * SKEWED);
            let both = (across * across + along * along).sqrt();
            let width = is_skewed.select(large, both);
            let half = bounded::<S>(simd, width * (0.5 * pieces_per_year));
            let is_wide = half.simd_ge(0.5 * POINT);
            let is_skewed = is_skewed & is_wide;
            let apart = bounded::<S>(simd, small * (GAUSS * pieces_per_year));
            is_wide
                .select(half, zero)
                .store_slice(&mut self.half[at..at + lanes]);
            is_skewed
                .select(apart, zero)
                .store_slice(&mut self.apart[at..at + lanes]);
            any_wide |= is_wide;
            any_skewed |= is_skewed;
        }
        usize::from(any_wide.any_true()) + usize::from(any_skewed.any_true())
    }

    /// Finds the pieces in which the middles are.
    #[simd]
    pub(super) fn fold<S: Simd, const REPEATS: bool>(
        &mut self,
        simd: S,
        table: &Table,
        times: &[f32],
    ) {
        let lanes = S::f32s::LEN;
        for at in (0..times.len()).step_by(lanes) {
            let (low, high) = S::f32s::from_slice(simd, &times[at..at + lanes]).widen();
            let (low, low_along) = piece_at::<S, REPEATS>(simd, table, low);
            let (high, high_along) = piece_at::<S, REPEATS>(simd, table, high);
            let (piece, along) = (low.narrow(high), low_along.narrow(high_along));
            piece.store_slice(&mut self.piece[at..at + lanes]);
            along.store_slice(&mut self.along[at..at + lanes]);
        }
    }
}

/// A vector of middles.
pub(super) struct Middle<S: Simd> {
    pub(super) piece: S::f32s,
    pub(super) along: S::f32s,
    pub(super) half: S::f32s,
    pub(super) apart: S::f32s,
    pub(super) is_point: S::mask32s,
}

impl<S: Simd> Middle<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, middles: &Middles, at: usize) -> Middle<S> {
        let range = at..at + S::f32s::LEN;
        let half = S::f32s::from_slice(simd, &middles.half[range.clone()]);
        Middle {
            piece: S::f32s::from_slice(simd, &middles.piece[range.clone()]),
            along: S::f32s::from_slice(simd, &middles.along[range.clone()]),
            half,
            apart: S::f32s::from_slice(simd, &middles.apart[range]),
            is_point: half.simd_eq(0.0),
        }
    }
}

/// At most the widest; that as well for NaN.
#[inline(always)]
fn bounded<S: Simd>(simd: S, width: S::f32s) -> S::f32s {
    width
        .simd_lt(WIDEST)
        .select(width, S::f32s::splat(simd, WIDEST))
}

/// The piece that holds a time, and the distance from its start. NaN is the earliest time.
#[inline(always)]
fn piece_at<S: Simd, const REPEATS: bool>(
    simd: S,
    table: &Table,
    time: S::f64s,
) -> (S::f64s, S::f64s) {
    let (years, count) = (table.years, f64::from(table.count));
    let farthest = S::f64s::splat(simd, FARTHEST * years);
    let time = time.simd_gt(-farthest).select(time, -farthest);
    let time = time.simd_lt(farthest).select(time, farthest);
    let place = if REPEATS {
        (time - periods::<S>(simd, table, time) * years) * table.pieces_per_year
    } else {
        let place = time * table.pieces_per_year;
        let place = time.simd_ge(years).select(place.max(count), place);
        place.max(-BEYOND).min(count + BEYOND)
    };
    let whole = floor_wide::<S>(place);
    (whole, place - whole)
}

/// Number of whole tables before a time.
#[inline(always)]
fn periods<S: Simd>(simd: S, table: &Table, time: S::f64s) -> S::f64s {
    // The product may be rounded across a whole number: year 47 of 47 years.
    let (near, years) = (floor_wide::<S>(time * table.frequency), table.years);
    let (none, one) = (S::f64s::splat(simd, 0.0), S::f64s::splat(simd, 1.0));
    let near = near + time.simd_ge((near + 1.0) * years).select(one, none);
    near - time.simd_lt(near * years).select(one, none)
}

/// The largest whole number up to `x`, for |x| < 2^51: instructions that every machine has.
#[inline(always)]
fn floor_wide<S: Simd>(x: S::f64s) -> S::f64s {
    // 1.5 * 2^52 leaves no room for a fraction.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let nearest = (x + ROUND) - ROUND;
    nearest.simd_gt(x).select(nearest - 1.0, nearest)
}
