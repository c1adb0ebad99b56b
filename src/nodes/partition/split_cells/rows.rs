//! Rows of bricks or boards.

use super::laid::{Closed, Laid, steps};
use crate::node::{Failure, Inputs};
use crate::nodes::random::Random;
use glam::DVec2;

/// Rows, one above the other.
pub(super) struct Rows {
    /// Length and width of a piece.
    pub(super) piece: DVec2,
    bond: &'static str,
    lengths: [f64; 2],
    widths: [f64; 2],
}

impl Rows {
    pub(super) fn read(
        inputs: &Inputs<'_>,
        piece: DVec2,
        period: Option<DVec2>,
    ) -> Result<Rows, Failure> {
        let lengths = inputs.get("lengths").map(|_| inputs.pair("lengths"));
        let rows = Rows {
            piece,
            bond: inputs.choice("bond"),
            lengths: lengths.unwrap_or([1.0, 1.0]),
            widths: inputs.pair("widths"),
        };
        for (input, [low, high]) in [("lengths", rows.lengths), ("widths", rows.widths)] {
            if low > high {
                let message = format!("`{input}` goes from {low} down to {high}");
                return Err(
                    Failure::of_input(input, message).with_hint("write the smaller number first")
                );
            }
        }
        if let Some(period) = period
            && (period.x < 0.5 * piece.x || period.y < 0.5 * piece.y)
        {
            return Err(Failure::of_input(
                "period",
                "the period is smaller than half a piece",
            ));
        }
        Ok(rows)
    }

    /// How far a row is shifted, in pieces.
    fn shift(&self, row: i32, random: &mut Random) -> f64 {
        match self.bond {
            "stack" => 0.0,
            "running" => f64::from(row.rem_euclid(2)) / 2.0,
            "third" => f64::from(row.rem_euclid(3)) / 3.0,
            _ => f64::from(random.share()),
        }
    }

    fn drawn([low, high]: [f64; 2], random: &mut Random) -> f64 {
        low + (high - low) * f64::from(random.share())
    }

    /// Rows that cover a box.
    pub(super) fn cover(&self, [low, high]: [DVec2; 2], random: &mut Random) -> Vec<Laid> {
        let mut laid = vec![];
        let is_even = self.widths[0] == self.widths[1];
        let width = self.piece.y * self.widths[0];
        let first = if is_even {
            *steps(low.y, high.y, width).start()
        } else {
            0
        };
        // Rows of many widths begin at the box, those of one at the origin.
        let mut bottom = if is_even {
            f64::from(first) * width
        } else {
            low.y
        };
        let mut row = first;
        while bottom < high.y {
            let top = match is_even {
                true => f64::from(row + 1) * width,
                false => bottom + self.piece.y * Rows::drawn(self.widths, random),
            };
            self.row([low.x, high.x], [bottom, top], row, random, &mut laid);
            (bottom, row) = (top, row + 1);
        }
        laid
    }

    fn row(
        &self,
        [left, right]: [f64; 2],
        [bottom, top]: [f64; 2],
        row: i32,
        random: &mut Random,
        laid: &mut Vec<Laid>,
    ) {
        let is_even = self.lengths[0] == self.lengths[1];
        let length = self.piece.x * self.lengths[0];
        let shift = self.shift(row, random);
        let column = ((left / length) - shift).floor() as i32;
        let mut column = if is_even { column } else { 0 };
        let at = |column: i32| (f64::from(column) + shift) * length;
        let mut from = if is_even {
            at(column)
        } else {
            left - shift * self.piece.x
        };
        while from < right {
            let to = match is_even {
                true => at(column + 1),
                false => from + self.piece.x * Rows::drawn(self.lengths, random),
            };
            let size = DVec2::new(to - from, top - bottom);
            let corners = vec![
                DVec2::new(from, bottom),
                DVec2::new(to, bottom),
                DVec2::new(to, top),
                DVec2::new(from, top),
            ];
            let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
            laid.push(Laid::straight(corners, along, [row, column]));
            (from, column) = (to, column + 1);
        }
    }

    /// Rows that close after a period.
    pub(super) fn closed(&self, period: DVec2, random: &mut Random) -> Closed {
        let mean = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let wanted = self.piece * DVec2::new(mean(self.lengths), mean(self.widths));
        let multiple = match self.bond {
            "running" => 2.0,
            "third" => 3.0,
            _ => 1.0,
        };
        let counts = DVec2::new(
            (period.x / wanted.x).round().max(1.0),
            (period.y / wanted.y / multiple).round().max(1.0) * multiple,
        );
        let heights = Rows::summing_to(period.y, counts.y as usize, self.widths, random);
        let mut laid = vec![];
        let mut bottom = 0.0;
        for (row, top) in heights.into_iter().enumerate() {
            let ends = Rows::summing_to(period.x, counts.x as usize, self.lengths, random);
            let shift = self.shift(row as i32, random) * period.x / counts.x;
            let mut from = 0.0;
            for (column, to) in ends.into_iter().enumerate() {
                let low = DVec2::new(from + shift, bottom);
                let high = DVec2::new(to + shift, top);
                let corners = vec![
                    low,
                    DVec2::new(high.x, low.y),
                    high,
                    DVec2::new(low.x, high.y),
                ];
                let size = high - low;
                let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
                laid.push(Laid::straight(corners, along, [row as i32, column as i32]));
                from = to;
            }
            bottom = top;
        }
        Closed {
            pieces: laid,
            stretched: period / counts / wanted,
        }
    }

    /// Where `count` parts of random lengths end that fill `total`.
    fn summing_to(total: f64, count: usize, range: [f64; 2], random: &mut Random) -> Vec<f64> {
        let parts: Vec<f64> = (0..count).map(|_| Rows::drawn(range, random)).collect();
        let sum: f64 = parts.iter().sum();
        let mut end = 0.0;
        let mut ends: Vec<f64> = parts
            .iter()
            .map(|part| {
                end += part;
                total * (end / sum)
            })
            .collect();
        if let Some(last) = ends.last_mut() {
            *last = total;
        }
        ends
    }
}
