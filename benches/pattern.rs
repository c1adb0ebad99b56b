//! Measures the filtered lookup of colour patterns against a plain lookup of single texels.
//!
//! `cargo bench --bench pattern` prints nanoseconds per sample on one thread, the best of many runs.

use fearless_simd::Level;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};
use yosegi::key::Key;
use yosegi::node::{Build, Inputs};
use yosegi::value::{AfterEnd, ColourPattern, Domain, Value};

const TILE: [u32; 2] = [126, 62];
const SAMPLES: usize = 128 * 64;

/// A picture across which growth time rises by some years.
struct Board {
    years_per_pixel: f64,
}

impl Target for Board {
    fn key(&self) -> Key {
        Key::of_bytes(b"board")
    }

    fn pixels(&self) -> [u32; 2] {
        TILE
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        for (index, value) in u.iter_mut().enumerate() {
            *value = (((x + index as f64 * step) + 0.1 * y) * self.years_per_pixel) as f32;
        }
        v.fill(0.0);
        w.fill(0.0);
    }
}

fn pattern(texels: usize, rings: usize, after_end: AfterEnd, smooth: bool) -> ColourPattern {
    let colour =
        |index: usize| [index * 37 % 101, index * 11 % 97, index % 89].map(|x| x as f32 / 101.0);
    ColourPattern {
        colours: (0..texels).map(colour).collect(),
        years: rings as f64,
        ring_starts: (0..rings).map(|ring| ring as f64 / rings as f64).collect(),
        after_end,
        smooth,
    }
}

fn lookup(pattern: ColourPattern, time: Field) -> Vec<Field> {
    let kind = yosegi::nodes::kind("pattern_lookup").expect("the kind is in the table");
    let values = [
        Some(Value::Field(time)),
        Some(Value::ColourPattern(Arc::new(pattern))),
    ];
    let build = Build {
        node: &Arc::from("bench"),
        seed: 0,
        cancel: None,
    };
    let outputs = (kind.build)(&Inputs::new(kind, &values), &build).expect("the node can be built");
    let field = |value| match value {
        Value::Field(field) => Some(field),
        _ => None,
    };
    outputs.into_iter().filter_map(field).collect()
}

/// Nanoseconds per sample of the fastest of many runs.
fn best(mut run: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..400 {
        let start = Instant::now();
        run();
        best = best.min(start.elapsed().as_secs_f64());
    }
    best * 1e9 / SAMPLES as f64
}

fn program(fields: &[Field], target: &Board, level: Level, filtering: bool) -> f64 {
    let context = RunContext {
        level,
        cache: None,
        filtering,
        cancel: None,
    };
    let program = Program::compile(fields);
    let samples = Samples::Grid {
        target,
        grid: PixelGrid::tile([0, 0], TILE, 1),
    };
    let mut scratch = Scratch::default();
    best(|| {
        program.run(&samples, &mut scratch, &context);
        black_box(program.output(&scratch, 0, 0));
    })
}

/// One texel by floor(frac(T) N), nothing else.
fn plain(pattern: &ColourPattern, target: &Board) -> f64 {
    let mut times = vec![0.0f32; SAMPLES];
    let [mut v, mut w] = [vec![0.0f32; SAMPLES], vec![0.0f32; SAMPLES]];
    target.write_row(0.0, 0.0, 1.0, [&mut times, &mut v, &mut w]);
    let mut columns = [vec![0.0f32; SAMPLES], v, w];
    let count = pattern.colours.len();
    best(|| {
        for (index, time) in black_box(&times).iter().enumerate() {
            let year = time / pattern.years as f32;
            let texel = ((year - year.floor()) * count as f32) as usize;
            let colour = pattern.colours[texel.min(count - 1)];
            for (column, part) in columns.iter_mut().zip(colour) {
                column[index] = part;
            }
        }
        black_box(&mut columns);
    })
}

fn main() {
    let time = Field::position(Domain::Plane).part(0, 1);
    println!("            nanoseconds of        plain lookup | sampling positions | their lookup:");
    println!(
        "years/px  table              at points, filtered, filtered with baseline instructions"
    );
    for years_per_pixel in [0.003, 0.1, 3.0] {
        let target = Board { years_per_pixel };
        let positions = program(std::slice::from_ref(&time), &target, Level::new(), true);
        for (texels, rings, after_end, smooth) in [
            (256, 1, AfterEnd::Repeat, true),
            (256, 1, AfterEnd::Repeat, false),
            (1504, 47, AfterEnd::Repeat, true),
            (1504, 47, AfterEnd::End, true),
        ] {
            let pattern = pattern(texels, rings, after_end, smooth);
            let fields = lookup(pattern.clone(), time.clone());
            let plain = plain(&pattern, &target);
            let [points, filtered, baseline] = [
                (Level::new(), false),
                (Level::new(), true),
                (Level::baseline(), true),
            ]
            .map(|(level, filtering)| program(&fields, &target, level, filtering) - positions);
            let name = format!(
                "{texels}/{rings} {after_end:?} {}",
                if smooth { "smooth" } else { "" }
            );
            println!(
                "{years_per_pixel:<9} {name:22} {plain:5.2} | {positions:5.2} | {points:5.2} {filtered:5.2} {baseline:5.2}"
            );
        }
    }
}
