//! Whether the channels that maps ask for are there, and whether whole samples can show them.

use crate::diagnostics::nearest;
use crate::node::{Failure, Inputs};
use crate::nodes::surface::material::STANDARD_CHANNELS;
use crate::value::{FileType, MapFormat, Material, SampleType, Value};
use std::collections::BTreeMap;

/// The channels of `ranges`, in their order.
pub(super) fn ranged<'i>(inputs: &Inputs<'i>) -> impl Iterator<Item = &'i String> {
    let channel = |item: &'i Value| match item {
        Value::Record(parts) => parts.iter().find_map(|part| match part {
            ("channel", Value::Text(channel)) => Some(channel),
            _ => None,
        }),
        _ => None,
    };
    inputs.list("ranges").iter().filter_map(channel)
}

/// Refuses names that are no channel of the material, all of them at once, each with the nearest that is one.
pub(super) fn known_channels<'c>(
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

/// Refuses and warns of whole samples that cannot show a channel.
pub(super) fn check_range(
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
    if !is_number || is_ratio {
        return Ok(());
    }
    if !is_whole {
        warn_of_half_ids(inputs, channel, format);
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

/// Warns of ids in floats of 16 bits, which hold whole numbers up to 2048.
fn warn_of_half_ids(inputs: &Inputs<'_>, channel: &str, format: MapFormat) {
    if is_of_ids(channel) && format.sample_type() == SampleType::Half {
        let name = format.name();
        inputs.warn(format!(
            "{name} tells the whole numbers of `{channel}` apart up to 2048 only; write `format: exr_float` for more"
        ));
    }
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
