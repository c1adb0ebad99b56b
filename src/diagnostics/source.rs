//! Recipe texts, and how bytes become lines and columns.

use std::ops::Range;
use std::path::PathBuf;

/// The text of a recipe with the path it came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// The path as the caller gave it.
    pub path: PathBuf,
    /// The whole text, with its byte order mark if it has one.
    pub text: String,
    /// Where each line begins.
    line_starts: Vec<usize>,
}

/// A place as editors count it; both begin at 1, and columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// The line; LF, CR and CRLF each end one.
    pub line: usize,
    /// The character in the line.
    pub column: usize,
}

impl SourceFile {
    /// Finds the lines of `text`.
    pub fn new(path: impl Into<PathBuf>, text: impl Into<String>) -> SourceFile {
        let text = text.into();
        let bytes = text.as_bytes();
        let ends_line = |at: &usize| match bytes[*at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        let after = (0..bytes.len()).filter(ends_line).map(|at| at + 1);
        let line_starts = std::iter::once(0).chain(after).collect();
        SourceFile {
            path: path.into(),
            text,
            line_starts,
        }
    }

    /// The line and column of a byte; a byte behind the end counts as the end.
    pub fn position(&self, byte: usize) -> Position {
        let is_boundary = |byte: &usize| self.text.is_char_boundary(*byte);
        let byte = (0..=byte.min(self.text.len()))
            .rev()
            .find(is_boundary)
            .unwrap_or(0);
        let line = self.line_of(byte);
        let before = &self.text[self.line_starts[line - 1]..byte];
        let column = 1 + before.trim_start_matches('\u{feff}').chars().count();
        Position { line, column }
    }

    /// The line of a byte, counted from 1.
    pub(crate) fn line_of(&self, byte: usize) -> usize {
        self.line_starts.partition_point(|start| *start <= byte)
    }

    /// The bytes of a line, counted from 1, without what ends it.
    pub(super) fn line(&self, line: usize) -> Range<usize> {
        let start = self.line_starts[line - 1];
        let end = self
            .line_starts
            .get(line)
            .copied()
            .unwrap_or(self.text.len());
        start..start + self.text[start..end].trim_end_matches(['\n', '\r']).len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_ending_counts_once() {
        let source = SourceFile::new("a.ron", "a\nb\r\nc\rd");
        let lines: Vec<_> = ["a", "b", "c", "d"]
            .map(|letter| source.text.find(letter).unwrap())
            .into();
        let numbers: Vec<_> = lines
            .iter()
            .map(|byte| source.position(*byte).line)
            .collect();
        assert_eq!(numbers, [1, 2, 3, 4]);
        assert_eq!(&source.text[source.line(2)], "b");
        assert_eq!(source.position(99), Position { line: 4, column: 2 });
    }

    #[test]
    fn columns_count_characters_and_skip_the_byte_order_mark() {
        let source = SourceFile::new("a.ron", "\u{feff}äöx");
        assert_eq!(source.position(source.text.find('x').unwrap()).column, 3);
        assert_eq!(source.position(3).column, 1);
        assert_eq!(
            source.position(4).column,
            1,
            "inside a character is at the character"
        );
    }
}
