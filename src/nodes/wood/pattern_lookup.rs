//! `pattern_lookup`: the colour that a colour pattern has at a growth time.
//!
//! Without a spread it is the lookup of Momoi & Takatera 2014: texel floor(frac(T) N), or linear between
//! texel centres. With one it is the exact mean over the growth time within the sample, so rings finer than
//! a pixel melt into their mean colour and the border between late and early wood is as wide as a pixel.
//! Behind the end of a pattern the last colour goes on: `inside` tells how much of a sample is wood.

mod span;
mod table;

use crate::field::{Block, InputColumn, Kernel, Sampling};
use crate::key::{Key, KeyHasher};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{AfterEnd, ColourPattern, Type, Unit, Value};
use fearless_simd::dispatch;
use span::{BLOCK, Spans};
use table::Table;

/// Looks up a colour pattern by growth time.
pub static KIND: Kind = Kind {
    name: "pattern_lookup",
    version: 1,
    about: "Gives the colour that a pattern has at a growth time, averaged exactly over each pixel. \
            Before time 0 a repeating pattern goes on backwards, and one that ends has its first colour.",
    source: "Momoi & Takatera 2014, section on colour; exact box filter by sums of the table: own construction \
             after Crow 1984",
    inputs: &[
        Input::number("time", Unit::Year, "When growth reached the point.").per_point(),
        Input::new(
            "pattern",
            Type::ColourPattern,
            "Colour from early to late wood.",
        ),
    ],
    outputs: &[
        Output::field("colour", Type::Colour, "Colour of the wood."),
        Output::field(
            "position",
            Type::Number(Unit::One),
            "Position in the ring: 0 where earlywood starts, towards 1 at the end of latewood.",
        ),
        Output::field(
            "inside",
            Type::Number(Unit::One),
            "1 before the pattern's end, 0 after it; always 1 where the pattern repeats.",
        ),
    ],
    example: r##"(nodes: {
    "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 2400)]),
    "time": growth_field(skeleton: "tree", elongation: 420, thickening: 2.4),
    "bar": colour_pattern(stops: [(at: 0, colour: "#e8c79a"), (at: 1, colour: "#9c6b3f")]),
    "example": pattern_lookup(time: "time.time", pattern: "bar"),
})"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let kernel = Lookup::new(inputs.colour_pattern("pattern"));
    let columns = build.kernel(kernel, vec![inputs.field("time")]);
    let part = |first, width| Value::Field(columns.part(first, width));
    Ok(vec![part(0, 3), part(3, 1), part(4, 1)])
}

/// Columns: the colour's three, position, inside.
#[derive(Debug)]
struct Lookup {
    table: Table,
    /// Colour and position behind the end.
    last: [f32; 4],
    key: Key,
}

impl Lookup {
    fn new(pattern: &ColourPattern) -> Lookup {
        let mut key = KeyHasher::new("pattern_lookup", KIND.version);
        key.whole(pattern.colours.len() as i64);
        pattern.colours.iter().flatten().for_each(|part| {
            key.number(f64::from(*part));
        });
        key.number(pattern.years)
            .whole(pattern.ring_starts.len() as i64);
        pattern.ring_starts.iter().for_each(|start| {
            key.number(*start);
        });
        key.whole(i64::from(pattern.after_end == AfterEnd::End))
            .whole(i64::from(pattern.smooth));
        let [r, g, b] = pattern.colours.last().copied().unwrap_or_default();
        Lookup {
            table: Table::new(pattern),
            last: [r, g, b, 1.0],
            key: key.finish(),
        }
    }
}

impl Kernel for Lookup {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("pattern_lookup").key(self.key);
    }

    fn width(&self) -> usize {
        5
    }

    fn reads_spread(&self, column: usize) -> bool {
        column == 0
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereStraight {
            column: 0,
            absolute: 0.02,
            relative: 0.02,
        }
    }

    fn nanoseconds(&self) -> f32 {
        7.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let time = block.inputs[0];
        let outputs = &mut *block.outputs;
        dispatch!(block.level, _ => self.look_up(time, outputs));
    }
}

impl Lookup {
    #[inline(always)]
    fn look_up(&self, time: InputColumn<'_>, outputs: &mut [Vec<f32>]) {
        let mut mean = Mean::new();
        let mut other = Mean::new();
        let length = time.values.len();
        for start in (0..length).step_by(BLOCK) {
            let range = start..length.min(start + BLOCK);
            let read = |column: &[f32]| {
                let mut block = [0.0; BLOCK];
                block[..range.len()].copy_from_slice(&column[range.clone()]);
                block
            };
            let boxes = Boxes::new(&read(time.values), time.spread.map(read));
            mean.over(self, &boxes.first, &boxes.width);
            if boxes.are_two {
                other.over(self, &boxes.second, &boxes.width);
                mean.average_with(&other);
            }
            for (output, mean) in outputs.iter_mut().zip(&mean.columns) {
                output[range.clone()].copy_from_slice(&mean[..range.len()]);
            }
        }
    }
}

/// The spans of time whose mean stands for the mean over a square sample.
///
/// The times in a square are those of a box as wide as the larger spread, blurred by a box as wide as the
/// smaller one. Where the smaller one counts, it is integrated at its two Gauss points (exact up to cubics);
/// elsewhere one box of the same variance does.
struct Boxes {
    first: [f64; BLOCK],
    second: [f64; BLOCK],
    width: [f32; BLOCK],
    /// Whether first and second differ anywhere in the block.
    are_two: bool,
}

/// Smaller spread, as a share of the larger one, from which on two boxes are used.
const SKEWED: f32 = 0.2;

/// Distance of the Gauss points from the middle of a box of width 1.
const GAUSS: f64 = 0.288_675_134_594_812_9;

impl Boxes {
    #[inline(always)]
    fn new(times: &[f32; BLOCK], [across, along]: [[f32; BLOCK]; 2]) -> Boxes {
        let times = times.map(f64::from);
        let mut boxes = Boxes {
            first: times,
            second: times,
            width: [0.0; BLOCK],
            are_two: false,
        };
        for index in 0..BLOCK {
            let (across, along) = (across[index].abs(), along[index].abs());
            let (large, small) = if across > along {
                (across, along)
            } else {
                (along, across)
            };
            let is_skewed = small > SKEWED * large;
            let apart = if is_skewed {
                GAUSS * f64::from(small)
            } else {
                0.0
            };
            boxes.width[index] = if is_skewed {
                large
            } else {
                (across * across + along * along).sqrt()
            };
            boxes.first[index] -= apart;
            boxes.second[index] += apart;
            boxes.are_two |= is_skewed;
        }
        boxes
    }
}

/// Means of colour, position and inside over a block of spans.
struct Mean {
    spans: Spans,
    means: [[f32; 4]; BLOCK],
    columns: [[f32; BLOCK]; 5],
}

impl Mean {
    fn new() -> Mean {
        Mean {
            spans: Spans::new(),
            means: [[0.0; 4]; BLOCK],
            columns: [[0.0; BLOCK]; 5],
        }
    }

    #[inline(always)]
    fn over(&mut self, lookup: &Lookup, times: &[f64; BLOCK], widths: &[f32; BLOCK]) {
        self.spans.place(&lookup.table, times, widths);
        lookup.table.means(&self.spans, &mut self.means);
        for (lane, last) in lookup.last.iter().enumerate() {
            for index in 0..BLOCK {
                // What lies behind the end has the last colour.
                let inside = self.spans.inside[index];
                self.columns[lane][index] =
                    inside * self.means[index][lane] + (1.0 - inside) * last;
            }
        }
        self.columns[4] = self.spans.inside;
    }

    #[inline(always)]
    fn average_with(&mut self, other: &Mean) {
        for (column, other) in self.columns.iter_mut().zip(&other.columns) {
            for (value, other) in column.iter_mut().zip(other) {
                *value = 0.5 * (*value + *other);
            }
        }
    }
}
