//! Profiles: piecewise cubic functions of one number, averaged exactly over what a sample covers.
//!
//! In a sample the input is c + a x + b y with x and y from -1/2 to 1/2. With F the second antiderivative of
//! the profile, its mean over the sample is
//!
//! ```text
//! (F(c + (a + b)/2) - F(c + (a - b)/2) - F(c - (a - b)/2) + F(c - (a + b)/2)) / (a b)
//! ```
//!
//! (repeated integration, Heckbert 1986). Linear parts of F cancel, so a profile that repeats needs only an F
//! that does. Where the sample stays within one cubic p, the mean is p(c) + p''(c) (a^2 + b^2) / 24.

use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;

/// What a profile does before its first and behind its last border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::nodes) enum Ends {
    /// It keeps its first and its last value.
    Stay,
    /// It starts again.
    Repeat,
}

/// One piece: from `start` on, lane l is the cubic with the coefficients `cubic[l]` in x - start.
#[derive(Clone, Debug)]
pub(in crate::nodes) struct Piece<const LANES: usize> {
    /// Where the piece begins.
    pub(in crate::nodes) start: f64,
    /// Coefficients from the constant up.
    pub(in crate::nodes) cubic: [[f64; 4]; LANES],
}

/// A piece with the first and the second antiderivative of each lane at its start.
#[derive(Clone, Debug)]
struct Summed<const LANES: usize> {
    piece: Piece<LANES>,
    once: [f64; LANES],
    twice: [f64; LANES],
}

/// A piecewise cubic function with `LANES` values.
#[derive(Clone, Debug)]
pub(in crate::nodes) struct Profile<const LANES: usize> {
    pieces: Vec<Summed<LANES>>,
    /// Where the first piece starts and the last one ends.
    range: [f64; 2],
    ends: Ends,
    /// What is left out of the antiderivatives so that they repeat; 0 where the ends stay.
    mean: [f64; LANES],
}

/// Share of the larger spread below which the smaller one does not count.
const NARROW: f64 = 1e-3;

/// Share of a profile's range below which a spread is a point.
const POINT: f64 = 1e-6;

/// Farthest that an input may lie from a profile, in ranges: an f32 has no fraction of it any more.
const FARTHEST: f64 = 1e9;

impl<const LANES: usize> Profile<LANES> {
    /// A profile of `pieces`, at least one, that rise strictly and of which the last ends at `end`.
    pub(in crate::nodes) fn new(pieces: Vec<Piece<LANES>>, end: f64, ends: Ends) -> Profile<LANES> {
        let range = [pieces[0].start, end];
        let mut profile = Profile {
            pieces: vec![],
            range,
            ends,
            mean: [0.0; LANES],
        };
        if ends == Ends::Stay {
            profile.pieces = profile.summed(with_flat_ends(pieces, end), [0.0; LANES]);
            return profile;
        }
        let period = end - range[0];
        let total = |summed: Vec<Summed<LANES>>, once: bool| {
            let last = &summed[summed.len() - 1];
            let at_end = last.sums(end - last.piece.start);
            at_end.map(|[first, second]| if once { first } else { second } / period)
        };
        profile.mean = total(profile.summed(pieces.clone(), [0.0; LANES]), true);
        let once = total(profile.summed(pieces.clone(), [0.0; LANES]), false).map(|sum| -sum);
        profile.pieces = profile.summed(pieces, once);
        profile
    }

    /// The antiderivatives of `pieces` without the mean; the first starts with `once` and 0.
    fn summed(&self, pieces: Vec<Piece<LANES>>, mut once: [f64; LANES]) -> Vec<Summed<LANES>> {
        let mut twice = [0.0; LANES];
        let mut summed: Vec<Summed<LANES>> = Vec::with_capacity(pieces.len());
        for mut piece in pieces {
            for (cubic, mean) in piece.cubic.iter_mut().zip(self.mean) {
                cubic[0] -= mean;
            }
            if let Some(last) = summed.last() {
                for (lane, sums) in last.sums(piece.start - last.piece.start).iter().enumerate() {
                    [once[lane], twice[lane]] = *sums;
                }
            }
            summed.push(Summed { piece, once, twice });
        }
        summed
    }

    /// The mean over a sample in which the input is `middle` and changes by `across` and `along`.
    pub(in crate::nodes) fn mean(&self, middle: f64, [across, along]: [f64; 2]) -> [f64; LANES] {
        let period = self.range[1] - self.range[0];
        let bounded = |value: f64, limit: f64| if value < limit { value } else { limit };
        let wide = bounded(across.abs().max(along.abs()), FARTHEST * period);
        let narrow = bounded(across.abs().min(along.abs()), FARTHEST * period);
        let middle = self.folded(middle);
        let reach = 0.5 * (wide + narrow);
        let piece = self.piece(middle - reach);
        if reach < POINT * period
            || piece == self.piece(middle + reach) && !self.wraps(middle, reach)
        {
            let variance = (wide * wide + narrow * narrow) / 12.0;
            let piece = self.piece(middle);
            return self.with_mean(self.pieces[piece].mean(middle, variance));
        }
        let apart = 0.5 * (wide - narrow);
        if narrow < NARROW * wide {
            let [to, from] = [middle + 0.5 * wide, middle - 0.5 * wide].map(|at| self.sums(at));
            return self.with_mean(std::array::from_fn(|lane| {
                (to[lane][0] - from[lane][0]) / wide
            }));
        }
        let [a, b, c, d] = [reach, apart, -apart, -reach].map(|offset| self.sums(middle + offset));
        self.with_mean(std::array::from_fn(|lane| {
            ((a[lane][1] - b[lane][1]) - (c[lane][1] - d[lane][1])) / (wide * narrow)
        }))
    }

    fn with_mean(&self, part: [f64; LANES]) -> [f64; LANES] {
        std::array::from_fn(|lane| part[lane] + self.mean[lane])
    }

    /// Whether a sample crosses the border from one period to the next.
    fn wraps(&self, middle: f64, reach: f64) -> bool {
        let [start, end] = self.range;
        self.ends == Ends::Repeat && (middle - reach < start || middle + reach >= end)
    }

    /// The input brought into the first period, or near enough to compute with; NaN becomes the start.
    fn folded(&self, value: f64) -> f64 {
        let [start, end] = self.range;
        let period = end - start;
        let far = FARTHEST * period;
        let value = if value > start - far {
            value
        } else {
            start - far
        };
        let value = if value < end + far { value } else { end + far };
        if self.ends == Ends::Stay {
            return value;
        }
        let folded = value - ((value - start) / period).floor() * period;
        // Rounding may lead to the border itself.
        if folded < start || folded >= end {
            start
        } else {
            folded
        }
    }

    fn piece(&self, at: f64) -> usize {
        self.pieces[1..].partition_point(|summed| summed.piece.start <= at)
    }

    /// First and second antiderivative; for profiles that repeat without the mean and what is linear.
    fn sums(&self, at: f64) -> [[f64; 2]; LANES] {
        let at = self.folded(at);
        let summed = &self.pieces[self.piece(at)];
        summed.sums(at - summed.piece.start)
    }

    /// How far an input may bend within a sample before the mean is more than half of 1/255 off.
    pub(in crate::nodes) fn sampling(&self) -> Sampling {
        let period = self.range[1] - self.range[0];
        let ends = self.pieces[1..].iter().map(|next| next.piece.start);
        let ends: Vec<f64> = ends.chain([self.range[1]]).collect();
        let mut steepest = 0.0f64;
        for (index, summed) in self.pieces.iter().enumerate() {
            let width = (ends[index] - summed.piece.start).max(0.0);
            let next = match self.ends {
                Ends::Stay => self.pieces.get(index + 1),
                Ends::Repeat => Some(&self.pieces[(index + 1) % self.pieces.len()]),
            };
            for (lane, [c0, c1, c2, c3]) in summed.piece.cubic.iter().enumerate() {
                let slopes = [0.0, 0.5, 1.0].map(|share| {
                    let h = share * width;
                    (c1 + h * (2.0 * c2 + 3.0 * c3 * h)).abs()
                });
                steepest = slopes.into_iter().fold(steepest, f64::max);
                let end = c0 + width * (c1 + width * (c2 + width * c3));
                let jump = next.map_or(0.0, |next| (next.piece.cubic[lane][0] - end).abs());
                if jump > 1e-9 {
                    steepest = f64::INFINITY;
                }
            }
        }
        let absolute = (0.002 / steepest).clamp(1e-5 * period, period) as f32;
        Sampling::FilteredWhereStraight {
            column: 0,
            absolute,
            relative: 0.015,
        }
    }

    pub(in crate::nodes) fn add_to_key(&self, key: &mut KeyHasher) {
        key.whole(LANES as i64)
            .whole(i64::from(self.ends == Ends::Repeat));
        key.number(self.range[0]).number(self.range[1]);
        key.whole(self.pieces.len() as i64);
        for Summed { piece, .. } in &self.pieces {
            key.number(piece.start);
            piece.cubic.iter().flatten().for_each(|part| {
                key.number(*part);
            });
        }
        self.mean.iter().for_each(|part| {
            key.number(*part);
        });
    }
}

impl<const LANES: usize> Summed<LANES> {
    /// First and second antiderivative at the distance `h` from the start.
    fn sums(&self, h: f64) -> [[f64; 2]; LANES] {
        std::array::from_fn(|lane| {
            let [c0, c1, c2, c3] = self.piece.cubic[lane];
            let once = h * (c0 + h * (c1 / 2.0 + h * (c2 / 3.0 + h * (c3 / 4.0))));
            let twice = h * h * (c0 / 2.0 + h * (c1 / 6.0 + h * (c2 / 12.0 + h * (c3 / 20.0))));
            let [start, before] = [self.once[lane], self.twice[lane]];
            [start + once, before + start * h + twice]
        })
    }

    /// The mean around `middle` over inputs of this variance.
    fn mean(&self, middle: f64, variance: f64) -> [f64; LANES] {
        let h = middle - self.piece.start;
        self.piece.cubic.map(|[c0, c1, c2, c3]| {
            c0 + h * (c1 + h * (c2 + h * c3)) + variance * (c2 + 3.0 * c3 * h)
        })
    }
}

/// Adds a flat piece on both sides; the first reaches backwards from its start.
fn with_flat_ends<const LANES: usize>(pieces: Vec<Piece<LANES>>, end: f64) -> Vec<Piece<LANES>> {
    let flat = |start: f64, values: [f64; LANES]| Piece {
        start,
        cubic: values.map(|value| [value, 0.0, 0.0, 0.0]),
    };
    let first = &pieces[0];
    let before = flat(first.start, first.cubic.map(|cubic| cubic[0]));
    let last = &pieces[pieces.len() - 1];
    let width = end - last.start;
    let after = flat(
        end,
        last.cubic
            .map(|[c0, c1, c2, c3]| c0 + width * (c1 + width * (c2 + width * c3))),
    );
    [before].into_iter().chain(pieces).chain([after]).collect()
}

/// The cubic from `from` to `to` over `width` with the slopes at both ends (Hermite).
pub(in crate::nodes) fn hermite(width: f64, from: f64, to: f64, slopes: [f64; 2]) -> [f64; 4] {
    let mean = (to - from) / width;
    let [start, end] = slopes;
    [
        from,
        start,
        (3.0 * mean - 2.0 * start - end) / width,
        (start + end - 2.0 * mean) / (width * width),
    ]
}

/// A kernel that gives a profile of its one input.
#[derive(Debug)]
pub(in crate::nodes) struct Along<const LANES: usize> {
    /// The kind on whose behalf it runs, with its version.
    pub(super) kind: (&'static str, u32),
    /// The profile.
    pub(super) profile: Profile<LANES>,
}

impl<const LANES: usize> Kernel for Along<LANES> {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text(self.kind.0).whole(i64::from(self.kind.1));
        self.profile.add_to_key(key);
    }

    fn width(&self) -> usize {
        LANES
    }

    fn reads_spread(&self, column: usize) -> bool {
        column == 0
    }

    fn sampling(&self) -> Sampling {
        self.profile.sampling()
    }

    fn nanoseconds(&self) -> f32 {
        3.0 * LANES as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let input = block.inputs[0];
        for (index, value) in input.values.iter().enumerate() {
            let spread = input.spread.map(|along| f64::from(along[index]));
            let means = self.profile.mean(f64::from(*value), spread);
            for (output, mean) in block.outputs.iter_mut().zip(means) {
                output[index] = mean as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(ends: Ends) -> Profile<1> {
        let piece = |start, cubic| Piece {
            start,
            cubic: [cubic],
        };
        let pieces = vec![
            piece(0.0, hermite(0.25, 0.1, 0.9, [4.0, 0.0])),
            piece(0.25, [0.3, 0.0, 0.0, 0.0]),
            piece(0.6, [0.3, 1.5, 0.0, 0.0]),
        ];
        Profile::new(pieces, 1.0, ends)
    }

    /// The mean over 400 x 400 points of the sample.
    fn brute(profile: &Profile<1>, middle: f64, [a, b]: [f64; 2]) -> f64 {
        let at = |index: usize| (index as f64 + 0.5) / 400.0 - 0.5;
        let sum: f64 = (0..160_000)
            .map(|i| profile.mean(middle + a * at(i % 400) + b * at(i / 400), [0.0; 2])[0])
            .sum();
        sum / 160_000.0
    }

    #[test]
    fn means_are_those_of_many_points() {
        for ends in [Ends::Stay, Ends::Repeat] {
            let profile = ramp(ends);
            for middle in [-1.3, -0.01, 0.1, 0.251, 0.7, 0.99, 1.02, 5.3] {
                for spread in [
                    [0.01, 0.0],
                    [0.3, 0.1],
                    [-0.2, 0.2],
                    [0.5, -2.7],
                    [0.0001, 1.1],
                ] {
                    let mean = profile.mean(middle, spread)[0];
                    let brute = brute(&profile, middle, spread);
                    assert!(
                        (mean - brute).abs() < 2e-3,
                        "{ends:?} at {middle} over {spread:?}: {mean}, not {brute}"
                    );
                }
            }
        }
    }

    #[test]
    fn narrow_spreads_and_far_inputs_lose_nothing() {
        let profile = ramp(Ends::Repeat);
        // Integrals by hand: the first cubic (0.1 + 0.9)/2 * 0.25 + 0.25^2 * 4/12, then 0.35 * 0.3, 0.4 * 0.6.
        let mean = 0.125 + 0.25 / 12.0 + 0.105 + 0.24;
        assert!((profile.mean(7e4, [1e6, 3e5])[0] - mean).abs() < 1e-6);
        assert!((profile.mean(0.7, [1e-7, 1e-7])[0] - 0.45).abs() < 1e-12);
        let ends = ramp(Ends::Stay);
        assert!((ends.mean(1e20, [3.0, 2.0])[0] - 0.9).abs() < 1e-9);
        assert!((ends.mean(-1e20, [3.0, 2.0])[0] - 0.1).abs() < 1e-9);
        assert!(ends.mean(f64::NAN, [f64::NAN, 1.0])[0].is_finite());
        assert!(profile.mean(f64::INFINITY, [f64::INFINITY, 0.0])[0].is_finite());
    }
}
