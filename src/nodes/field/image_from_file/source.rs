//! The pixels of a picture file, with what has to be said about them.

use super::pyramid::{Base, Codes};
use crate::colour;
use crate::node::{Failure, Inputs};
use crate::nodes::picture::{self, Format};
use crate::value::FileContents;

/// Bytes of the reduced copies of a picture for each of its pixels: a third of four floats.
const REDUCED: u64 = 6;

/// Decodes the picture, once its memory has been taken.
///
/// # Errors
/// Broken files, pictures over the limits, too many of them.
pub(super) fn read(
    inputs: &Inputs<'_>,
    file: &FileContents,
    format: Format,
    space: Option<&str>,
) -> Result<Base, Failure> {
    let is_raw = space == Some("raw");
    let area = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
    if format == Format::Exr {
        let size = picture::exr_size(&file.bytes)?;
        inputs.take_memory("file", area(size) * (16 + REDUCED))?;
        let decoded = picture::decode_exr(&file.bytes)?;
        if decoded.not_finite > 0 {
            inputs.warn(format!(
                "{} samples of `{}` are not finite and count as 0",
                decoded.not_finite,
                file.path.display()
            ));
        }
        return Ok(Base {
            size,
            codes: Codes::Floats(decoded.pixels),
            is_weighed: false,
        });
    }
    let size = picture::head(&file.bytes, format)?;
    // A PNG states the bits of its samples behind its width and height.
    let is_deep = format == Format::Png && file.bytes.get(24) == Some(&16);
    inputs.take_memory("file", area(size) * (if is_deep { 8 } else { 4 } + REDUCED))?;
    let decoded = picture::decode(&file.bytes, format)?;
    let is_deep = decoded.color().bytes_per_pixel() > decoded.color().channel_count();
    let codes = match is_deep {
        true => Codes::Sixteen(decoded.into_rgba16().into_raw(), table(65_535, space)),
        false => Codes::Eight(decoded.into_rgba8().into_raw(), table(255, space)),
    };
    Ok(Base {
        size,
        codes,
        is_weighed: !is_raw,
    })
}

/// The value of every code.
fn table(largest: u32, space: Option<&str>) -> Vec<f32> {
    let value = |code: u32| {
        let share = f64::from(code) / f64::from(largest);
        match space {
            None | Some("srgb") => colour::from_srgb(share) as f32,
            _ => share as f32,
        }
    };
    (0..=largest).map(value).collect()
}
