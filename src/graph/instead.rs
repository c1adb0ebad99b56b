//! What to write in the place of a literal of another type.

use super::literal::Slot;
use super::names::shown;
use super::tree::{Shape, Tree};
use crate::value::Type;

/// The sixteen colours that HTML 4.01 (section 6.5) gives names, and grey as we spell it.
const COLOURS: [(&str, &str); 17] = [
    ("aqua", "#00ffff"),
    ("black", "#000000"),
    ("blue", "#0000ff"),
    ("fuchsia", "#ff00ff"),
    ("gray", "#808080"),
    ("grey", "#808080"),
    ("green", "#008000"),
    ("lime", "#00ff00"),
    ("maroon", "#800000"),
    ("navy", "#000080"),
    ("olive", "#808000"),
    ("purple", "#800080"),
    ("red", "#ff0000"),
    ("silver", "#c0c0c0"),
    ("teal", "#008080"),
    ("white", "#ffffff"),
    ("yellow", "#ffff00"),
];

/// What to write instead of a literal that is not of the slot's type.
pub(super) fn instead(tree: &Tree, slot: Slot<'_>) -> Option<String> {
    match (slot.value_type, &tree.shape) {
        (Type::Colour, Shape::Name(name)) => Some(colour(name)),
        (Type::List(Type::Record(_)), Shape::Record(..)) => {
            Some("put it into a list, even if it is the only one: `[(..)]`".to_owned())
        }
        (Type::List(Type::List(_)), Shape::List(_) | Shape::Tuple(..)) => {
            let message = "each item is a list of its own; put even a single one in brackets: `[[(0, 0), (1, 0), (1, 1)]]`";
            Some(message.to_owned())
        }
        (Type::List(Type::Pair(_)), Shape::Record(..)) => {
            Some("write the points alone: `[(0, 0), (1, 0), (1, 1)]`".to_owned())
        }
        (Type::Record(parts), Shape::List(_) | Shape::Tuple(..)) => {
            let first = parts.first()?.name;
            Some(format!("name the parts of a record: `({first}: ..)`"))
        }
        _ => None,
    }
}

/// What to write instead of a text that is the name of no node, for an input that takes literals.
pub(super) fn instead_of_text(text: &str, name: &str, wanted: Type) -> Option<String> {
    match wanted {
        // What has a dot is the output of a node.
        Type::Colour if text.contains('.') => None,
        Type::Colour => Some(colour(text)),
        Type::Number(_) | Type::Whole | Type::Toggle | Type::Pair(_) | Type::Vector(_) => {
            let name = shown(name);
            Some(format!(
                "{name} is a {wanted}; a text here is the name of a node, or begins with `=` or `$`"
            ))
        }
        _ => None,
    }
}

/// How a colour is written that somebody gave a name or other digits.
fn colour(text: &str) -> String {
    let known = COLOURS
        .iter()
        .find(|(name, _)| *name == text.to_ascii_lowercase());
    match known {
        Some((name, digits)) => format!("write {name} as `\"{digits}\"`"),
        None => "write colours as six digits behind `#`, such as `\"#c8a06e\"`".to_owned(),
    }
}
