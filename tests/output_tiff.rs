//! TIFF maps read back by another reader hold exactly the expected samples and say what they are.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod output_support;

use half::f16;
use output_support::{KINDS, Map, SIZES, expected, key, request, with_size};
use std::io::Cursor;
use tiff::ColorType;
use tiff::decoder::ifd::Value;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;
use yosegi::output::{MapKind, MapRequest, read_key};
use yosegi::value::MapFormat;

fn decoder(map: &Map) -> Decoder<Cursor<&[u8]>> {
    Decoder::new(Cursor::new(map.bytes.as_slice())).unwrap()
}

fn samples(map: &Map) -> DecodingResult {
    decoder(map).read_image().unwrap()
}

/// Every kind and size.
fn requests(format: MapFormat) -> impl Iterator<Item = MapRequest> {
    let pairs = KINDS
        .into_iter()
        .flat_map(|kind| SIZES.map(|size| (kind, size)));
    pairs.map(move |(kind, size)| with_size(size, kind, format))
}

#[test]
fn whole_samples_are_the_nearest() {
    for (format, max) in [(MapFormat::Tiff8, 255.0), (MapFormat::Tiff16, 65535.0)] {
        for request in requests(format) {
            let map = Map::gradient(&request);
            let found: Vec<u16> = match samples(&map) {
                DecodingResult::U8(samples) => samples.into_iter().map(u16::from).collect(),
                DecodingResult::U16(samples) => samples,
                _ => panic!("whole samples"),
            };
            let wanted = map
                .values
                .iter()
                .map(|value| expected(request.kind, max, *value));
            assert!(found == wanted.collect::<Vec<_>>(), "{request:?}");
        }
    }
}

#[test]
fn floats_are_the_values_themselves() {
    for request in requests(MapFormat::TiffFloat) {
        let map = Map::gradient(&request);
        let DecodingResult::F32(found) = samples(&map) else {
            panic!("floats")
        };
        assert!(found == map.values, "{request:?}");
    }
}

#[test]
fn halves_are_the_nearest() {
    for request in requests(MapFormat::TiffHalf) {
        let map = Map::gradient(&request);
        let DecodingResult::F16(found) = samples(&map) else {
            panic!("halves")
        };
        let wanted = map.values.iter().map(|value| f16::from_f32_const(*value));
        assert!(found == wanted.collect::<Vec<_>>(), "{request:?}");
    }
}

#[test]
fn several_strips_come_back_in_their_order() {
    let map = Map::gradient(&with_size(
        [3000, 130],
        MapKind::Number,
        MapFormat::TiffFloat,
    ));
    assert!(decoder(&map).strip_count().unwrap() > 10);
    let DecodingResult::F32(found) = samples(&map) else {
        panic!("floats")
    };
    assert!(found == map.values);
}

#[test]
fn a_tiff_tells_its_size_its_key_and_its_colours() {
    for (kind, format, colours) in [
        (MapKind::Colour, MapFormat::Tiff8, ColorType::RGB(8)),
        (MapKind::Colour, MapFormat::TiffHalf, ColorType::RGB(16)),
        (MapKind::Normal, MapFormat::Tiff16, ColorType::RGB(16)),
        (MapKind::Number, MapFormat::TiffFloat, ColorType::Gray(32)),
    ] {
        let map = Map::gradient(&request(kind, format));
        let mut decoder = decoder(&map);
        assert_eq!(decoder.dimensions().unwrap(), (33, 20));
        assert_eq!(decoder.colortype().unwrap(), colours);
        // 33 by 20 pixels on 8.25 by 10 mm: 40 and 20 to the centimetre, in thousandths.
        let mut numbers = |tag| decoder.get_tag_u32_vec(tag).ok();
        assert_eq!(numbers(Tag::XResolution), Some(vec![40_000, 1000]));
        assert_eq!(numbers(Tag::YResolution), Some(vec![20_000, 1000]));
        assert_eq!(numbers(Tag::ResolutionUnit), Some(vec![3]));
        let mut fractions = |tag| decoder.get_tag(Tag::Unknown(tag)).ok();
        let is_colour = kind == MapKind::Colour;
        let list = |numbers: &[u32]| {
            let fractions = numbers.iter().map(|it| Value::Rational(*it, 10_000));
            is_colour.then(|| Value::List(fractions.collect()))
        };
        assert_eq!(fractions(318), list(&[3127, 3290]));
        assert_eq!(fractions(319), list(&[6400, 3300, 3000, 6000, 1500, 600]));
        let mut text = |tag| decoder.get_tag_ascii_string(tag).unwrap();
        assert_eq!(text(Tag::Software), "Yosegi");
        assert_eq!(
            text(Tag::ImageDescription),
            format!("yosegi:key {}\nyosegi:channel bark", key().hexadecimal())
        );
    }
}

#[test]
fn a_foreign_tiff_has_no_key() {
    let map = Map::gradient(&request(MapKind::Number, MapFormat::Tiff8));
    let mut foreign = Cursor::new(Vec::new());
    tiff::encoder::TiffEncoder::new(&mut foreign)
        .unwrap()
        .write_image::<tiff::encoder::colortype::Gray8>(2, 2, &[1, 2, 3, 4])
        .unwrap();
    map.world.insert("foreign", foreign.into_inner());
    assert_eq!(read_key(&map.world, "foreign".as_ref()), None);
    // Offsets that lead nowhere, in both widths.
    for wrong in [
        &b"II\x2a\0\xff\xff\xff\xff"[..],
        b"II\x2b\0\x08\0\0\0\xff\xff\xff\xff\xff\xff\xff\xff",
        b"II\x2a\0\x08\0\0\0\xff\xff\x0e\x01\x02\0\xff\xff\xff\xff\xff\xff\xff\xff",
        b"II",
    ] {
        map.world.insert("foreign", wrong);
        assert_eq!(read_key(&map.world, "foreign".as_ref()), None);
    }
}
