//! Boards and bricks in rows, each row moved against the last.

use super::ground::{Laid, Steps, Tile, Window};
use crate::node::{Failure, Inputs};
use crate::nodes::random::Random;
use glam::DVec2;

/// How rows are moved against each other.
pub(super) const BONDS: [&str; 4] = ["running", "third", "stack", "random"];

/// What rows are made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    bond: &'static str,
    /// Between which shares of the length and of the width boards are.
    shares: [[f64; 2]; 2],
}

/// The item whose random numbers are the widths of rows.
const WIDTHS: u32 = u32::MAX;

impl Rows {
    /// What the inputs state.
    ///
    /// # Errors
    /// If the range of the lengths or of the widths is none.
    pub(super) fn read(inputs: &Inputs<'_>) -> Result<Rows, Failure> {
        let shares = ["lengths", "widths"].map(|name| inputs.pair(name));
        for (name, [low, high]) in ["lengths", "widths"].into_iter().zip(shares) {
            if low > high {
                let message =
                    format!("expected a range from low to high, found from {low} to {high}");
                return Err(Failure::of_input(name, message));
            }
        }
        let bond = inputs.choice("bond");
        Ok(Rows { bond, shares })
    }

    /// Rows that are not moved, of equal boards.
    pub(super) fn grid() -> Rows {
        Rows {
            bond: "stack",
            shares: [[1.0; 2]; 2],
        }
    }

    /// After how many rows the bond repeats.
    fn cycle(self) -> i64 {
        match self.bond {
            "running" => 2,
            "third" => 3,
            _ => 1,
        }
    }

    /// By how much of a board a row is moved.
    fn moved(self, row: i64, random: &mut Random) -> f64 {
        // Joints of boards of unequal lengths would meet only where all rows begin.
        if self.bond == "random" || is_range(self.shares[0]) {
            return f64::from(random.share());
        }
        row.rem_euclid(self.cycle()) as f64 / self.cycle() as f64
    }
}

fn is_range([low, high]: [f64; 2]) -> bool {
    low != high
}

/// Lays boards in rows.
pub(super) fn lay(
    window: &Window,
    board: DVec2,
    rows: Rows,
    random: Random,
    go_on: &mut dyn FnMut() -> Result<(), Failure>,
) -> Result<Laid, Failure> {
    let mean = |axis: usize| board[axis] * 0.5 * (rows.shares[axis][0] + rows.shares[axis][1]);
    let along = window.steps(0, mean(0), 1);
    let across = window.steps(1, mean(1), rows.cycle());
    let borders = Joints::new(window, 1, across, rows.shares[1]);
    let borders = borders.places(0.0, &mut random.of_item(WIDTHS));
    let joints = Joints::new(window, 0, along, rows.shares[0]);
    let mut tiles = vec![];
    for (row, sides) in (borders.first..).zip(borders.ends.windows(2)) {
        go_on()?;
        let mut random = random.of_item(row as u32);
        let moved = rows.moved(row, &mut random);
        let joints = joints.places(moved, &mut random);
        for (column, ends) in (joints.first..).zip(joints.ends.windows(2)) {
            let values = vec![
                ("row", row as f64),
                ("column", column as f64),
                ("length", ends[1] - ends[0]),
            ];
            let [low, high] = [0, 1].map(|end| DVec2::new(ends[end], sides[end]));
            if window.is_near(low, high) {
                tiles.push(Tile::rectangle(low, high, DVec2::X, values));
            }
        }
    }
    Ok(Laid::over(tiles, [along.stretch, across.stretch]))
}

/// How boards follow each other along an axis.
struct Joints<'a> {
    window: &'a Window,
    axis: usize,
    steps: Steps,
    shares: [f64; 2],
}

/// Where boards begin, and where the last ends.
struct Places {
    /// The number of the first board.
    first: i64,
    ends: Vec<f64>,
}

impl Joints<'_> {
    fn new(window: &Window, axis: usize, steps: Steps, shares: [f64; 2]) -> Joints<'_> {
        Joints {
            window,
            axis,
            steps,
            shares,
        }
    }

    /// Where boards begin if the first is moved by a share of a step.
    fn places(&self, moved: f64, random: &mut Random) -> Places {
        let steps = self.steps;
        if !is_range(self.shares) {
            let end = |number: i64| (number as f64 + moved) * steps.step;
            return Places {
                first: steps.first,
                ends: (steps.first..=steps.end).map(end).collect(),
            };
        }
        let ends = match self.window.period {
            None => self.covering(moved, random),
            Some(period) => self.closing(moved, period[self.axis], random),
        };
        Places { first: 0, ends }
    }

    /// The length of a board.
    fn length(&self, random: &mut Random) -> f64 {
        let share = 2.0 / (self.shares[0] + self.shares[1]);
        self.steps.step * share * random.between(self.shares)
    }

    /// Boards from before the window until behind it.
    fn covering(&self, moved: f64, random: &mut Random) -> Vec<f64> {
        let (low, high) = (self.window.low[self.axis], self.window.high[self.axis]);
        let mut end = low - moved.max(0.01) * self.length(random);
        let mut ends = vec![end];
        while end < high {
            end += self.length(random);
            ends.push(end);
        }
        ends
    }

    /// Boards that fill a period.
    fn closing(&self, moved: f64, period: f64, random: &mut Random) -> Vec<f64> {
        let count = self.steps.first..self.steps.end;
        let lengths: Vec<f64> = count.map(|_| self.length(random)).collect();
        let scale = period / lengths.iter().sum::<f64>();
        let start = moved * period;
        let mut sum = 0.0;
        let mut ends = vec![start];
        for length in &lengths[..lengths.len() - 1] {
            sum += length * scale;
            ends.push(start + sum);
        }
        ends.push(start + period);
        ends
    }
}
