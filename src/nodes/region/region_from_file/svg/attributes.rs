//! What the attributes of elements say: lengths, numbers, properties and transforms.

use super::super::path;
use super::Complaints;
use glam::{DAffine2, DVec2};
use roxmltree::Node;

/// A length in CSS pixels; percentages are of `whole`, if there is one, and letters are 16 pixels high.
pub(super) fn pixels(text: &str, whole: Option<f64>) -> Option<f64> {
    let text = text.trim();
    let end = text
        .char_indices()
        .find(|(at, letter)| *letter == '%' || begins_unit(&text[*at..]))
        .map_or(text.len(), |(at, _)| at);
    let (number, unit) = text.split_at(end);
    let factor = match unit {
        "" | "px" => 1.0,
        "mm" => 96.0 / 25.4,
        "cm" => 960.0 / 25.4,
        "in" => 96.0,
        "pt" => 96.0 / 72.0,
        "pc" => 16.0,
        "Q" => 24.0 / 25.4,
        "em" | "rem" => 16.0,
        "ex" | "ch" => 8.0,
        "%" => whole? / 100.0,
        _ => return None,
    };
    number
        .trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
        .map(|number| number * factor)
}

/// Whether letters are a unit and not the exponent of a number.
fn begins_unit(text: &str) -> bool {
    let mut letters = text.chars();
    let first = letters.next().unwrap_or(' ');
    let is_exponent = "eE".contains(first)
        && letters
            .next()
            .is_some_and(|next| next.is_ascii_digit() || "+-".contains(next));
    first.is_ascii_alphabetic() && !is_exponent
}

/// A length of an element in units of its drawing, if it has it; percentages are of `whole`.
pub(super) fn length(
    node: &Node<'_, '_>,
    name: &str,
    whole: f64,
    complaints: &mut Complaints,
) -> Option<f64> {
    let text = node.attribute(name)?;
    let length = pixels(text, Some(whole));
    if length.is_none() && text.trim() != "auto" {
        complaints.add(format!(
            "the length `{name}=\"{text}\"` in line {} is not understood and left out",
            line(node)
        ));
    }
    length
}

/// A property from an attribute, or from `style`, which comes first.
pub(super) fn property<'a>(node: &Node<'a, '_>, name: &str) -> Option<&'a str> {
    let style = node.attribute("style").unwrap_or_default();
    let mut declared = style.split(';').filter_map(|part| part.split_once(':'));
    let in_style = declared.rfind(|(property, _)| property.trim() == name);
    in_style
        .map(|(_, value)| value.trim())
        .or_else(|| node.attribute(name))
}

/// The line of the file that an element begins in.
pub(super) fn line(node: &Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// The list of transforms of an element; what is not understood changes nothing.
pub(super) fn transform(node: &Node<'_, '_>, complaints: &mut Complaints) -> DAffine2 {
    let text = node.attribute("transform").unwrap_or_default();
    let mut whole = DAffine2::IDENTITY;
    for part in text.split(')') {
        let Some((name, numbers)) = part.split_once('(') else {
            continue;
        };
        let numbers = path::numbers(numbers);
        let turn = |degrees: f64| {
            let (sine, cosine) = libm::sincos(degrees.to_radians());
            DAffine2::from_cols_array(&[cosine, sine, -sine, cosine, 0.0, 0.0])
        };
        let slant = |degrees: f64| libm::tan(degrees.to_radians());
        whole *= match (
            name.trim_matches(|letter: char| letter.is_whitespace() || letter == ','),
            &numbers[..],
        ) {
            ("matrix", [a, b, c, d, e, f]) => DAffine2::from_cols_array(&[*a, *b, *c, *d, *e, *f]),
            ("translate", [x]) => DAffine2::from_translation(DVec2::new(*x, 0.0)),
            ("translate", [x, y]) => DAffine2::from_translation(DVec2::new(*x, *y)),
            ("scale", [both]) => DAffine2::from_scale(DVec2::splat(*both)),
            ("scale", [x, y]) => DAffine2::from_scale(DVec2::new(*x, *y)),
            ("rotate", [angle]) => turn(*angle),
            ("rotate", [angle, x, y]) => {
                let to = DAffine2::from_translation(DVec2::new(*x, *y));
                to * turn(*angle) * to.inverse()
            }
            ("skewX", [angle]) => {
                DAffine2::from_cols_array(&[1.0, 0.0, slant(*angle), 1.0, 0.0, 0.0])
            }
            ("skewY", [angle]) => {
                DAffine2::from_cols_array(&[1.0, slant(*angle), 0.0, 1.0, 0.0, 0.0])
            }
            _ => {
                complaints.add(format!(
                    "the transform `{})` in line {} is not understood and left out",
                    part.trim(),
                    line(node)
                ));
                DAffine2::IDENTITY
            }
        };
    }
    whole
}
