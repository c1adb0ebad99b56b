//! Lines on white paper as a colour at every point, each as wide as it is on a picture of any resolution.
//!
//! The share of a pixel that a line covers is that of an interval as long as the pixel's side across the line: exact
//! along a straight line, as good as that at its ends and bends. Where lines of one ink meet, the largest share counts.
//! Pixels that are larger than what is drawn are divided.

use crate::field::{Block, InputColumn, Kernel};
use crate::key::KeyHasher;
use std::ops::RangeInclusive;

/// What lines are drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    Faint,
    Curve,
    Black,
}

/// The inks' linear colours, in the order in which they cover each other.
const COLOURS: [[f64; 3]; 3] = [[0.75, 0.75, 0.75], [0.22, 0.07, 0.02], [0.01, 0.01, 0.01]];

/// A line with round ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    ink: Ink,
    /// Its ends in mm.
    ends: [[f64; 2]; 2],
    /// Half of its width in mm.
    half_width: f64,
}

impl Line {
    pub(super) fn new(ink: Ink, ends: [[f64; 2]; 2], half_width: f64) -> Line {
        Line {
            ink,
            ends,
            half_width,
        }
    }
}

/// Cells of the table that finds the lines near a point, along each side.
const CELLS: [usize; 2] = [128, 64];

/// A drawing on a piece.
#[derive(Debug)]
pub(super) struct Drawing {
    lines: Vec<Line>,
    size: [f64; 2],
    /// The lines that touch each cell, row by row.
    cells: Vec<Vec<u32>>,
}

impl Drawing {
    /// Lays lines out over a piece of this size in mm.
    pub(super) fn new(lines: Vec<Line>, size: [f64; 2]) -> Drawing {
        let mut drawing = Drawing {
            lines: vec![],
            size,
            cells: vec![vec![]; CELLS[0] * CELLS[1]],
        };
        for (index, line) in lines.iter().enumerate() {
            let [a, b] = line.ends;
            let ends = [0, 1].map(|axis| {
                let [low, high] = [a[axis].min(b[axis]), a[axis].max(b[axis])];
                drawing.cells_of(axis, low - line.half_width, high + line.half_width)
            });
            for row in ends[1].clone() {
                for column in ends[0].clone() {
                    drawing.cells[row * CELLS[0] + column].push(index as u32);
                }
            }
        }
        Drawing { lines, ..drawing }
    }

    /// The cells that an interval of an axis touches; beyond the piece those at its border.
    fn cells_of(&self, axis: usize, low: f64, high: f64) -> RangeInclusive<usize> {
        let scale = CELLS[axis] as f64 / self.size[axis];
        let cell = |place: f64| (place * scale).clamp(0.0, CELLS[axis] as f64 - 1.0) as usize;
        cell(low)..=cell(high)
    }

    /// How much of a pixel with sides of `side` mm around a point each ink covers.
    fn covered(&self, point: [f64; 2], side: f64) -> [f64; 3] {
        let mut covered = [0.0_f64; 3];
        let [columns, rows] = [0, 1]
            .map(|axis| self.cells_of(axis, point[axis] - side / 2.0, point[axis] + side / 2.0));
        for row in rows {
            for column in columns.clone() {
                for index in &self.cells[row * CELLS[0] + column] {
                    let line = &self.lines[*index as usize];
                    let ink = &mut covered[line.ink as usize];
                    *ink = ink.max(line.share(point, side));
                }
            }
        }
        covered
    }
}

/// Longest side in mm of a pixel that is looked at as one: larger ones hold bends and ends of many lines.
const LONGEST: f64 = 0.4;

/// Most parts of a pixel along each side.
const MOST_PARTS: f64 = 16.0;

/// Points that are sampled alone have no size; the least one keeps quotients finite.
const LEAST: f64 = 1e-6;

/// A pixel: its middle and its sides, in mm.
struct Pixel {
    middle: [f64; 2],
    sides: [[f64; 2]; 2],
}

impl Pixel {
    fn new(columns: [&InputColumn<'_>; 2], index: usize) -> Pixel {
        let side = |side: usize| columns.map(|column| f64::from(column.spread[side][index]));
        Pixel {
            middle: columns.map(|column| f64::from(column.values[index])),
            sides: [side(0), side(1)],
        }
    }

    /// The mean length of its sides.
    fn length(&self) -> f64 {
        let length = |[across, up]: [f64; 2]| (across * across + up * up).sqrt();
        ((length(self.sides[0]) + length(self.sides[1])) / 2.0).max(LEAST)
    }

    /// The middles of its parts, as many along each side.
    fn parts(&self, count: usize) -> impl Iterator<Item = [f64; 2]> {
        let place = move |part: usize| (part as f64 + 0.5) / count as f64 - 0.5;
        let places = (0..count * count).map(move |part| [place(part % count), place(part / count)]);
        places.map(|[a, b]| {
            [0, 1].map(|axis| self.middle[axis] + a * self.sides[0][axis] + b * self.sides[1][axis])
        })
    }
}

impl Drawing {
    /// The mean colour of a pixel.
    fn colour(&self, pixel: &Pixel) -> [f64; 3] {
        let length = pixel.length();
        let count = (length / LONGEST).ceil().clamp(1.0, MOST_PARTS) as usize;
        let mut sum = [0.0; 3];
        for point in pixel.parts(count) {
            let covered = self.covered(point, length / count as f64);
            for (part, sum) in sum.iter_mut().enumerate() {
                let over = |below: f64, (ink, share): (&[f64; 3], &f64)| {
                    below + (ink[part] - below) * share
                };
                *sum += COLOURS.iter().zip(&covered).fold(1.0, over);
            }
        }
        sum.map(|sum| sum / (count * count) as f64)
    }
}

impl Line {
    /// The share of an interval of `side` mm, around the point and across the line, that is in the line.
    fn share(&self, point: [f64; 2], side: f64) -> f64 {
        let [a, b] = self.ends;
        let (along, to) = (
            [b[0] - a[0], b[1] - a[1]],
            [point[0] - a[0], point[1] - a[1]],
        );
        let length2 = along[0] * along[0] + along[1] * along[1];
        let foot = if length2 > 0.0 {
            ((to[0] * along[0] + to[1] * along[1]) / length2).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let apart = [to[0] - foot * along[0], to[1] - foot * along[1]];
        let distance = (apart[0] * apart[0] + apart[1] * apart[1]).sqrt();
        let inside = (distance + side / 2.0).min(self.half_width)
            - (distance - side / 2.0).max(-self.half_width);
        (inside / side).clamp(0.0, 1.0)
    }
}

impl Kernel for Drawing {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("drawing")
            .whole(i64::from(super::KIND.version))
            .whole(self.lines.len() as i64);
        for line in &self.lines {
            let numbers = [line.ends[0], line.ends[1], [line.half_width, 0.0]];
            key.whole(line.ink as i64);
            numbers.iter().flatten().for_each(|number| {
                key.number(*number);
            });
        }
        self.size.iter().for_each(|length| {
            key.number(*length);
        });
    }

    fn width(&self) -> usize {
        3
    }

    fn reads_spread(&self, column: usize) -> bool {
        column < 2
    }

    fn nanoseconds(&self) -> f32 {
        50.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for index in 0..block.inputs[0].values.len() {
            let pixel = Pixel::new([&block.inputs[0], &block.inputs[1]], index);
            let colour = self.colour(&pixel);
            for (output, part) in block.outputs.iter_mut().zip(colour) {
                output[index] = part as f32;
            }
        }
    }
}
