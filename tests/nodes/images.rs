//! Pictures as fields: values, places, filters, and files that are not what they should be.

use super::*;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgba};
use std::io::Cursor;
use std::sync::Mutex;
use yosegi::engine::Event;

fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(vec![]);
    picture.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// 3 x 2 pixels of grey: 0, 51, 102 above 153, 204, 255.
fn six() -> Vec<u8> {
    let picture = ImageBuffer::from_fn(3, 2, |x, y| Luma([(51 * (x + 3 * y)) as u8]));
    encoded(DynamicImage::ImageLuma8(picture), ImageFormat::Png)
}

fn shown_as(bytes: Vec<u8>, file: &str, rest: &str, output: &str) -> Result<Field, String> {
    let nodes = format!("\"example\": image_from_file(file: \"{file}\"{rest})");
    field_with(&[(file, bytes)], &nodes, output)
}

/// Values of the six greys in raw numbers, in units of 1/5, at pixels of 1 mm.
fn fifths(rest: &str, points: &[[f64; 2]]) -> Vec<f32> {
    let field = shown_as(
        six(),
        "six.png",
        &format!(", pixels_per_mm: 1, colour_space: raw{rest}"),
        "value",
    );
    let points: Vec<[f64; 3]> = points.iter().map(|[u, v]| [*u, *v, 0.0]).collect();
    number(&field.unwrap(), &points)
        .iter()
        .map(|value| 5.0 * value)
        .collect()
}

fn nearly(found: &[f32], expected: &[f32]) {
    let close = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(
        found.len() == expected.len() && close,
        "{found:?}, not {expected:?}"
    );
}

#[test]
fn pixels_have_their_places_and_what_is_between_is_interpolated() {
    let centres = [[0.5, 1.5], [1.5, 1.5], [2.5, 1.5], [0.5, 0.5], [2.5, 0.5]];
    nearly(&fifths("", &centres), &[0.0, 1.0, 2.0, 3.0, 5.0]);
    nearly(
        &fifths(", interpolation: cubic", &centres),
        &[0.0, 1.0, 2.0, 3.0, 5.0],
    );
    let between = [[1.0, 1.5], [1.5, 1.0], [1.25, 0.75]];
    nearly(&fifths("", &between), &[0.5, 2.5, 3.75 - 0.75 + 0.0]);
    nearly(
        &fifths(", interpolation: nearest", &[[1.01, 1.01], [0.99, 0.99]]),
        &[1.0, 3.0],
    );
    nearly(&fifths(", origin: (10, 20)", &[[10.5, 21.5]]), &[0.0]);
}

#[test]
fn the_picture_goes_on_as_wrap_says() {
    let beyond = [[3.5, 1.5], [-0.5, 1.5], [-0.5, -0.5]];
    nearly(&fifths("", &beyond), &[0.0, 2.0, 2.0]);
    nearly(&fifths(", wrap: mirror", &beyond), &[2.0, 0.0, 3.0]);
    nearly(&fifths(", wrap: clamp", &beyond), &[2.0, 0.0, 3.0]);
    nearly(&fifths(", wrap: blank", &beyond), &[0.0, 0.0, 0.0]);
    let blank = shown_as(six(), "six.png", ", pixels_per_mm: 1, wrap: blank", "alpha").unwrap();
    nearly(
        &number(&blank, &[[3.0, 1.5, 0.0], [9.0, 1.0, 0.0], [1.0, 1.0, 0.0]]),
        &[0.5, 0.0, 1.0],
    );
}

#[test]
fn colour_spaces_say_what_codes_mean() {
    let value = |space: &str| {
        let field = shown_as(
            six(),
            "six.png",
            &format!(", pixels_per_mm: 1{space}"),
            "value",
        )
        .unwrap();
        number(&field, &[[1.5, 0.5, 0.0]])[0]
    };
    // 0.8 of sRGB is 0.6038 of light.
    assert!((value("") - 0.603_827).abs() < 1e-5);
    assert!((value(", colour_space: linear") - 0.8).abs() < 1e-6);
    // Half of a pixel is opaque red, the other half translucent green: weighed, except as raw numbers.
    let pair = ImageBuffer::from_fn(2, 1, |x, _| {
        Rgba(if x == 0 {
            [255u8, 0, 0, 255]
        } else {
            [0, 255, 0, 85]
        })
    });
    let colour = |space: &str| {
        let bytes = encoded(DynamicImage::ImageRgba8(pair.clone()), ImageFormat::Png);
        let field = shown_as(
            bytes,
            "pair.png",
            &format!(", pixels_per_mm: 1{space}"),
            "colour",
        )
        .unwrap();
        at(&field, &[[1.0, 0.5, 0.0]])
            .iter()
            .map(|column| column[0])
            .collect::<Vec<_>>()
    };
    nearly(&colour(""), &[0.75, 0.25, 0.0]);
    nearly(&colour(", colour_space: raw"), &[0.5, 0.5, 0.0]);
    let deep = ImageBuffer::from_fn(1, 1, |_, _| Luma([12_345u16]));
    let bytes = encoded(DynamicImage::ImageLuma16(deep), ImageFormat::Png);
    let field = shown_as(
        bytes,
        "deep.png",
        ", pixels_per_mm: 1, colour_space: raw",
        "value",
    )
    .unwrap();
    nearly(&number(&field, &[[0.5, 0.5, 0.0]]), &[12_345.0 / 65_535.0]);
}

#[test]
fn sizes_come_from_the_recipe_or_the_file() {
    let told = |rest: &str, words: &str| {
        let message = shown_as(six(), "six.png", rest, "value").unwrap_err();
        assert!(message.contains(words), "{message}");
    };
    told("", "does not say how large it is");
    told("", "it has 3 x 2 pixels");
    told(
        ", size: (3, 2), pixels_per_mm: 1",
        "both `size` and `pixels_per_mm`",
    );
    let mut bytes = vec![];
    let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
    let (xppu, yppu) = (500, 1000);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu,
        yppu,
        unit: png::Unit::Meter,
    }));
    encoder
        .write_header()
        .unwrap()
        .write_image_data(&[0, 51, 102, 153, 204, 255])
        .unwrap();
    // Half a pixel a mm across: the third pixel's centre is at 5 mm.
    let field = shown_as(bytes, "six.png", ", colour_space: raw", "value").unwrap();
    nearly(&number(&field, &[[5.0, 0.5, 0.0]]), &[1.0]);
}

/// Coarse and fine blocks of colour, half of them translucent: 300 x 200 pixels.
fn busy() -> Vec<u8> {
    let block = |x: u32, y: u32, side: u32| {
        (x / side)
            .wrapping_mul(2_654_435_761)
            .wrapping_add((y / side).wrapping_mul(40_503 * 7919))
            >> 7
    };
    let picture = ImageBuffer::from_fn(300, 200, |x, y| {
        let (coarse, fine) = (block(x, y, 23), block(x, y, 3));
        let alpha = if coarse % 2 == 0 { 255 } else { 120 };
        Rgba([
            (coarse % 256) as u8,
            (fine % 256) as u8,
            ((coarse + fine) % 256) as u8,
            alpha,
        ])
    });
    encoded(DynamicImage::ImageRgba8(picture), ImageFormat::Png)
}

#[test]
fn pictures_keep_the_contract_enlarged_reduced_turned_and_wrapped() {
    // Enlarged 1.5 times, then 2 to 5 pixels a pixel, then the whole picture more than once in each.
    for (what, size, rest) in [
        ("enlarged", 450.0, ", interpolation: cubic"),
        ("at its size", 250.0, ", interpolation: nearest"),
        ("reduced", 90.0, ""),
        ("reduced, mirrored", 90.0, ", wrap: mirror"),
        ("tiny", 0.71, ""),
    ] {
        let rest = format!(", size: ({size}, {}), colour_space: raw{rest}", size / 1.5);
        let field = shown_as(busy(), "busy.png", &rest, "colour").unwrap();
        let square = |pixels| Square { side: 64.0, pixels };
        let large = painted(&field, &square(512), 8, true);
        let small = painted(&field, &square(64), 1, true);
        let found = difference(&large, &small, 1.0);
        println!("{what}: {found:.2?}");
        assert!(found[0] < 1.0 && found[1] < 12.0, "{what}: {found:?}");
    }
    let nodes = "\"picture\": image_from_file(file: \"busy.png\", size: (90, 60), wrap: mirror, colour_space: raw),
        \"example\": transform_field(colour: \"picture\", turn: (0, 0, 27), scale: (1, 1.4, 1))";
    let turned = field_with(&[("busy.png", busy())], nodes, "colour").unwrap();
    keeps_the_contract("turned picture", &turned, 64.0, 1.0);
}

/// What is warned of, and how it ends.
fn said(bytes: &[u8], file: &str) -> (Vec<String>, Option<String>) {
    let world = Memory::default();
    world.insert(Path::new("recipes").join(file), bytes.to_vec());
    let recipe =
        format!("(nodes: {{ \"example\": image_from_file(file: \"{file}\", pixels_per_mm: 1) }})");
    let graph = load_text("recipes/recipe.ron", recipe, &Settings::default())
        .unwrap()
        .graph;
    let engine = Engine::new(Arc::new(world), Options::default()).unwrap();
    let warnings = Mutex::new(vec![]);
    let listener = |event: Event| {
        if let Event::Warning { message, .. } = event {
            warnings.lock().unwrap().push(message);
        }
    };
    let result = engine.fields(&graph, "example", &listener);
    let error = result
        .err()
        .map(|error| error.diagnostics()[0].message.clone());
    (warnings.into_inner().unwrap(), error)
}

#[test]
fn cut_and_damaged_files_are_refused() {
    let whole = busy();
    let step = whole.len() / 60;
    for length in (0..60).chain((60..whole.len() - 12).step_by(step)) {
        let (_, error) = said(&whole[..length], "a.png");
        assert!(error.is_some(), "cut at {length} of {}", whole.len());
    }
    // A wrong check sum of the head and of the data.
    let data = whole.windows(4).position(|name| name == b"IDAT").unwrap();
    for at in [16, 30, data + 40] {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x10;
        assert!(said(&damaged, "a.png").1.is_some(), "damaged at {at}");
    }
    let picture =
        ImageBuffer::from_fn(64, 64, |x, y| image::Rgb([(x * y) as u8, x as u8, y as u8]));
    let jpeg = encoded(DynamicImage::ImageRgb8(picture), ImageFormat::Jpeg);
    assert_eq!(said(&jpeg, "a.jpg"), (vec![], None));
    for length in (3..jpeg.len() - 2).step_by(97) {
        assert!(
            said(&jpeg[..length], "a.jpg").1.is_some(),
            "cut at {length}"
        );
    }
    let none = said(b"hello", "a.png").1.unwrap();
    assert!(none.contains("found another kind of file"), "{none}");
}

#[test]
fn a_name_that_lies_is_told() {
    let (warnings, error) = said(&six(), "six.jpg");
    assert_eq!(error, None);
    assert_eq!(
        warnings,
        ["`six.jpg` is called .jpg, but is a PNG file; it is read as one"]
    );
}

/// The head of a PNG of this size, with a right check sum and nothing behind it.
fn head(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = vec![];
    let writer = png::Encoder::new(&mut bytes, 1, 1).write_header().unwrap();
    drop(writer);
    let mut head = bytes[..33].to_vec();
    head[16..20].copy_from_slice(&width.to_be_bytes());
    head[20..24].copy_from_slice(&height.to_be_bytes());
    // Eight bits of red, green, blue and opacity.
    head[25] = 6;
    let crc = !head[12..29].iter().fold(!0u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 & (!(crc & 1)).wrapping_add(1))
        })
    });
    head[29..33].copy_from_slice(&crc.to_be_bytes());
    head.extend(b"\0\0\0\x08IDATxxxxxxxx");
    head
}

#[test]
fn bombs_are_refused_before_anything_is_decoded() {
    for (width, height) in [
        (1_000_000, 1_000_000),
        (0x7fff_ffff, 0x7fff_ffff),
        (32_769, 1),
        (20_000, 20_000),
    ] {
        let error = said(&head(width, height), "a.png").1.unwrap();
        assert!(
            error.contains("larger than 32768 pixels a side or 256 MiB"),
            "{error}"
        );
    }
    assert!(said(&head(0, 5), "a.png").1.is_some());
    // Each is allowed, all of them are not: 8192 x 8192 pixels take 640 MiB with their copies.
    let nodes: String = (0..4)
        .map(|i| format!("\"p{i}\": image_from_file(file: \"{i}.png\", pixels_per_mm: 1),"))
        .collect();
    let mixes = "\"m\": mix(a: \"p0\", b: \"p1\", amount: 0.5), \"n\": mix(a: \"p2\", b: \"p3\", amount: 0.5),
        \"example\": mix(a: \"m\", b: \"n\", amount: 0.5)";
    let names = ["0.png", "1.png", "2.png", "3.png"];
    let files = names.map(|name| (name, head(8192, 8192)));
    let message = field_with(&files, &format!("{nodes} {mixes}"), "colour").unwrap_err();
    assert!(
        message.contains("takes 640 MiB, and all files of a recipe may take 2048 MiB"),
        "{message}"
    );
}

/// An OpenEXR picture of 2 x 1 pixels with these reds.
fn exr(reds: [f32; 2]) -> Vec<u8> {
    use exr::prelude::*;
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| (reds[at.x()], 0.25f32, 4.0f32));
    let mut bytes = Cursor::new(vec![]);
    Image::from_channels((2, 1), channels)
        .write()
        .to_buffered(&mut bytes)
        .unwrap();
    bytes.into_inner()
}

#[test]
fn open_exr_is_light_as_it_is_and_what_is_not_finite_counts_as_0_with_a_warning() {
    let field = shown_as(exr([0.5, 8.0]), "a.exr", ", pixels_per_mm: 1", "colour").unwrap();
    let columns = at(&field, &[[0.5, 0.5, 0.0], [1.5, 0.5, 0.0]]);
    assert_eq!(columns, [[0.5, 8.0], [0.25, 0.25], [4.0, 4.0]]);
    assert_eq!(said(&exr([0.5, 8.0]), "a.exr"), (vec![], None));
    let (warnings, error) = said(&exr([f32::NAN, f32::INFINITY]), "a.exr");
    assert_eq!(error, None);
    assert_eq!(
        warnings,
        ["2 samples of `a.exr` are not finite and count as 0"]
    );
    let whole = exr([0.5, 8.0]);
    for length in (4..whole.len() - 1).step_by(7) {
        assert!(
            said(&whole[..length], "a.exr").1.is_some(),
            "cut at {length}"
        );
    }
    let message = shown_as(
        whole,
        "a.exr",
        ", pixels_per_mm: 1, colour_space: srgb",
        "colour",
    )
    .unwrap_err();
    assert!(message.contains("holds light as it is"), "{message}");
}
