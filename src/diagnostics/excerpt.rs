//! Excerpts of a recipe: a few lines that are safe to print, whatever the file holds.

use super::{Label, SourceFile, Span};
use std::borrow::Cow;

/// Characters of a line that are shown at most; longer lines are cut around what matters.
const WIDTH: usize = 120;
/// Characters shown before the place that matters when a line is cut.
const BEFORE: usize = 40;
/// Lines without a label that are shown between two with one.
const GAP: usize = 2;

/// Consecutive lines, ready to print, with the places of labels in them.
#[derive(Debug, Default)]
pub(super) struct Excerpt {
    /// The lines, joined by line feeds.
    pub(super) text: String,
    /// The number of the first line.
    pub(super) first_line: usize,
    /// For each label its bytes in `text`.
    pub(super) spans: Vec<Span>,
}

/// The lines of `source` that the labels point at, and few between them.
///
/// A label that spans several lines is cut to its first.
pub(super) fn excerpts<'l>(
    source: &SourceFile,
    labels: &[&'l Label],
) -> Vec<(Excerpt, Vec<&'l Label>)> {
    let line_of = |label: &&Label| source.position(label.span.start).line;
    let mut sorted = labels.to_vec();
    sorted.sort_by_key(|label| label.span.start);
    let mut excerpts: Vec<(Excerpt, Vec<&Label>)> = vec![];
    let mut last_line = 0;
    for same_line in sorted.chunk_by(|a, b| line_of(a) == line_of(b)) {
        let line = line_of(&same_line[0]);
        if last_line == 0 || line > last_line + GAP + 1 {
            excerpts.push((
                Excerpt {
                    first_line: line,
                    ..Excerpt::default()
                },
                vec![],
            ));
            last_line = line;
        }
        if let Some((excerpt, shown)) = excerpts.last_mut() {
            for between in last_line + 1..line {
                excerpt.push_line(source, between, &[]);
            }
            excerpt.push_line(source, line, same_line);
            shown.extend(same_line);
        }
        last_line = line;
    }
    excerpts
}

impl Excerpt {
    /// The column, from 1, of a label in the excerpt.
    pub(super) fn column(&self, label: usize) -> usize {
        let before = &self.text[..self.spans[label].start];
        1 + before
            .chars()
            .rev()
            .take_while(|letter| *letter != '\n')
            .count()
    }

    fn push_line(&mut self, source: &SourceFile, line: usize, labels: &[&Label]) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        let range = source.line(line);
        let text = &source.text[range.clone()];
        let within = |byte: usize| byte.clamp(range.start, range.end) - range.start;
        let focus = labels.first().map_or(0, |label| within(label.span.start));
        let mut starts = vec![self.text.len(); labels.len()];
        let mut ends = vec![None; labels.len()];
        let (shown, cut_before, cut_after) = window(text, focus);
        if cut_before {
            self.text.push('…');
        }
        for (at, letter) in text[shown.clone()].char_indices() {
            let at = shown.start + at;
            for (index, label) in labels.iter().enumerate() {
                if at <= within(label.span.start) {
                    starts[index] = self.text.len();
                }
                if at >= within(label.span.end) && ends[index].is_none() {
                    ends[index] = Some(self.text.len());
                }
            }
            if at > 0 || letter != '\u{feff}' {
                push_safe(&mut self.text, letter);
            }
        }
        let end = self.text.len();
        for (index, label) in labels.iter().enumerate() {
            if within(label.span.start) >= shown.end {
                starts[index] = end;
            }
            self.spans
                .push(starts[index]..ends[index].unwrap_or(end).max(starts[index]));
        }
        if cut_after {
            self.text.push('…');
        }
    }
}

/// The bytes of a line to show around byte `focus`, and whether something before and after is cut.
fn window(line: &str, focus: usize) -> (Span, bool, bool) {
    let after = line[focus..].chars().take(WIDTH).count();
    let before = BEFORE.max(WIDTH - after);
    let start = match line[..focus].char_indices().rev().nth(before - 1) {
        Some((at, _)) if line.chars().nth(WIDTH).is_some() => at,
        _ => 0,
    };
    let end = line[start..]
        .char_indices()
        .nth(WIDTH)
        .map_or(line.len(), |(at, _)| start + at);
    (start..end, start > 0, end < line.len())
}

/// Text in which nothing moves the cursor, changes colours or reorders letters.
pub(super) fn safe(text: &str) -> Cow<'_, str> {
    if text.chars().all(|letter| !is_unsafe(letter)) {
        return Cow::Borrowed(text);
    }
    let mut result = String::new();
    text.chars()
        .for_each(|letter| push_safe(&mut result, letter));
    Cow::Owned(result)
}

fn push_safe(text: &mut String, letter: char) {
    match letter {
        '\t' => text.push(' '),
        letter if is_unsafe(letter) => text.extend(letter.escape_unicode()),
        letter => text.push(letter),
    }
}

/// Control characters, and those that show nothing or change how others are shown.
pub(crate) fn is_unsafe(letter: char) -> bool {
    letter.is_control()
        || matches!(letter,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e0fff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn excerpt_of(text: &str, span: Span) -> Excerpt {
        let label = Label {
            span,
            text: String::new(),
        };
        excerpts(&SourceFile::new("a.ron", text), &[&label])
            .remove(0)
            .0
    }

    #[test]
    fn a_long_line_is_cut_around_the_label() {
        let text = format!("first\n{}here{}", "a".repeat(1000), "b".repeat(1000));
        let excerpt = excerpt_of(&text, 1006..1010);
        assert_eq!(excerpt.first_line, 2);
        assert_eq!(excerpt.text.chars().count(), WIDTH + 2);
        assert_eq!(&excerpt.text[excerpt.spans[0].clone()], "here");
    }

    #[test]
    fn escapes_and_invisible_letters_are_spelt_out() {
        let excerpt = excerpt_of("a\u{1b}[31mb\u{202e}c", 6..7);
        assert_eq!(excerpt.text, "a\\u{1b}[31mb\\u{202e}c");
        assert_eq!(&excerpt.text[excerpt.spans[0].clone()], "b");
        assert_eq!(safe("a\nb"), "a\\u{a}b");
    }

    #[test]
    fn distant_lines_are_apart_and_near_ones_together() {
        let source = SourceFile::new("a.ron", "0\n1\n2\n3\n4\n5\n6\n7\n8\n9\n");
        let labels = [0, 4, 16].map(|at| Label {
            span: at..at + 1,
            text: String::new(),
        });
        let labels: Vec<_> = labels.iter().collect();
        let texts: Vec<_> = excerpts(&source, &labels)
            .into_iter()
            .map(|(e, _)| e.text)
            .collect();
        assert_eq!(texts, ["0\n1\n2", "8"]);
    }
}
