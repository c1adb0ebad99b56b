//! Positions in the rings of a pattern: 0 where a ring starts, towards 1 at its end.

use super::span::{Ends, Spans};
use super::table::Lanes;

/// Rings with their starts and widths in pieces of the table.
#[derive(Debug)]
pub(super) struct Rings {
    starts: Vec<f64>,
    reciprocals: Vec<f64>,
    /// For each piece inside which a ring starts the ring before that; `None` for others.
    split: Vec<Option<u32>>,
}

impl Rings {
    /// The rings of a table of `count` pieces, from their starts between 0 and 1.
    pub(super) fn new(starts: &[f64], count: usize) -> Rings {
        // 5 / 47 * 47 has to be 5, or the first sample of a year would fall into the year before.
        let start = |start: &f64| {
            let start = start * count as f64;
            if (start - start.round()).abs() < 1e-9 {
                start.round()
            } else {
                start
            }
        };
        let starts: Vec<f64> = starts.iter().map(start).collect();
        let whole = count as f64;
        let ends = starts.iter().skip(1).chain([&whole]);
        let reciprocals = starts
            .iter()
            .zip(ends)
            .map(|(start, end)| 1.0 / (end - start));
        let mut rings = Rings {
            reciprocals: reciprocals.collect(),
            starts,
            split: vec![],
        };
        let split = |piece: usize| {
            let ring = rings.ring(0, piece as f64);
            let next = rings.starts.get(ring + 1);
            next.filter(|start| **start < (piece + 1) as f64)
                .map(|_| ring as u32)
        };
        // A table has a piece before its start and one behind its end.
        rings.split = std::iter::once(None)
            .chain((0..count).map(split))
            .chain([None])
            .collect();
        rings
    }

    pub(super) fn are_several(&self) -> bool {
        self.starts.len() > 1
    }

    /// The position at the start of a piece and how much it rises up to its end.
    pub(super) fn along_piece(&self, piece: usize) -> (f64, f64) {
        let ring = self.ring(0, piece as f64);
        let reciprocal = self.reciprocals[ring];
        ((piece as f64 - self.starts[ring]) * reciprocal, reciprocal)
    }

    /// The integral of the position up to a place, in pieces: over a whole ring it is half the width.
    pub(super) fn integral(&self, at: f64) -> f64 {
        self.integral_in(self.ring(0, at), at)
    }

    fn integral_in(&self, ring: usize, at: f64) -> f64 {
        let along = at - self.starts[ring];
        0.5 * self.starts[ring] + 0.5 * along * along * self.reciprocals[ring]
    }

    /// The ring that holds a place, if it is not before `first`.
    fn ring(&self, first: usize, at: f64) -> usize {
        let after = self.starts[first + 1..].iter();
        first + after.take_while(|start| **start <= at).count()
    }

    /// Replaces the mean positions of spans that start or end in a piece in which a ring starts: it is not
    /// linear there.
    pub(super) fn correct(&self, spans: &Spans, means: &mut [Lanes], period: f64) {
        let used = spans.used_ends();
        for (index, mean) in means.iter_mut().enumerate() {
            let is_split = |ends: &Ends| self.split[ends.piece[index] as usize].is_some();
            if used.iter().any(is_split) {
                mean[3] = self.mean(spans, index, period) as f32;
            }
        }
    }

    fn mean(&self, spans: &Spans, index: usize, period: f64) -> f64 {
        let at = |ends: &Ends| f64::from(ends.piece[index] - 1) + ends.along[index];
        let ring = |ends: &Ends| {
            let known = self.split[ends.piece[index] as usize].unwrap_or(0);
            self.ring(known as usize, at(ends))
        };
        let [low, ..] = &spans.ends;
        if spans.scale[index] == 0.0 {
            let ring = ring(low);
            return (at(low) - self.starts[ring]) * self.reciprocals[ring];
        }
        let count = self.split.len() as f64 - 2.0;
        let integral = |ends: &Ends| match at(ends) {
            before if before < 0.0 => 0.0,
            after if after > count => self.integral(count) + (after - count),
            inside => self.integral_in(ring(ends), inside),
        };
        let boxes = spans.used_ends().chunks_exact(2);
        let sum: f64 = boxes
            .map(|ends| integral(&ends[1]) - integral(&ends[0]))
            .sum();
        (sum + spans.periods[index] * period) * spans.scale[index]
    }
}
