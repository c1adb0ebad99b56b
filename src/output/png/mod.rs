//! PNG maps, written as a stream of strips.

mod filter;

use super::strips::{Division, Strip, Strips};
use super::{CHANNEL_NAME, KEY_NAME, MapKind, MapRequest, MapWriter, SOFTWARE, deflate};
use crate::cancel::Cancel;
use crate::world::PendingFile;
use std::io::{self, Cursor};

/// Writes a PNG: the strips in work are all that it holds, and each becomes one chunk.
pub(super) struct PngWriter {
    file: Box<dyn PendingFile>,
    strips: Strips,
    pixel_bytes: usize,
    /// Checksum of all filtered rows so far.
    adler: u32,
}

/// A finished chunk, and checksum and length of what it was made of.
struct Compressed {
    chunk: Vec<u8>,
    adler: u32,
    length: usize,
}

impl PngWriter {
    pub(super) fn new(
        mut file: Box<dyn PendingFile>,
        request: &MapRequest,
        cancel: &Cancel,
    ) -> io::Result<PngWriter> {
        file.write_all(&start(request))?;
        let division = Division::new(request.row_bytes(), request.pixels[1] as usize);
        Ok(PngWriter {
            file,
            strips: Strips::new(division, cancel),
            pixel_bytes: request.pixel_bytes(),
            adler: 1,
        })
    }
}

impl MapWriter for PngWriter {
    fn write_rows(&mut self, rows: &[u8]) -> io::Result<()> {
        let PngWriter { file, adler, .. } = self;
        let pixel_bytes = self.pixel_bytes;
        self.strips.push(
            rows,
            |strip| Ok(compress(strip, pixel_bytes)),
            |compressed| append(file, adler, &compressed),
        )
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.file
            .write_all(&chunk(b"IDAT", &self.adler.to_be_bytes()))?;
        self.file.write_all(&chunk(b"IEND", &[]))?;
        self.file.commit()
    }
}

fn compress(strip: Strip<'_>, pixel_bytes: usize) -> Compressed {
    let filtered = filter::filter_rows(strip.rows, strip.above, pixel_bytes);
    let mut data = vec![];
    if strip.index == 0 {
        data.extend(deflate::ZLIB_HEADER);
    }
    data.extend(deflate::compress(&filtered, strip.is_last));
    Compressed {
        chunk: chunk(b"IDAT", &data),
        adler: simd_adler32::adler32(&filtered.as_slice()),
        length: filtered.len(),
    }
}

fn append(
    file: &mut Box<dyn PendingFile>,
    adler: &mut u32,
    compressed: &Compressed,
) -> io::Result<()> {
    *adler = deflate::join_adler(*adler, compressed.adler, compressed.length);
    file.write_all(&compressed.chunk)
}

/// What comes before the pixels.
///
/// Colours carry an `sRGB` chunk, and `gAMA` and `cHRM` for readers that do not know it (PNG
/// specification, 11.3.2.5). Data carry none of them: without one, no reader converts their samples, while
/// one that honours `gAMA` 1 would.
fn start(request: &MapRequest) -> Vec<u8> {
    let is_colour = request.kind == MapKind::Colour;
    let mut start = b"\x89PNG\r\n\x1a\n".to_vec();
    start.extend(chunk(b"IHDR", &header(request)));
    if is_colour {
        let words = |words: &[u32]| -> Vec<u8> {
            words.iter().flat_map(|word| word.to_be_bytes()).collect()
        };
        // Perceptual, 1 / 2.2, and white, red, green and blue of Rec. 709, in hundred-thousandths.
        start.extend(chunk(b"sRGB", &[0]));
        start.extend(chunk(b"gAMA", &words(&[45455])));
        let places = [31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000];
        start.extend(chunk(b"cHRM", &words(&places)));
    }
    if let Some(density) = request.density() {
        start.extend(chunk(b"pHYs", &pixels_per_metre(density)));
    }
    let key = request.key.hexadecimal();
    for (name, text) in [
        (KEY_NAME, &*key),
        (CHANNEL_NAME, &request.channel),
        ("Software", SOFTWARE),
    ] {
        start.extend(chunk(
            b"tEXt",
            &[name.as_bytes(), &[0], text.as_bytes()].concat(),
        ));
    }
    start
}

/// Width, height, bits, and grey or RGB, not interlaced.
fn header(request: &MapRequest) -> Vec<u8> {
    let samples = request.kind.samples();
    let bits = request.pixel_bytes() / samples * 8;
    let colour_type = if samples == 3 { 2 } else { 0 };
    let [width, height] = request.pixels.map(u32::to_be_bytes);
    [&width[..], &height, &[bits as u8, colour_type, 0, 0, 0]].concat()
}

fn pixels_per_metre(per_mm: [f64; 2]) -> Vec<u8> {
    // Rounded to nearest; the conversion clamps. The unit is the metre.
    let [across, down] = per_mm.map(|density| ((density * 1000.0 + 0.5) as u32).to_be_bytes());
    [&across[..], &down, &[1]].concat()
}

fn chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut chunk = Vec::with_capacity(data.len() + 12);
    chunk.extend_from_slice(&(data.len() as u32).to_be_bytes());
    chunk.extend_from_slice(name);
    chunk.extend_from_slice(data);
    let sum = crc32fast::hash(&chunk[4..]);
    chunk.extend_from_slice(&sum.to_be_bytes());
    chunk
}

/// The text called `name` in front of the pixels of a PNG that may be cut off after them.
pub(super) fn read_text(start: &[u8], name: &str) -> Option<String> {
    let reader = png::Decoder::new(Cursor::new(start)).read_info().ok()?;
    let mut texts = reader.info().uncompressed_latin1_text.iter();
    texts
        .find(|text| text.keyword == name)
        .map(|text| text.text.clone())
}
