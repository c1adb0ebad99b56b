//! Maps for the tests of the writers: gradients with known values.
#![allow(dead_code, reason = "each test program uses a part")]

pub(crate) mod worlds;

use std::path::PathBuf;
use yosegi::colour::to_srgb;
use yosegi::key::Key;
use yosegi::output::{Encoder, MapKind, MapRequest, create};
use yosegi::value::MapFormat;
use yosegi::world::{Memory, World};

pub(crate) const KINDS: [MapKind; 3] = [MapKind::Colour, MapKind::Number, MapKind::Normal];
pub(crate) const SIZES: [[u32; 2]; 5] = [[1, 1], [1, 5], [17, 16], [333, 71], [1500, 120]];

/// The nearest sample, straight from the definition.
pub(crate) fn expected(kind: MapKind, max: f64, value: f32) -> u16 {
    let value = f64::from(value);
    let ratio = match kind {
        MapKind::Colour => to_srgb(value.clamp(0.0, 1.0)),
        MapKind::Number => value,
        MapKind::Normal => 0.5 + 0.5 * value,
    };
    (ratio.clamp(0.0, 1.0) * max).round() as u16
}

pub(crate) fn key() -> Key {
    Key::of_bytes(b"a board of spruce")
}

/// A request for a map of 33 by 20 pixels.
pub(crate) fn request(kind: MapKind, format: MapFormat) -> MapRequest {
    MapRequest {
        pixels: [33, 20],
        size_mm: [8.25, 10.0],
        kind,
        format,
        key: key(),
        channel: "bark".to_owned(),
    }
}

pub(crate) fn with_size(pixels: [u32; 2], kind: MapKind, format: MapFormat) -> MapRequest {
    MapRequest {
        pixels,
        ..request(kind, format)
    }
}

/// The value of a sample: gradients that differ in each channel, over the range of the kind.
pub(crate) fn value(request: &MapRequest, [x, y]: [u32; 2], sample: usize) -> f32 {
    let [width, height] = request.pixels;
    let [u, v] = [x as f32 / width as f32, y as f32 / height as f32];
    let ratio = [u, 1.0 - v, 0.5 * (u + v)][sample];
    if request.kind == MapKind::Normal {
        2.0 * ratio - 1.0
    } else {
        ratio
    }
}

/// The values of a row, one column for each sample.
pub(crate) fn row(request: &MapRequest, y: u32) -> Vec<Vec<f32>> {
    let column = |sample| (0..request.pixels[0]).map(move |x| value(request, [x, y], sample));
    (0..request.kind.samples())
        .map(|sample| column(sample).collect())
        .collect()
}

pub(crate) fn encoded_row(request: &MapRequest, y: u32) -> Vec<u8> {
    let columns = row(request, y);
    let columns: Vec<&[f32]> = columns.iter().map(Vec::as_slice).collect();
    let mut bytes = vec![0; request.row_bytes()];
    Encoder::new(request.kind, request.format, None).encode(&columns, &mut bytes);
    bytes
}

pub(crate) fn encoded(request: &MapRequest) -> Vec<u8> {
    (0..request.pixels[1])
        .flat_map(|y| encoded_row(request, y))
        .collect()
}

/// A map that was written, with the values it was written from.
pub(crate) struct Map {
    pub(crate) world: Memory,
    pub(crate) path: PathBuf,
    pub(crate) bytes: Vec<u8>,
    pub(crate) values: Vec<f32>,
    pub(crate) samples: usize,
}

impl Map {
    pub(crate) fn gradient(request: &MapRequest) -> Map {
        let world = Memory::default();
        let path = PathBuf::from("maps/bark");
        let mut writer = create(&world, &path, request).unwrap();
        for y in 0..request.pixels[1] {
            writer.write_rows(&encoded_row(request, y)).unwrap();
        }
        writer.finish().unwrap();
        let bytes = world.read(&path).unwrap();
        let samples = request.kind.samples();
        let pixels =
            (0..request.pixels[1]).flat_map(|y| (0..request.pixels[0]).map(move |x| [x, y]));
        let values = pixels
            .flat_map(|pixel| (0..samples).map(move |sample| value(request, pixel, sample)))
            .collect();
        Map {
            world,
            path,
            bytes,
            values,
            samples,
        }
    }

    /// The values of one sample of all pixels.
    pub(crate) fn column(&self, sample: usize) -> Vec<f32> {
        self.values
            .iter()
            .copied()
            .skip(sample)
            .step_by(self.samples)
            .collect()
    }
}
