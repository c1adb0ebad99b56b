//! `patches_from_file`: bicubic Bezier patches, as Newell's teapot is written.
//!
//! The file holds numbers, divided by commas, blanks or ends of lines: the number of patches, for each the numbers of its
//! 16 control points, counted from 1, the number of points, and three coordinates for each. The first four control
//! points of a patch run along u.

use super::scan::{self, Line, UNIT, UP, refuse, shown};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Patch, Patches, Type, Unit, Value};
use glam::DVec3;
use std::sync::Arc;

/// Bezier patches from a file.
pub static KIND: Kind = Kind {
    name: "patches_from_file",
    version: 1,
    about: "Bicubic Bezier patches from a file as Newell's teapot: each becomes a square of a map.",
    source: "Newell 1975 (the teapot and its format, as published by Kouhia 1991)",
    inputs: &[
        Input::new(
            "file",
            Type::File,
            "Patches by the numbers of their control points, and the points.",
        ),
        UNIT,
        UP,
        INSIDE_OUT,
        GUTTER,
    ],
    outputs: &[Output::new("patches", Type::Patches, "The patches.")],
    example: r##"(nodes: {
        "example": patches_from_file(file: "teapot/teapot.txt", unit: inch),
    })"##,
    build,
};

/// Turns surfaces over.
pub(super) const INSIDE_OUT: Input = Input::new(
    "inside_out",
    Type::Toggle,
    "Turns every patch over, by exchanging u and v.",
)
.default("false");

/// Keeps squares apart.
pub(super) const GUTTER: Input = Input::number(
    "gutter",
    Unit::One,
    "Free border at each side of a patch's square on the map, in parts of the square.",
)
.default("0.02")
.range(0.0, 0.4);

/// Numbers looked at between two questions whether to go on.
const AT_ONCE: usize = 4096;

/// Bytes that a patch takes.
const TAKEN: u64 = 1024;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let bytes = &inputs.file("file").bytes;
    // A patch has at least 16 numbers of a digit.
    inputs.take_memory("file", bytes.len() as u64 / 32 * TAKEN)?;
    let mut numbers = Numbers::new(bytes, build);
    let count = numbers.whole("the number of patches")?;
    let mut corners: Vec<([usize; 16], usize)> = vec![];
    for _ in 0..count {
        let mut patch = [0; 16];
        for corner in &mut patch {
            *corner = numbers.whole("the number of a control point")?;
        }
        corners.push((patch, numbers.line));
    }
    let stated = numbers.whole("the number of points")?;
    let mut points: Vec<DVec3> = vec![];
    for _ in 0..stated {
        let mut part = || numbers.next("a coordinate");
        points.push(DVec3::new(part()?, part()?, part()?));
    }
    scan::place(inputs, &mut points)?;
    let patches: Result<Vec<Patch>, Failure> = corners.into_iter().map(|(patch, line)| {
        let mut found = [DVec3::ZERO; 16];
        for (index, corner) in patch.into_iter().enumerate() {
            let place = match inputs.toggle("inside_out") {
                true => index % 4 * 4 + index / 4,
                false => index,
            };
            let point = corner.checked_sub(1).and_then(|index| points.get(index));
            found[place] = *point.ok_or_else(|| {
                refuse(format!("line {line}: there is no point {corner}: they are counted from 1 to {stated}"))
            })?;
        }
        Ok(Patch::bezier(found))
    }).collect();
    let patches = patches?;
    if patches.is_empty() {
        return Err(refuse("the file has no patches"));
    }
    Ok(vec![Value::Patches(Arc::new(Patches {
        patches,
        gutter: inputs.number("gutter"),
    }))])
}

/// The numbers of a file, one after the other.
struct Numbers<'a> {
    lines: Box<dyn Iterator<Item = Line> + 'a>,
    words: Vec<String>,
    /// The line of the last number.
    line: usize,
    taken: usize,
    build: &'a Build<'a>,
}

impl<'a> Numbers<'a> {
    fn new(bytes: &'a [u8], build: &'a Build<'a>) -> Numbers<'a> {
        Numbers {
            lines: Box::new(scan::lines(bytes)),
            words: vec![],
            line: 1,
            taken: 0,
            build,
        }
    }

    /// The next finite number.
    fn next(&mut self, what: &str) -> Result<f64, Failure> {
        self.taken += 1;
        if self.taken.is_multiple_of(AT_ONCE) {
            self.build.go_on()?;
        }
        while self.words.is_empty() {
            let Some(line) = self.lines.next() else {
                return Err(refuse(format!(
                    "line {}: expected {what}, found the end of the file",
                    self.line
                )));
            };
            let words = line
                .text
                .split(|letter: char| letter == ',' || letter.is_whitespace());
            self.words = words
                .rev()
                .filter(|word| !word.is_empty())
                .map(str::to_owned)
                .collect();
            if !self.words.is_empty() {
                self.line = line.number;
            }
        }
        let word = self.words.pop().unwrap_or_default();
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| {
            refuse(format!(
                "line {}: expected {what}, found {}",
                self.line,
                shown(&word)
            ))
        })
    }

    /// The next number, which has to be whole and not negative.
    fn whole(&mut self, what: &str) -> Result<usize, Failure> {
        let number = self.next(what)?;
        match number.fract() == 0.0 && (0.0..1e9).contains(&number) {
            true => Ok(number as usize),
            false => Err(refuse(format!(
                "line {}: expected {what}, found `{number}`",
                self.line
            ))),
        }
    }
}
