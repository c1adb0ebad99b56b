//! `sample_pattern`: drawn pictures with known values, broken files, and the bar of real spruce.

use super::build;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb, Rgba};
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;
use yosegi::colour;
use yosegi::node::Failure;
use yosegi::value::{AfterEnd, ColourPattern, FileContents, Value};

const SPRUCE: &[u8] = include_bytes!("../../assets/spruce_bar/spruce_bar.png");

fn sample(bytes: &[u8], inputs: &[(&str, Value)]) -> Result<Arc<ColourPattern>, Failure> {
    let file = FileContents {
        path: PathBuf::from("picture"),
        bytes: Arc::from(bytes),
    };
    let mut all = vec![
        ("file", Value::File(file)),
        ("spans", Value::Choice("year")),
        ("even_years", Value::Toggle(false)),
        ("smooth", Value::Toggle(true)),
    ];
    all.retain(|default| inputs.iter().all(|input| input.0 != default.0));
    all.extend_from_slice(inputs);
    match build("sample_pattern", &all)?.remove(0) {
        Value::ColourPattern(pattern) => Ok(pattern),
        other => panic!("found a {}", other.type_name()),
    }
}

fn line(from: [f64; 2], to: [f64; 2], band: f64) -> Vec<(&'static str, Value)> {
    vec![
        ("from", Value::Pair(from)),
        ("to", Value::Pair(to)),
        ("band", Value::Number(band)),
    ]
}

fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(vec![]);
    picture.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A picture whose red rises to the right and whose green rises downwards.
fn drawn() -> Vec<u8> {
    let colour = |x: u32, y: u32| Rgb([40 * x as u8, 50 * y as u8, 128]);
    encoded(ImageBuffer::from_fn(6, 4, colour), ImageFormat::Png)
}

fn linear(byte: f64) -> f64 {
    colour::from_srgb(byte / 255.0)
}

fn assert_near(found: f32, expected: f64) {
    assert!(
        (f64::from(found) - expected).abs() < 1e-6,
        "{found} instead of {expected}"
    );
}

#[test]
fn without_a_line_the_whole_height_is_averaged_in_linear_light() {
    let pattern = sample(&drawn(), &[]).unwrap();
    assert_eq!((pattern.colours.len(), pattern.years), (6, 1.0));
    assert_eq!(
        (pattern.after_end, &pattern.ring_starts[..]),
        (AfterEnd::Repeat, &[0.0][..])
    );
    let green = [0.0, 50.0, 100.0, 150.0].map(linear).iter().sum::<f64>() / 4.0;
    for (x, colour) in pattern.colours.iter().enumerate() {
        assert_near(colour[0], linear(40.0 * x as f64));
        assert_near(colour[1], green);
        assert_near(colour[2], linear(128.0));
    }
}

#[test]
fn texels_are_means_over_parts_of_pixels() {
    // Upwards through the column of pixels at x = 2, from the middle of the lowest: 2 texels of 1.5 pixels.
    let mut inputs = line([2.5, 3.5], [2.5, 0.5], 0.5);
    inputs.push(("texels", Value::Whole(2)));
    let pattern = sample(&drawn(), &inputs).unwrap();
    assert_near(pattern.colours[0][0], linear(80.0));
    assert_near(
        pattern.colours[0][1],
        (0.5 * linear(150.0) + linear(100.0)) / 1.5,
    );
    assert_near(
        pattern.colours[1][1],
        (linear(50.0) + 0.5 * linear(0.0)) / 1.5,
    );
}

#[test]
fn slanted_bands_cover_what_geometry_says() {
    // A square that stands on its corner in the middle of four pixels takes a quarter of each.
    let side = std::f64::consts::FRAC_1_SQRT_2;
    let (from, to) = ([2.75, 1.75], [3.25, 2.25]);
    let mut inputs = line(from, to, side);
    inputs.push(("texels", Value::Whole(2)));
    let pattern = sample(&drawn(), &inputs).unwrap();
    let mean = |part: usize| 0.5 * (pattern.colours[0][part] + pattern.colours[1][part]);
    assert_near(mean(0), 0.5 * (linear(80.0) + linear(120.0)));
    assert_near(mean(1), 0.5 * (linear(50.0) + linear(100.0)));
    // Its first half: one half of the pixel up left, a quarter each of two others.
    assert_near(
        pattern.colours[0][0],
        0.75 * linear(80.0) + 0.25 * linear(120.0),
    );
}

#[test]
fn sixteen_bits_and_grey_are_kept() {
    let grey = ImageBuffer::from_fn(2, 1, |x, _| Luma([20_000 + x as u16]));
    let pattern = sample(&encoded(grey, ImageFormat::Png), &[]).unwrap();
    for (x, colour) in pattern.colours.iter().enumerate() {
        let expected = colour::from_srgb((20_000.0 + x as f64) / 65_535.0);
        assert_eq!(*colour, [expected as f32; 3]);
    }
    let bitmap = ImageBuffer::from_fn(3, 2, |x, _| Rgb([10 * x as u8; 3]));
    let pattern = sample(&encoded(bitmap, ImageFormat::Bmp), &[]).unwrap();
    assert_near(pattern.colours[2][1], linear(20.0));
}

#[test]
fn translucent_pixels_count_by_their_opacity() {
    let pixels = [
        Rgba([200u8, 0, 0, 255]),
        Rgba([0, 200, 0, 51]),
        Rgba([9, 9, 9, 0]),
    ];
    let picture = ImageBuffer::from_fn(2, 3, |_, y| pixels[y as usize]);
    let bytes = encoded(picture, ImageFormat::Png);
    let pattern = sample(&bytes, &[]).unwrap();
    assert_near(pattern.colours[0][0], linear(200.0) / 1.2);
    assert_near(pattern.colours[0][1], 0.2 * linear(200.0) / 1.2);
    assert_near(pattern.colours[0][2], 0.0);
    let failure = sample(&bytes, &line([0.0, 2.5], [2.0, 2.5], 1.0)).unwrap_err();
    assert_eq!(
        failure.message,
        "the picture is transparent at (0, 2), under the band"
    );
}

#[test]
fn lines_and_bands_outside_of_the_picture_are_refused() {
    let refused = |from, to, band| sample(&drawn(), &line(from, to, band)).unwrap_err();
    let failure = refused([1.0, 2.0], [1.0, 2.0], 1.0);
    assert_eq!(
        failure.message,
        "the line has no length: `from` and `to` are one point"
    );
    let failure = refused([1.0, 2.0], [5.0, 2.0], 4.5);
    assert_eq!(failure.input, Some("band"));
    let expected = "the band reaches (1, -0.25), outside of the picture of 6 x 4 pixels";
    assert_eq!(failure.message, expected);
    let failure = sample(&drawn(), &[("from", Value::Pair([0.0, 0.0]))]).unwrap_err();
    assert_eq!(failure.message, "`from` needs `to`");
    let failure = sample(&drawn(), &[("band", Value::Number(5.0))]).unwrap_err();
    assert_eq!(failure.input, Some("band"));
}

#[test]
fn what_only_a_bar_has_is_refused_for_a_year() {
    let failure = sample(&drawn(), &[("rings", Value::Whole(2))]).unwrap_err();
    assert_eq!(
        failure.message,
        "`rings` is for a bar, but the line spans one year"
    );
    let even = [
        ("spans", Value::Choice("bar")),
        ("even_years", Value::Toggle(true)),
    ];
    assert_eq!(
        sample(&drawn(), &even).unwrap_err().input,
        Some("even_years")
    );
}

#[test]
fn a_bar_without_rings_is_divided_evenly() {
    let bar = [
        ("spans", Value::Choice("bar")),
        ("years", Value::Number(4.0)),
    ];
    let pattern = sample(&drawn(), &bar).unwrap();
    assert_eq!((pattern.years, pattern.after_end), (4.0, AfterEnd::End));
    assert_eq!(pattern.ring_starts, [0.0, 0.25, 0.5, 0.75]);
    let repeat = [
        ("spans", Value::Choice("bar")),
        ("after", Value::Choice("repeat")),
    ];
    assert_eq!(
        sample(&drawn(), &repeat).unwrap().after_end,
        AfterEnd::Repeat
    );
    let end = sample(&drawn(), &[("after", Value::Choice("end"))]).unwrap();
    assert_eq!(end.after_end, AfterEnd::End);
}

/// Rings of known widths, each darkening towards its end.
fn rings(widths: &[u32]) -> Vec<u8> {
    let row: Vec<u8> = widths
        .iter()
        .flat_map(|width| {
            (0..*width).map(move |x| 220 - (100 * (x + 1) * (x + 1) / (width * width)) as u8)
        })
        .collect();
    let picture = ImageBuffer::from_fn(row.len() as u32, 3, |x, _| Luma([row[x as usize]]));
    encoded(picture, ImageFormat::Png)
}

#[test]
fn drawn_rings_are_found_at_their_borders() {
    let widths = [40, 25, 32, 18, 21, 44, 30];
    let inputs = [("spans", Value::Choice("bar")), ("rings", Value::Whole(7))];
    let pattern = sample(&rings(&widths), &inputs).unwrap();
    assert_eq!((pattern.years, pattern.colours.len()), (7.0, 210));
    let borders = [0, 40, 65, 97, 115, 136, 180].map(|x| f64::from(x) / 210.0);
    assert_eq!(pattern.ring_starts, borders);

    let inputs = [("spans", Value::Choice("bar")), ("rings", Value::Whole(9))];
    let failure = sample(&rings(&widths), &inputs).unwrap_err();
    assert_eq!(
        failure.message,
        "expected 9 rings along the line, found 7 by their edges"
    );
}

#[test]
fn even_years_have_one_ring_each() {
    let inputs = [
        ("spans", Value::Choice("bar")),
        ("rings", Value::Whole(3)),
        ("even_years", Value::Toggle(true)),
        ("texels", Value::Whole(60)),
    ];
    let pattern = sample(&rings(&[20, 40, 30]), &inputs).unwrap();
    assert_eq!(pattern.ring_starts, [0.0, 1.0 / 3.0, 2.0 / 3.0]);
    let [first, second] = [&pattern.colours[..20], &pattern.colours[20..40]];
    // The first ring has its own 20 pixels, of the second each texel averages two.
    let red =
        |x: u32, width: u32| linear(f64::from(220 - 100 * (x + 1) * (x + 1) / (width * width)));
    for x in 0..20 {
        assert_near(first[x as usize][0], red(x, 20));
        assert_near(
            second[x as usize][0],
            0.5 * (red(2 * x, 40) + red(2 * x + 1, 40)),
        );
    }
}

/// The darkest pixels of the 46 dark lines inside the spruce bar, counted and read off by eye from an enlarged
/// copy and a table of the brightness.
const DARK_LINES: [u16; 46] = [
    66, 132, 184, 252, 320, 393, 454, 533, 605, 655, 690, 722, 755, 781, 797, 822, 845, 867, 888,
    905, 921, 938, 952, 968, 986, 1012, 1040, 1062, 1086, 1100, 1120, 1139, 1160, 1182, 1202, 1224,
    1242, 1262, 1287, 1319, 1354, 1383, 1412, 1430, 1456, 1482,
];

#[test]
fn the_spruce_bar_has_47_rings() {
    let inputs = [("spans", Value::Choice("bar")), ("rings", Value::Whole(47))];
    let pattern = sample(SPRUCE, &inputs).unwrap();
    assert_eq!((pattern.colours.len(), pattern.years), (1504, 47.0));
    let starts: Vec<f64> = pattern
        .ring_starts
        .iter()
        .map(|start| (start * 1504.0).round())
        .collect();
    assert_eq!(starts.len(), 47);
    for (start, dark) in starts[1..].iter().zip(DARK_LINES) {
        let behind = start - f64::from(dark);
        assert!(
            (1.0..=6.0).contains(&behind),
            "a ring starts at {start}, its dark line is at {dark}"
        );
    }
    let widths = starts.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(
        widths.clone().all(|width| (12.0..=80.0).contains(&width)),
        "{:?}",
        widths.collect::<Vec<_>>()
    );
    // Every ring ends darker than it goes on: late wood before early wood.
    let luminance = |x: f64| colour::luminance(pattern.colours[x as usize]);
    assert!(
        starts[1..]
            .iter()
            .all(|start| luminance(start - 3.0) < luminance(start + 3.0))
    );
    // Mean linear colour, as an independent program gives it.
    let mean = |part: usize| {
        pattern
            .colours
            .iter()
            .map(|colour| f64::from(colour[part]))
            .sum::<f64>()
            / 1504.0
    };
    for (part, expected) in [0.771_397, 0.599_431, 0.445_421].into_iter().enumerate() {
        assert!(
            (mean(part) - expected).abs() < 1e-5,
            "{} instead of {expected}",
            mean(part)
        );
    }
}

#[test]
fn foreign_and_oversized_files_are_refused() {
    let message = |bytes: &[u8]| sample(bytes, &[]).unwrap_err().message;
    let foreign = "expected a PNG, JPEG or BMP picture, found another kind of file";
    assert_eq!(message(b""), foreign);
    assert_eq!(message(b"GIF89a and so on"), foreign);
    // A bitmap that claims 40 000 x 40 000 pixels: refused before anything is allocated.
    let mut bitmap = encoded(
        ImageBuffer::from_pixel(2, 2, Rgb([0u8; 3])),
        ImageFormat::Bmp,
    );
    bitmap[18..22].copy_from_slice(&40_000u32.to_le_bytes());
    bitmap[22..26].copy_from_slice(&40_000u32.to_le_bytes());
    assert_eq!(
        message(&bitmap),
        "the picture is larger than 32768 pixels a side or 256 MiB"
    );
}

#[test]
fn damaged_files_never_panic() {
    let picture = ImageBuffer::from_fn(24, 16, |x, y| {
        Rgb([10 * x as u8, 15 * y as u8, (x * y) as u8])
    });
    let mut random = 0x1234_5678_9abc_def1u64;
    let mut next = move || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        random as usize
    };
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Bmp] {
        let whole = encoded(picture.clone(), format);
        let intact = sample(&whole, &[]).unwrap();
        for length in (0..whole.len()).step_by(7) {
            // What was cut off may be but the trailer, and JPEG files decode in part.
            if let Err(failure) = sample(&whole[..length], &[]) {
                assert_eq!(failure.input, Some("file"), "{}", failure.message);
            }
        }
        let mut refused = 0;
        for _ in 0..300 {
            let mut damaged = whole.clone();
            for _ in 0..1 + next() % 3 {
                let at = next() % damaged.len();
                damaged[at] = next() as u8;
            }
            match sample(&damaged, &[]) {
                Ok(pattern) => assert!(
                    pattern
                        .colours
                        .iter()
                        .flatten()
                        .all(|part| (0.0..=1.0).contains(part))
                ),
                Err(failure) => {
                    refused += 1;
                    assert_eq!(failure.input, Some("file"), "{}", failure.message);
                }
            }
        }
        assert!(refused > 0 && intact.colours.len() == 24, "{format:?}");
    }
}
