//! What readers of shapes have in common: lines and words with their places for messages, units and axes.

use crate::node::{Failure, Input, Inputs};
use crate::value::Type;
use glam::DVec3;

/// What is wrong with the file.
pub(super) fn refuse(message: impl Into<String>) -> Failure {
    Failure::of_input("file", message)
}

/// How many mm a length in the file is.
pub(super) fn millimetres(inputs: &Inputs<'_>) -> f64 {
    match inputs.choice("unit") {
        "cm" => 10.0,
        "m" => 1000.0,
        "inch" => 25.4,
        _ => 1.0,
    }
}

/// Turns points of the file, so that z points up.
pub(super) fn turn_upright(inputs: &Inputs<'_>, points: &mut [DVec3]) {
    if inputs.choice("up") == "y" {
        let upright = |it: &mut DVec3| *it = DVec3::new(it.x, -it.z, it.y);
        points.iter_mut().for_each(upright);
    }
}

/// Turns points of the file into mm with z up.
///
/// # Errors
/// Points that are too far off.
pub(super) fn place(inputs: &Inputs<'_>, points: &mut [DVec3]) -> Result<(), Failure> {
    turn_upright(inputs, points);
    let unit = millimetres(inputs);
    points.iter_mut().for_each(|point| *point *= unit);
    let too_far = |point: &&DVec3| point.abs().max_element() > LARGEST;
    match points.iter().find(too_far) {
        None => Ok(()),
        Some(point) => {
            let message = format!("a point is at {point} mm; the farthest is {LARGEST} mm off");
            Err(refuse(message).with_hint("check `unit`"))
        }
    }
}

/// Largest coordinate in mm.
const LARGEST: f64 = 1e9;

/// The unit of the lengths in a file.
pub(super) const UNIT: Input = Input::new(
    "unit",
    Type::Choice(&["mm", "cm", "m", "inch"]),
    "Unit of the lengths in the file.",
)
.default("mm");

/// Which way is up in a file.
pub(super) const UP: Input = Input::new(
    "up",
    Type::Choice(&["z", "y"]),
    "Which axis of the file points up; here it is z.",
)
.default("z");

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

    /// A finite number.
    pub(super) fn number(&self, word: &str) -> Result<f64, Failure> {
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
