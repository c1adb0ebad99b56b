//! Maps as files: samples are made tile by tile, and files are written row by row.
//!
//! An [`Encoder`] turns columns of numbers into the bytes of pixels, from as many threads as one likes. A
//! [`MapWriter`] takes whole rows of such bytes from top to bottom, compresses them and forgets them: it
//! holds a block of rows, never the image. The file appears when it is finished, all at once.

mod bmp;
mod deflate;
mod encode;
mod exr;
mod placing;
mod png;
mod srgb;
mod strips;
mod tiff;

pub use bmp::{LARGEST_BMP, bmp_bytes};
pub use encode::{Encoder, Faults, MapKind};
pub(crate) use placing::{Contents, Placing};

use crate::cancel::Cancel;
use crate::key::Key;
use crate::value::{FileType, MapFormat};
use crate::world::{PendingFile, World};
use std::io;
use std::path::{Path, PathBuf};

/// The name under which PNG text, EXR attributes and the description of a TIFF carry the key of a map.
const KEY_NAME: &str = "yosegi:key";
/// The name under which they carry the name of the channel.
const CHANNEL_NAME: &str = "yosegi:channel";
/// What they name as the program that wrote them.
const SOFTWARE: &str = "Yosegi";

/// A map to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct MapRequest {
    /// Width and height in pixels.
    pub pixels: [u32; 2],
    /// Width and height of the piece in mm; the file tells its resolution by them.
    pub size_mm: [f64; 2],
    /// What the samples are.
    pub kind: MapKind,
    /// How the samples are written.
    pub format: MapFormat,
    /// The key of the output, by which [`read_key`] knows it again.
    pub key: Key,
    /// The name of the channel, in ASCII.
    pub channel: String,
}

impl MapRequest {
    /// The bytes of one row, as the [`Encoder`] makes them.
    pub fn row_bytes(&self) -> usize {
        self.pixels[0] as usize * self.pixel_bytes()
    }

    fn pixel_bytes(&self) -> usize {
        Encoder::new(self.kind, self.format, None).pixel_bytes()
    }

    /// Pixels per mm in both directions; `None` where the size says nothing.
    fn density(&self) -> Option<[f64; 2]> {
        let density = [0, 1].map(|axis| f64::from(self.pixels[axis]) / self.size_mm[axis]);
        density
            .iter()
            .all(|it| it.is_finite() && *it > 0.0)
            .then_some(density)
    }

    /// Width of a pixel over its height: 1 where both sides of the picture were rounded to whole pixels.
    fn pixel_aspect(&self) -> f64 {
        let Some([across, down]) = self.density() else {
            return 1.0;
        };
        let aspect = down / across;
        let shorter = f64::from(self.pixels[0].min(self.pixels[1]));
        if (aspect - 1.0).abs() <= 1.0 / shorter {
            1.0
        } else {
            aspect
        }
    }

    fn check(&self) -> io::Result<()> {
        // The widest row that fits into a block of OpenEXR, and the largest side of a PNG.
        let [width, height] = self.pixels;
        if width == 0 || height == 0 || width > 1 << 22 || height > i32::MAX as u32 {
            return Err(invalid(format!(
                "expected a map of 1 to 4194304 by 1 to 2147483647 pixels, found {width} by {height}"
            )));
        }
        let bytes = bmp_bytes(self.pixels, self.kind);
        if self.format.file_type() == FileType::Bmp && bytes > LARGEST_BMP {
            return Err(invalid(format!(
                "expected a BMP of at most {LARGEST_BMP} bytes, found {bytes} bytes"
            )));
        }
        if self.channel.is_empty() || !self.channel.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Err(invalid(format!(
                "expected a channel name in ASCII, found {:?}",
                self.channel
            )));
        }
        Ok(())
    }
}

/// A map that is being written. Dropped before it is finished, it leaves nothing behind.
pub trait MapWriter: Send {
    /// Writes the next rows, from top to bottom: any number of whole ones, their pixels as the
    /// [`Encoder`] makes them. How rows are grouped into calls does not change the file.
    ///
    /// # Errors
    /// If the file cannot be written, or the bytes are no whole rows or too many. The map is then given
    /// up: it can only be dropped.
    fn write_rows(&mut self, rows: &[u8]) -> io::Result<()>;

    /// Completes the file and puts it in its place.
    ///
    /// # Errors
    /// If rows are missing, or the file cannot be written. Nothing is then left behind.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// Starts a map at `path`, which holds nothing new until the map is finished.
///
/// # Errors
/// If the request cannot be written in its format, or the file cannot be made. The message names the path.
pub fn create(
    world: &dyn World,
    path: &Path,
    request: &MapRequest,
) -> io::Result<Box<dyn MapWriter>> {
    create_until(world, path, request, &Cancel::new())
}

/// As [`create`], for a run that may be cancelled: its rows are then compressed no more.
pub(crate) fn create_until(
    world: &dyn World,
    path: &Path,
    request: &MapRequest,
    cancel: &Cancel,
) -> io::Result<Box<dyn MapWriter>> {
    start(path, request, cancel, || world.create(path))
}

/// As [`create_until`]; `placing` says what comes before the map is put in place.
pub(crate) fn create_placing(
    world: &dyn World,
    path: &Path,
    request: &MapRequest,
    cancel: &Cancel,
    placing: Placing,
) -> io::Result<Box<dyn MapWriter>> {
    start(
        path,
        request,
        cancel,
        || Ok(placing.of(world.create(path)?)),
    )
}

fn start(
    path: &Path,
    request: &MapRequest,
    cancel: &Cancel,
    create: impl FnOnce() -> io::Result<Box<dyn PendingFile>>,
) -> io::Result<Box<dyn MapWriter>> {
    let start = || -> io::Result<Box<dyn MapWriter>> {
        request.check()?;
        let file = create()?;
        Ok(match request.format.file_type() {
            FileType::Png => Box::new(png::PngWriter::new(file, request, cancel)?),
            FileType::Exr => Box::new(exr::ExrWriter::new(file, request, cancel)?),
            FileType::Tiff => Box::new(tiff::TiffWriter::new(file, request, cancel)?),
            FileType::Bmp => Box::new(bmp::BmpWriter::new(file, request)?),
        })
    };
    Ok(Box::new(Guarded {
        writer: Some(start().map_err(|error| about(path, &error))?),
        path: path.to_owned(),
        row_bytes: request.row_bytes(),
        missing_rows: request.pixels[1] as usize,
    }))
}

/// The key that a map was written with, read from the start of the file; `None` if there is no such
/// file, or it is no PNG, TIFF or OpenEXR, or it carries no key. A BMP has no place for one.
pub fn read_key(world: &dyn World, path: &Path) -> Option<Key> {
    Key::from_hexadecimal(&read_text(world, path, KEY_NAME)?)
}

/// The name of the channel that a map was written for; `None` as for [`read_key`].
pub fn read_channel(world: &dyn World, path: &Path) -> Option<String> {
    read_text(world, path, CHANNEL_NAME)
}

/// The text that a map carries under `name`.
fn read_text(world: &dyn World, path: &Path, name: &str) -> Option<String> {
    text_in(&world.read_start(path, START).ok()?, name)
}

/// Headers of ours end within the first thousand bytes; other programs write longer ones.
const START: usize = 1 << 16;

fn text_in(start: &[u8], name: &str) -> Option<String> {
    let start = &start[..start.len().min(START)];
    if start.starts_with(b"\x89PNG") {
        png::read_text(start, name)
    } else if start.starts_with(b"II") {
        tiff::read_text(start, name)
    } else {
        exr::read_text(start, name)
    }
}

/// A writer that gets whole rows, as many as the map has, and nothing more after an error.
struct Guarded {
    /// `None` once something failed: what was written so far is gone then.
    writer: Option<Box<dyn MapWriter>>,
    path: PathBuf,
    row_bytes: usize,
    missing_rows: usize,
}

impl Guarded {
    fn take_rows(&mut self, rows: &[u8]) -> io::Result<()> {
        let count = rows.len() / self.row_bytes;
        if count * self.row_bytes != rows.len() {
            let found = rows.len();
            return Err(invalid(format!(
                "expected rows of {} bytes, found {found} bytes",
                self.row_bytes
            )));
        }
        let message = || format!("expected {} more rows, found {count}", self.missing_rows);
        self.missing_rows = self
            .missing_rows
            .checked_sub(count)
            .ok_or_else(|| invalid(message()))?;
        let writer = self
            .writer
            .as_mut()
            .ok_or_else(|| invalid("an earlier write failed"))?;
        if rows.is_empty() {
            Ok(())
        } else {
            writer.write_rows(rows)
        }
    }

    fn complete(&mut self) -> io::Result<()> {
        let writer = self
            .writer
            .take()
            .ok_or_else(|| invalid("an earlier write failed"))?;
        if self.missing_rows > 0 {
            return Err(invalid(format!("{} rows are missing", self.missing_rows)));
        }
        writer.finish()
    }
}

impl MapWriter for Guarded {
    fn write_rows(&mut self, rows: &[u8]) -> io::Result<()> {
        self.take_rows(rows).map_err(|error| {
            self.writer = None;
            about(&self.path, &error)
        })
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.complete().map_err(|error| about(&self.path, &error))
    }
}

fn invalid(message: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message.into())
}

/// An error with the file that it is about.
pub(crate) fn about(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("cannot write `{}`: {error}", path.display()),
    )
}
