//! Lines and words of text formats, with their places for messages.

use super::refuse;
use crate::node::Failure;

/// One line of a file, without its remark; continued lines are one.
pub(super) struct Line {
    /// Its number in the file, from 1; that of its first part.
    pub(super) number: usize,
    /// What it says.
    pub(super) text: String,
}

impl Line {
    /// Something is wrong with the line.
    pub(super) fn refuse(&self, message: impl std::fmt::Display) -> Failure {
        refuse(format!("line {}: {message}", self.number))
    }

    /// The first word, and what is behind it.
    pub(super) fn keyword(&self) -> (&str, &str) {
        let text = self.text.trim();
        let end = text.find(char::is_whitespace).unwrap_or(text.len());
        (&text[..end], text[end..].trim())
    }

    /// At least `count` finite numbers, of which the first are taken.
    pub(super) fn numbers<const COUNT: usize>(&self, words: &str) -> Result<[f64; COUNT], Failure> {
        let mut numbers = [0.0; COUNT];
        let mut found = words.split_whitespace();
        for (index, number) in numbers.iter_mut().enumerate() {
            let Some(word) = found.next() else {
                let message = format!("expected {COUNT} numbers, found {index}");
                return Err(self.refuse(message));
            };
            *number = self.number(word)?;
        }
        Ok(numbers)
    }

    fn number(&self, word: &str) -> Result<f64, Failure> {
        let number = word.parse::<f64>().ok().filter(|it| it.is_finite());
        number
            .ok_or_else(|| self.refuse(format!("expected a finite number, found {}", shown(word))))
    }
}

/// A word in a message, cut off where it is long.
pub(super) fn shown(word: &str) -> String {
    format!("`{}`", word.chars().take(40).collect::<String>())
}

/// The lines of a text in which `\` at the end of a line continues it and `#` begins a remark. Names may be in any
/// encoding: what is not UTF-8 is replaced.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = Line> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut rest = bytes.split(|byte| *byte == b'\n').zip(1..);
    std::iter::from_fn(move || {
        let (first, number) = rest.next()?;
        let mut text = plain(first);
        while text.ends_with('\\') {
            text.pop();
            text.push(' ');
            match rest.next() {
                Some((next, _)) => text.push_str(&plain(next)),
                None => break,
            }
        }
        Some(Line { number, text })
    })
}

fn plain(line: &[u8]) -> String {
    let text = String::from_utf8_lossy(line);
    let end = text.find('#').unwrap_or(text.len());
    text[..end].trim_end().to_owned()
}
