//! Pictures from files: which format they have, and decoding within limits.

mod exr;
mod png;

pub(super) use exr::{decode as decode_exr, size as exr_size};
pub(super) use png::pixels_per_mm;

use crate::node::Failure;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::path::Path;

/// Longest side in pixels.
pub(super) const MAX_SIDE: u32 = 32_768;

/// Memory that decoding one picture may take, in MiB.
pub(super) const MAX_MEBIBYTES: u64 = 256;

/// The formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// Portable Network Graphics.
    Png,
    /// JPEG, baseline or progressive.
    Jpeg,
    /// Windows bitmap.
    Bmp,
    /// OpenEXR.
    Exr,
}

impl Format {
    /// The format that a file has by what it begins with, whatever it is called.
    pub(super) fn of(bytes: &[u8]) -> Option<Format> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => Some(Format::Png),
            [0xff, 0xd8, 0xff, ..] => Some(Format::Jpeg),
            [b'B', b'M', ..] => Some(Format::Bmp),
            [0x76, 0x2f, 0x31, 0x01, ..] => Some(Format::Exr),
            _ => None,
        }
    }

    /// Its name in messages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Format::Png => "PNG",
            Format::Jpeg => "JPEG",
            Format::Bmp => "BMP",
            Format::Exr => "OpenEXR",
        }
    }

    /// What is wrong with a file's name, if it says another format.
    pub(super) fn contradiction(self, path: &Path) -> Option<String> {
        let extension = path.extension()?.to_string_lossy().to_lowercase();
        let fits: &[&str] = match self {
            Format::Png => &["png"],
            Format::Jpeg => &["jpg", "jpeg", "jpe"],
            Format::Bmp => &["bmp", "dib"],
            Format::Exr => &["exr"],
        };
        (!fits.contains(&extension.as_str())).then(|| {
            format!(
                "`{}` is called .{extension}, but is a {} file; it is read as one",
                path.display(),
                self.name()
            )
        })
    }

    fn decoder(self) -> ImageFormat {
        match self {
            Format::Png => ImageFormat::Png,
            Format::Jpeg => ImageFormat::Jpeg,
            Format::Bmp => ImageFormat::Bmp,
            Format::Exr => ImageFormat::OpenExr,
        }
    }
}

/// That a picture is over the limits.
pub(super) fn too_large() -> Failure {
    let message =
        format!("the picture is larger than {MAX_SIDE} pixels a side or {MAX_MEBIBYTES} MiB");
    Failure::of_input("file", message).with_hint("scale it down")
}

/// That a picture is broken.
pub(super) fn broken(reason: &str) -> Failure {
    Failure::of_input("file", format!("the picture cannot be decoded: {reason}"))
}

/// Calls a decoder; they have been known to panic on hostile files.
pub(super) fn guarded<T>(
    decode: impl FnOnce() -> Result<T, Failure> + std::panic::UnwindSafe,
) -> Result<T, Failure> {
    std::panic::catch_unwind(decode).unwrap_or_else(|_| Err(broken("the file is broken")))
}

/// Width and height of a PNG, JPEG or BMP picture; reads the head only.
///
/// # Errors
/// Broken files, and pictures over the limits.
pub(super) fn head(bytes: &[u8], format: Format) -> Result<[u32; 2], Failure> {
    guarded(|| {
        let decoder = reader(bytes, format).into_decoder().map_err(failure)?;
        let (width, height) = decoder.dimensions();
        let pixel = u64::from(decoder.color_type().bytes_per_pixel());
        let decoded = u64::from(width) * u64::from(height) * pixel;
        match width.max(height) > MAX_SIDE || decoded > MAX_MEBIBYTES << 20 {
            true => Err(too_large()),
            false => Ok([width, height]),
        }
    })
}

/// Decodes a PNG, JPEG or BMP file as it is stored, whatever profile or orientation it notes.
///
/// # Errors
/// Broken or cut files, and pictures over the limits.
pub(super) fn decode(bytes: &[u8], format: Format) -> Result<DynamicImage, Failure> {
    if format == Format::Jpeg && is_cut(bytes) {
        return Err(broken("the file ends before the picture does"));
    }
    guarded(|| {
        let decoded = reader(bytes, format).decode();
        decoded.map_err(failure)
    })
}

fn reader(bytes: &[u8], format: Format) -> ImageReader<Cursor<&[u8]>> {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_MEBIBYTES << 20);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format.decoder());
    reader.limits(limits);
    reader
}

fn failure(error: ImageError) -> Failure {
    match error {
        ImageError::Limits(_) => too_large(),
        error => broken(&error.to_string()),
    }
}

/// Whether no end follows the last scan of a JPEG file: its decoder would make up the rest.
fn is_cut(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xff, marker]);
    match (last(0xda), last(0xd9)) {
        (Some(scan), Some(end)) => end < scan,
        _ => true,
    }
}
