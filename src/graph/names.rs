//! Names: which are valid, and how they are shown when they are not.

use super::report::Report;
use crate::diagnostics::{Code, Span, is_unsafe};

/// Letters of the longest name: nodes inside compounds bear those of all uses around them.
const LONGEST: usize = 100;
/// Letters of a name or a literal that a message shows.
const SHOWN: usize = 60;

/// Whether `name` is `[a-z][a-z0-9_]*`.
pub(super) fn is_name(name: &str) -> bool {
    name.starts_with(|letter: char| letter.is_ascii_lowercase()) && wrong_letter(name).is_none()
}

/// The first letter that no name has.
fn wrong_letter(name: &str) -> Option<char> {
    let is_wrong = |letter: &char| !matches!(letter, 'a'..='z' | '0'..='9' | '_');
    name.chars().find(is_wrong)
}

/// Reports a name that is not valid; `what` says whose it is.
pub(super) fn check_name(report: &mut Report, what: &str, name: &str, span: Span) {
    if name.len() > LONGEST {
        let message = format!("{} is too long a name for {what}", shown(name));
        let label = format!("has {} letters", name.chars().count());
        let error = report.error(Code::InvalidName, message, span, label);
        report.add(error.expected(format!("at most {LONGEST} letters"), name.chars().count()));
        return;
    }
    if is_name(name) {
        return;
    }
    let message = format!("{} is no name for {what}", shown(name));
    let label = match (wrong_letter(name), name.chars().next()) {
        (_, None) => "the name is empty".to_owned(),
        (Some(letter), _) => format!("holds {}", shown_letter(letter)),
        (None, Some(first)) => format!("begins with `{first}`"),
    };
    report.add(
        report
            .error(Code::InvalidName, message, span, label)
            .expected(
                "a name of letters a to z, digits and `_`, the first a letter",
                shown(name),
            )
            .hint("begin with a letter from a to z and go on with letters, digits and `_`"),
    );
}

/// The label of a name that is not known: the letter that makes it another, or `otherwise`.
pub(super) fn look_alike(name: &str, otherwise: &str) -> String {
    match name.chars().find(|letter| !letter.is_ascii()) {
        Some(letter) => format!("holds {}", shown_letter(letter)),
        None => otherwise.to_owned(),
    }
}

/// Whether Windows would take the name for a device.
pub(super) fn is_reserved(name: &str) -> bool {
    let name = name.to_lowercase();
    let is_port = |rest: &str| rest.len() == 1 && ('1'..='9').any(|digit| rest.starts_with(digit));
    matches!(name.as_str(), "con" | "prn" | "aux" | "nul")
        || ["com", "lpt"]
            .iter()
            .any(|port| name.strip_prefix(port).is_some_and(is_port))
}

/// A name in backticks, cut if it is long.
pub(super) fn shown(name: &str) -> String {
    match name.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("`{}…`", &name[..end]),
        None => format!("`{name}`"),
    }
}

/// A letter in backticks, with its code point if it may be mistaken for another or cannot be seen.
pub(super) fn shown_letter(letter: char) -> String {
    let code = u32::from(letter);
    match letter {
        ' ' => "a space".to_owned(),
        letter if letter.is_ascii_graphic() => format!("`{letter}`"),
        letter if is_unsafe(letter) || letter.is_whitespace() => format!("U+{code:04X}"),
        letter => format!("`{letter}` (U+{code:04X})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_small_latin_letters_digits_and_underscores() {
        for name in ["a", "ring_width", "x2"] {
            assert!(is_name(name), "{name}");
        }
        for name in ["", "A", "2x", "_a", "a-b", "\u{430}", "a\u{200b}", "a b"] {
            assert!(!is_name(name), "{name}");
        }
    }

    #[test]
    fn devices_of_windows_are_reserved_in_any_case() {
        for name in ["con", "NUL", "com1", "lpt9"] {
            assert!(is_reserved(name), "{name}");
        }
        for name in ["com0", "com10", "cone", "lpt"] {
            assert!(!is_reserved(name), "{name}");
        }
    }

    #[test]
    fn look_alikes_show_their_code_point() {
        assert_eq!(shown_letter('\u{430}'), "`\u{430}` (U+0430)");
        assert_eq!(shown_letter('\u{202e}'), "U+202E");
    }
}
