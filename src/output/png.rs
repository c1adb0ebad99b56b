//! PNG maps, written as a stream.

use super::{CHANNEL_NAME, KEY_NAME, MapKind, MapRequest, MapWriter, SOFTWARE};
use crate::value::MapFormat;
use crate::world::PendingFile;
use png::{BitDepth, ColorType, Compression, Filter, PixelDimensions, SrgbRenderingIntent, Unit};
use std::io::{self, Cursor, Write};
use std::sync::{Arc, Mutex, PoisonError};

/// Bytes of compressed data in one chunk of the file.
const CHUNK: usize = 1 << 16;

/// Writes a PNG: the compressor and two rows are all that it holds.
///
/// Colours carry an `sRGB` chunk. Data carry no `gAMA`: a viewer that honours gamma 1 would change them.
pub(super) struct PngWriter {
    stream: png::StreamWriter<'static, Sink>,
    sink: Sink,
}

impl PngWriter {
    pub(super) fn new(file: Box<dyn PendingFile>, request: &MapRequest) -> io::Result<PngWriter> {
        let sink = Sink(Arc::new(Mutex::new(Latch { file, error: None })));
        let writer = describe(sink.clone(), request)?.write_header()?;
        let stream = writer.into_stream_writer_with_size(CHUNK)?;
        sink.check()?;
        Ok(PngWriter { stream, sink })
    }
}

fn describe(sink: Sink, request: &MapRequest) -> io::Result<png::Encoder<'static, Sink>> {
    let mut info = png::Info::with_size(request.pixels[0], request.pixels[1]);
    info.pixel_dims = request.density().map(pixels_per_metre);
    let mut encoder = png::Encoder::with_info(sink, info)?;
    encoder.set_color(match request.kind {
        MapKind::Colour | MapKind::Normal => ColorType::Rgb,
        MapKind::Number => ColorType::Grayscale,
    });
    encoder.set_depth(match request.format {
        MapFormat::Png16 => BitDepth::Sixteen,
        _ => BitDepth::Eight,
    });
    if request.kind == MapKind::Colour {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    }
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    encoder.add_text_chunk(KEY_NAME.to_owned(), request.key.hexadecimal())?;
    encoder.add_text_chunk(CHANNEL_NAME.to_owned(), request.channel.clone())?;
    encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())?;
    Ok(encoder)
}

fn pixels_per_metre(per_mm: [f64; 2]) -> PixelDimensions {
    // Rounded to nearest; the conversion clamps.
    let [xppu, yppu] = per_mm.map(|density| (density * 1000.0 + 0.5) as u32);
    PixelDimensions {
        xppu,
        yppu,
        unit: Unit::Meter,
    }
}

impl MapWriter for PngWriter {
    fn write_rows(&mut self, rows: &[u8]) -> io::Result<()> {
        self.stream.write_all(rows)?;
        self.sink.check()
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        let PngWriter { stream, sink } = *self;
        // Dropping what the stream held writes the last chunk.
        stream.finish()?;
        let latch = Arc::into_inner(sink.0).expect("the stream is gone");
        let Latch { file, error } = latch.into_inner().unwrap_or_else(PoisonError::into_inner);
        error.map_or_else(|| file.commit(), Err)
    }
}

/// Passes bytes to the file until that fails, then drops them and keeps the error.
///
/// The compressor takes for granted that its writer never fails, and the stream gives it back to nobody:
/// so errors are kept here, and the file is shared with the one who commits it.
#[derive(Clone)]
struct Sink(Arc<Mutex<Latch>>);

struct Latch {
    file: Box<dyn PendingFile>,
    error: Option<io::Error>,
}

impl Sink {
    /// The error that was kept, once.
    fn check(&self) -> io::Result<()> {
        let mut latch = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        latch.error.take().map_or(Ok(()), Err)
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut latch = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if latch.error.is_none() {
            latch.error = latch.file.write_all(bytes).err();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The text called `name` in front of the pixels of a PNG that may be cut off after them.
pub(super) fn read_text(start: &[u8], name: &str) -> Option<String> {
    let reader = png::Decoder::new(Cursor::new(start)).read_info().ok()?;
    let mut texts = reader.info().uncompressed_latin1_text.iter();
    texts
        .find(|text| text.keyword == name)
        .map(|text| text.text.clone())
}
