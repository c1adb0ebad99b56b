//! OpenEXR pictures: the first layer with flat samples.

use super::{MAX_MEBIBYTES, MAX_SIDE, broken, guarded, too_large};
use crate::node::Failure;
use exr::image::AnyChannel;
use exr::image::FlatSamples;
use exr::image::read::read;
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers};
use std::io::Cursor;

/// A decoded OpenEXR picture.
pub(in crate::nodes) struct ExrPicture {
    /// Red, green, blue and opacity of every pixel, row by row; colours are multiplied by the opacity.
    pub(in crate::nodes) pixels: Vec<[f32; 4]>,
    /// Samples that were not finite; they are 0.
    pub(in crate::nodes) not_finite: u64,
}

/// Width and height; reads the head only.
///
/// # Errors
/// Broken files, and pictures over the limits.
pub(in crate::nodes) fn size(bytes: &[u8]) -> Result<[u32; 2], Failure> {
    guarded(|| {
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), false)
            .map_err(|error| broken(&error.to_string()))?;
        let header = meta.headers.iter().find(|header| !header.deep);
        let header = header.ok_or_else(|| broken("it holds deep data only"))?;
        let [width, height] = [header.layer_size.x(), header.layer_size.y()];
        if width == 0 || height == 0 {
            return Err(broken("it has no pixels"));
        }
        let total: u128 = meta
            .headers
            .iter()
            .map(|header| {
                header.layer_size.area() as u128 * header.channels.bytes_per_pixel as u128
            })
            .sum();
        let is_long = [width, height].iter().any(|side| *side > MAX_SIDE as usize);
        match is_long || total > u128::from(MAX_MEBIBYTES << 20) {
            true => Err(too_large()),
            false => Ok([width as u32, height as u32]),
        }
    })
}

/// Decodes a picture; [`size`] has been asked before.
///
/// # Errors
/// Broken files, and layers that have neither R, G and B nor one channel of brightness.
pub(in crate::nodes) fn decode(bytes: &[u8]) -> Result<ExrPicture, Failure> {
    guarded(|| {
        let picture = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(Cursor::new(bytes))
            .map_err(|error| broken(&error.to_string()))?;
        let area = picture.layer_data.size.area();
        combined(&picture.layer_data.channel_data.list, area)
    })
}

fn combined(channels: &[AnyChannel<FlatSamples>], area: usize) -> Result<ExrPicture, Failure> {
    let channel = |name: &str| {
        let named = |channel: &&AnyChannel<FlatSamples>| {
            channel.name.to_string().eq_ignore_ascii_case(name)
        };
        channels.iter().find(named)
    };
    let colours = [channel("R"), channel("G"), channel("B")];
    let parts = match (colours, channel("Y"), channels) {
        ([Some(r), Some(g), Some(b)], _, _) => [r, g, b],
        (_, Some(grey), _) | (_, None, [grey]) => [grey; 3],
        _ => {
            let names: Vec<String> = channels
                .iter()
                .map(|channel| channel.name.to_string())
                .collect();
            let message = format!("the picture has the channels {}", names.join(", "));
            let failure = Failure::of_input("file", message);
            return Err(failure.with_hint("it needs R, G and B, or Y, or one channel only"));
        }
    };
    let mut picture = ExrPicture {
        pixels: vec![[0.0, 0.0, 0.0, 1.0]; area],
        not_finite: 0,
    };
    for (lane, channel) in parts
        .into_iter()
        .map(Some)
        .chain([channel("A")])
        .enumerate()
    {
        let Some(channel) = channel else { continue };
        if channel.sampling.x() != 1 || channel.sampling.y() != 1 {
            return Err(broken("its channels have different resolutions"));
        }
        for (pixel, value) in picture
            .pixels
            .iter_mut()
            .zip(channel.sample_data.values_as_f32())
        {
            let is_finite = value.is_finite();
            picture.not_finite += u64::from(!is_finite);
            pixel[lane] = if is_finite { value } else { 0.0 };
        }
    }
    Ok(picture)
}
