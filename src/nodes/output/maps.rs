//! `maps`: writes channels of a flat piece as image files, one file a channel.
//!
//! A file is called after the output and the channel: `board_base_color.png`. The picture's upper left
//! corner is the piece's; v points up. Whole samples (PNG, `tiff8`, `tiff16`, BMP) hold sRGB for colours and
//! plain values for the rest: ratios as they are, normals as (n + 1) / 2, lengths and extras scaled from their
//! range. Floats (EXR, `tiff_half`, `tiff_float`) hold everything as it is, colours linear.

use crate::diagnostics::nearest;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::surface::material::STANDARD_CHANNELS;
use crate::value::{Domain, FileType, MapFormat, Maps, Material, Type, Unit, Value};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Largest width and height of a picture in pixels.
const LARGEST_SIDE: u32 = 65_536;

/// Writes channels of a flat piece as image files.
pub static KIND: Kind = Kind {
    name: "maps",
    version: 1,
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

/// The channels of `ranges`, in their order.
fn ranged<'i>(inputs: &Inputs<'i>) -> impl Iterator<Item = &'i String> {
    let channel = |item: &'i Value| match item {
        Value::Record(parts) => parts.iter().find_map(|part| match part {
            ("channel", Value::Text(channel)) => Some(channel),
            _ => None,
        }),
        _ => None,
    };
    inputs.list("ranges").iter().filter_map(channel)
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

/// Refuses names that are no channel of the material, all of them at once, each with the nearest that is one.
fn known_channels<'c>(
    input: &'static str,
    names: impl Iterator<Item = &'c String>,
    material: &Material,
) -> Result<(), Failure> {
    let known = || {
        let channels = material.channels.keys();
        channels.map(String::as_str).chain(["normal"])
    };
    let unknown: Vec<(usize, &String)> = names
        .enumerate()
        .filter(|(_, name)| !known().any(|known| known == *name))
        .collect();
    let Some((first, _)) = unknown.first() else {
        return Ok(());
    };
    let listed: Vec<String> = unknown
        .iter()
        .map(|(_, name)| format!("`{name}`"))
        .collect();
    let message = match &listed[..] {
        [only] => format!("the material has no channel {only}"),
        [rest @ .., last] => {
            let rest = rest.join(", ");
            format!("the material has no channels {rest} and {last}")
        }
        [] => return Ok(()),
    };
    let mut near: Vec<String> = unknown
        .iter()
        .filter_map(|(_, name)| {
            nearest(name, known())
                .first()
                .map(|near| format!("`{near}`"))
        })
        .collect();
    near.dedup();
    let suggestion = match near.is_empty() {
        true => String::new(),
        false => format!("did you mean {}? ", near.join(", ")),
    };
    let all = known().collect::<Vec<_>>().join(", ");
    Err(Failure::of_input(input, message)
        .at_item(*first)
        .with_hint(format!("{suggestion}it has {all}")))
}

fn check_range(
    inputs: &Inputs<'_>,
    channel: &str,
    material: &Material,
    format: MapFormat,
    ranges: &BTreeMap<String, [f64; 2]>,
) -> Result<(), Failure> {
    let is_ratio =
        channel == "normal" || (channel != "height" && STANDARD_CHANNELS.contains(&channel));
    let is_number = material
        .channels
        .get(channel)
        .is_some_and(|field| field.width() == 1);
    let is_whole = !format.sample_type().is_float();
    if !is_whole || !is_number || is_ratio {
        return Ok(());
    }
    match ranges.get(channel) {
        Some(range) => warn_of_ids(inputs, channel, format, *range),
        None => return Err(refuse_unranged(channel, format)),
    }
    Ok(())
}

/// What is said of a channel of which nobody knows what is black and white.
fn refuse_unranged(channel: &str, format: MapFormat) -> Failure {
    let file = match format.file_type() {
        FileType::Tiff => "a TIFF of whole samples",
        FileType::Bmp => "a BMP",
        _ => "a PNG",
    };
    let message = format!("{file} of `{channel}` needs to know which values are black and white");
    let hint = match is_of_ids(channel) {
        true => format!(
            "ids are whole numbers: write `format: exr_float`, which holds them as they are, or `format: png16` with \
             `ranges: [(channel: \"{channel}\", low: 0, high: 65535)]`"
        ),
        false => format!(
            "add `ranges: [(channel: \"{channel}\", low: 0, high: 1)]` with its values, or write EXR"
        ),
    };
    Failure::of_input("channels", message).with_hint(hint)
}

/// Whether a channel holds whole numbers that tell things apart, by its name.
fn is_of_ids(channel: &str) -> bool {
    channel == "id" || channel.ends_with("_id")
}

/// Warns of ids that whole samples would not tell apart.
fn warn_of_ids(inputs: &Inputs<'_>, channel: &str, format: MapFormat, [low, high]: [f64; 2]) {
    let steps = libm::exp2(8.0 * format.sample_type().bytes() as f64) - 1.0;
    if is_of_ids(channel) && (high - low).abs() > steps {
        let name = format.name();
        inputs.warn(format!(
            "`{channel}` from {low} to {high} does not fit into the {} values of {name}, so different ids look the same; \
             write `format: exr_float`, or `png16` for ids up to 65535",
            steps + 1.0
        ));
    }
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
