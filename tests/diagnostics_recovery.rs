//! One slip of the finger gives one message, where it happened.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fs;
use yosegi::diagnostics::{SourceFile, render_all};
use yosegi::graph::{Settings, load_text};

/// What one letter left out has led to, over all places where it stands.
#[derive(Debug, Default)]
struct Tally {
    places: usize,
    one_message: usize,
    most_messages: usize,
    first_on_line: usize,
}

/// Leaves out each `letter` of `text` in turn.
fn tally(text: &str, letter: char, tally: &mut Tally) {
    for (at, _) in text.match_indices(letter) {
        let broken = format!("{}{}", &text[..at], &text[at + 1..]);
        let Err(diagnostics) = load_text("a.ron", &*broken, &Settings::default()) else {
            continue;
        };
        let line = SourceFile::new("a.ron", text).position(at).line;
        let lines = diagnostics.iter().filter_map(|one| {
            let start = one.label.as_ref()?.span.start;
            Some(one.source.as_ref()?.position(start).line)
        });
        tally.places += 1;
        tally.one_message += usize::from(diagnostics.len() == 1);
        tally.most_messages = tally.most_messages.max(diagnostics.len());
        tally.first_on_line += usize::from(lines.min() == Some(line));
    }
}

/// For each letter: the share in percent of places with one message, the most messages at any place, and
/// the share of places where the first message is on the line of the slip.
const BOUNDS: [(char, usize, usize, usize); 9] = [
    ('"', 100, 1, 100),
    ('(', 75, 6, 70),
    (')', 85, 2, 75),
    ('[', 75, 4, 75),
    (']', 85, 2, 75),
    ('{', 100, 1, 20),
    ('}', 20, 2, 20),
    (':', 100, 1, 100),
    (',', 100, 1, 100),
];

#[test]
fn a_letter_left_out_is_found_where_it_was() {
    let recipes = ["graphs/spruce_log_board.ron", "tests/data/slips.ron"];
    for (letter, one, most, on_line) in BOUNDS {
        let mut sum = Tally::default();
        for recipe in recipes {
            tally(&fs::read_to_string(recipe).unwrap(), letter, &mut sum);
        }
        let share = |count: usize| 100 * count / sum.places.max(1);
        assert!(sum.places >= 8, "`{letter}`: {sum:?}");
        assert!(share(sum.one_message) >= one, "`{letter}`: {sum:?}");
        assert!(sum.most_messages <= most, "`{letter}`: {sum:?}");
        assert!(share(sum.first_on_line) >= on_line, "`{letter}`: {sum:?}");
    }
}

/// Every letter doubled: a string, a bracket or a comma too many.
#[test]
fn a_letter_too_many_gives_few_messages() {
    let text = fs::read_to_string("graphs/bent_trunk.ron").unwrap();
    for letter in "\"()[]{}:,".chars() {
        for (at, _) in text.match_indices(letter) {
            let broken = format!("{}{letter}{}", &text[..at], &text[at..]);
            if let Err(diagnostics) = load_text("a.ron", &*broken, &Settings::default()) {
                let text = render_all(&diagnostics);
                assert!(diagnostics.len() <= 6, "{letter} at byte {at}\n{text}");
            }
        }
    }
}
