//! The heights of a material on a grid, filtered as a map of them would be.

use crate::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target, remainder};
use crate::key::{Key, KeyHasher};
use crate::node::{Build, Failure};
use glam::DVec2;
use rayon::prelude::*;

/// Corners along each side of what is sampled in one go.
const TILE: usize = 128;

/// The corners of the cells of a flat piece, as pixels of a target that stands on its head: rows run upwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners {
    pub(super) cells: [usize; 2],
    pub(super) size: DVec2,
}

impl Corners {
    /// The values of a field at all corners, row after row.
    ///
    /// # Errors
    /// If the run was cancelled, or if a value is not a number.
    pub(super) fn sample(
        &self,
        field: &Field,
        charts: &[Field],
        build: &Build<'_>,
    ) -> Result<Vec<f32>, Failure> {
        let program = Program::compile_in_charts(std::slice::from_ref(field), charts);
        let context = RunContext {
            level: fearless_simd::Level::new(),
            cache: None,
            filtering: true,
            cancel: build.cancel,
        };
        let tiles = self.tiles();
        let tiles = tiles
            .par_iter()
            .map_init(Scratch::default, |scratch, tile| {
                self.sample_tile(&program, *tile, scratch, &context)
            });
        let tiles: Vec<Vec<f32>> = tiles.collect();
        build.go_on()?;
        let [width, height] = self.pixels().map(|side| side as usize);
        let mut corners = vec![0.0; width * height];
        for ([first, last], values) in self.tiles().iter().zip(tiles) {
            for (y, row) in (first[1]..last[1]).zip(values.chunks(last[0] - first[0])) {
                corners[y * width + first[0]..][..row.len()].copy_from_slice(row);
            }
        }
        match corners.iter().position(|height| !height.is_finite()) {
            None => Ok(corners),
            Some(index) => Err(self.not_a_height(index % width, index / width)),
        }
    }

    /// The first corners of tiles, and those behind their last.
    fn tiles(&self) -> Vec<[[usize; 2]; 2]> {
        let [width, height] = self.pixels().map(|side| side as usize);
        let starts = |length: usize| (0..length).step_by(TILE);
        let tile = |x: usize, y: usize| [[x, y], [(x + TILE).min(width), (y + TILE).min(height)]];
        let band = |y: usize| starts(width).map(move |x| tile(x, y));
        starts(height).flat_map(band).collect()
    }

    fn sample_tile(
        &self,
        program: &Program,
        [first, last]: [[usize; 2]; 2],
        scratch: &mut Scratch,
        context: &RunContext<'_>,
    ) -> Vec<f32> {
        let margin = program.margin();
        let corner = first.map(|side| side as u32);
        let size = [0, 1].map(|axis| (last[axis] - first[axis]) as u32);
        let grid = PixelGrid::tile(corner, size, margin);
        let width = grid.width;
        let samples = Samples::Grid { target: self, grid };
        program.run(&samples, scratch, context);
        if context.is_cancelled() {
            return vec![];
        }
        let values = program.output(scratch, 0, 0);
        let rows = margin..margin + size[1] as usize;
        rows.flat_map(|y| &values[y * width + margin..][..size[0] as usize])
            .copied()
            .collect()
    }

    fn not_a_height(&self, x: usize, y: usize) -> Failure {
        let place = self.size * DVec2::new(x as f64, y as f64)
            / DVec2::new(self.cells[0] as f64, self.cells[1] as f64);
        let message = format!(
            "the height at ({:.3}, {:.3}) is not a number",
            place.x, place.y
        );
        Failure::of_input("of", message)
    }

    fn place(&self, axis: usize, at: f64) -> f64 {
        (at - 0.5) * self.size[axis] / self.cells[axis] as f64
    }
}

impl Target for Corners {
    fn key(&self) -> Key {
        let mut key = KeyHasher::new("view corners", 1);
        for axis in 0..2 {
            key.whole(self.cells[axis] as i64).number(self.size[axis]);
        }
        key.finish()
    }

    fn pixels(&self) -> [u32; 2] {
        self.cells.map(|side| side as u32 + 1)
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        for (index, u) in (0i32..).zip(u) {
            *u = self.place(0, x + f64::from(index) * step) as f32;
        }
        v.fill(self.place(1, y) as f32);
        w.fill(0.0);
    }

    fn write_remainders(&self, x: f64, _: f64, step: f64, row: &mut [f32]) {
        for (index, value) in (0i32..).zip(row) {
            *value = remainder(self.place(0, x + f64::from(index) * step));
        }
    }
}
