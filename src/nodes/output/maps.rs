//! `maps`: writes channels of a flat piece as image files, one file a channel.
//!
//! A file is called after the output and the channel: `board_base_color.png`. The picture's upper left
//! corner is the piece's; v points up. Whole samples (PNG, `tiff8`, `tiff16`, BMP) hold sRGB for colours and
//! plain values for the rest: ratios as they are, normals as (n + 1) / 2, lengths and extras scaled from their
//! range. Floats (EXR, `tiff_half`, `tiff_float`) hold everything as it is, colours linear.

mod channels;

use self::channels::{check_range, known_channels, ranged};
use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, MapFormat, Maps, Material, Type, Unit, Value};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Largest width and height of a picture in pixels.
const LARGEST_SIDE: u32 = 65_536;

/// Writes channels of a flat piece as image files.
pub static KIND: Kind = Kind {
    name: "maps",
    version: 2,
    about: "Writes channels of a flat piece as image files; stands in `outputs`.",
    source: "own construction; conventions of OpenPBR, glTF and OpenEXR",
    inputs: &[
        Input::new("of", Type::Material, "The piece.").of(Domain::Plane),
        Input::new(
            "size",
            Type::Pair(Unit::Millimetre),
            "Width and height of a piece that has none of its own, such as a picture; pieces that were cut have.",
        )
        .optional()
        .range(1e-3, 1e7),
        Input::number(
            "pixels_per_mm",
            Unit::PixelPerMillimetre,
            "Resolution; the picture's size follows from the piece's.",
        )
        .optional()
        .range(1e-4, 1e4),
        Input::new(
            "pixels",
            Type::Pair(Unit::Pixel),
            "Size of the picture, instead of `pixels_per_mm`; of another shape than the piece, it is stretched.",
        )
        .optional()
        .range(1.0, LARGEST_SIDE as f64),
        Input::new(
            "channels",
            Type::Names,
            "Channels to write: standard ones, `normal`, and extras.",
        )
        .default("[base_color]"),
        Input::new(
            "format",
            Type::Choice(&MapFormat::NAMES),
            "File format and samples: 8 or 16 bits whole (colours sRGB), half or float (as it is, colours \
             linear). A BMP has at most 2147483647 bytes and carries no key: the store knows it.",
        )
        .default("png8"),
        Input::new(
            "ranges",
            Type::List(&Type::Record(RANGE)),
            "What whole samples write as black and as white.",
        )
        .default("[]"),
    ],
    outputs: &[Output::new("maps", Type::Maps, "The files.")],
    example: r##"(nodes: {
        "wood": material(base_color: "#c8a06e"),
        "board": slice_cut(of: "wood", cut: end_grain, origin: (0, 0, 500), size: (100, 50)),
    }, outputs: {
        "example": maps(of: "board", pixels_per_mm: 2, channels: [base_color, roughness]),
    })"##,
    build,
};

const RANGE: &[Input] = &[
    Input::new("channel", Type::Text, "Name of the channel."),
    Input::number(
        "low",
        Unit::One,
        "Value that becomes black, in the channel's unit.",
    ),
    Input::number(
        "high",
        Unit::One,
        "Value that becomes white, in the channel's unit.",
    ),
];

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let material = inputs.material("of");
    let size = size(inputs, material.size)?;
    let format = MapFormat::from_name(inputs.choice("format"))
        .expect("the format is one of the names that the input declares");
    let channels = inputs.names("channels").to_vec();
    if channels.is_empty() {
        let message = "no channel is listed, so nothing would be written";
        return Err(
            Failure::of_input("channels", message).with_hint("write `channels: [base_color]`")
        );
    }
    let ranges = ranges(inputs)?;
    known_channels("channels", channels.iter(), material)?;
    known_channels("ranges", ranged(inputs), material)?;
    for channel in &channels {
        check_range(inputs, channel, material, format, &ranges)?;
    }
    let mut sorted = channels.clone();
    sorted.sort();
    if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        let message = format!("the channel `{}` is listed twice", twice[0]);
        return Err(Failure::of_input("channels", message).with_hint("remove one of them"));
    }
    let pixels = pixels(inputs, size)?;
    warn_of_seams(inputs, size, &channels, material);
    let maps = Maps {
        material: (**material).clone(),
        pixels,
        size,
        is_view: false,
        channels,
        format,
        ranges,
    };
    Ok(vec![Value::Maps(Arc::new(maps))])
}

fn ranges(inputs: &Inputs<'_>) -> Result<BTreeMap<String, [f64; 2]>, Failure> {
    let mut ranges = BTreeMap::new();
    for item in inputs.list("ranges") {
        let Value::Record(parts) = item else { continue };
        let [
            (_, Value::Text(channel)),
            (_, Value::Number(low)),
            (_, Value::Number(high)),
        ] = parts.as_slice()
        else {
            continue;
        };
        if low == high {
            let message = format!("the range of `{channel}` is empty: {low} to {high}");
            return Err(Failure::of_input("ranges", message));
        }
        ranges.insert(channel.clone(), [*low, *high]);
    }
    Ok(ranges)
}

/// Width and height of the piece: its own, or as stated.
fn size(inputs: &Inputs<'_>, own: Option<[f64; 2]>) -> Result<[f64; 2], Failure> {
    let stated = inputs.get("size").map(|_| inputs.pair("size"));
    match (own, stated) {
        (Some(size), None) | (None, Some(size)) => Ok(size),
        (None, None) => {
            let message = "the material is not a cut piece, so it has no size";
            let hint = "cut it, for example with `slice_cut`, or state its `size: (200, 100)` here";
            Err(Failure::of_input("of", message).with_hint(hint))
        }
        (Some([width, height]), Some(_)) => {
            let message = format!("the piece has a size of its own, {width} x {height} mm");
            Err(Failure::of_input("size", message).with_hint("remove `size`"))
        }
    }
}

/// How far a number of periods may be from a whole one.
const WHOLE: f64 = 1e-4;

/// Warns if cells that repeat do not fit the piece a whole number of times. Less than a period is a look at a part.
fn warn_of_seams(inputs: &Inputs<'_>, size: [f64; 2], channels: &[String], material: &Material) {
    let shown = |channel: &String| match channel.as_str() {
        "normal" => material.channels.get("height"),
        name => material.channels.get(name),
    };
    let mut periods: Vec<[f64; 2]> = vec![];
    for period in channels.iter().filter_map(shown).flat_map(Field::periods) {
        if !periods.contains(&period) {
            periods.push(period);
        }
    }
    let does_not_meet = |[width, height]: &[f64; 2]| {
        let times = [size[0] / width, size[1] / height];
        let is_part = |times: &f64| *times > 1.0 - WHOLE && (times - times.round()).abs() > WHOLE;
        times.iter().any(is_part)
    };
    for [width, height] in periods.into_iter().filter(does_not_meet) {
        let fitting = [[size[0], width], [size[1], height]]
            .map(|[size, period]| (1e6 * period * (size / period).floor().max(1.0)).round() / 1e6);
        inputs.warn(format!(
            "the picture shows {} x {} mm of cells that repeat every {width} x {height} mm, so it has a seam where it is tiled; \
             {} x {} mm would have none",
            size[0],
            size[1],
            fitting[0],
            fitting[1]
        ));
    }
}

/// Width and height of the picture, from its resolution or as stated.
fn pixels(inputs: &Inputs<'_>, size: [f64; 2]) -> Result<[u32; 2], Failure> {
    match (inputs.get("pixels_per_mm"), inputs.get("pixels")) {
        (Some(_), None) => {
            let resolution = inputs.number("pixels_per_mm");
            let pixels = size.map(|length| (length * resolution).round().max(1.0));
            if pixels.iter().any(|side| *side > f64::from(LARGEST_SIDE)) {
                let message = format!(
                    "the picture would be {} x {} pixels; the largest side is {LARGEST_SIDE}",
                    pixels[0], pixels[1]
                );
                return Err(Failure::of_input("pixels_per_mm", message)
                    .with_hint("lower `pixels_per_mm`, or cut a smaller piece"));
            }
            Ok(pixels.map(|side| side as u32))
        }
        (None, Some(_)) => Ok(inputs.pair("pixels").map(|side| side.round() as u32)),
        (None, None) => Err(Failure::new("neither `pixels_per_mm` nor `pixels` is set")
            .with_hint("add `pixels_per_mm: 4`")),
        (Some(_), Some(_)) => Err(Failure::of_input(
            "pixels",
            "both `pixels_per_mm` and `pixels` are set",
        )
        .with_hint("remove one of them")),
    }
}
