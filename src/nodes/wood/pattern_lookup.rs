//! `pattern_lookup`: the colour that a colour pattern has at a growth time.
//!
//! Without a spread it is the lookup of Momoi & Takatera 2014: texel floor(frac(T) N), or linear between
//! texel centres. With one it is the exact mean over the growth time within the sample, so rings finer than
//! a pixel melt into their mean colour and the border between late and early wood is as wide as a pixel.
//! Behind the end of a pattern the last colour goes on: `inside` tells how much of a sample is wood.

mod middle;
mod rings;
mod span;
mod table;

use crate::field::{Block, InputColumn, Kernel, Sampling, transposed};
use crate::key::{Key, KeyHasher};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{AfterEnd, ColourPattern, Type, Unit, Value};
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use span::{BLOCK, Spans};
use table::{Lanes, Table};

/// Looks up a colour pattern by growth time.
pub static KIND: Kind = Kind {
    name: "pattern_lookup",
    version: 2,
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
        dispatch!(block.level, simd => self.look_up(simd, time, outputs));
    }
}

impl Lookup {
    #[simd]
    fn look_up<S: Simd>(&self, simd: S, time: InputColumn<'_>, outputs: &mut [Vec<f32>]) {
        let mut spans = Spans::new();
        let mut means = [[0.0; 4]; BLOCK];
        let length = time.values.len();
        for start in (0..length).step_by(BLOCK) {
            let range = start..length.min(start + BLOCK);
            let spread = [
                &time.spread[0][range.clone()],
                &time.spread[1][range.clone()],
            ];
            spans.place(simd, &self.table, &time.values[range.clone()], spread);
            let means = &mut means[..range.len()];
            self.table.means(simd, &spans, means);
            write_columns(simd, means, &mut outputs[..4], start);
            outputs[4][range.clone()].copy_from_slice(&spans.inside[..range.len()]);
        }
    }
}

#[inline(always)]
fn write_columns<S: Simd>(simd: S, means: &[Lanes], outputs: &mut [Vec<f32>], start: usize) {
    let [red, green, blue, position] = outputs else {
        return;
    };
    for (index, [a, b, c, d]) in means.as_chunks::<4>().0.iter().enumerate() {
        let [reds, greens, blues, positions] = transposed(simd, [a, b, c, d]);
        let four = start + 4 * index..start + 4 * index + 4;
        reds.store_slice(&mut red[four.clone()]);
        greens.store_slice(&mut green[four.clone()]);
        blues.store_slice(&mut blue[four.clone()]);
        positions.store_slice(&mut position[four]);
    }
}
