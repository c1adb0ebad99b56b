//! Putting items into brackets and taking them out, in the layout that is there.

use super::Change;
use crate::diagnostics::Span;

/// Brackets and the items between them.
#[derive(Clone, Debug)]
pub(super) struct Container {
    /// From the opening to behind the closing bracket.
    pub(super) span: Span,
    /// Each item from its key or name to the end of its value, without commas.
    pub(super) items: Vec<Span>,
}

/// What stands between an item and the next token that is neither comma nor comment.
struct Gap {
    /// The comma.
    comma: Option<usize>,
    /// Where the line of the item ends: before the line ending, or where the next token stands.
    line_end: usize,
    /// Whether the line ends within the gap.
    ends_line: bool,
}

impl Container {
    /// Adds an item behind the others.
    pub(super) fn append(&self, text: &str, item: &str) -> Vec<Change> {
        let close = self.span.end - 1;
        let Some(last) = self.items.last() else {
            return vec![self.first(text, item)];
        };
        let gap = Gap::after(text, last.end, close);
        let Some(line) = own_line(text, last.start).filter(|_| gap.ends_line) else {
            return vec![match gap.comma {
                Some(comma) => Change::insert(comma + 1, format!(" {item},")),
                None => Change::insert(last.end, format!(", {item}")),
            }];
        };
        let (comma, end) = match gap.comma {
            Some(_) => (None, ","),
            None => (Some(Change::insert(last.end, ",")), ""),
        };
        let new_line = Change::insert(gap.line_end, format!("{line}{item}{end}"));
        comma.into_iter().chain([new_line]).collect()
    }

    /// The first item: on a line of its own if the brackets are on different lines.
    fn first(&self, text: &str, item: &str) -> Change {
        let close = self.span.end - 1;
        match own_line(text, close) {
            Some(line) if text[self.span.clone()].contains(['\n', '\r']) => {
                let ending = line.trim_end_matches([' ', '\t']);
                let at = close - (line.len() - ending.len());
                let indent = &line[ending.len()..];
                Change::insert(at, format!("{indent}    {item},{ending}"))
            }
            _ => Change::insert(close, item),
        }
    }

    /// Takes an item away, with its comma and with its line if nothing else stands on it.
    pub(super) fn remove(&self, text: &str, index: usize) -> Vec<Change> {
        let item = self.items[index].clone();
        let close = self.span.end - 1;
        let next = self.items.get(index + 1).map_or(close, |next| next.start);
        let gap = Gap::after(text, item.end, next);
        let before = index.checked_sub(1).map(|before| self.items[before].end);
        // `(a: 1, b: 2)` becomes `(a: 1)`.
        if let (Some(before), None) = (before, gap.comma)
            && is_comma_and_spaces(&text[before..item.start])
        {
            return vec![Change::new(before..item.end, "")];
        }
        let mut cut = item;
        let mut comma = None;
        match gap.comma {
            Some(at) if is_blank(&text[cut.end..at]) => cut.end = at + 1,
            Some(at) => comma = Some(Change::new(at..at + 1, "")),
            None => {}
        }
        let spaces = |text: &str| text.len() - text.trim_start_matches([' ', '\t']).len();
        let after = cut.end + spaces(&text[cut.end..close]);
        let ends_line = text[after..].starts_with(['\n', '\r']);
        let line = own_line(text, cut.start);
        match line {
            Some(line) if ends_line => cut = cut.start - line.len()..after,
            None if ends_line => cut = text[..cut.start].trim_end_matches([' ', '\t']).len()..after,
            _ if after < close => cut.end = after,
            _ => {}
        }
        let cut = Change::new(cut, "");
        [cut].into_iter().chain(comma).collect()
    }
}

impl Gap {
    /// The gap from `start` on, at most to `end`.
    fn after(text: &str, start: usize, end: usize) -> Gap {
        let mut gap = Gap {
            comma: None,
            line_end: end,
            ends_line: false,
        };
        let mut at = start;
        while let Some(letter) = text[at..end].chars().next() {
            let rest = &text[at..end];
            match letter {
                '\n' | '\r' if !gap.ends_line => {
                    gap.line_end = at;
                    gap.ends_line = true;
                }
                ',' => gap.comma = gap.comma.or(Some(at)),
                _ => {}
            }
            at += match rest.as_bytes() {
                [b'/', b'/', ..] => rest.find(['\n', '\r']).unwrap_or(rest.len()),
                [b'/', b'*', ..] => comment_length(rest),
                _ => letter.len_utf8(),
            };
        }
        gap
    }
}

/// Bytes of the block comment that `text` begins with; comments hold comments.
fn comment_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0_usize, 0);
    while at < bytes.len() {
        match bytes.get(at..at + 2) {
            Some(b"/*") => (depth, at) = (depth + 1, at + 2),
            Some(b"*/") => (depth, at) = (depth.saturating_sub(1), at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    bytes.len()
}

/// The line ending and the spaces before `at`, if nothing else stands before it on its line.
fn own_line(text: &str, at: usize) -> Option<&str> {
    let before = &text[..at];
    let line = before.trim_end_matches([' ', '\t']);
    let ending = match line.as_bytes() {
        [.., b'\r', b'\n'] => 2,
        [.., b'\n' | b'\r'] => 1,
        _ => return None,
    };
    Some(&before[line.len() - ending..])
}

fn is_blank(text: &str) -> bool {
    text.bytes().all(|byte| matches!(byte, b' ' | b'\t'))
}

fn is_comma_and_spaces(text: &str) -> bool {
    let spaces = [' ', '\t'];
    text.trim_matches(spaces) == ","
}
