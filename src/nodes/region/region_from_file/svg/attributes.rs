//! What the attributes of elements say: lengths, numbers, properties and transforms.

use super::super::path;
use glam::{DAffine2, DVec2};
use roxmltree::Node;

/// From the coordinates of the file to mm on its page, upwards.
pub(super) fn page(root: &Node<'_, '_>) -> DAffine2 {
    let lengths = ["width", "height"].map(|name| root.attribute(name).and_then(millimetres));
    let view = path::numbers(root.attribute("viewBox").unwrap_or_default());
    let unit = 25.4 / 96.0;
    let (corner, view) = match view[..] {
        [x, y, width, height] if width > 0.0 && height > 0.0 => {
            (DVec2::new(x, y), Some([width, height]))
        }
        _ => (DVec2::ZERO, None),
    };
    let scales = [0, 1].map(|axis| Some(lengths[axis]? / view?[axis]));
    // Both scales are the smaller one, as is usual: the drawing is in the middle of its page.
    let scale = match scales {
        [Some(x), Some(y)] => x.min(y),
        [x, y] => x.or(y).unwrap_or(unit),
    };
    let size = |axis: usize| {
        lengths[axis]
            .or(view.map(|view| view[axis] * scale))
            .unwrap_or_default()
    };
    let drawn = |axis: usize| view.map_or(size(axis), |view| view[axis] * scale);
    let aside = |axis: usize| 0.5 * (size(axis) - drawn(axis));
    let flip = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, aside(0), size(1) - aside(1)]);
    flip * DAffine2::from_scale(DVec2::splat(scale)) * DAffine2::from_translation(-corner)
}

/// A length in mm.
fn millimetres(text: &str) -> Option<f64> {
    let text = text.trim();
    let end = text.find(|letter: char| {
        letter.is_ascii_alphabetic() && !"eE".contains(letter) || letter == '%'
    });
    let (number, unit) = text.split_at(end.unwrap_or(text.len()));
    let factor = match unit {
        "" | "px" => 25.4 / 96.0,
        "mm" => 1.0,
        "cm" => 10.0,
        "in" => 25.4,
        "pt" => 25.4 / 72.0,
        "pc" => 25.4 / 6.0,
        "Q" => 0.25,
        _ => return None,
    };
    number
        .trim()
        .parse()
        .ok()
        .map(|number: f64| number * factor)
        .filter(|number| *number > 0.0)
}

/// A length of the drawing in its own units, 0 if it is not there.
pub(super) fn number(node: &Node<'_, '_>, name: &str) -> f64 {
    let text = node.attribute(name).unwrap_or_default();
    let first = path::numbers(text).first().copied().unwrap_or_default();
    let unit = text
        .trim_start_matches(|letter: char| !letter.is_ascii_alphabetic() || "eE".contains(letter));
    match unit {
        "mm" | "cm" | "in" | "pt" | "pc" | "Q" => {
            millimetres(text).unwrap_or_default() * 96.0 / 25.4
        }
        _ => first,
    }
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

/// A list of transforms; what is not understood changes nothing.
pub(super) fn transform(text: &str) -> DAffine2 {
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
            _ => DAffine2::IDENTITY,
        };
    }
    whole
}
