//! Text in quotes: plain and raw strings, and the RON literals that look like them.

use crate::diagnostics::Span;

/// Bytes behind a string that are looked at for other strings.
const LONGEST_LINE: usize = 1000;

/// Text in quotes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct TextLiteral {
    /// What it says: escapes replaced, every line ending a line feed.
    pub(super) value: String,
    /// Where the letters of `value` stand in the file, if they stand there as they are.
    pub(super) verbatim: Option<usize>,
}

impl TextLiteral {
    /// The same text, `offset` bytes later in the file.
    pub(super) fn moved(self, offset: usize) -> TextLiteral {
        TextLiteral {
            verbatim: self.verbatim.map(|at| at + offset),
            ..self
        }
    }
}

/// What was found at the beginning of a text.
#[derive(Debug)]
pub(super) struct Found {
    /// Bytes it takes, quotes included.
    pub(super) length: usize,
    /// Bytes of what opens it.
    pub(super) opening: usize,
    /// Whether its end was found, and stands where a string can end.
    pub(super) is_closed: bool,
    /// Whether no end was found up to the end of the file.
    pub(super) takes_rest: bool,
    /// The text; `None` for bytes and characters.
    pub(super) literal: Option<TextLiteral>,
}

/// The string, byte string, character or byte that `text` begins with.
pub(super) fn read(text: &str) -> Option<Found> {
    let unprefixed = text.strip_prefix('b').unwrap_or(text);
    let prefix = text.len() - unprefixed.len();
    let found = match unprefixed.as_bytes().first()? {
        b'"' => plain(unprefixed),
        b'r' => raw(unprefixed)?,
        b'\'' => character(unprefixed)?,
        _ => return None,
    };
    let literal = found.literal.filter(|_| prefix == 0);
    Some(Found {
        length: found.length + prefix,
        opening: found.opening + prefix,
        literal,
        ..found
    })
}

fn plain(text: &str) -> Found {
    let bytes = text.as_bytes();
    let mut at = 1;
    while at < bytes.len() && bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    let takes_rest = at >= bytes.len();
    let content = if takes_rest { &text[1..] } else { &text[1..at] };
    let length = if takes_rest { text.len() } else { at + 1 };
    Found {
        length,
        opening: 1,
        is_closed: !takes_rest && ends_well(content, &text[length..]),
        takes_rest,
        literal: Some(literal(content, 1, unescape)),
    }
}

/// Whether a string can end where `rest` begins. If a quotation mark was forgotten, strings begin where
/// others end: the next one that is closed has letters right behind it, or begins a line further down.
fn ends_well(content: &str, rest: &str) -> bool {
    let Some(next) = rest.chars().next() else {
        return true;
    };
    if next.is_whitespace() || ",)]}/".contains(next) {
        return true;
    }
    // No name goes over several lines.
    if content.contains(['\n', '\r']) {
        return false;
    }
    let bytes = rest.bytes().take(LONGEST_LINE);
    let line = bytes.take_while(|byte| !matches!(byte, b'\n' | b'\r'));
    let (length, marks) = line.fold((0, 0), |(length, marks), byte| {
        (length + 1, marks + usize::from(byte == b'"'))
    });
    next == ':' || length == LONGEST_LINE || marks % 2 == 0
}

/// The part of an unclosed string that is most likely meant: up to what cannot be in a link or a name, or
/// to the end of the line.
pub(super) fn likely_length(text: &str, opening: usize) -> usize {
    let line = text[opening..].split(['\n', '\r']).next().unwrap_or("");
    let mut depth = 0_usize;
    for (at, letter) in line.char_indices() {
        match letter {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' if depth > 0 => depth -= 1,
            ')' | ']' | '}' | '"' => return opening + at,
            ',' | ':' if depth == 0 => return opening + at,
            _ => {}
        }
    }
    opening + line.len()
}

/// `r"..."` or `r#"..."#` with any number of `#`.
fn raw(text: &str) -> Option<Found> {
    let hashes = text[1..].bytes().take_while(|byte| *byte == b'#').count();
    let opening = 1 + hashes + 1;
    if text.as_bytes().get(opening - 1) != Some(&b'"') {
        return None;
    }
    let closing = format!("\"{}", "#".repeat(hashes));
    let end = text[opening..].find(&closing);
    let content = &text[opening..][..end.unwrap_or(text.len() - opening)];
    let length = end.map_or(text.len(), |end| opening + end + closing.len());
    let literal = Some(literal(content, opening, str::to_owned));
    Some(Found {
        length,
        opening,
        is_closed: end.is_some(),
        takes_rest: end.is_none(),
        literal,
    })
}

/// `'a'`, also with an escape: a few letters between apostrophes.
fn character(text: &str) -> Option<Found> {
    let longest = "\\u{10ffff}".len();
    let mut letters = text.char_indices().skip(1);
    let (_, first) = letters.next()?;
    if first == '\\' {
        letters.next()?;
    }
    let (end, _) = letters.take(longest).find(|(_, letter)| *letter == '\'')?;
    Some(Found {
        length: end + 1,
        opening: 1,
        is_closed: true,
        takes_rest: false,
        literal: None,
    })
}

fn literal(content: &str, offset: usize, decode: fn(&str) -> String) -> TextLiteral {
    // Line endings first: a carriage return that an escape asks for stays.
    let value = decode(&content.replace("\r\n", "\n").replace('\r', "\n"));
    let verbatim = (value == content).then_some(offset);
    TextLiteral { value, verbatim }
}

/// Replaces escapes. Wrong ones are left as they are: the `ron` crate reports them.
fn unescape(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('\\') {
        bytes.extend_from_slice(&rest.as_bytes()[..at]);
        let (escape, length) = escape(&rest[at + 1..]);
        bytes.extend_from_slice(&escape);
        rest = &rest[at + 1 + length..];
    }
    bytes.extend_from_slice(rest.as_bytes());
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The bytes that an escape means, and how many it takes behind the backslash.
fn escape(text: &str) -> (Vec<u8>, usize) {
    let Some(letter) = text.chars().next() else {
        return (b"\\".to_vec(), 0);
    };
    let digits = |span: Span| u32::from_str_radix(text.get(span).unwrap_or("-"), 16).ok();
    let plain = match letter {
        'n' => b'\n',
        't' => b'\t',
        'r' => b'\r',
        '0' => 0,
        '"' | '\'' | '\\' => letter as u8,
        '\n' | '\r' => {
            let rest = text.trim_start_matches([' ', '\t', '\n', '\r']);
            return (vec![], text.len() - rest.len());
        }
        'x' => match digits(1..3).and_then(|byte| u8::try_from(byte).ok()) {
            Some(byte) => return (vec![byte], 3),
            None => return (b"\\".to_vec(), 0),
        },
        'u' => {
            let end = text
                .bytes()
                .take(9)
                .position(|byte| byte == b'}')
                .unwrap_or(0);
            let letter = digits(2..end.max(2)).and_then(char::from_u32);
            return match letter {
                Some(letter) => (letter.to_string().into_bytes(), end + 1),
                None => (b"\\".to_vec(), 0),
            };
        }
        _ => return (b"\\".to_vec(), 0),
    };
    (vec![plain], 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> String {
        read(text).unwrap().literal.unwrap().value
    }

    #[test]
    fn escapes_mean_what_ron_means() {
        for text in [
            r#""a\n\t\"\\\'\0b""#,
            r#""\x41\u{e4}\u{1F600}""#,
            r#""\xc3\xa4""#,
            "\"one \\\n    two\"",
            "r\"no \\n escape\"",
            "r##\"with \"# inside\"##",
        ] {
            assert_eq!(
                value(text),
                ron::from_str::<String>(text).unwrap(),
                "{text}"
            );
        }
    }

    #[test]
    fn line_endings_are_unified() {
        assert_eq!(value("\"a\r\nb\rc\\r\""), "a\nb\nc\r");
    }

    #[test]
    fn the_place_of_letters_is_known_only_where_they_stand_as_they_are() {
        assert_eq!(read("\"abc\"").unwrap().literal.unwrap().verbatim, Some(1));
        assert_eq!(
            read("r#\"abc\"#").unwrap().literal.unwrap().verbatim,
            Some(3)
        );
        assert_eq!(read("\"a\\tc\"").unwrap().literal.unwrap().verbatim, None);
    }

    #[test]
    fn a_string_does_not_end_where_another_begins() {
        let is_closed = |text: &str| read(text).unwrap().is_closed;
        assert!(!is_closed("\"look),\n\"wood\": material()"));
        assert!(!is_closed("\"look, height: \"= 2\"),\n"));
        assert!(is_closed("\"two\nlines\", next: \"a\""));
        assert!(is_closed("\"two\nlines\" nodes: {"));
        assert!(is_closed("\"one\"nodes"));
        assert_eq!(likely_length("\"look),\n", 1), 5);
        assert_eq!(likely_length("\"= max(1, 2), a: 3", 1), 12);
        assert_eq!(likely_length("r#\"#c8a06e\"),", 3), 10);
    }

    #[test]
    fn what_is_not_closed_takes_the_rest() {
        for text in ["\"abc", "\"abc\\", "r##\"abc\"#", "b\"", "\"\\\u{e4}"] {
            let found = read(text).unwrap();
            assert!(!found.is_closed, "{text}");
            assert!(found.takes_rest && found.length == text.len());
        }
        assert!(read("'").is_none() && read("'abc").is_none() && read("r#name").is_none());
    }
}
