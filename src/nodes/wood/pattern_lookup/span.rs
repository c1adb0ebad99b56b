//! Spans of growth time as spans of a pattern's table, a block of samples at once.
//!
//! The middle of a span is folded into the table in f64, so a texel is hit as well at year 100 as at
//! year 0. From there on whole pieces and what is left of them are kept apart: both are exact in f32.

use super::table::Table;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// Samples that are looked up together.
pub(super) const BLOCK: usize = 64;

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

/// Where spans of growth time start and end in the table.
///
/// The times in a square are those of a box as wide as the larger spread, blurred by a box as wide as the
/// smaller one. Where the smaller one counts, it is integrated at its two Gauss points (exact up to cubics);
/// elsewhere one box of the same variance does.
pub(super) struct Spans {
    /// Boxes whose means stand for the mean over a sample; 0 if all samples are points.
    pub(super) boxes: usize,
    /// Start and end of the first box, then of the second.
    pub(super) ends: [Ends; 4],
    /// Whole periods between starts and ends.
    pub(super) periods: [f64; BLOCK],
    /// One over the width of all boxes, in pieces; 0 for a point, which is at the start of the first box.
    pub(super) scale: [f64; BLOCK],
    /// Share of the span inside the pattern.
    pub(super) inside: [f32; BLOCK],
    middles: Middles,
}

/// Places in the table.
pub(super) struct Ends {
    /// Number of the piece; 0 is the one before the start of the table.
    pub(super) piece: [i32; BLOCK],
    /// Distance from the start of the piece, in pieces.
    pub(super) along: [f64; BLOCK],
}

/// Middles of spans, in pieces.
struct Middles {
    /// Start of the piece.
    piece: [f32; BLOCK],
    along: [f32; BLOCK],
    /// Half the width of a box; 0 for points.
    half: [f32; BLOCK],
    /// Distance of the boxes from the middle.
    apart: [f32; BLOCK],
}

impl Spans {
    /// Spans that are nowhere yet.
    pub(super) fn new() -> Spans {
        let (none, zeros) = ([0.0; BLOCK], [0.0; BLOCK]);
        let ends = || Ends {
            piece: [0; BLOCK],
            along: zeros,
        };
        Spans {
            boxes: 0,
            ends: [ends(), ends(), ends(), ends()],
            periods: zeros,
            scale: zeros,
            inside: none,
            middles: Middles {
                piece: none,
                along: none,
                half: none,
                apart: none,
            },
        }
    }

    /// The starts and ends that are in use.
    pub(super) fn used_ends(&self) -> &[Ends] {
        &self.ends[..(2 * self.boxes).max(1)]
    }

    /// Finds the spans of up to [`BLOCK`] times with these spreads.
    #[simd]
    pub(super) fn place<S: Simd>(
        &mut self,
        simd: S,
        table: &Table,
        times: &[f32],
        spread: [&[f32]; 2],
    ) {
        self.boxes = self.middles.widths(simd, table, times.len(), spread);
        if table.repeats {
            self.middles.fold::<S, true>(simd, table, times);
            self.place_ends::<S, true>(simd, table, times.len());
        } else {
            self.middles.fold::<S, false>(simd, table, times);
            self.place_ends::<S, false>(simd, table, times.len());
        }
    }

    #[simd]
    fn place_ends<S: Simd, const REPEATS: bool>(&mut self, simd: S, table: &Table, count: usize) {
        let [low, high, second_low, second_high] = &mut self.ends;
        for at in (0..count).step_by(S::f32s::LEN) {
            let middle = Middle::new(simd, &self.middles, at);
            let first = [&mut *low, &mut *high];
            let mut spans = place_box::<S, REPEATS>(simd, table, &middle, -middle.apart, at, first);
            if self.boxes == 2 {
                let second = [&mut *second_low, &mut *second_high];
                let other = place_box::<S, REPEATS>(simd, table, &middle, middle.apart, at, second);
                spans.width += other.width;
                spans.periods += other.periods;
                spans.inside = (spans.inside + other.inside) * 0.5;
            }
            let scale = S::f32s::splat(simd, 1.0) / spans.width;
            let scale = middle.is_point.select(S::f32s::splat(simd, 0.0), scale);
            store_wide(simd, scale, &mut self.scale[at..]);
            store_wide(simd, spans.periods, &mut self.periods[at..]);
            spans
                .inside
                .store_slice(&mut self.inside[at..at + S::f32s::LEN]);
        }
    }
}

/// A vector of middles.
struct Middle<S: Simd> {
    piece: S::f32s,
    along: S::f32s,
    half: S::f32s,
    apart: S::f32s,
    is_point: S::mask32s,
}

impl<S: Simd> Middle<S> {
    #[inline(always)]
    fn new(simd: S, middles: &Middles, at: usize) -> Middle<S> {
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

/// A vector of boxes.
struct Box<S: Simd> {
    width: S::f32s,
    periods: S::f32s,
    inside: S::f32s,
}

/// An end of a vector of boxes: the piece as if the table went on, and the distance from its start.
struct End<S: Simd> {
    piece: S::f32s,
    along: S::f32s,
}

#[inline(always)]
fn place_box<S: Simd, const REPEATS: bool>(
    simd: S,
    table: &Table,
    middle: &Middle<S>,
    apart: S::f32s,
    at: usize,
    [low, high]: [&mut Ends; 2],
) -> Box<S> {
    let centre = middle.along + apart;
    let (start, end) = (centre - middle.half, centre + middle.half);
    let width = end - start;
    let (start, end) = (End::<S>::new(middle, start), End::<S>::new(middle, end));
    if REPEATS {
        let before = low.fold(simd, table, &start, middle, at);
        let after = high.fold(simd, table, &end, middle, at);
        return Box {
            width,
            periods: after - before,
            inside: S::f32s::splat(simd, 1.0),
        };
    }
    low.cut(simd, table, &start, at);
    high.cut(simd, table, &end, at);
    Box {
        width,
        periods: S::f32s::splat(simd, 0.0),
        inside: inside(simd, table, middle, [&start, &end], width),
    }
}

impl<S: Simd> End<S> {
    #[inline(always)]
    fn new(middle: &Middle<S>, place: S::f32s) -> End<S> {
        let whole = floor::<S>(place);
        End {
            piece: middle.piece + whole,
            along: place - whole,
        }
    }
}

impl Ends {
    /// Stores ends in a table that repeats; gives the number of whole periods before them.
    #[inline(always)]
    fn fold<S: Simd>(
        &mut self,
        simd: S,
        table: &Table,
        end: &End<S>,
        middle: &Middle<S>,
        at: usize,
    ) -> S::f32s {
        // Half a piece from both borders, so that rounding cannot matter.
        let periods = floor::<S>((end.piece + 0.5) * (1.0 / table.count));
        // A point that rounding has put at the end of the table stays there.
        let periods = middle.is_point.select(S::f32s::splat(simd, 0.0), periods);
        self.store(simd, end.piece - periods * table.count, end.along, at);
        periods
    }

    /// Stores ends in a table that does not repeat.
    #[inline(always)]
    fn cut<S: Simd>(&mut self, simd: S, table: &Table, end: &End<S>, at: usize) {
        let piece = end.piece.max(-1.0).min(table.count);
        self.store(simd, piece, end.along, at);
        let (low, high) = (end.piece - piece).widen();
        let half = S::f64s::LEN;
        let along = &mut self.along[at..at + 2 * half];
        (S::f64s::from_slice(simd, &along[..half]) + low).store_slice(&mut along[..half]);
        (S::f64s::from_slice(simd, &along[half..]) + high).store_slice(&mut along[half..]);
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, simd: S, piece: S::f32s, along: S::f32s, at: usize) {
        let number = (piece + 1.0).to_int::<S::i32s>();
        number.store_slice(&mut self.piece[at..at + S::f32s::LEN]);
        store_wide(simd, along, &mut self.along[at..]);
    }
}

/// The share of boxes that lies before the end of the table.
#[inline(always)]
fn inside<S: Simd>(
    simd: S,
    table: &Table,
    middle: &Middle<S>,
    [start, end]: [&End<S>; 2],
    width: S::f32s,
) -> S::f32s {
    let (none, all) = (S::f32s::splat(simd, 0.0), S::f32s::splat(simd, 1.0));
    let behind = end.piece.simd_ge(table.count);
    let point = behind.select(none, all);
    // Seen from the end of the table: near it nothing is lost.
    let part = -((start.piece - table.count) + start.along);
    let part = (part / width).max(0.0).min(1.0);
    middle.is_point.select(point, behind.select(part, all))
}

#[inline(always)]
fn store_wide<S: Simd>(_: S, values: S::f32s, wide: &mut [f64]) {
    let (low, high) = values.widen();
    low.store_slice(&mut wide[..S::f64s::LEN]);
    high.store_slice(&mut wide[S::f64s::LEN..2 * S::f64s::LEN]);
}

impl Middles {
    /// Finds the widths of the boxes and how far they are apart; gives how many boxes are needed.
    #[simd]
    fn widths<S: Simd>(
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
    fn fold<S: Simd, const REPEATS: bool>(&mut self, simd: S, table: &Table, times: &[f32]) {
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

/// The largest whole number up to `x`, for |x| < 2^22: instructions that every machine has.
#[inline(always)]
fn floor<S: Simd>(x: S::f32s) -> S::f32s {
    // 1.5 * 2^23 leaves no room for a fraction.
    const ROUND: f32 = 12_582_912.0;
    let nearest = (x + ROUND) - ROUND;
    nearest.simd_gt(x).select(nearest - 1.0, nearest)
}

/// The same for |x| < 2^51.
#[inline(always)]
fn floor_wide<S: Simd>(x: S::f64s) -> S::f64s {
    // 1.5 * 2^52 leaves no room for a fraction.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let nearest = (x + ROUND) - ROUND;
    nearest.simd_gt(x).select(nearest - 1.0, nearest)
}
