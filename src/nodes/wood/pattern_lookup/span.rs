//! Spans of growth time as spans of a pattern's table, a block of samples at once.
//!
//! Places are whole pieces and what is left of them, so that wide tables cost short spans no digits.

use super::middle::{Middle, Middles};
use super::table::Table;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// Samples that are looked up together.
pub(super) const BLOCK: usize = 64;

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
            middles: Middles::new(),
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

/// The largest whole number up to `x`, for |x| < 2^22: instructions that every machine has.
#[inline(always)]
fn floor<S: Simd>(x: S::f32s) -> S::f32s {
    // 1.5 * 2^23 leaves no room for a fraction.
    const ROUND: f32 = 12_582_912.0;
    let nearest = (x + ROUND) - ROUND;
    nearest.simd_gt(x).select(nearest - 1.0, nearest)
}
