//! The slope of a surface of heights for shading: smooth where the heights are, and steps keep to one cell.

use super::Heights;
use glam::DVec2;

impl Heights {
    /// The slope over a place along both axes: that of cubics through the corners in each row and column which turn
    /// only where the corners do (Fritsch & Carlson 1980, with the harmonic mean of Fritsch & Butland 1984).
    pub(crate) fn slope(&self, place: DVec2) -> DVec2 {
        let (cell, at) = self.cell_at(place);
        let along_row = |y: usize| {
            let [before, a, b, behind] = self.four(cell[0], self.cells[0], |x| [x, y]);
            rise([before, a, b, behind], at.x)
        };
        let along_column = |x: usize| {
            let [before, a, b, behind] = self.four(cell[1], self.cells[1], |y| [x, y]);
            rise([before, a, b, behind], at.y)
        };
        let [x, y] = cell;
        let mixed = DVec2::new(
            along_row(y) * (1.0 - at.y) + along_row(y + 1) * at.y,
            along_column(x) * (1.0 - at.x) + along_column(x + 1) * at.x,
        );
        mixed / self.cell
    }

    /// Four corners of a row or column around a cell; beyond the rim the surface goes on as it was.
    fn four(&self, first: usize, cells: usize, corner: impl Fn(usize) -> [usize; 2]) -> [f64; 4] {
        let height = |index: usize| self.corner(corner(index));
        let (a, b) = (height(first), height(first + 1));
        let before = match first {
            0 => 2.0 * a - b,
            _ => height(first - 1),
        };
        let behind = match first + 1 == cells {
            true => 2.0 * b - a,
            false => height(first + 2),
        };
        [before, a, b, behind]
    }
}

/// The slope of the cubic between the middle two of four heights, `at` from 0 to 1.
fn rise([before, a, b, behind]: [f64; 4], at: f64) -> f64 {
    let (first, second, third) = (a - before, b - a, behind - b);
    let (start, end) = (harmonic(first, second), harmonic(second, third));
    let square = at * at;
    6.0 * second * (at - square)
        + start * (1.0 - 4.0 * at + 3.0 * square)
        + end * (3.0 * square - 2.0 * at)
}

/// The harmonic mean of two steps; 0 where they run against each other.
fn harmonic(a: f64, b: f64) -> f64 {
    if a * b > 0.0 {
        2.0 * a * b / (a + b)
    } else {
        0.0
    }
}
