//! Maps read back by other readers hold exactly the expected samples, in every format and kind.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod output_support;

use exr::prelude::{AttributeValue, FlatSamples, ReadChannels, ReadLayers, Text, read};
use image::DynamicImage;
use output_support::{KINDS, Map, SIZES, expected, key, request, with_size};
use std::io::Cursor;
use yosegi::colour::to_srgb;
use yosegi::output::{Encoder, Faults, MapKind, read_key};
use yosegi::value::MapFormat;
use yosegi::world::World;

/// Samples of a PNG, pixel after pixel, as 16-bit numbers.
fn png_samples(map: &Map) -> Vec<u16> {
    let wide = |samples: Vec<u8>| samples.into_iter().map(u16::from).collect();
    match image::load_from_memory(&map.bytes).unwrap() {
        DynamicImage::ImageLuma8(image) => wide(image.into_raw()),
        DynamicImage::ImageRgb8(image) => wide(image.into_raw()),
        DynamicImage::ImageLuma16(image) => image.into_raw(),
        DynamicImage::ImageRgb16(image) => image.into_raw(),
        other => panic!("{:?}", other.color()),
    }
}

/// Channels of an OpenEXR file by name.
fn exr_channels(map: &Map) -> Vec<(String, FlatSamples)> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(&map.bytes))
        .unwrap();
    let channels = image.layer_data.channel_data.list;
    channels
        .into_iter()
        .map(|channel| (channel.name.to_string(), channel.sample_data))
        .collect()
}

#[test]
fn png_maps_hold_the_nearest_samples() {
    for (format, max) in [(MapFormat::Png8, 255.0), (MapFormat::Png16, 65535.0)] {
        for (kind, size) in KINDS
            .into_iter()
            .flat_map(|kind| SIZES.map(|size| (kind, size)))
        {
            let map = Map::gradient(&with_size(size, kind, format));
            let wanted: Vec<u16> = map
                .values
                .iter()
                .map(|value| expected(kind, max, *value))
                .collect();
            assert_eq!(png_samples(&map), wanted, "{kind:?} {format:?} {size:?}");
        }
    }
}

#[test]
fn exr_maps_hold_the_values_themselves() {
    for (kind, size) in KINDS
        .into_iter()
        .flat_map(|kind| SIZES.map(|size| (kind, size)))
    {
        let map = Map::gradient(&with_size(size, kind, MapFormat::ExrFloat));
        let names = if kind == MapKind::Number {
            vec!["Y"]
        } else {
            vec!["B", "G", "R"]
        };
        let channels = exr_channels(&map);
        assert_eq!(
            channels
                .iter()
                .map(|(name, _)| name.as_str())
                .collect::<Vec<_>>(),
            names
        );
        for (index, (name, samples)) in channels.iter().enumerate() {
            let wanted = map.column(names.len() - 1 - index);
            assert_eq!(
                samples,
                &FlatSamples::F32(wanted),
                "{name} {kind:?} {size:?}"
            );
        }
    }
}

#[test]
fn half_maps_hold_the_nearest_halves() {
    for (kind, size) in KINDS
        .into_iter()
        .flat_map(|kind| SIZES.map(|size| (kind, size)))
    {
        let map = Map::gradient(&with_size(size, kind, MapFormat::ExrHalf));
        let channels = exr_channels(&map);
        let count = channels.len();
        for (index, (_, samples)) in channels.iter().enumerate() {
            let column = map.column(count - 1 - index);
            // The conversion of constants is written in plain integer arithmetic.
            let wanted = column.into_iter().map(half::f16::from_f32_const).collect();
            assert_eq!(samples, &FlatSamples::F16(wanted), "{kind:?} {size:?}");
        }
    }
}

#[test]
fn a_half_is_the_nearest_for_floats_all_over_the_range() {
    let encoder = Encoder::new(MapKind::Number, MapFormat::ExrHalf, None);
    let values: Vec<f32> = (0..=u32::MAX / 65521)
        .map(|step| f32::from_bits(step * 65521))
        .filter(|value| value.is_finite())
        .collect();
    let mut bytes = vec![0; values.len() * 2];
    let faults = encoder.encode(&[&values], &mut bytes);
    let overflowing = values.iter().filter(|value| value.abs() >= 65520.0).count();
    assert_eq!(
        faults,
        Faults {
            non_finite: 0,
            clamped: overflowing as u64
        }
    );
    for (value, half) in values.iter().zip(bytes.as_chunks::<2>().0) {
        let wanted = half::f16::from_f32_const(value.clamp(-65504.0, 65504.0));
        assert_eq!(half::f16::from_ne_bytes(*half), wanted, "{value:e}");
    }
}

#[test]
fn every_limit_between_samples_of_data_is_where_it_should_be() {
    for (format, max) in [(MapFormat::Png8, 255u32), (MapFormat::Png16, 65535)] {
        let encoder = Encoder::new(MapKind::Number, format, None);
        let limit = |sample: u32| ((f64::from(sample) - 0.5) / f64::from(max)) as f32;
        let around = (1..=max).flat_map(|sample| {
            [
                limit(sample).next_down(),
                limit(sample),
                limit(sample).next_up(),
            ]
        });
        let values: Vec<f32> = around.collect();
        let mut bytes = vec![0; values.len() * encoder.pixel_bytes()];
        assert_eq!(encoder.encode(&[&values], &mut bytes), Faults::default());
        for (value, bytes) in values.iter().zip(bytes.chunks(encoder.pixel_bytes())) {
            let sample = bytes
                .iter()
                .fold(0u32, |sample, byte| sample << 8 | u32::from(*byte));
            // The product is exact; a half goes to the even neighbour.
            let wanted = (f64::from(*value) * f64::from(max)).round_ties_even();
            assert_eq!(f64::from(sample), wanted, "{value:e}");
        }
    }
}

#[test]
fn a_flat_normal_is_128_128_255() {
    let encoder = Encoder::new(MapKind::Normal, MapFormat::Png8, None);
    let mut bytes = [0; 3];
    assert_eq!(
        encoder.encode(&[&[0.0], &[-0.0], &[1.0]], &mut bytes),
        Faults::default()
    );
    assert_eq!(bytes, [128, 128, 255]);
}

#[test]
fn ranges_say_what_is_black_and_what_is_white() {
    let encode = |kind, range, values: &[f32]| {
        let mut bytes = vec![0; values.len()];
        let faults = Encoder::new(kind, MapFormat::Png8, Some(range)).encode(&[values], &mut bytes);
        (bytes, faults.clamped)
    };
    let (bytes, clamped) = encode(
        MapKind::Number,
        [-2.0, 3.0],
        &[-2.5, -2.0, 0.5, 2.9999, 3.0, 3.009, 3.011],
    );
    assert_eq!((bytes, clamped), (vec![0, 0, 128, 255, 255, 255, 255], 2));
    let (bytes, clamped) = encode(MapKind::Number, [1.0, 0.0], &[1.1, 1.0, 0.2, 0.0, -0.1]);
    assert_eq!((bytes, clamped), (vec![0, 0, 204, 255, 255], 2));
    let (bytes, _) = encode(MapKind::Number, [0.5, 0.5], &[0.4, 0.5, 0.6]);
    assert_eq!(bytes, [0, 0, 255]);
}

#[test]
fn a_range_of_a_colour_applies_before_it_is_encoded() {
    for (format, max) in [(MapFormat::Png8, 255.0), (MapFormat::Png16, 65535.0)] {
        let encoder = Encoder::new(MapKind::Colour, format, Some([0.0, 4.0]));
        let mut bytes = vec![0; encoder.pixel_bytes()];
        let faults = encoder.encode(&[&[4.0], &[0.86], &[-1.0]], &mut bytes);
        assert_eq!(
            faults,
            Faults {
                non_finite: 0,
                clamped: 1
            }
        );
        let sample = |bytes: &[u8]| {
            bytes
                .iter()
                .fold(0, |all, byte| all << 8 | u16::from(*byte))
        };
        let samples: Vec<u16> = bytes.chunks(bytes.len() / 3).map(sample).collect();
        let middle = (to_srgb(0.215) * max).round() as u16;
        assert_eq!(samples, [max as u16, middle, 0]);
    }
}

#[test]
fn what_is_no_number_is_counted_and_never_white() {
    let values = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2.0, -1.0, 0.25];
    for kind in [MapKind::Colour, MapKind::Normal] {
        let encoder = Encoder::new(kind, MapFormat::Png8, None);
        let mut bytes = vec![7; 18];
        let faults = encoder.encode(&[&values, &[0.5; 6], &values], &mut bytes);
        let clamped = if kind == MapKind::Colour { 4 } else { 2 };
        assert_eq!(
            faults,
            Faults {
                non_finite: 6,
                clamped
            }
        );
        assert_eq!(
            [bytes[0], bytes[3], bytes[6], bytes[9], bytes[12]],
            [0, 255, 0, 255, 0]
        );
    }
}

#[test]
fn exr_keeps_what_is_no_number_with_one_pattern() {
    let values = [f32::NAN, -f32::NAN, f32::INFINITY, 1e9, -1e9];
    let mut bytes = [0; 20];
    let encoder = Encoder::new(MapKind::Number, MapFormat::ExrFloat, None);
    assert_eq!(
        encoder.encode(&[&values], &mut bytes),
        Faults {
            non_finite: 3,
            clamped: 0
        }
    );
    let bits: Vec<u32> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|bytes| u32::from_ne_bytes(*bytes))
        .collect();
    let plain = [f32::INFINITY, 1e9, -1e9].map(f32::to_bits);
    assert_eq!(
        bits,
        [0x7fc0_0000, 0x7fc0_0000, plain[0], plain[1], plain[2]]
    );
    let encoder = Encoder::new(MapKind::Number, MapFormat::ExrHalf, None);
    let mut bytes = [0; 10];
    assert_eq!(
        encoder.encode(&[&values], &mut bytes),
        Faults {
            non_finite: 3,
            clamped: 2
        }
    );
    let bits: Vec<u16> = bytes
        .as_chunks::<2>()
        .0
        .iter()
        .map(|bytes| u16::from_ne_bytes(*bytes))
        .collect();
    assert_eq!(bits, [0x7e00, 0x7e00, 0x7c00, 0x7bff, 0xfbff]);
}

#[test]
fn a_png_tells_its_size_its_key_and_its_colours() {
    for (kind, colour) in [(MapKind::Colour, true), (MapKind::Number, false)] {
        let map = Map::gradient(&request(kind, MapFormat::Png8));
        let reader = png::Decoder::new(Cursor::new(&map.bytes))
            .read_info()
            .unwrap();
        let info = reader.info();
        assert_eq!(
            info.srgb,
            colour.then_some(png::SrgbRenderingIntent::Perceptual)
        );
        let gamma = info.gama_chunk.map(png::ScaledFloat::into_scaled);
        assert_eq!(gamma, colour.then_some(45455));
        let places = info.chrm_chunk.map(|chunk| {
            [chunk.white, chunk.red, chunk.green, chunk.blue]
                .map(|(x, y)| (x.into_scaled(), y.into_scaled()))
        });
        let rec_709 = [
            (31270, 32900),
            (64000, 33000),
            (30000, 60000),
            (15000, 6000),
        ];
        assert_eq!(places, colour.then_some(rec_709));
        // 33 by 20 pixels on 8.25 by 10 mm.
        let size = info.pixel_dims.unwrap();
        assert_eq!(
            (size.xppu, size.yppu, size.unit),
            (4000, 2000, png::Unit::Meter)
        );
        let texts: Vec<(&str, &str)> = info
            .uncompressed_latin1_text
            .iter()
            .map(|text| (text.keyword.as_str(), text.text.as_str()))
            .collect();
        let digits = key().hexadecimal();
        let wanted = [
            ("yosegi:key", digits.as_str()),
            ("yosegi:channel", "bark"),
            ("Software", "Yosegi"),
        ];
        assert_eq!(texts, wanted);
    }
}

#[test]
fn an_exr_tells_its_size_its_key_and_its_colours() {
    for (kind, colour) in [(MapKind::Colour, true), (MapKind::Number, false)] {
        let map = Map::gradient(&request(kind, MapFormat::ExrHalf));
        let meta = exr::meta::MetaData::read_from_buffered(map.bytes.as_slice(), true).unwrap();
        let [header] = meta.headers.as_slice() else {
            panic!("one layer")
        };
        assert_eq!(
            header.line_order,
            exr::meta::attribute::LineOrder::Increasing
        );
        let (shared, own) = (&header.shared_attributes, &header.own_attributes);
        // Pixels are half as wide as they are high.
        assert_eq!(shared.pixel_aspect, 0.5);
        assert_eq!(
            shared.chromaticities.map(|it| it.red.0),
            colour.then_some(0.64)
        );
        let text = |text: &str| AttributeValue::Text(Text::from(text));
        assert_eq!(
            own.other[&Text::from("yosegi:key")],
            text(&key().hexadecimal())
        );
        assert_eq!(own.other[&Text::from("yosegi:channel")], text("bark"));
        assert_eq!(own.software_name, Some(Text::from("Yosegi")));
        // 4 pixels to the mm, 25.4 mm to the inch.
        assert_eq!(own.horizontal_density, Some(101.6));
    }
}

#[test]
fn the_key_is_read_back_from_every_format_and_from_nothing_else() {
    let with_key = |format: &MapFormat| *format != MapFormat::Bmp;
    for format in MapFormat::ALL.into_iter().filter(with_key) {
        let map = Map::gradient(&request(MapKind::Colour, format));
        assert_eq!(read_key(&map.world, &map.path), Some(key()));
        // The header is enough, and half of it is not.
        for (length, wanted) in [(1000, Some(key())), (100, None), (3, None), (0, None)] {
            map.world
                .insert("cut", &map.bytes[..length.min(map.bytes.len())]);
            assert_eq!(
                read_key(&map.world, "cut".as_ref()),
                wanted,
                "{format:?} {length}"
            );
        }
        let plain = String::from_utf8_lossy(&map.bytes).contains(&key().hexadecimal());
        assert!(plain, "the key is readable without a decoder");
    }
    let mut foreign = Cursor::new(Vec::new());
    DynamicImage::new_luma8(4, 4)
        .write_to(&mut foreign, image::ImageFormat::Png)
        .unwrap();
    let map = Map::gradient(&request(MapKind::Colour, MapFormat::Png8));
    map.world.insert("foreign", foreign.into_inner());
    assert_eq!(read_key(&map.world, "foreign".as_ref()), None);
    assert_eq!(read_key(&map.world, "absent".as_ref()), None);
    assert!(map.world.read("foreign".as_ref()).is_ok());
}
