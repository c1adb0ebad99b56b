//! Encoding and writing maps against the one-call writers of the crates, in pairs, as ratios of one run.
//!
//! `cargo bench --bench output [SIDE]`: a picture of wood with grain, 4096 by 4096 pixels unless said
//! otherwise. Ours starts from columns of floats, theirs from finished bytes or floats in memory; files
//! go nowhere. Ratios are medians of pairs, times the least of the runs.

use exr::prelude::{
    Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage, f16,
};
use std::hint::black_box;
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::Instant;
use yosegi::key::Key;
use yosegi::output::{Encoder, MapKind, MapRequest, create};
use yosegi::value::MapFormat;
use yosegi::world::{PendingFile, World};

const PAIRS: usize = 5;
/// Rows that are encoded and written together, as the engine does with a row of tiles.
const BAND: usize = 64;

/// A disk that forgets everything.
struct Nowhere;

impl World for Nowhere {
    fn read(&self, _: &Path) -> io::Result<Vec<u8>> {
        Err(io::ErrorKind::NotFound.into())
    }

    fn create(&self, _: &Path) -> io::Result<Box<dyn PendingFile>> {
        Ok(Box::new(Nowhere))
    }
}

impl Write for Nowhere {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(black_box(bytes).len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Nowhere {
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        Ok(0)
    }
}

impl PendingFile for Nowhere {
    fn commit(self: Box<Self>) -> io::Result<()> {
        Ok(())
    }
}

/// Red, green and blue of a plain-sawn board: rings across, fibres along, noise from point to point.
fn wood(side: usize) -> [Vec<f32>; 3] {
    let noise = |x: usize, y: usize| {
        let mixed = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
        let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d);
        ((mixed ^ mixed >> 13) & 0xff) as f32 / 255.0 - 0.5
    };
    let pixel = |x: usize, y: usize| {
        let [u, v] = [x as f32 / side as f32, y as f32 / side as f32];
        let ring = ((u + 0.04 * v * (1.0 - v)) * 40.0).fract();
        let light = 1.0 + 0.08 * noise(x, y / 64) + 0.03 * noise(x, y);
        [(0.62, 0.35), (0.4, 0.27), (0.21, 0.15)]
            .map(|(early, late)| (early - late * ring * ring * ring) * light)
    };
    let pixels = |sample: usize| {
        let all = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        all.map(|(x, y)| pixel(x, y)[sample]).collect()
    };
    [pixels(0), pixels(1), pixels(2)]
}

fn encode(encoder: &Encoder, columns: &[Vec<f32>; 3], start: usize, bytes: &mut [u8]) {
    let length = bytes.len() / encoder.pixel_bytes();
    let part = columns
        .each_ref()
        .map(|column| &column[start..start + length]);
    black_box(encoder.encode(&part, bytes));
}

/// Encodes and writes a map of ours.
fn ours(columns: &[Vec<f32>; 3], side: usize, format: MapFormat) {
    let request = MapRequest {
        pixels: [side as u32; 2],
        size_mm: [1000.0; 2],
        kind: MapKind::Colour,
        format,
        key: Key::of_bytes(b"bench"),
        channel: "base_color".to_owned(),
    };
    let encoder = Encoder::new(request.kind, format, None);
    let mut writer = create(&Nowhere, Path::new("wood"), &request).expect("nowhere has room");
    let mut band = vec![0; BAND * request.row_bytes()];
    for start in (0..side * side).step_by(BAND * side) {
        let rows = BAND.min(side - start / side);
        let bytes = &mut band[..rows * request.row_bytes()];
        encode(&encoder, columns, start, bytes);
        writer.write_rows(bytes).expect("nowhere has room");
    }
    writer.finish().expect("nowhere has room");
}

/// The png crate's own call with the same setting.
fn their_png(bytes: &[u8], side: usize, depth: png::BitDepth) {
    let mut encoder = png::Encoder::new(Nowhere, side as u32, side as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().expect("nowhere has room");
    writer.write_image_data(bytes).expect("nowhere has room");
}

/// The exr crate's own call on one thread with the same compression.
fn their_exr(columns: &[Vec<f32>; 3], side: usize, format: MapFormat) {
    let encoding = Encoding {
        compression: exr::compression::Compression::PIZ,
        blocks: exr::image::Blocks::ScanLines,
        line_order: exr::meta::attribute::LineOrder::Increasing,
    };
    let at = |Vec2(x, y): Vec2<usize>| columns.each_ref().map(|column| column[y * side + x]);
    let size = Vec2(side, side);
    let attributes = LayerAttributes::default();
    let mut file = Cursor::new(Vec::new());
    let written = if format == MapFormat::ExrHalf {
        let channels = SpecificChannels::rgb(|at_pixel: Vec2<usize>| {
            let [r, g, b] = at(at_pixel).map(f16::from_f32);
            (r, g, b)
        });
        let image = Image::from_layer(Layer::new(size, attributes, encoding, channels));
        image.write().non_parallel().to_buffered(&mut file)
    } else {
        let channels = SpecificChannels::rgb(|at_pixel: Vec2<usize>| at(at_pixel).into());
        let image = Image::from_layer(Layer::new(size, attributes, encoding, channels));
        image.write().non_parallel().to_buffered(&mut file)
    };
    written.expect("memory has room");
    black_box(file.into_inner());
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// Runs both in turn and prints the least times and the median ratio.
fn compare(name: &str, mut ours: impl FnMut(), mut theirs: impl FnMut()) {
    let pairs: Vec<[f64; 2]> = (0..PAIRS)
        .map(|_| [seconds(&mut ours), seconds(&mut theirs)])
        .collect();
    let least = |which: usize| {
        pairs
            .iter()
            .map(|pair| pair[which])
            .fold(f64::INFINITY, f64::min)
    };
    let mut ratios: Vec<f64> = pairs.iter().map(|[ours, theirs]| ours / theirs).collect();
    ratios.sort_by(f64::total_cmp);
    let (ours, theirs, ratio) = (least(0) * 1e3, least(1) * 1e3, ratios[PAIRS / 2]);
    println!("{name:32} ours {ours:7.1} ms, theirs {theirs:7.1} ms, ratio {ratio:.2}");
}

fn main() {
    let side = std::env::args()
        .find_map(|argument| argument.parse().ok())
        .unwrap_or(4096);
    let columns = wood(side);
    let depths = [
        (MapFormat::Png8, png::BitDepth::Eight),
        (MapFormat::Png16, png::BitDepth::Sixteen),
    ];
    for (format, depth) in depths {
        let encoder = Encoder::new(MapKind::Colour, format, None);
        let mut bytes = vec![0; side * side * encoder.pixel_bytes()];
        encode(&encoder, &columns, 0, &mut bytes);
        let all = seconds(|| encode(&encoder, &columns, 0, &mut bytes));
        let samples = (side * side * 3) as f64;
        println!(
            "{format:?}: encoding alone {:.2} ns a sample",
            all * 1e9 / samples
        );
        compare(
            &format!("{format:?} encoded and written"),
            || ours(&columns, side, format),
            || their_png(&bytes, side, depth),
        );
    }
    for (format, threads) in [MapFormat::ExrHalf, MapFormat::ExrFloat]
        .into_iter()
        .flat_map(|format| [(format, 1), (format, 2)])
    {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.expect("threads can be started");
        compare(
            &format!("{format:?} with {threads} of our threads"),
            || pool.install(|| ours(&columns, side, format)),
            || their_exr(&columns, side, format),
        );
    }
}
