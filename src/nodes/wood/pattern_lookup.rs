//! `pattern_lookup`: the colour that a colour pattern has at a growth time.
//!
//! Without a spread it is the lookup of Momoi & Takatera 2014: texel floor(frac(T) N), or linear between
//! texel centres. With one it is the exact mean over the growth time within the sample, so rings finer than
//! a pixel melt into their mean colour and the border between late and early wood is as wide as a pixel.

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
    "bar": colour_pattern(stops: [(at: 0, colour: "#e8c79a"), (at: 1, colour: "#9c6b3f")]),
    "example": pattern_lookup(time: 2.25, pattern: "bar"),
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
        Lookup {
            table: Table::new(pattern),
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
            absolute: 0.05,
            relative: 0.1,
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
        let mut spans = Spans::new();
        let mut means = [[0.0; 4]; BLOCK];
        let length = time.values.len();
        for start in (0..length).step_by(BLOCK) {
            let range = start..length.min(start + BLOCK);
            let read = |column: &[f32]| {
                let mut block = [0.0; BLOCK];
                block[..range.len()].copy_from_slice(&column[range.clone()]);
                block
            };
            let (times, spread) = (read(time.values), time.spread.map(read));
            spans.place(&self.table, &times, [&spread[0], &spread[1]]);
            self.table.means(&spans, &mut means);
            for (lane, output) in outputs[..4].iter_mut().enumerate() {
                for (output, mean) in output[range.clone()].iter_mut().zip(&means) {
                    *output = mean[lane];
                }
            }
            outputs[4][range.clone()].copy_from_slice(&spans.inside[..range.len()]);
        }
    }
}
