//! Encoding and writing maps against the one-call writers of the crates, in pairs, as ratios of one run.
//!
//! `cargo bench --bench output [SIDE]`: wood with grain and the normals of a rough ground, 4096 by 4096
//! pixels unless said otherwise. Ours starts from columns of floats, theirs from finished bytes or floats in
//! memory; files go nowhere. Times are the least of the runs, ratios the medians of the pairs.

mod output_support;

use exr::prelude::{
    Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage, f16,
};
use output_support::pictures::{normals, wood};
use output_support::{Nowhere, seconds};
use rayon::ThreadPool;
use rayon::prelude::*;
use std::hint::black_box;
use std::io::Cursor;
use std::path::Path;
use std::sync::atomic::Ordering;
use yosegi::key::Key;
use yosegi::output::{Encoder, MapKind, MapRequest, create};
use yosegi::value::MapFormat;

const PAIRS: usize = 7;
/// Rows that are encoded and written together, as the engine does with a row of tiles.
const BAND: usize = 128;
/// Rows that one thread encodes.
const PART: usize = 16;

/// A picture, and how it is to be written.
struct Picture {
    name: &'static str,
    columns: [Vec<f32>; 3],
    side: usize,
    kind: MapKind,
}

impl Picture {
    fn encode(&self, encoder: &Encoder, start: usize, bytes: &mut [u8]) {
        let part_bytes = PART * self.side * encoder.pixel_bytes();
        let parts = bytes.par_chunks_mut(part_bytes).enumerate();
        parts.for_each(|(part, bytes)| {
            let start = start + part * PART * self.side;
            let length = bytes.len() / encoder.pixel_bytes();
            let part = self
                .columns
                .each_ref()
                .map(|column| &column[start..start + length]);
            black_box(encoder.encode(&part, bytes));
        });
    }

    fn bytes(&self, format: MapFormat) -> Vec<u8> {
        let encoder = Encoder::new(self.kind, format, None);
        let mut bytes = vec![0; self.side * self.side * encoder.pixel_bytes()];
        self.encode(&encoder, 0, &mut bytes);
        bytes
    }

    /// Writes a map of ours, the rows of each band made by `fill`; gives its size.
    fn write_bands(&self, format: MapFormat, mut fill: impl FnMut(usize, &mut [u8])) -> u64 {
        let request = MapRequest {
            pixels: [self.side as u32; 2],
            size_mm: [1000.0; 2],
            kind: self.kind,
            format,
            key: Key::of_bytes(b"bench"),
            channel: self.name.to_owned(),
        };
        let nowhere = Nowhere::default();
        let mut writer =
            create(&nowhere, Path::new(self.name), &request).expect("nowhere has room");
        let mut band = vec![0; BAND * request.row_bytes()];
        for row in (0..self.side).step_by(BAND) {
            let bytes = &mut band[..BAND.min(self.side - row) * request.row_bytes()];
            fill(row, bytes);
            writer.write_rows(bytes).expect("nowhere has room");
        }
        writer.finish().expect("nowhere has room");
        nowhere.0.load(Ordering::Relaxed)
    }

    /// Encodes and writes a map of ours; gives its size.
    fn write(&self, format: MapFormat) -> u64 {
        let encoder = Encoder::new(self.kind, format, None);
        self.write_bands(format, |row, band| {
            self.encode(&encoder, row * self.side, band);
        })
    }

    /// Writes finished bytes.
    fn write_bytes(&self, format: MapFormat, bytes: &[u8]) -> u64 {
        let row_bytes = bytes.len() / self.side;
        self.write_bands(format, |row, band| {
            let start = row * row_bytes;
            band.copy_from_slice(&bytes[start..start + band.len()]);
        })
    }
}

/// The png crate's own call at its fast setting; gives the size of the file.
fn their_png(bytes: &[u8], side: usize, depth: png::BitDepth) -> u64 {
    let nowhere = Nowhere::default();
    let mut encoder = png::Encoder::new(nowhere.clone(), side as u32, side as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().expect("nowhere has room");
    writer.write_image_data(bytes).expect("nowhere has room");
    writer.finish().expect("nowhere has room");
    nowhere.0.load(Ordering::Relaxed)
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

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Runs both in turn and prints the least times and the median ratios, on the wall and of the processors.
fn compare(name: &str, mut ours: impl FnMut(), mut theirs: impl FnMut()) {
    let pairs: Vec<[[f64; 2]; 2]> = (0..PAIRS)
        .map(|_| [seconds(&mut ours), seconds(&mut theirs)])
        .collect();
    let least = |which: usize, clock: usize| {
        let times = pairs.iter().map(|pair| pair[which][clock]);
        times.fold(f64::INFINITY, f64::min) * 1e3
    };
    let ratio = |clock: usize| {
        let ratios = pairs.iter().map(|pair| pair[0][clock] / pair[1][clock]);
        median(ratios.collect())
    };
    let [processor, wall] = [1, 0].map(|clock| {
        let [ours, theirs] = [least(0, clock), least(1, clock)];
        format!("{ours:7.1} to {theirs:7.1} ms = {:.2}", ratio(clock))
    });
    println!("{name:40} processor {processor}   wall {wall}");
}

fn pool(threads: usize) -> ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads can be started")
}

fn compare_png([one, two]: &[ThreadPool; 2], picture: &Picture, format: MapFormat) {
    let depth = match format {
        MapFormat::Png16 => png::BitDepth::Sixteen,
        _ => png::BitDepth::Eight,
    };
    let bytes = one.install(|| picture.bytes(format));
    let encoder = Encoder::new(picture.kind, format, None);
    let mut place = bytes.clone();
    let [_, alone] = seconds(|| one.install(|| picture.encode(&encoder, 0, &mut place)));
    let samples = (picture.side * picture.side * 3) as f64;
    let name = format!("{} {}", picture.name, format.name());
    let sizes = [
        picture.write(format),
        their_png(&bytes, picture.side, depth),
    ];
    let percent = sizes.map(|size| size as f64 / bytes.len() as f64 * 100.0);
    println!(
        "{name}: encoding alone {:.2} ns a sample; ours {:.1} %, theirs {:.1} % of the samples",
        alone * 1e9 / samples,
        percent[0],
        percent[1]
    );
    let theirs = || {
        their_png(&bytes, picture.side, depth);
    };
    let ours = |pool: &ThreadPool| {
        pool.install(|| picture.write(format));
    };
    compare(
        &format!("{name}, 1 thread, finished bytes"),
        || {
            one.install(|| picture.write_bytes(format, &bytes));
        },
        theirs,
    );
    compare(&format!("{name}, 1 thread to theirs"), || ours(one), theirs);
    compare(
        &format!("{name}, 2 threads to theirs"),
        || ours(two),
        theirs,
    );
    compare(
        &format!("{name}, 2 threads to 1"),
        || ours(two),
        || ours(one),
    );
}

fn main() {
    let side = std::env::args()
        .find_map(|argument| argument.parse().ok())
        .unwrap_or(4096);
    let wood = Picture {
        name: "wood",
        columns: wood(side),
        side,
        kind: MapKind::Colour,
    };
    let normals = Picture {
        name: "normals",
        columns: normals(side),
        side,
        kind: MapKind::Normal,
    };
    // The pools outlive all measurements: the time of a thread that has ended is no longer told.
    let pools = [1, 2].map(pool);
    for picture in [&wood, &normals] {
        compare_png(&pools, picture, MapFormat::Png8);
        compare_png(&pools, picture, MapFormat::Png16);
    }
    for format in [MapFormat::ExrHalf, MapFormat::ExrFloat] {
        for pool in &pools {
            compare(
                &format!(
                    "{}, {} of our threads",
                    format.name(),
                    pool.current_num_threads()
                ),
                || {
                    pool.install(|| wood.write(format));
                },
                || their_exr(&wood.columns, side, format),
            );
        }
    }
}
