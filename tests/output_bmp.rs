//! BMP maps read back by another reader hold exactly the expected samples; larger ones are refused.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod output_support;

use output_support::{KINDS, Map, SIZES, expected, request, with_size};
use std::io;
use yosegi::output::{LARGEST_BMP, MapKind, bmp_bytes, create, read_key};
use yosegi::value::MapFormat;
use yosegi::world::Memory;

/// The little-endian number of `length` bytes that starts at `at`.
fn number(bytes: &[u8], at: usize, length: usize) -> u32 {
    let bytes = bytes[at..at + length].iter().rev();
    bytes.fold(0, |all, byte| all << 8 | u32::from(*byte))
}

#[test]
fn samples_are_the_nearest() {
    for kind in KINDS {
        for size in SIZES {
            let map = Map::gradient(&with_size(size, kind, MapFormat::Bmp));
            let image = image::load_from_memory_with_format(&map.bytes, image::ImageFormat::Bmp);
            let found = image.unwrap().into_rgb8().into_raw();
            let samples = map
                .values
                .iter()
                .map(|value| expected(kind, 255.0, *value) as u8);
            let wanted: Vec<u8> = if kind == MapKind::Number {
                samples.flat_map(|grey| [grey; 3]).collect()
            } else {
                samples.collect()
            };
            assert!(found == wanted, "{kind:?} {size:?}");
        }
    }
}

#[test]
fn the_header_tells_sizes_and_resolution() {
    for (kind, bits, start, stride) in [
        (MapKind::Colour, 24, 54, 100),
        (MapKind::Number, 8, 1078, 36),
    ] {
        let map = Map::gradient(&request(kind, MapFormat::Bmp));
        let bytes = &map.bytes;
        assert_eq!(&bytes[..2], b"BM");
        assert_eq!(number(bytes, 2, 4) as usize, bytes.len());
        assert_eq!(bytes.len(), start + 20 * stride);
        assert_eq!(bmp_bytes([33, 20], kind), bytes.len() as u64);
        assert_eq!(number(bytes, 10, 4) as usize, start);
        assert_eq!([18, 22].map(|at| number(bytes, at, 4)), [33, 20]);
        assert_eq!([26, 28].map(|at| number(bytes, at, 2)), [1, bits]);
        // Pixels to the metre.
        assert_eq!([38, 42].map(|at| number(bytes, at, 4)), [4000, 2000]);
        assert_eq!(read_key(&map.world, &map.path), None);
    }
}

#[test]
fn a_bmp_beyond_the_limit_is_refused() {
    // 54 bytes of headers, and rows of three bytes a pixel filled up to multiples of four.
    let [fits, beyond] = [[26_754, 26_754], [26_755, 26_754]];
    assert_eq!(bmp_bytes(fits, MapKind::Colour), 54 + 80_264 * 26_754);
    assert!(bmp_bytes(fits, MapKind::Colour) <= LARGEST_BMP);
    assert!(bmp_bytes(beyond, MapKind::Colour) > LARGEST_BMP);
    let world = Memory::default();
    let start = |pixels| {
        create(
            &world,
            "bark".as_ref(),
            &with_size(pixels, MapKind::Colour, MapFormat::Bmp),
        )
    };
    assert!(start(fits).is_ok());
    let error = start(beyond).err().unwrap();
    assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
    assert_eq!(
        error.to_string(),
        "cannot write `bark`: expected a BMP of at most 2147483647 bytes, found 2147490126 bytes"
    );
}
