//! A colour pattern prepared for exact averages over spans of growth time.
//!
//! The table is a chain of pieces on which colour is linear, with the integral up to the start of each:
//! an average over any span is the difference of two integrals (summed-area tables, Crow 1984, in one
//! dimension), whole periods in closed form. The position in the ring is linear within each ring, so its
//! integral needs no table.

use crate::value::{AfterEnd, ColourPattern};

/// Spans shorter than this part of a texel are looked up like points: the integrals' difference
/// would lose its digits.
const POINT: f64 = 1e-5;

/// Largest number of tables between time 0 and a sample: no f32 has a fraction there any more.
const FARTHEST: f64 = 1e9;

/// What a pattern gives for a span of growth time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    /// Mean colour of the part inside the pattern; the last colour if there is none.
    pub(super) colour: [f64; 3],
    /// Mean position in the ring of the part inside the pattern; 1 if there is none.
    pub(super) position: f64,
    /// Share of the span before the pattern's end.
    pub(super) inside: f64,
}

/// Pieces and rings of a pattern.
#[derive(Debug)]
pub(super) struct Table {
    pieces: Vec<Piece>,
    rings: Vec<Ring>,
    /// From texel borders to piece borders: 0.5 where colours are interpolated between centres.
    offset: f64,
    texels: f64,
    years: f64,
    frequency: f64,
    total: [f64; 3],
    first: [f64; 3],
    last: [f64; 3],
    repeats: bool,
}

/// Colour `value + 2 slope g` at the distance g, in texels, from the start of the piece.
#[derive(Debug)]
struct Piece {
    /// Integral from the start of the table to the start of the piece.
    integral: [f64; 3],
    value: [f64; 3],
    /// Half the change over the piece.
    slope: [f64; 3],
    /// The ring that holds the start of the piece.
    ring: u32,
}

#[derive(Debug)]
struct Ring {
    start: f64,
    reciprocal: f64,
}

/// Integrals from the start of the table.
struct Integral {
    /// In texels.
    colour: [f64; 3],
    /// In tables.
    position: f64,
}

impl Table {
    /// Prepares a pattern.
    pub(super) fn new(pattern: &ColourPattern) -> Table {
        let colours: Vec<[f64; 3]> = pattern
            .colours
            .iter()
            .map(|colour| colour.map(f64::from))
            .collect();
        let texels = colours.len() as f64;
        let rings = rings(&pattern.ring_starts);
        let offset = if pattern.smooth { 0.5 } else { 0.0 };
        let pieces = pieces(&colours, &rings, pattern.smooth);
        let total = colours
            .iter()
            .fold([0.0; 3], |sum, colour| add(sum, *colour, 1.0));
        Table {
            pieces,
            rings,
            offset,
            texels,
            years: pattern.years,
            frequency: 1.0 / pattern.years,
            total,
            first: colours[0],
            last: colours[colours.len() - 1],
            repeats: pattern.after_end == AfterEnd::Repeat,
        }
    }

    /// What the pattern gives on average over `width` years around `time`.
    #[inline(always)]
    pub(super) fn look(&self, time: f64, width: f64) -> Look {
        let farthest = FARTHEST * self.years;
        // NaN becomes a number here: `max` and `min` give the other operand.
        let time = time.max(-farthest).min(farthest);
        let half = 0.5 * (width.max(0.0).min(farthest) * self.frequency);
        if self.repeats {
            self.repeating(time, half)
        } else {
            self.ending(time / self.years, half)
        }
    }

    #[inline(always)]
    fn repeating(&self, time: f64, half: f64) -> Look {
        let middle = (time - self.periods(time) * self.years) / self.years;
        let texels = 2.0 * half * self.texels;
        if texels < POINT {
            return self.point(middle);
        }
        let (from, to) = (middle - half, middle + half);
        let (from_period, to_period) = (floor(from), floor(to));
        let start = self.integral(from - from_period);
        let end = self.integral(to - to_period);
        let periods = to_period - from_period;
        let colour = add(difference(end.colour, start.colour), self.total, periods);
        // The mean position of every whole ring is a half, so that of a whole table is too.
        let position = end.position - start.position + 0.5 * periods;
        let scale = 1.0 / texels;
        Look {
            colour: colour.map(|part| part * scale),
            position: position * (scale * self.texels),
            inside: 1.0,
        }
    }

    /// Number of whole tables before `time`.
    #[inline(always)]
    fn periods(&self, time: f64) -> f64 {
        // The product may be rounded across a whole number: years 46.9.. to 47 over 47 years.
        let near = floor(time * self.frequency);
        let near = if time >= (near + 1.0) * self.years {
            near + 1.0
        } else {
            near
        };
        if time < near * self.years {
            near - 1.0
        } else {
            near
        }
    }

    #[inline(always)]
    fn ending(&self, middle: f64, half: f64) -> Look {
        let (from, to) = (middle - half, (middle + half).min(1.0));
        let texels = (to - from) * self.texels;
        if 2.0 * half * self.texels < POINT {
            return if middle < 1.0 {
                self.point(middle.max(0.0))
            } else {
                self.nothing(0.0)
            };
        }
        if texels < POINT {
            return self.nothing(((to - from) / (2.0 * half)).max(0.0));
        }
        // Before its start the pattern has its first colour and position 0.
        let [start, end] = [from, to].map(|at| self.integral(at.max(0.0)));
        let before = (to.min(0.0) - from.min(0.0)) * self.texels;
        let colour = add(difference(end.colour, start.colour), self.first, before);
        let scale = 1.0 / texels;
        Look {
            colour: colour.map(|part| part * scale),
            position: (end.position - start.position) * (scale * self.texels),
            inside: (to - from) / (2.0 * half),
        }
    }

    /// The pattern at the place `at` of the table, from 0 to 1.
    #[inline(always)]
    fn point(&self, at: f64) -> Look {
        let (piece, g) = self.piece(at);
        let ring = self.ring(piece, at);
        Look {
            colour: add(piece.value, piece.slope, 2.0 * g),
            position: (at - ring.start) * ring.reciprocal,
            inside: 1.0,
        }
    }

    fn nothing(&self, inside: f64) -> Look {
        Look {
            colour: self.last,
            position: 1.0,
            inside,
        }
    }

    /// The integrals from 0 to `at`, which is from 0 to 1.
    #[inline(always)]
    fn integral(&self, at: f64) -> Integral {
        let (piece, g) = self.piece(at);
        let ring = self.ring(piece, at);
        let along = at - ring.start;
        Integral {
            colour: add(piece.integral, add(piece.value, piece.slope, g), g),
            // Every ring before this one contributes half its width.
            position: 0.5 * (ring.start + along * along * ring.reciprocal),
        }
    }

    /// The piece that holds the place `at` of the table, and the distance from its start in texels.
    #[inline(always)]
    fn piece(&self, at: f64) -> (&Piece, f64) {
        let along = at * self.texels + self.offset;
        // `at` may have been rounded up to 1.
        let index = index(along).min(self.pieces.len() - 1);
        (&self.pieces[index], along - index as f64)
    }

    #[inline(always)]
    fn ring(&self, piece: &Piece, at: f64) -> &Ring {
        let mut index = piece.ring as usize;
        while index + 1 < self.rings.len() && self.rings[index + 1].start <= at {
            index += 1;
        }
        &self.rings[index]
    }
}

fn rings(starts: &[f64]) -> Vec<Ring> {
    let ends = starts.iter().skip(1).chain(&[1.0]);
    let ring = |(start, end): (&f64, &f64)| Ring {
        start: *start,
        reciprocal: 1.0 / (end - start),
    };
    starts.iter().zip(ends).map(ring).collect()
}

/// Without interpolation one piece for each texel; with it one from centre to centre, and half ones at
/// the ends, where the colour stays that of the outermost centre.
fn pieces(colours: &[[f64; 3]], rings: &[Ring], smooth: bool) -> Vec<Piece> {
    let count = colours.len();
    let (pieces, offset) = if smooth {
        (count + 1, 0.5)
    } else {
        (count, 0.0)
    };
    let mut integral = if smooth {
        colours[0].map(|part| -0.5 * part)
    } else {
        [0.0; 3]
    };
    let piece = |index: usize| {
        let (value, next) = if smooth {
            (colours[index.max(1) - 1], colours[index.min(count - 1)])
        } else {
            (colours[index], colours[index])
        };
        let slope = difference(next, value).map(|part| 0.5 * part);
        let start = (index as f64 - offset) / count as f64;
        let ring = rings.partition_point(|ring| ring.start <= start).max(1) - 1;
        let piece = Piece {
            integral,
            value,
            slope,
            ring: ring as u32,
        };
        integral = add(integral, add(value, slope, 1.0), 1.0);
        piece
    };
    (0..pieces).map(piece).collect()
}

#[inline(always)]
fn add(a: [f64; 3], b: [f64; 3], times: f64) -> [f64; 3] {
    [
        a[0] + b[0] * times,
        a[1] + b[1] * times,
        a[2] + b[2] * times,
    ]
}

#[inline(always)]
fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Added to a number, leaves its nearest whole number in the low bits: 1.5 * 2^52.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// The largest whole number up to `x`, for |x| < 2^51; faster than a call where the machine has no
/// instruction for it, and the same everywhere.
#[inline(always)]
fn floor(x: f64) -> f64 {
    let nearest = (x + ROUND) - ROUND;
    if nearest > x { nearest - 1.0 } else { nearest }
}

/// The whole part of `x`, from 0 to 2^31.
#[inline(always)]
fn index(x: f64) -> usize {
    (floor(x) + ROUND).to_bits() as u32 as usize
}
