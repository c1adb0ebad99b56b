//! A surface of heights over a rectangle: corners on a grid, between four of which the height is bilinear, with the
//! greatest height over squares of cells, so that lines pass over what lies below them (Tevs and others 2008).

mod horizon;
mod line;
mod meeting;
mod slope;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

pub(crate) use self::horizon::Rises;

/// Heights over the rectangle from the origin to `size`.
#[derive(Debug)]
pub(crate) struct Heights {
    /// Number of cells along each axis.
    cells: [usize; 2],
    /// Width and height of a cell.
    cell: DVec2,
    /// Heights at the corners of cells, row after row from the origin on.
    corners: Vec<f32>,
    /// The greatest height over squares of 2, 4, 8 ... cells a side, up to one square over all.
    levels: Vec<Level>,
    /// The least and the greatest height.
    range: [f64; 2],
}

/// The greatest heights over squares of cells.
#[derive(Debug)]
struct Level {
    columns: usize,
    greatest: Vec<f32>,
}

impl Heights {
    /// A surface of `cells` over `size`, both more than 0, from one finite height for each corner of a cell.
    pub(crate) fn new(cells: [usize; 2], size: DVec2, corners: Vec<f32>) -> Heights {
        let [columns, rows] = cells;
        assert_eq!(
            corners.len(),
            (columns + 1) * (rows + 1),
            "a height a corner"
        );
        let least = corners.iter().copied().fold(f32::INFINITY, f32::min);
        let greatest = corners.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let mut heights = Heights {
            cells,
            cell: size / DVec2::new(columns as f64, rows as f64),
            corners,
            levels: vec![],
            range: [f64::from(least), f64::from(greatest)],
        };
        let of_cell = |x: usize, y: usize| heights.greatest_in_cell([x, y]);
        let mut levels = vec![Level::over([columns, rows], of_cell)];
        while levels[levels.len() - 1].greatest.len() > 1 {
            let below = &levels[levels.len() - 1];
            let sides = [below.columns, below.greatest.len() / below.columns];
            let of_square = |x: usize, y: usize| below.greatest[y * below.columns + x];
            levels.push(Level::over(sides, of_square));
        }
        heights.levels = levels;
        heights
    }

    /// Number of cells along each axis.
    pub(crate) fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// The least and the greatest height.
    pub(crate) fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Where a corner of the surface is.
    pub(crate) fn point(&self, [x, y]: [usize; 2]) -> DVec3 {
        (self.cell * DVec2::new(x as f64, y as f64)).extend(self.corner([x, y]))
    }

    /// The height of a corner.
    fn corner(&self, [x, y]: [usize; 2]) -> f64 {
        f64::from(self.corners[y * (self.cells[0] + 1) + x])
    }

    /// Whether a place lies over the rectangle.
    pub(crate) fn is_over(&self, place: DVec2) -> bool {
        (0..2).all(|axis| (0.0..=self.cell[axis] * self.cells[axis] as f64).contains(&place[axis]))
    }

    /// The shorter side of a cell.
    pub(crate) fn finest(&self) -> f64 {
        self.cell.min_element()
    }

    /// The cell over a place, or the nearest, and where in it the place lies, from 0 to 1.
    pub(crate) fn cell_at(&self, place: DVec2) -> ([usize; 2], DVec2) {
        let scaled = place / self.cell;
        let index = |axis: usize| (scaled[axis].max(0.0) as usize).min(self.cells[axis] - 1);
        let cell = [index(0), index(1)];
        let within = scaled - DVec2::new(cell[0] as f64, cell[1] as f64);
        (cell, within.clamp(DVec2::ZERO, DVec2::ONE))
    }

    /// The height over a place.
    pub(crate) fn height(&self, place: DVec2) -> f64 {
        let (cell, at) = self.cell_at(place);
        let [a, b, c, d] = self.around(cell);
        (a + (b - a) * at.x) * (1.0 - at.y) + (c + (d - c) * at.x) * at.y
    }

    /// The heights of a cell's corners: two from left to right, and two above them.
    #[inline]
    fn around(&self, [x, y]: [usize; 2]) -> [f64; 4] {
        let width = self.cells[0] + 1;
        let first = y * width + x;
        [first, first + 1, first + width, first + width + 1].map(|at| f64::from(self.corners[at]))
    }

    /// The greatest height in a cell.
    fn greatest_in_cell(&self, cell: [usize; 2]) -> f32 {
        self.around(cell)
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max) as f32
    }

    /// The greatest height over the square of `2^level` cells a side, at least 2, that holds a cell.
    #[inline]
    fn greatest(&self, [x, y]: [usize; 2], level: usize) -> f64 {
        let it = &self.levels[level - 1];
        f64::from(it.greatest[(y >> level) * it.columns + (x >> level)])
    }
}

impl Level {
    /// The greatest of each two by two of `sides` values.
    fn over(sides: [usize; 2], of: impl Fn(usize, usize) -> f32) -> Level {
        let halves = sides.map(|side| side.div_ceil(2));
        let square = |index: usize| {
            let [x, y] = [index % halves[0] * 2, index / halves[0] * 2];
            let [right, above] = [(x + 1).min(sides[0] - 1), (y + 1).min(sides[1] - 1)];
            of(x, y)
                .max(of(right, y))
                .max(of(x, above))
                .max(of(right, above))
        };
        Level {
            columns: halves[0],
            greatest: (0..halves[0] * halves[1]).map(square).collect(),
        }
    }
}
