//! A colour pattern prepared for exact averages over spans of growth time.
//!
//! The table is a chain of pieces on which colour and position are linear, with the integral up to the
//! start of each: an average is the difference of two integrals (summed-area tables, Crow 1984, in one
//! dimension), whole periods in closed form. Integrals are f64, so that short spans lose no digits.

use super::rings::Rings;
use super::span::{Ends, Spans};
use crate::value::{AfterEnd, ColourPattern};
use fearless_simd::f64x4;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// Red, green, blue, position in the ring.
pub(super) type Lanes = [f32; 4];

/// The pieces of a pattern, and where rings begin in them.
#[derive(Debug)]
pub(super) struct Table {
    pub(super) years: f64,
    pub(super) frequency: f64,
    pub(super) pieces_per_year: f64,
    pub(super) repeats: bool,
    /// Pieces between the start and the end of the table.
    pub(super) count: f32,
    /// One before the start, those of the table, one behind the end.
    pieces: Vec<Piece>,
    /// What one whole period adds to an integral.
    period: [f64; 4],
    rings: Rings,
}

/// At the distance g, in pieces, from the start of the piece the value is `value + 2 slope g`, and the
/// integral from the start of the table `integral + g (value + slope g)`.
#[derive(Clone, Debug)]
#[repr(align(32))]
struct Piece {
    value: [f64; 4],
    /// Half the change over the piece.
    slope: [f64; 4],
    integral: [f64; 4],
}

impl Piece {
    /// A piece of one colour.
    fn even([red, green, blue]: [f32; 3], position: f64, integral: [f64; 4]) -> Piece {
        let [red, green, blue] = [red, green, blue].map(f64::from);
        Piece {
            value: [red, green, blue, position],
            slope: [0.0; 4],
            integral,
        }
    }
}

impl Table {
    /// Prepares a pattern.
    pub(super) fn new(pattern: &ColourPattern) -> Table {
        // Between texel centres colours are linear, so borders of pieces lie at borders and at centres.
        let pieces_per_texel = if pattern.smooth { 2 } else { 1 };
        let count = pieces_per_texel * pattern.colours.len();
        let rings = Rings::new(&pattern.ring_starts, count);
        let pieces = pieces(pattern, count, &rings);
        Table {
            years: pattern.years,
            frequency: 1.0 / pattern.years,
            pieces_per_year: count as f64 / pattern.years,
            repeats: pattern.after_end == AfterEnd::Repeat,
            count: count as f32,
            period: pieces[count + 1].integral,
            pieces,
            rings,
        }
    }

    /// Writes the mean colours and positions of spans.
    #[simd]
    pub(super) fn means<S: Simd>(&self, simd: S, spans: &Spans, means: &mut [Lanes]) {
        match spans.boxes {
            0 => self.means_of::<S, 0>(simd, spans, means),
            1 => self.means_of::<S, 1>(simd, spans, means),
            _ => self.means_of::<S, 2>(simd, spans, means),
        }
        if self.rings.are_several() {
            self.rings.correct(spans, means, self.period[3]);
        }
    }

    #[simd]
    fn means_of<S: Simd, const BOXES: usize>(&self, simd: S, spans: &Spans, means: &mut [Lanes]) {
        for (pair, means) in means.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let first = self.mean::<S, BOXES>(simd, spans, 2 * pair);
            let second = self.mean::<S, BOXES>(simd, spans, 2 * pair + 1);
            first.narrow(second).store_slice(means.as_flattened_mut());
        }
    }

    #[inline(always)]
    fn mean<S: Simd, const BOXES: usize>(&self, simd: S, spans: &Spans, index: usize) -> f64x4<S> {
        let [low, high, second_low, second_high] = &spans.ends;
        if BOXES == 0 || spans.scale[index] == 0.0 {
            return self.value(simd, low, index);
        }
        let mut sum = self.integral(simd, high, index) - self.integral(simd, low, index);
        if BOXES == 2 {
            let high = self.integral(simd, second_high, index);
            sum += high - self.integral(simd, second_low, index);
        }
        let periods = f64x4::load_array_ref(simd, &self.period) * spans.periods[index];
        (sum + periods) * spans.scale[index]
    }

    #[inline(always)]
    fn value<S: Simd>(&self, simd: S, ends: &Ends, index: usize) -> f64x4<S> {
        let piece = self.piece(ends.piece[index]);
        let slope = f64x4::load_array_ref(simd, &piece.slope);
        slope * (2.0 * ends.along[index]) + f64x4::load_array_ref(simd, &piece.value)
    }

    #[inline(always)]
    fn integral<S: Simd>(&self, simd: S, ends: &Ends, index: usize) -> f64x4<S> {
        let (piece, along) = (self.piece(ends.piece[index]), ends.along[index]);
        let slope = f64x4::load_array_ref(simd, &piece.slope);
        let mean = slope * along + f64x4::load_array_ref(simd, &piece.value);
        mean * along + f64x4::load_array_ref(simd, &piece.integral)
    }

    #[inline(always)]
    fn piece(&self, index: i32) -> &Piece {
        &self.pieces[index as usize]
    }
}

/// Where interpolated, pieces are half a texel long: at the ends of the table the colour stays that of the
/// outermost centre. The pieces around the table go on with the first and the last colour.
fn pieces(pattern: &ColourPattern, count: usize, rings: &Rings) -> Vec<Piece> {
    let (colours, smooth) = (&pattern.colours, pattern.smooth);
    let last = colours.len() - 1;
    let border = |piece: usize| match (smooth, piece.is_multiple_of(2)) {
        (false, _) => colours[piece.min(last)].map(f64::from),
        (true, false) => colours[piece / 2].map(f64::from),
        (true, true) => {
            let (before, after) = (
                colours[(piece / 2).max(1) - 1],
                colours[(piece / 2).min(last)],
            );
            [0, 1, 2].map(|part| 0.5 * (f64::from(before[part]) + f64::from(after[part])))
        }
    };
    let mut integral = [0.0; 4];
    let piece = |index: usize| {
        let ([red, green, blue], end) = (border(index), border(index + usize::from(smooth)));
        let (position, rise) = rings.along_piece(index);
        let value = [red, green, blue, position];
        let change = [end[0] - red, end[1] - green, end[2] - blue, rise];
        let (slope, start) = (change.map(|change| 0.5 * change), integral);
        for part in 0..3 {
            integral[part] += value[part] + slope[part];
        }
        integral[3] = rings.integral((index + 1) as f64);
        Piece {
            value,
            slope,
            integral: start,
        }
    };
    let inside: Vec<Piece> = (0..count).map(piece).collect();
    // The first one starts at -1, so that integrals are 0 at the start of the table.
    let first = colours[0].map(|part| -f64::from(part));
    let before = Piece::even(colours[0], 0.0, [first[0], first[1], first[2], 0.0]);
    let after = Piece::even(colours[last], 1.0, integral);
    std::iter::once(before)
        .chain(inside)
        .chain([after])
        .collect()
}
