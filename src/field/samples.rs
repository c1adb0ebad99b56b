//! Where a program is sampled: pixels of a target, or points of the caller's own.

use crate::key::{Key, KeyHasher};

/// What an output is painted on: gives every pixel a position.
pub trait Target: Send + Sync {
    /// Identifies the mapping from pixels to positions.
    fn key(&self) -> Key;

    /// Width and height in pixels.
    fn pixels(&self) -> [u32; 2];

    /// Writes the positions in mm of a row of samples: the first at pixel coordinates (x, y), the next
    /// `step` pixels to the right. The centre of the first pixel is (0.5, 0.5), y points down. Defined
    /// outside the picture as well, since margins reach there.
    fn write_row(&self, x: f64, y: f64, step: f64, row: [&mut [f32]; 3]);

    /// Writes what rounding to f32 took from the first part of the positions of a row; 0 where it is not known.
    fn write_remainders(&self, x: f64, y: f64, step: f64, row: &mut [f32]) {
        let _ = (x, y, step);
        row.fill(0.0);
    }
}

/// Equal grids of samples laid one after the other: one for a tile, many small ones where single
/// pixels are supersampled.
#[derive(Clone, Debug)]
pub struct PixelGrid {
    /// Samples in a row of a grid.
    pub width: usize,
    /// Rows of a grid.
    pub height: usize,
    /// Distance between samples in pixels.
    pub step: f64,
    /// Samples at each side that serve only as neighbours.
    pub margin: usize,
    /// Pixel coordinates of the first sample of each grid.
    pub origins: Vec<[f64; 2]>,
}

impl PixelGrid {
    /// The pixels of a rectangle with a margin on all sides.
    pub fn tile(corner: [u32; 2], size: [u32; 2], margin: usize) -> PixelGrid {
        let first = |corner: u32| f64::from(corner) + 0.5 - margin as f64;
        PixelGrid {
            width: size[0] as usize + 2 * margin,
            height: size[1] as usize + 2 * margin,
            step: 1.0,
            margin,
            origins: vec![[first(corner[0]), first(corner[1])]],
        }
    }

    /// `count` x `count` samples in each of the pixels whose indices are given, with a margin.
    pub fn within_pixels(&self, indices: &[u32], count: usize, margin: usize) -> PixelGrid {
        let step = self.step / count as f64;
        // From the pixel's centre to the first sample of its grid.
        let back = step * (0.5 * (count as f64 - 1.0) + margin as f64);
        let origin = |index: &u32| {
            let [x, y] = self.coordinates(*index as usize);
            [x - back, y - back]
        };
        let side = count + 2 * margin;
        let origins = indices.iter().map(origin).collect();
        PixelGrid {
            width: side,
            height: side,
            step,
            margin,
            origins,
        }
    }

    /// Number of samples in all grids.
    pub fn len(&self) -> usize {
        self.width * self.height * self.origins.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Pixel coordinates of the first sample of every row of every grid.
    fn rows(&self) -> impl Iterator<Item = [f64; 2]> {
        let rows = move |[x, y]: &[f64; 2]| {
            let (x, y) = (*x, *y);
            (0..self.height).map(move |row| [x, y + row as f64 * self.step])
        };
        self.origins.iter().flat_map(rows)
    }

    /// Pixel coordinates of sample `index`.
    fn coordinates(&self, index: usize) -> [f64; 2] {
        let area = self.width * self.height;
        let [x, y] = self.origins[index / area];
        let (row, column) = (index % area / self.width, index % self.width);
        [x + column as f64 * self.step, y + row as f64 * self.step]
    }
}

/// The samples of one run of a program.
#[derive(Clone)]
pub enum Samples<'a> {
    /// Pixels, or parts of pixels, of a target.
    Grid {
        /// What the pixels belong to.
        target: &'a dyn Target,
        /// Which pixels.
        grid: PixelGrid,
    },
    /// Points in mm without neighbours: every spread is 0, nothing is filtered.
    Points(&'a [[f64; 3]]),
}

impl Samples<'_> {
    /// Number of samples.
    pub fn len(&self) -> usize {
        match self {
            Samples::Grid { grid, .. } => grid.len(),
            Samples::Points(points) => points.len(),
        }
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Width and height of each grid of neighbours.
    pub fn shape(&self) -> [usize; 2] {
        match self {
            Samples::Grid { grid, .. } => [grid.width, grid.height],
            Samples::Points(_) => [1, 1],
        }
    }

    /// Identifies the positions of the samples.
    pub fn key(&self) -> Key {
        let mut key = KeyHasher::new("samples", 1);
        match self {
            Samples::Grid { target, grid } => {
                key.text("grid").key(target.key()).number(grid.step);
                key.whole(grid.width as i64)
                    .whole(grid.height as i64)
                    .whole(grid.margin as i64);
                grid.origins.iter().flatten().for_each(|part| {
                    key.number(*part);
                });
            }
            Samples::Points(points) => {
                key.text("points");
                points.iter().flatten().for_each(|part| {
                    key.number(*part);
                });
            }
        }
        key.finish()
    }

    /// Writes the positions as three columns, padded with copies of the last sample.
    pub(super) fn write_positions(&self, columns: &mut [Vec<f32>; 3], padded: usize) {
        let length = self.len();
        columns
            .iter_mut()
            .for_each(|column| column.resize(padded, 0.0));
        match self {
            Samples::Grid { target, grid } => write_grid(*target, grid, columns),
            Samples::Points(points) => {
                for (axis, column) in columns.iter_mut().enumerate() {
                    for (value, point) in column.iter_mut().zip(*points) {
                        *value = point[axis] as f32;
                    }
                }
            }
        }
        for column in columns {
            let last = column[length.saturating_sub(1)];
            column[length..].fill(last);
        }
    }

    /// Writes what rounding took from the first part of the positions, padded with copies of the last.
    pub(super) fn write_remainders(&self, column: &mut Vec<f32>, padded: usize) {
        let length = self.len();
        column.resize(padded, 0.0);
        match self {
            Samples::Grid { target, grid } => {
                for (row, [x, y]) in column.chunks_exact_mut(grid.width).zip(grid.rows()) {
                    target.write_remainders(x, y, grid.step, row);
                }
            }
            Samples::Points(points) => {
                for (value, point) in column.iter_mut().zip(*points) {
                    *value = remainder(point[0]);
                }
            }
        }
        let last = column[length.saturating_sub(1)];
        column[length..].fill(last);
    }
}

/// What rounding to f32 takes from a number.
pub(crate) fn remainder(number: f64) -> f32 {
    (number - f64::from(number as f32)) as f32
}

fn write_grid(target: &dyn Target, grid: &PixelGrid, [u, v, w]: &mut [Vec<f32>; 3]) {
    for (index, [x, y]) in grid.rows().enumerate() {
        let row = index * grid.width..(index + 1) * grid.width;
        target.write_row(
            x,
            y,
            grid.step,
            [&mut u[row.clone()], &mut v[row.clone()], &mut w[row]],
        );
    }
}
