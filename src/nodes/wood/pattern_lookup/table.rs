//! A colour pattern prepared for exact averages over spans of growth time.
//!
//! The table is a chain of pieces on which colour and position are linear, with the integral up to the
//! start of each: an average is the difference of two integrals (summed-area tables, Crow 1984, in one
//! dimension), whole periods in closed form. What is left of the first piece and what is used of the last
//! are added as they are, so that short spans lose no digits.

use super::span::{BLOCK, Spans};
use crate::value::{AfterEnd, ColourPattern};

/// Spans shorter than this part of a texel are points.
pub(super) const POINT: f64 = 1e-5;

/// Largest number of tables between time 0 and a sample: no f32 has a fraction there any more.
pub(super) const FARTHEST: f64 = 1e9;

/// Red, green, blue, position in the ring.
type Lanes = [f32; 4];

/// Pieces and rings of a pattern.
#[derive(Debug)]
pub(super) struct Table {
    pub(super) years: f64,
    pub(super) frequency: f64,
    pub(super) texels_per_year: f64,
    pub(super) repeats: bool,
    /// From texel borders to piece borders: 0.5 where colours are interpolated between centres.
    pub(super) offset: f64,
    /// Where the last piece ends, in pieces.
    length: f32,
    pieces: Vec<Piece>,
    /// What one whole period, or one texel before the start, adds to an integral.
    lead: [f64; 4],
    /// Empty where the pieces hold the position.
    rings: Vec<Ring>,
    /// The ring that holds the start of each piece.
    ring_of: Vec<u32>,
}

/// The value is `value + 2 slope g` at the distance g, in texels, from the start of the piece.
#[derive(Clone, Debug)]
struct Piece {
    value: Lanes,
    /// Half the change over the piece.
    slope: Lanes,
    /// Integral in texels from the start of the table to the start of the piece.
    integral: [f64; 4],
}

/// A ring, in years from the start of the table.
#[derive(Clone, Debug)]
struct Ring {
    start: f64,
    reciprocal: f64,
}

impl Table {
    /// Prepares a pattern.
    pub(super) fn new(pattern: &ColourPattern) -> Table {
        let repeats = pattern.after_end == AfterEnd::Repeat;
        let texels = pattern.colours.len() as f64;
        let offset = if pattern.smooth { 0.5 } else { 0.0 };
        let pieces = pieces(&pattern.colours, pattern.smooth);
        let [red, green, blue] = pattern.colours[0];
        let total = pieces[pieces.len() - 2].integral;
        let lead = if repeats {
            total
        } else {
            [red, green, blue, 0.0].map(f64::from)
        };
        let several = pattern.ring_starts.len() > 1;
        let rings = if several {
            rings(&pattern.ring_starts, pattern.years)
        } else {
            vec![]
        };
        let ring_of = |piece: usize| {
            let start = (piece as f64 - offset) / texels * pattern.years;
            rings.partition_point(|ring| ring.start <= start).max(1) as u32 - 1
        };
        Table {
            years: pattern.years,
            frequency: 1.0 / pattern.years,
            texels_per_year: texels / pattern.years,
            repeats,
            offset,
            length: (texels + offset) as f32,
            lead,
            ring_of: (0..pieces.len()).map(ring_of).collect(),
            pieces,
            rings,
        }
    }

    /// The mean colours and positions of spans.
    #[inline(always)]
    pub(super) fn means(&self, spans: &Spans, means: &mut [Lanes; BLOCK]) {
        for (index, mean) in means.iter_mut().enumerate() {
            let (first, last) = (spans.starts.piece[index], spans.ends.piece[index]);
            let (from, to) = (spans.starts.along[index], spans.ends.along[index]);
            let lead = f64::from(spans.lead[index]);
            let start = &self.pieces[first as usize];
            *mean = if first == last && lead == 0.0 {
                let middle = from + to;
                lanes(|lane| start.value[lane] + start.slope[lane] * middle)
            } else {
                let after = &self.pieces[first as usize + 1];
                let end = &self.pieces[last as usize];
                // The first and the last piece may be halves.
                let border = (self.length - first as f32).min(1.0);
                let begin = (self.offset as f32 - last as f32).max(0.0);
                let [rest, used] = [border - from, to - begin];
                let scale = spans.scale[index];
                lanes(|lane| {
                    let tail = rest * (start.value[lane] + start.slope[lane] * (border + from));
                    let head = used * (end.value[lane] + end.slope[lane] * (to + begin));
                    let whole = end.integral[lane] - after.integral[lane];
                    ((tail + head) + (whole + lead * self.lead[lane]) as f32) * scale
                })
            };
        }
        if !self.rings.is_empty() {
            self.positions(spans, means);
        }
    }

    /// The mean positions where there are several rings: linear in each of them.
    #[inline(always)]
    fn positions(&self, spans: &Spans, means: &mut [Lanes; BLOCK]) {
        let periods = if self.repeats { 0.5 * self.years } else { 0.0 };
        for (index, mean) in means.iter_mut().enumerate() {
            let (from, to, lead) = (spans.from[index], spans.to[index], spans.lead[index]);
            let start = self.ring(spans.starts.piece[index], from);
            let end = self.ring(spans.ends.piece[index], to);
            mean[3] = if start.start == end.start && lead == 0.0 {
                ((0.5 * (from + to) - start.start) * start.reciprocal) as f32
            } else {
                let whole = (0.5 * (end.start - start.start)) + f64::from(lead) * periods;
                let sum = whole + end.part(to) - start.part(from);
                (sum * self.texels_per_year) as f32 * spans.scale[index]
            };
        }
    }

    #[inline(always)]
    fn ring(&self, piece: u32, at: f64) -> &Ring {
        let mut index = self.ring_of[piece as usize] as usize;
        while index + 1 < self.rings.len() && self.rings[index + 1].start <= at {
            index += 1;
        }
        &self.rings[index]
    }
}

impl Ring {
    /// The integral of the position from the start of the ring; over a whole ring it is half the width.
    #[inline(always)]
    fn part(&self, to: f64) -> f64 {
        let along = to - self.start;
        0.5 * along * along * self.reciprocal
    }
}

fn rings(starts: &[f64], years: f64) -> Vec<Ring> {
    // 5 / 47 * 47 has to be 5, or the first sample of a year would fall into the year before.
    let start = |start: &f64| {
        let start = start * years;
        if (start - start.round()).abs() < 1e-9 {
            start.round()
        } else {
            start
        }
    };
    let starts: Vec<f64> = starts.iter().map(start).collect();
    let ends = starts.iter().skip(1).chain([&years]);
    let ring = |(start, end): (&f64, &f64)| Ring {
        start: *start,
        reciprocal: 1.0 / (end - start),
    };
    starts.iter().zip(ends).map(ring).collect()
}

/// Without interpolation one piece for each texel; with it one from centre to centre, and half ones at
/// the ends, where the colour stays that of the outermost centre. Two more follow, so that rounding past
/// the end meets the last colour.
fn pieces(colours: &[[f32; 3]], smooth: bool) -> Vec<Piece> {
    let count = colours.len();
    let position = |border: f64| (border / count as f64) as f32;
    let colour = |index: usize| colours[index.min(count - 1)];
    let ends = |index: usize| match smooth {
        true => (colour(index.max(1) - 1), colour(index), index as f64 - 0.5),
        false => (colour(index), colour(index), index as f64),
    };
    let mut integral = [0.0; 4];
    let piece = |index: usize| {
        let ([red, green, blue], next, border) = ends(index);
        let beyond = border >= count as f64;
        let value = [red, green, blue, position(border.min(count as f64))];
        let next = [
            next[0],
            next[1],
            next[2],
            if beyond { 1.0 } else { position(border + 1.0) },
        ];
        let slope = lanes(|lane| 0.5 * (next[lane] - value[lane]));
        let piece = Piece {
            value,
            slope,
            integral,
        };
        // The first and the last piece are halves: from the border of the table to a centre.
        let [begin, end] = match index {
            _ if !smooth => [0.0, 1.0],
            0 => [0.5, 1.0],
            _ => [0.0, if index == count { 0.5 } else { 1.0 }],
        };
        for lane in 0..4 {
            let [value, slope] = [value[lane], slope[lane]].map(f64::from);
            integral[lane] += (end - begin) * (value + slope * (end + begin));
        }
        piece
    };
    let inside = if smooth { count + 1 } else { count };
    (0..inside + 2).map(piece).collect()
}

#[inline(always)]
fn lanes(lane: impl Fn(usize) -> f32) -> Lanes {
    [lane(0), lane(1), lane(2), lane(3)]
}
