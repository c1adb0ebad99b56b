//! BMP maps: the plainest file there is, without compression and without a place for a key.

use super::{MapKind, MapRequest, MapWriter, invalid};
use crate::world::PendingFile;
use std::io::{self, SeekFrom};

/// Most bytes of a BMP: many readers hold its sizes in signed 32-bit numbers.
pub const LARGEST_BMP: u64 = i32::MAX as u64;

/// Bytes of the two headers in front of the palette.
const HEADERS: usize = 14 + 40;
/// Bytes of the greys of maps with one sample a pixel.
const PALETTE: usize = 256 * 4;

/// Writes a BMP from its end to its start: the rows of the file go upwards, as every reader expects.
pub(super) struct BmpWriter {
    file: Box<dyn PendingFile>,
    layout: Layout,
    /// Rows that are still to come.
    missing: u64,
}

/// Where things lie in the file.
struct Layout {
    samples: usize,
    row_bytes: usize,
    /// Bytes of a row filled up to a multiple of four.
    stride: usize,
    height: u64,
    start: usize,
}

impl Layout {
    fn new([width, height]: [u32; 2], kind: MapKind) -> Layout {
        let samples = kind.samples();
        let row_bytes = width as usize * samples;
        Layout {
            samples,
            row_bytes,
            stride: row_bytes.next_multiple_of(4),
            height: height.into(),
            start: HEADERS + if samples == 1 { PALETTE } else { 0 },
        }
    }

    fn file_bytes(&self) -> u64 {
        self.start as u64 + self.stride as u64 * self.height
    }

    /// What comes before the pixels.
    fn head(&self, request: &MapRequest) -> Vec<u8> {
        let words = |words: &[u32]| -> Vec<u8> {
            words.iter().flat_map(|word| word.to_le_bytes()).collect()
        };
        let [width, height] = request.pixels;
        // Rounded to nearest; the conversion clamps; 0 is unknown.
        let density = request.density().unwrap_or([0.0; 2]);
        let [across, down] = density.map(|it| (it * 1000.0 + 0.5) as i32 as u32);
        let planes_and_bits = 1 | (self.samples as u32 * 8) << 16;
        let pixels = self.file_bytes() - self.start as u64;
        let mut head = b"BM".to_vec();
        head.extend(words(&[self.file_bytes() as u32, 0, self.start as u32]));
        head.extend(words(&[40, width, height, planes_and_bits, 0]));
        head.extend(words(&[pixels as u32, across, down, 0, 0]));
        if self.samples == 1 {
            let greys = (0..=255u8).flat_map(|grey| [grey, grey, grey, 0]);
            head.extend(greys);
        }
        head
    }

    /// Rows from top to bottom as the file holds them: upwards, blue before green before red, filled up.
    fn turned(&self, rows: &[u8]) -> Vec<u8> {
        let mut turned = vec![0; rows.len() / self.row_bytes * self.stride];
        let places = turned.chunks_exact_mut(self.stride);
        for (place, row) in places.zip(rows.chunks_exact(self.row_bytes).rev()) {
            let place = &mut place[..self.row_bytes];
            place.copy_from_slice(row);
            place
                .chunks_exact_mut(self.samples)
                .for_each(<[u8]>::reverse);
        }
        turned
    }
}

/// The bytes of a BMP of maps of `kind`; more than [`LARGEST_BMP`] are refused.
pub fn bmp_bytes(pixels: [u32; 2], kind: MapKind) -> u64 {
    Layout::new(pixels, kind).file_bytes()
}

impl BmpWriter {
    pub(super) fn new(
        mut file: Box<dyn PendingFile>,
        request: &MapRequest,
    ) -> io::Result<BmpWriter> {
        let layout = Layout::new(request.pixels, request.kind);
        file.write_all(&layout.head(request))?;
        Ok(BmpWriter {
            file,
            missing: layout.height,
            layout,
        })
    }
}

impl MapWriter for BmpWriter {
    fn write_rows(&mut self, rows: &[u8]) -> io::Result<()> {
        let count = (rows.len() / self.layout.row_bytes) as u64;
        self.missing = self
            .missing
            .checked_sub(count)
            .ok_or_else(|| invalid("more rows than the map has"))?;
        let place = self.layout.start as u64 + self.missing * self.layout.stride as u64;
        self.file.seek(SeekFrom::Start(place))?;
        self.file.write_all(&self.layout.turned(rows))
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.file.commit()
    }
}
