//! Paints the maps of one output: tiles in parallel, rows into the writers, no image in memory.
//!
//! Tiles are computed in windows of a few bands. While one window is computed, the rows of the window
//! before are compressed and written.

use super::event::{Event, Listener};
use super::{Cancel, Options, RunError};
use crate::diagnostics::{Code, Diagnostic};
use crate::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target, Work};
use crate::output::{Encoder, Faults, MapWriter};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Mutex, PoisonError};

/// One map on its way to a file.
pub(super) struct Sheet {
    pub(super) field: Field,
    pub(super) encoder: Encoder,
    pub(super) writer: Box<dyn MapWriter>,
    pub(super) faults: Faults,
}

/// What painting needs besides the sheets.
pub(super) struct Painter<'a> {
    pub(super) output: &'a str,
    pub(super) target: &'a dyn Target,
    pub(super) options: &'a Options,
    pub(super) context: RunContext<'a>,
    pub(super) listener: &'a dyn Listener,
    pub(super) cancel: &'a Cancel,
}

/// A rectangle of pixels.
#[derive(Clone, Copy)]
struct Tile {
    corner: [u32; 2],
    size: [u32; 2],
}

/// The samples of a tile: for every sheet its rows, one after the other.
struct Painted {
    tile: Tile,
    rows: Vec<Vec<u8>>,
    faults: Vec<Faults>,
    work: BTreeMap<Arc<str>, Work>,
}

/// Bands of tiles, each from left to right.
type Window = Vec<Vec<Painted>>;

/// Pixels around a tile that fields may need.
const LARGEST_MARGIN: usize = 256;

impl Painter<'_> {
    /// Paints all sheets.
    ///
    /// # Errors
    /// [`RunError::Cancelled`], or what the writers say.
    pub(super) fn paint(&self, sheets: &mut [Sheet]) -> Result<(), PaintError> {
        let fields: Vec<Field> = sheets.iter().map(|sheet| sheet.field.clone()).collect();
        let encoders: Vec<Encoder> = sheets.iter().map(|sheet| sheet.encoder).collect();
        let program = Program::compile(&fields);
        let scratches = Mutex::new(vec![]);
        if program.margin() > LARGEST_MARGIN {
            return Err(PaintError::TooWide(program.margin()));
        }
        let windows = self.windows();
        let total = windows.iter().flatten().map(Vec::len).sum();
        let mut tally = Tally::default();
        let mut waiting: Option<Window> = None;
        for window in windows {
            let (painted, written) = rayon::join(
                || self.paint_window(&program, &encoders, window, &scratches),
                || {
                    waiting
                        .take()
                        .map_or(Ok(0), |window| tally.write(sheets, window))
                },
            );
            self.progress(written?, &mut tally, total);
            waiting = Some(painted.ok_or(PaintError::Cancelled)?);
        }
        let written = waiting.map_or(Ok(0), |window| tally.write(sheets, window))?;
        self.progress(written, &mut tally, total);
        tally.report(self.output, self.listener);
        Ok(())
    }

    /// Windows of bands of tiles; a window keeps every thread busy.
    fn windows(&self) -> Vec<Vec<Vec<Tile>>> {
        let [width, height] = self.target.pixels();
        let side = self.options.tile;
        let band = |y: u32| {
            let tile = |x: u32| Tile {
                corner: [x, y],
                size: [side.min(width - x), side.min(height - y)],
            };
            (0..width)
                .step_by(side as usize)
                .map(tile)
                .collect::<Vec<_>>()
        };
        let bands: Vec<Vec<Tile>> = (0..height).step_by(side as usize).map(band).collect();
        let wanted = 4 * rayon::current_num_threads();
        let across = width.div_ceil(side) as usize;
        bands
            .chunks(wanted.div_ceil(across))
            .map(<[_]>::to_vec)
            .collect()
    }

    /// `None` if the run was cancelled.
    fn paint_window(
        &self,
        program: &Program,
        encoders: &[Encoder],
        window: Vec<Vec<Tile>>,
        scratches: &Mutex<Vec<Scratch>>,
    ) -> Option<Window> {
        let tile = |tile: &Tile| {
            if self.cancel.is_cancelled() {
                return None;
            }
            let mut scratch = lock(scratches).pop().unwrap_or_default();
            let painted = self.paint_tile(program, encoders, *tile, &mut scratch);
            lock(scratches).push(scratch);
            Some(painted)
        };
        window
            .par_iter()
            .map(|band| band.par_iter().map(tile).collect::<Option<Vec<Painted>>>())
            .collect()
    }

    fn paint_tile(
        &self,
        program: &Program,
        encoders: &[Encoder],
        tile: Tile,
        scratch: &mut Scratch,
    ) -> Painted {
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
        let [width, height] = tile.size.map(|side| side as usize);
        let mut painted = Painted {
            tile,
            rows: vec![],
            faults: vec![],
            work: scratch.take_work(),
        };
        for (output, encoder) in encoders.iter().enumerate() {
            let row_bytes = width * encoder.pixel_bytes();
            let mut rows = vec![0; row_bytes * height];
            let mut faults = Faults::default();
            for (row, bytes) in rows.chunks_exact_mut(row_bytes).enumerate() {
                let start = (row + margin) * stride + margin;
                let columns = program.columns(scratch, output);
                let columns: Vec<&[f32]> = columns
                    .iter()
                    .map(|column| &column[start..start + width])
                    .collect();
                faults += encoder.encode(&columns, bytes);
            }
            painted.rows.push(rows);
            painted.faults.push(faults);
        }
        painted
    }

    fn progress(&self, written: usize, tally: &mut Tally, total: usize) {
        tally.tiles += written;
        if written > 0 {
            let output = self.output.to_owned();
            self.listener.hear(Event::Progress {
                output,
                done: tally.tiles,
                total,
            });
        }
    }
}

/// Nodes that look at neighbours of neighbours: a chain so long that no computer could hold the tiles.
fn too_wide(found: usize) -> Diagnostic {
    let message = format!(
        "a pixel would depend on {found} pixels around it: too many nodes that are not straight follow each \
         other"
    );
    Diagnostic::error(Code::TooMuch, message)
        .expected(format!("at most {LARGEST_MARGIN}"), found)
        .hint("make fewer nodes out of the long chain, or make what decides in them constant")
}

/// Why painting stopped.
pub(super) enum PaintError {
    Cancelled,
    Files(io::Error),
    /// Pixels around a tile that the fields would need.
    TooWide(usize),
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
            PaintError::TooWide(found) => RunError::Limit(vec![too_wide(found)]),
        }
    }
}

/// Counts what the tiles report.
#[derive(Default)]
struct Tally {
    tiles: usize,
    /// Tiles computed and reused, by node.
    work: BTreeMap<Arc<str>, [usize; 2]>,
}

impl Tally {
    /// Writes the rows of a window into every sheet; gives the number of its tiles.
    fn write(&mut self, sheets: &mut [Sheet], window: Window) -> io::Result<usize> {
        sheets
            .par_iter_mut()
            .enumerate()
            .try_for_each(|(index, sheet)| {
                let mut rows = vec![];
                for band in &window {
                    append_rows(&mut rows, band, index, sheet.encoder.pixel_bytes());
                    band.iter()
                        .for_each(|painted| sheet.faults += painted.faults[index]);
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
        Ok(window.iter().map(Vec::len).sum())
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
