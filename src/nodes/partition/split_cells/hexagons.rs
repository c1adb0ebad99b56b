//! Regular hexagons.

use super::ground::{Laid, Tile, Window};
use glam::DVec2;

/// Lays hexagons with this distance from flat to flat, flats up and down the columns.
pub(super) fn lay(window: &Window, width: f64) -> Laid {
    let along = window.steps(0, 0.5 * width, 2);
    let across = window.steps(1, width * 0.75_f64.sqrt(), 2);
    // Corners lie on a lattice of half widths and of thirds of rows.
    let at = |half: i64, third: i64| {
        DVec2::new(half as f64 * along.step, third as f64 * across.step / 3.0)
    };
    let mut tiles = vec![];
    for row in across.first..across.end + i64::from(window.period.is_none()) {
        for half in along.first..along.end + i64::from(window.period.is_none()) {
            if (half + row).rem_euclid(2) == 1 {
                continue;
            }
            let third = 3 * row;
            let around = [(1, -1), (1, 1), (0, 2), (-1, 1), (-1, -1), (0, -2)];
            let corners: Vec<DVec2> = around
                .iter()
                .map(|(x, y)| at(half + x, third + y))
                .collect();
            let values = vec![
                ("row", row as f64),
                ("column", (half - row).div_euclid(2) as f64),
                ("length", 2.0 * along.step),
            ];
            if window.is_near(at(half - 1, third - 2), at(half + 1, third + 2)) {
                tiles.push(Tile::straight(corners, DVec2::X, values));
            }
        }
    }
    Laid::over(tiles, [along.stretch, across.stretch])
}
