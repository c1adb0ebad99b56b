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
    /// Shares of the length.
    lengths: [f64; 2],
}

impl Rows {
    /// What the inputs state.
    ///
    /// # Errors
    /// If the range of the lengths is none.
    pub(super) fn read(inputs: &Inputs<'_>) -> Result<Rows, Failure> {
        let lengths = inputs.pair("lengths");
        if lengths[0] > lengths[1] {
            let message = format!(
                "expected a range from low to high, found from {} to {}",
                lengths[0], lengths[1]
            );
            return Err(Failure::of_input("lengths", message));
        }
        let bond = inputs.choice("bond");
        Ok(Rows { bond, lengths })
    }

    /// Rows that are not moved, of equal boards.
    pub(super) fn grid() -> Rows {
        Rows {
            bond: "stack",
            lengths: [1.0; 2],
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
}

/// Lays boards in rows.
pub(super) fn lay(
    window: &Window,
    board: DVec2,
    rows: Rows,
    random: Random,
    go_on: &mut dyn FnMut() -> Result<(), Failure>,
) -> Result<Laid, Failure> {
    let across = window.steps(1, board.y, rows.cycle());
    let mean = board.x * 0.5 * (rows.lengths[0] + rows.lengths[1]);
    let along = window.steps(0, mean, 1);
    let mut tiles = vec![];
    for row in across.first..across.end {
        go_on()?;
        let mut random = random.of_item(row as u32);
        let moved = match rows.bond {
            "random" => f64::from(random.share()),
            // Joints of boards of unequal lengths would meet only where all rows begin.
            _ if rows.lengths[0] != rows.lengths[1] => f64::from(random.share()),
            _ => row.rem_euclid(rows.cycle()) as f64 / rows.cycle() as f64,
        };
        let joints = joints(window, along, rows.lengths, moved, &mut random);
        let [low, high] = [row, row + 1].map(|row| row as f64 * across.step);
        let first = if rows.lengths[0] == rows.lengths[1] {
            along.first
        } else {
            0
        };
        for (column, ends) in (first..).zip(joints.windows(2)) {
            let values = vec![
                ("row", row as f64),
                ("column", column as f64),
                ("length", ends[1] - ends[0]),
            ];
            let [low, high] = [DVec2::new(ends[0], low), DVec2::new(ends[1], high)];
            if window.is_near(low, high) {
                tiles.push(Tile::rectangle(low, high, DVec2::X, values));
            }
        }
    }
    Ok(Laid::over(tiles, [along.stretch, across.stretch]))
}

/// Where the boards of a row begin, and where the last ends.
fn joints(
    window: &Window,
    along: Steps,
    lengths: [f64; 2],
    moved: f64,
    random: &mut Random,
) -> Vec<f64> {
    if lengths[0] == lengths[1] {
        let joint = |column: i64| (column as f64 + moved) * along.step;
        return (along.first..=along.end).map(joint).collect();
    }
    let share = 2.0 / (lengths[0] + lengths[1]);
    let mut length = || along.step * share * random.between(lengths);
    let Some(period) = window.period else {
        let mut joints = vec![window.low.x - moved.max(0.01) * length()];
        while joints[joints.len() - 1] < window.high.x {
            joints.push(joints[joints.len() - 1] + length());
        }
        return joints;
    };
    let lengths: Vec<f64> = (along.first..along.end).map(|_| length()).collect();
    let scale = period.x / lengths.iter().sum::<f64>();
    let start = moved * period.x;
    let mut joints = vec![start];
    let mut sum = 0.0;
    for length in &lengths[..lengths.len() - 1] {
        sum += length * scale;
        joints.push(start + sum);
    }
    joints.push(start + period.x);
    joints
}
