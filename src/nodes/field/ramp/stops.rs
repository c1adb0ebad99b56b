//! The stops of a ramp as a profile.

use crate::colour::luminance;
use crate::node::{Failure, Inputs};
use crate::nodes::field::profile::{Ends, Piece, Profile, hermite};
use crate::value::Value;

/// Red, green, blue and value at a place.
#[derive(Clone, Copy, Debug)]
struct Stop {
    at: f64,
    lanes: [f64; 4],
}

/// Stops closer than this share of their range are at one place.
const SAME: f64 = 1e-9;

/// The profile that the inputs of a ramp describe.
///
/// # Errors
/// No stops, stops that do not rise or are not alike, and periods shorter than the stops.
pub(super) fn profile(inputs: &Inputs<'_>) -> Result<Profile<4>, Failure> {
    let mut stops = read(inputs.list("stops"))?;
    let ends = match inputs.choice("ends") {
        "repeat" => Ends::Repeat,
        _ => Ends::Stay,
    };
    let (first, last) = (stops[0], stops[stops.len() - 1]);
    if ends == Ends::Stay {
        if inputs.get("period").is_some() {
            let failure = Failure::of_input("period", "a ramp that holds its ends has no period");
            return Err(failure.with_hint("write `ends: repeat`, or leave `period` out"));
        }
        return Ok(held(&stops, inputs.choice("curve")));
    }
    let period = match inputs.get("period") {
        Some(_) => inputs.number("period"),
        None => 1.0,
    };
    let end = first.at + period;
    if last.at > end {
        let message = format!(
            "the stop at {} lies behind the end of the period at {end}",
            last.at
        );
        let failure = Failure::of_input("stops", message);
        return Err(
            failure.with_hint("set `period` to the distance from the first stop to its return")
        );
    }
    stops.push(Stop { at: end, ..first });
    Ok(Profile::new(
        pieces(&stops, ends, inputs.choice("curve")),
        end,
        ends,
    ))
}

/// The stops with the first one before them and the last one behind them.
fn held(stops: &[Stop], curve: &str) -> Profile<4> {
    let flat = |start: f64, stop: Stop| Piece {
        start,
        cubic: stop.lanes.map(|lane| [lane, 0.0, 0.0, 0.0]),
    };
    let (first, last) = (stops[0], stops[stops.len() - 1]);
    let reach = (last.at - first.at).max(1e-3 * first.at.abs()).max(1e-3);
    let before = [flat(first.at - reach, first)].into_iter();
    let between = pieces(stops, Ends::Stay, curve);
    let pieces = before.chain(between).chain([flat(last.at, last)]).collect();
    Profile::new(pieces, last.at + reach, Ends::Stay)
}

fn read(items: &[Value]) -> Result<Vec<Stop>, Failure> {
    let refuse = |message: String| Failure::of_input("stops", message);
    let mut stops: Vec<Stop> = vec![];
    let mut alike = None;
    for (index, item) in items.iter().enumerate() {
        let number = index + 1;
        let (at, colour, value) = parts(item);
        let has = (colour.is_some(), value.is_some());
        if has == (false, false) {
            let message = format!("stop {number} has neither `colour` nor `value`");
            return Err(refuse(message).with_hint("write `(at: 0.5, colour: \"#c89a62\")`"));
        }
        if *alike.get_or_insert(has) != has {
            let message = format!("stop {number} is unlike the stops before it");
            let hint = "give every stop a `colour`, every stop a `value`, or every stop both";
            return Err(refuse(message).with_hint(hint));
        }
        if let Some(before) = stops.last().filter(|before| at < before.at) {
            let message = format!(
                "stop {number} at {at} stands before the stop at {}",
                before.at
            );
            return Err(refuse(message).with_hint("sort the stops by `at`"));
        }
        let grey = value.unwrap_or_default();
        let [r, g, b] = colour.unwrap_or([grey; 3]);
        let light = f64::from(luminance([r, g, b].map(|part| part as f32)));
        stops.push(Stop {
            at,
            lanes: [r, g, b, value.unwrap_or(light)],
        });
    }
    if stops.is_empty() {
        return Err(refuse("expected at least one stop, found none".to_owned()));
    }
    Ok(stops)
}

/// Place, colour and value of a checked record.
fn parts(item: &Value) -> (f64, Option<[f64; 3]>, Option<f64>) {
    let Value::Record(parts) = item else {
        return (0.0, None, None);
    };
    let (mut at, mut colour, mut value) = (0.0, None, None);
    for (name, part) in parts {
        match (*name, part) {
            ("at", Value::Number(number)) => at = *number,
            ("value", Value::Number(number)) => value = Some(*number),
            (_, Value::Colour(part)) => colour = Some(*part),
            _ => {}
        }
    }
    (at, colour, value)
}

/// The pieces between stops; of stops at one place the first ends what is before, the last begins what follows.
fn pieces(stops: &[Stop], ends: Ends, curve: &str) -> Vec<Piece<4>> {
    let range = stops[stops.len() - 1].at - stops[0].at;
    let mut pieces = vec![];
    for index in 0..stops.len() - 1 {
        let (from, to) = (stops[index], stops[index + 1]);
        let width = to.at - from.at;
        if width <= SAME * range {
            continue;
        }
        let cubic = std::array::from_fn(|lane| {
            let (start, end) = (from.lanes[lane], to.lanes[lane]);
            let slope = |index| slope(stops, ends, index, lane, SAME * range);
            match curve {
                "step" => [start, 0.0, 0.0, 0.0],
                "smooth" => hermite(width, start, end, [0.0, 0.0]),
                "monotone" => hermite(width, start, end, [slope(index), slope(index + 1)]),
                _ => [start, (end - start) / width, 0.0, 0.0],
            }
        });
        pieces.push(Piece {
            start: from.at,
            cubic,
        });
    }
    pieces
}

/// The slope at a stop: the weighted harmonic mean of the slopes on both sides, 0 at a turn, an edge or an end.
fn slope(stops: &[Stop], ends: Ends, index: usize, lane: usize, same: f64) -> f64 {
    let last = stops.len() - 1;
    let cyclic = ends == Ends::Repeat;
    let before = match index {
        0 if cyclic => last,
        0 => return 0.0,
        _ => index,
    };
    let after = match index {
        _ if index == last && cyclic => 0,
        _ if index == last => return 0.0,
        _ => index,
    };
    let side = |from: usize| {
        let width = stops[from + 1].at - stops[from].at;
        let rise = stops[from + 1].lanes[lane] - stops[from].lanes[lane];
        (width > same).then(|| (width, rise / width))
    };
    let (Some((left, before)), Some((right, after))) = (side(before - 1), side(after)) else {
        return 0.0;
    };
    if before * after <= 0.0 {
        return 0.0;
    }
    let weights = [left + 2.0 * right, 2.0 * left + right];
    (weights[0] + weights[1]) / (weights[0] / before + weights[1] / after)
}
