//! Spans of growth time as spans of a pattern's table, a block of samples at once.
//!
//! Plain loops over arrays without branches, so the compiler turns them into vector code. Everything
//! is f64 up to the fraction of a texel, so a texel is hit as well at year 100 as at year 0.

use super::table::{FARTHEST, POINT, Table};

/// Samples that are looked up together.
pub(super) const BLOCK: usize = 64;

/// Where spans of growth time start and end in the table.
pub(super) struct Spans {
    /// Starts, in years from the start of the table.
    pub(super) from: [f64; BLOCK],
    /// Ends, in years from the start of the table.
    pub(super) to: [f64; BLOCK],
    /// Starts, in pieces.
    pub(super) starts: Places,
    /// Ends, in pieces.
    pub(super) ends: Places,
    /// Whole periods between start and end, or texels before the table's start.
    pub(super) lead: [f32; BLOCK],
    /// One over the part of the span inside the pattern, in texels.
    pub(super) scale: [f32; BLOCK],
    /// Share of the span inside the pattern.
    pub(super) inside: [f32; BLOCK],
}

/// Places in the table.
#[derive(Clone)]
pub(super) struct Places {
    /// Number of the piece.
    pub(super) piece: [u32; BLOCK],
    /// Distance from the start of the piece in texels, 0 to 1.
    pub(super) along: [f32; BLOCK],
}

impl Places {
    #[inline(always)]
    fn split(&mut self, years: &[f64; BLOCK], table: &Table) {
        for ((years, piece), along) in years.iter().zip(&mut self.piece).zip(&mut self.along) {
            let texels = years * table.texels_per_year + table.offset;
            let whole = floor(texels);
            *piece = (whole + ROUND).to_bits() as u32;
            *along = (texels - whole) as f32;
        }
    }
}

impl Spans {
    /// Spans that are nowhere yet.
    pub(super) fn new() -> Spans {
        let (years, ratios) = ([0.0; BLOCK], [0.0; BLOCK]);
        let places = Places {
            piece: [0; BLOCK],
            along: ratios,
        };
        let (starts, ends) = (places.clone(), places);
        Spans {
            from: years,
            to: years,
            starts,
            ends,
            lead: ratios,
            scale: ratios,
            inside: ratios,
        }
    }

    /// Finds the spans of `widths` around `times`.
    #[inline(always)]
    pub(super) fn place(&mut self, table: &Table, times: &[f64; BLOCK], widths: &[f32; BLOCK]) {
        if table.repeats {
            self.fold(table, times, widths);
        } else {
            self.cut(table, times, widths);
        }
        self.starts.split(&self.from, table);
        self.ends.split(&self.to, table);
    }

    /// Folds spans of `widths` around `times` into a table that repeats.
    #[inline(always)]
    fn fold(&mut self, table: &Table, times: &[f64; BLOCK], widths: &[f32; BLOCK]) {
        let (years, frequency) = (table.years, table.frequency);
        for index in 0..BLOCK {
            let time = bounded(times[index], years);
            let width = width(widths[index], years);
            let middle = time - periods(time, years, frequency) * years;
            let texels = width * table.texels_per_year;
            let half = if texels < POINT { 0.0 } else { 0.5 * width };
            let (from, to) = (middle - half, middle + half);
            let before = floor(from * frequency).min(0.0);
            let after = if half > 0.0 {
                floor(to * frequency)
            } else {
                0.0
            };
            self.from[index] = (from - before * years).max(0.0).min(years);
            self.to[index] = (to - after * years).max(0.0).min(years);
            self.lead[index] = (after - before) as f32;
            self.scale[index] = 1.0 / texels as f32;
            self.inside[index] = 1.0;
        }
    }

    /// Cuts spans of `widths` around `times` at the end of a table that does not repeat.
    #[inline(always)]
    fn cut(&mut self, table: &Table, times: &[f64; BLOCK], widths: &[f32; BLOCK]) {
        let years = table.years;
        for index in 0..BLOCK {
            let time = bounded(times[index], years);
            let width = width(widths[index], years);
            let point = width * table.texels_per_year < POINT;
            let half = if point { 0.0 } else { 0.5 * width };
            let (from, to) = (time - half, (time + half).min(years));
            let texels = (to - from) * table.texels_per_year;
            let nothing = !point && texels < POINT;
            let before = (to.min(0.0) - from.min(0.0)) * table.texels_per_year;
            self.to[index] = if nothing { years } else { to.max(0.0) };
            self.from[index] = if nothing {
                years
            } else {
                from.max(0.0).min(years)
            };
            self.lead[index] = if nothing || to <= 0.0 {
                0.0
            } else {
                before as f32
            };
            self.scale[index] = 1.0 / texels as f32;
            let share = ((to - from) / width).max(0.0) as f32;
            let whole = if time < years { 1.0 } else { 0.0 };
            self.inside[index] = if point { whole } else { share };
        }
    }
}

/// A time that no arithmetic below can overflow; NaN becomes the earliest.
#[inline(always)]
fn bounded(time: f64, years: f64) -> f64 {
    let farthest = FARTHEST * years;
    let time = if time > -farthest { time } else { -farthest };
    if time < farthest { time } else { farthest }
}

/// A width that no arithmetic above can overflow; NaN becomes the most.
#[inline(always)]
fn width(width: f32, years: f64) -> f64 {
    let (width, farthest) = (f64::from(width), FARTHEST * years);
    if width < farthest { width } else { farthest }
}

/// Number of whole tables before `time`.
#[inline(always)]
fn periods(time: f64, years: f64, frequency: f64) -> f64 {
    // The product may be rounded across a whole number: year 47 of 47 years.
    let near = floor(time * frequency);
    let near = if time >= (near + 1.0) * years {
        near + 1.0
    } else {
        near
    };
    if time < near * years {
        near - 1.0
    } else {
        near
    }
}

/// Added to a number, leaves its nearest whole number in the low bits: 1.5 * 2^52.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// The largest whole number up to `x`, for |x| < 2^51; faster than a call where the machine has no
/// instruction for it, and the same everywhere.
#[inline(always)]
pub(super) fn floor(x: f64) -> f64 {
    let nearest = (x + ROUND) - ROUND;
    if nearest > x { nearest - 1.0 } else { nearest }
}
