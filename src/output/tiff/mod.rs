//! TIFF maps, written as a stream of strips.

mod directory;
mod predict;

use super::strips::{Division, Strip, Strips};
use super::{MapRequest, MapWriter, deflate};
use crate::cancel::Cancel;
use crate::world::PendingFile;
use directory::Directory;
use predict::Predictor;
use std::io::{self, SeekFrom};

pub(super) use directory::read_text;

/// Writes a TIFF: it holds the strips in work, and where each strip lies.
///
/// The directory is in front of the strips, so that a reader finds the key in the first bytes. It is written
/// twice: its tables are known when all strips are.
pub(super) struct TiffWriter {
    file: Box<dyn PendingFile>,
    strips: Strips,
    predictor: Predictor,
    directory: Directory,
    /// Bytes written so far.
    position: u64,
    /// Strips written so far.
    written: usize,
}

impl TiffWriter {
    pub(super) fn new(
        file: Box<dyn PendingFile>,
        request: &MapRequest,
        cancel: &Cancel,
    ) -> io::Result<TiffWriter> {
        let division = Division::new(request.row_bytes(), request.pixels[1] as usize);
        let directory = Directory::new(request, division);
        TiffWriter::start(file, request, division, directory, cancel)
    }

    fn start(
        mut file: Box<dyn PendingFile>,
        request: &MapRequest,
        division: Division,
        directory: Directory,
        cancel: &Cancel,
    ) -> io::Result<TiffWriter> {
        let head = directory.bytes();
        file.write_all(&head)?;
        Ok(TiffWriter {
            file,
            strips: Strips::new(division, cancel),
            predictor: Predictor::new(request),
            directory,
            position: head.len() as u64,
            written: 0,
        })
    }
}

impl MapWriter for TiffWriter {
    fn write_rows(&mut self, rows: &[u8]) -> io::Result<()> {
        let TiffWriter {
            file,
            strips,
            predictor,
            directory,
            position,
            written,
        } = self;
        strips.push(
            rows,
            |strip| Ok(compress(strip, *predictor)),
            |strip| {
                directory.place(*written, *position, strip.len() as u64);
                *written += 1;
                *position += strip.len() as u64;
                file.write_all(&strip)
            },
        )
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(0))?;
        self.file.write_all(&self.directory.bytes())?;
        self.file.commit()
    }
}

/// A strip as a stream of its own.
fn compress(strip: Strip<'_>, predictor: Predictor) -> Vec<u8> {
    let predicted = predictor.apply(strip.rows);
    let mut bytes = deflate::ZLIB_HEADER.to_vec();
    bytes.extend(deflate::compress(&predicted, true));
    bytes.extend(simd_adler32::adler32(&predicted.as_slice()).to_be_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::key::Key;
    use crate::output::MapKind;
    use crate::value::MapFormat;
    use crate::world::{Memory, World};
    use std::io::Cursor;
    use tiff::decoder::{Decoder, DecodingResult};

    #[test]
    fn a_file_with_wide_offsets_comes_back() {
        let request = MapRequest {
            pixels: [900, 300],
            size_mm: [90.0, 30.0],
            kind: MapKind::Number,
            format: MapFormat::Tiff8,
            key: Key::of_bytes(b"a board"),
            channel: "bark".to_owned(),
        };
        let division = Division::new(request.row_bytes(), 300);
        let directory = Directory::with_offsets(&request, division, true);
        let files = Memory::default();
        let file = files.create("bark".as_ref()).unwrap();
        let mut writer =
            TiffWriter::start(file, &request, division, directory, &Cancel::new()).unwrap();
        let rows: Vec<u8> = (0..900u32 * 300).map(|at| (at / 7) as u8).collect();
        writer.write_rows(&rows).unwrap();
        Box::new(writer).finish().unwrap();
        let bytes = files.read("bark".as_ref()).unwrap();
        assert_eq!(bytes[..4], *b"II\x2b\0");
        let mut decoder = Decoder::new(Cursor::new(bytes)).unwrap();
        let DecodingResult::U8(found) = decoder.read_image().unwrap() else {
            panic!("bytes")
        };
        assert!(found == rows);
    }
}
