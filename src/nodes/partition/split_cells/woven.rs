//! Boards in two directions: herringbone, basket, chevron.

use super::ground::{Laid, Tile, Window};
use crate::node::Failure;
use glam::DVec2;

/// A length may be off a whole number of widths by this share of one.
const WHOLE: f64 = 1e-6;

/// Herringbone: blocks of `beside` boards side by side, each block as long as a whole number of its widths, that end at the
/// flank of the next.
///
/// In widths of a block, with n the length, blocks along the first axis are those at (0, 0) to (n, 1), those across at
/// (n, 1 - n) to (n + 1, 1), both moved by all multiples of (1, 1) and (2n, 0).
///
/// # Errors
/// If the length is no whole number of widths.
pub(super) fn herringbone(window: &Window, board: DVec2, beside: i64) -> Result<Laid, Failure> {
    let width = board.y * beside as f64;
    let ratio = whole_ratio(board.x, width, beside)?;
    let unit = 2.0 * board.x;
    let steps = [0, 1].map(|axis| window.steps(axis, unit, 1));
    // The size of a width along each axis.
    let scale = DVec2::new(steps[0].step, steps[1].step) / (2 * ratio) as f64;
    let mut tiles = vec![];
    let mut lay = |low: DVec2, across: bool, row: i64, column: i64| {
        let size = if across {
            DVec2::new(1.0, ratio as f64)
        } else {
            DVec2::new(ratio as f64, 1.0)
        };
        for board in 0..beside {
            let [from, to] = [board, board + 1].map(|board| board as f64 / beside as f64);
            let [from, to] = match across {
                true => [DVec2::new(from, 0.0), DVec2::new(to, size.y)],
                false => [DVec2::new(0.0, from), DVec2::new(size.x, to)],
            };
            let [from, to] = [(low + from) * scale, (low + to) * scale];
            let along = if across { DVec2::Y } else { DVec2::X };
            let long = (to - from).dot(along);
            let values = vec![
                ("row", row as f64),
                ("column", column as f64),
                ("length", long),
            ];
            if window.is_near(from, to) {
                tiles.push(Tile::rectangle(from, to, along, values));
            }
        }
    };
    let rows = 2 * ratio * steps[1].first..2 * ratio * steps[1].end;
    for row in rows {
        for column in steps[0].first - 1..steps[0].end + 1 {
            if window.period.is_some() && !(steps[0].first..steps[0].end).contains(&column) {
                continue;
            }
            let at = DVec2::new(
                (row.rem_euclid(2 * ratio) + 2 * ratio * column) as f64,
                row as f64,
            );
            lay(at, false, row, column);
            lay(
                at + DVec2::new(ratio as f64, (1 - ratio) as f64),
                true,
                row,
                column,
            );
        }
    }
    Ok(Laid::over(tiles, steps.map(|steps| steps.stretch)))
}

/// Basket weave: square blocks of boards, along and across in turn.
///
/// # Errors
/// If the length is no whole number of widths.
pub(super) fn basket(window: &Window, board: DVec2) -> Result<Laid, Failure> {
    let ratio = whole_ratio(board.x, board.y, 1)?;
    let [along, across] = [0, 1].map(|axis| window.steps(axis, board.x, 2));
    let mut tiles = vec![];
    for row in across.first..across.end {
        for column in along.first..along.end {
            let at = |x: f64, y: f64| {
                DVec2::new(
                    (column as f64 + x) * along.step,
                    (row as f64 + y) * across.step,
                )
            };
            if !window.is_near(at(0.0, 0.0), at(1.0, 1.0)) {
                continue;
            }
            let upright = (row + column).rem_euclid(2) == 1;
            for board in 0..ratio {
                let [from, to] = [board, board + 1].map(|board| board as f64 / ratio as f64);
                let values = vec![
                    ("row", row as f64),
                    ("column", column as f64),
                    ("length", if upright { across.step } else { along.step }),
                ];
                tiles.push(match upright {
                    true => Tile::rectangle(at(from, 0.0), at(to, 1.0), DVec2::Y, values),
                    false => Tile::rectangle(at(0.0, from), at(1.0, to), DVec2::X, values),
                });
            }
        }
    }
    Ok(Laid::over(tiles, [along.stretch, across.stretch]))
}

/// Chevron: columns of boards with slanted ends, rising and falling in turn.
pub(super) fn chevron(window: &Window, board: DVec2, slope: f64) -> Laid {
    let along = window.steps(0, board.x * libm::cos(slope), 2);
    let across = window.steps(1, board.y / libm::cos(slope), 1);
    let rise = along.step * libm::tan(slope);
    let more = if window.period.is_some() {
        0
    } else {
        (rise / across.step).ceil() as i64 + 1
    };
    let mut tiles = vec![];
    for column in along.first..along.end {
        let falls = column.rem_euclid(2) == 1;
        let [left, right] = [column, column + 1].map(|column| column as f64 * along.step);
        let [from, to] = if falls { [rise, 0.0] } else { [0.0, rise] };
        for row in across.first - more..across.end {
            let [low, high] = [row, row + 1].map(|row| row as f64 * across.step);
            let corners = vec![
                DVec2::new(left, low + from),
                DVec2::new(right, low + to),
                DVec2::new(right, high + to),
                DVec2::new(left, high + from),
            ];
            let axis = corners[1] - corners[0];
            let values = vec![
                ("row", row as f64),
                ("column", column as f64),
                ("length", axis.length()),
            ];
            if window.is_near(DVec2::new(left, low), DVec2::new(right, high + rise)) {
                tiles.push(Tile::straight(corners, axis.normalize(), values));
            }
        }
    }
    Laid::over(tiles, [along.stretch, across.stretch])
}

/// How many widths make a length.
fn whole_ratio(length: f64, width: f64, beside: i64) -> Result<i64, Failure> {
    let ratio = length / width;
    if ratio.round() < 1.0 || (ratio - ratio.round()).abs() > WHOLE {
        let boards = if beside == 1 {
            "the width"
        } else {
            "two widths"
        };
        let message = format!(
            "expected a length that is a whole number of times {boards}, found {ratio:.3} times"
        );
        let nearest = ratio.round().max(1.0) * width;
        return Err(Failure::of_input("length", message)
            .with_hint(format!("the nearest such length is {nearest} mm")));
    }
    Ok(ratio.round() as i64)
}
