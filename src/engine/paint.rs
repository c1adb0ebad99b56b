//! Paints the maps of one output: tiles in parallel, rows into the writers, no image in memory.
//!
//! Tiles are computed in windows of a few bands. While one window is computed, the rows of the window
//! before are compressed and written.

use super::event::{Event, Listener, Spot};
use super::progress::Meter;
use super::{Cancel, Options, RunError};
use crate::field::{PixelGrid, Program, RunContext, Samples, Scratch, Target, Work};
use crate::output::{Encoder, Faults, MapWriter};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Bytes of rows in a window, at most, as long as a window has a row.
const WINDOW_BYTES: usize = 64 << 20;

/// One map on its way to a file.
pub(super) struct Sheet {
    pub(super) encoder: Encoder,
    pub(super) writer: Box<dyn MapWriter>,
    pub(super) faults: Faults,
    /// Where the first sample is that is not finite.
    pub(super) first_not_finite: Option<Spot>,
}

/// What painting needs besides the sheets.
pub(super) struct Painter<'a> {
    pub(super) output: &'a str,
    /// Gives the columns of all sheets, in order.
    pub(super) program: &'a Program,
    pub(super) target: &'a dyn Target,
    pub(super) options: &'a Options,
    pub(super) context: RunContext<'a>,
    pub(super) listener: &'a dyn Listener,
    pub(super) cancel: &'a Cancel,
    pub(super) meter: &'a Meter<'a>,
}

/// A rectangle of pixels.
#[derive(Clone, Copy)]
struct Tile {
    corner: [u32; 2],
    size: [u32; 2],
}

/// A picture divided into bands of tiles, and these into windows.
struct Bands {
    pixels: [u32; 2],
    /// Width and height of a tile that is not cut off.
    tile: [u32; 2],
    /// Bands in a window.
    at_once: usize,
}

impl Bands {
    fn tiles(&self) -> usize {
        let [across, down] = [0, 1].map(|axis| self.pixels[axis].div_ceil(self.tile[axis]));
        across as usize * down as usize
    }

    /// Windows from top to bottom, each of bands of tiles from left to right.
    fn windows(&self) -> impl Iterator<Item = Vec<Vec<Tile>>> {
        let starts = (0..self.pixels[1]).step_by(self.tile[1] as usize * self.at_once);
        starts.map(|start| {
            let bands = (start..self.pixels[1]).step_by(self.tile[1] as usize);
            bands.take(self.at_once).map(|y| self.band(y)).collect()
        })
    }

    fn band(&self, y: u32) -> Vec<Tile> {
        let [width, height] = self.pixels;
        let tile = |x: u32| Tile {
            corner: [x, y],
            size: [self.tile[0].min(width - x), self.tile[1].min(height - y)],
        };
        (0..width)
            .step_by(self.tile[0] as usize)
            .map(tile)
            .collect()
    }
}

/// The samples of a tile: for every sheet its rows, one after the other.
struct Painted {
    tile: Tile,
    rows: Vec<Vec<u8>>,
    faults: Vec<Faults>,
    /// For every sheet where the first sample is that is not finite.
    firsts: Vec<Option<Spot>>,
    work: BTreeMap<Arc<str>, Work>,
}

/// Bands of tiles, each from left to right.
type Window = Vec<Vec<Painted>>;

impl Painter<'_> {
    /// Paints all sheets.
    ///
    /// # Errors
    /// [`RunError::Cancelled`], or what the writers say.
    pub(super) fn paint(&self, sheets: &mut [Sheet]) -> Result<(), PaintError> {
        let encoders: Vec<Encoder> = sheets.iter().map(|sheet| sheet.encoder).collect();
        let scratches = Mutex::new(vec![]);
        let pixel_bytes = encoders.iter().map(Encoder::pixel_bytes).sum();
        let bands = self.bands(pixel_bytes);
        self.meter.count().divide(bands.tiles());
        let mut tally = Tally::default();
        let mut waiting: Option<Window> = None;
        for window in bands.windows() {
            let (painted, written) = rayon::join(
                || self.paint_window(&encoders, window, &scratches),
                || {
                    waiting
                        .take()
                        .map_or(Ok(()), |window| tally.write(sheets, window))
                },
            );
            written?;
            waiting = Some(painted.ok_or(PaintError::Cancelled)?);
        }
        waiting.map_or(Ok(()), |window| tally.write(sheets, window))?;
        self.meter.tiles_done();
        tally.report(self.output, self.listener);
        Ok(())
    }

    /// How the picture is divided: a window keeps every thread busy.
    fn bands(&self, pixel_bytes: usize) -> Bands {
        let [width, height] = self.target.pixels();
        let rows = (WINDOW_BYTES / (width as usize * pixel_bytes)).max(1);
        let side = self.options.tile;
        let tile = [side, side.min(u32::try_from(rows).unwrap_or(side))];
        let wanted = (4 * rayon::current_num_threads()).div_ceil(width.div_ceil(side) as usize);
        Bands {
            pixels: [width, height],
            tile,
            at_once: wanted.clamp(1, (rows / tile[1] as usize).max(1)),
        }
    }

    /// `None` if the run was cancelled.
    fn paint_window(
        &self,
        encoders: &[Encoder],
        window: Vec<Vec<Tile>>,
        scratches: &Mutex<Vec<Scratch>>,
    ) -> Option<Window> {
        let tile = |tile: &Tile| {
            if self.cancel.is_cancelled() {
                return None;
            }
            let start = Instant::now();
            let mut scratch = lock(scratches).pop().unwrap_or_default();
            let painted = self.paint_tile(encoders, *tile, &mut scratch)?;
            lock(scratches).push(scratch);
            self.meter.tile(start.elapsed());
            Some(painted)
        };
        window
            .par_iter()
            .map(|band| band.par_iter().map(tile).collect::<Option<Vec<Painted>>>())
            .collect()
    }

    /// `None` if the run was cancelled.
    fn paint_tile(
        &self,
        encoders: &[Encoder],
        tile: Tile,
        scratch: &mut Scratch,
    ) -> Option<Painted> {
        let program = self.program;
        let margin = program.margin();
        let grid = PixelGrid::tile(tile.corner, tile.size, margin);
        let stride = grid.width;
        program.run(
            &Samples::Grid {
                target: self.target,
                grid,
            },
            scratch,
            &self.context,
        );
        if self.cancel.is_cancelled() {
            return None;
        }
        let [width, height] = tile.size.map(|side| side as usize);
        let mut painted = Painted {
            tile,
            rows: vec![],
            faults: vec![],
            firsts: vec![],
            work: scratch.take_work(),
        };
        for (output, encoder) in encoders.iter().enumerate() {
            let row_bytes = width * encoder.pixel_bytes();
            let mut rows = vec![0; row_bytes * height];
            let mut faults = Faults::default();
            let mut first = None;
            for (row, bytes) in rows.chunks_exact_mut(row_bytes).enumerate() {
                let start = (row + margin) * stride + margin;
                let columns = program.columns(scratch, output);
                let columns: Vec<&[f32]> = columns
                    .iter()
                    .map(|column| &column[start..start + width])
                    .collect();
                faults += encoder.encode(&columns, bytes);
                if faults.non_finite > 0 && first.is_none() {
                    first = self
                        .first_not_finite(&columns, [tile.corner[0], tile.corner[1] + row as u32]);
                }
            }
            painted.firsts.push(first);
            painted.rows.push(rows);
            painted.faults.push(faults);
        }
        Some(painted)
    }

    /// The first pixel of a row, which begins at `corner`, with a sample that is not finite.
    fn first_not_finite(&self, columns: &[&[f32]], corner: [u32; 2]) -> Option<Spot> {
        let first = |column: &&[f32]| column.iter().position(|value| !value.is_finite());
        let across = columns.iter().filter_map(first).min()?;
        let pixel = [corner[0] + across as u32, corner[1]];
        let [x, y] = pixel.map(|count| f64::from(count) + 0.5);
        let [mut u, mut v, mut w] = [[0.0]; 3];
        self.target.write_row(x, y, 1.0, [&mut u, &mut v, &mut w]);
        let place = [u[0], v[0]];
        Some(Spot { pixel, place })
    }
}

/// The upper one of two spots, or the left one of a row.
fn upper(one: Option<Spot>, other: Option<Spot>) -> Option<Spot> {
    let found = one.into_iter().chain(other);
    found.min_by_key(|spot| [spot.pixel[1], spot.pixel[0]])
}

/// Why painting stopped.
pub(super) enum PaintError {
    Cancelled,
    Files(io::Error),
}

impl From<io::Error> for PaintError {
    fn from(error: io::Error) -> PaintError {
        PaintError::Files(error)
    }
}

impl From<PaintError> for RunError {
    fn from(error: PaintError) -> RunError {
        match error {
            PaintError::Cancelled => RunError::Cancelled,
            PaintError::Files(error) => RunError::not_written(&error),
        }
    }
}

/// Counts what the tiles report.
#[derive(Default)]
struct Tally {
    /// Tiles computed and reused, by node.
    work: BTreeMap<Arc<str>, [usize; 2]>,
}

impl Tally {
    /// Writes the rows of a window into every sheet.
    fn write(&mut self, sheets: &mut [Sheet], window: Window) -> io::Result<()> {
        sheets
            .par_iter_mut()
            .enumerate()
            .try_for_each(|(index, sheet)| {
                let parts = window
                    .iter()
                    .flatten()
                    .map(|painted| painted.rows[index].len());
                let mut rows = Vec::with_capacity(parts.sum());
                for band in &window {
                    append_rows(&mut rows, band, index, sheet.encoder.pixel_bytes());
                    for painted in band {
                        sheet.faults += painted.faults[index];
                        sheet.first_not_finite =
                            upper(sheet.first_not_finite, painted.firsts[index]);
                    }
                }
                sheet.writer.write_rows(&rows)
            })?;
        for painted in window.iter().flatten() {
            for (node, work) in &painted.work {
                let [computed, reused] = self.work.entry(Arc::clone(node)).or_default();
                *computed += usize::from(work.computed);
                *reused += usize::from(work.reused && !work.computed);
            }
        }
        Ok(())
    }

    fn report(self, output: &str, listener: &dyn Listener) {
        for (node, [computed, reused]) in self.work {
            let (output, node) = (output.to_owned(), node.to_string());
            listener.hear(Event::FieldTiles {
                output,
                node,
                computed,
                reused,
            });
        }
    }
}

/// Joins the tiles of a band into whole rows.
fn append_rows(rows: &mut Vec<u8>, band: &[Painted], sheet: usize, pixel_bytes: usize) {
    let height = band
        .first()
        .map_or(0, |painted| painted.tile.size[1] as usize);
    for row in 0..height {
        for painted in band {
            let length = painted.tile.size[0] as usize * pixel_bytes;
            rows.extend_from_slice(&painted.rows[sheet][row * length..(row + 1) * length]);
        }
    }
}

fn lock(scratches: &Mutex<Vec<Scratch>>) -> std::sync::MutexGuard<'_, Vec<Scratch>> {
    scratches.lock().unwrap_or_else(PoisonError::into_inner)
}
