//! Octaves of solid noise on a 2048 x 2048 slice: the library's way against the crate `simdnoise`.
//!
//! `cargo bench --bench noise` prints nanoseconds of processor time per sample on one thread, and the
//! medians of ratios of pairs measured one right after the other, so they hold on a busy machine as well;
//! `-- Avx2 ridged` chooses lines that have both words.
//! Ours is the whole program: oblique positions, their spread, and the noise filtered by it, in tiles with
//! a margin of one sample; theirs is simplex noise on a grid along the axes, which is all that it offers
//! without unsafe code, always with the best instructions of the machine. It ends with a pass for the range.

use fearless_simd::Level;
use glam::DVec3;
use simdnoise::NoiseBuilder;
use std::fs;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};
use yosegi::key::{Key, KeyHasher};
use yosegi::node::{Build, Inputs};
use yosegi::value::Value;

const SIZE: u32 = 2048;
const TILE: u32 = 128;
const PAIRS: usize = 7;

/// A plane with pixels of 1 mm on which x, y and z all vary along rows and columns.
struct Plane;

impl Target for Plane {
    fn key(&self) -> Key {
        KeyHasher::new("bench plane", 1).finish()
    }

    fn pixels(&self) -> [u32; 2] {
        [SIZE, SIZE]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, row: [&mut [f32]; 3]) {
        let right = DVec3::new(2.0, 1.0, 2.0) / 3.0;
        let down = DVec3::new(-2.0, 2.0, 1.0) / 3.0;
        let origin = DVec3::new(-180.0, -120.0, 100.0) + right * x + down * y;
        for (axis, row) in row.into_iter().enumerate() {
            let (origin, step) = (origin[axis], step * right[axis]);
            for (index, value) in (0i32..).zip(row) {
                *value = (origin + f64::from(index) * step) as f32;
            }
        }
    }
}

/// The values of a node `solid_noise`, by the names of its inputs.
fn noise(output: usize, literals: &[(&str, Value)]) -> Field {
    let kind = yosegi::nodes::kind("solid_noise").expect("the kind is in the table");
    let standard = [
        ("gain", Value::Number(0.5)),
        ("lacunarity", Value::Number(2.0)),
        ("form", Value::Choice("fbm")),
        ("period", Value::Vector(DVec3::ZERO)),
        ("seed", Value::Whole(0)),
    ];
    let value = |name: &str| {
        let found = literals.iter().chain(&standard).find(|(of, _)| *of == name);
        found.map(|(_, value)| value.clone())
    };
    let values: Vec<_> = kind.inputs.iter().map(|input| value(input.name)).collect();
    let build = Build {
        node: &Arc::from("bench"),
        seed: 0,
        cancel: None,
    };
    let outputs = (kind.build)(&Inputs::new(kind, &values), &build).expect("the node can be built");
    match &outputs[output] {
        Value::Field(field) => field.clone(),
        other => panic!("expected a field, found a {}", other.type_name()),
    }
}

/// Paints the picture tile by tile.
fn ours(program: &Program, level: Level, filtering: bool, scratch: &mut Scratch) {
    let context = RunContext {
        level,
        cache: None,
        filtering,
        cancel: None,
    };
    for corner in (0..SIZE * SIZE / TILE / TILE).map(|tile| {
        let across = SIZE / TILE;
        [tile % across * TILE, tile / across * TILE]
    }) {
        let samples = Samples::Grid {
            target: &Plane,
            grid: PixelGrid::tile(corner, [TILE; 2], program.margin()),
        };
        program.run(&samples, scratch, &context);
        black_box(program.output(scratch, 0, 0));
    }
}

/// Paints the picture with `simdnoise`.
fn theirs(size: f32, octaves: u8) {
    let side = SIZE as usize;
    let mut builder = NoiseBuilder::fbm_3d(side, side, 1);
    builder.with_freq(1.0 / size).with_octaves(octaves);
    builder.with_lacunarity(2.0).with_gain(0.5).with_seed(7);
    black_box(builder.generate());
}

/// Seconds that this thread has been running; where the system does not say, seconds that have passed.
fn seconds(start: Instant) -> f64 {
    let counted = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = counted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |count| count * 1e-9)
}

/// Nanoseconds per sample.
fn timed(start: Instant, run: impl FnOnce()) -> f64 {
    let before = seconds(start);
    run();
    (seconds(start) - before) * 1e9 / f64::from(SIZE * SIZE)
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Every level of vector instructions that this machine has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        levels.extend(best.as_avx2().map(Level::Avx2));
        levels.extend(best.as_avx512().map(Level::Avx512));
    }
    levels
}

/// Measures one of our programs against theirs and prints a line.
fn compare(name: &str, field: &Field, size: f32, octaves: u8, level: Level, filtering: bool) {
    let level_name = format!("{level:?}");
    let level_name = level_name.split('(').next().unwrap_or_default();
    let line = format!("{name:28} {level_name:9}");
    let mut wanted = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with('-'));
    if !wanted.all(|word| line.contains(&word)) {
        return;
    }
    let program = Program::compile(std::slice::from_ref(field));
    let (mut scratch, start) = (Scratch::default(), Instant::now());
    ours(&program, level, filtering, &mut scratch);
    let pairs: Vec<[f64; 2]> = (0..PAIRS)
        .map(|_| {
            [
                timed(start, || ours(&program, level, filtering, &mut scratch)),
                timed(start, || theirs(size, octaves)),
            ]
        })
        .collect();
    let of = |side: usize| median(pairs.iter().map(|pair| pair[side]).collect());
    let ratio = median(pairs.iter().map(|pair| pair[0] / pair[1]).collect());
    println!(
        "{line} ours {:6.2}  theirs {:6.2}  ratio {ratio:.2}",
        of(0),
        of(1)
    );
}

fn main() {
    println!("nanoseconds per sample; theirs is fBm with as many octaves, whatever the form");
    let size = |millimetres: f64| ("size", Value::Vector(DVec3::splat(millimetres)));
    let octaves = |count: i64| ("octaves", Value::Whole(count));
    for level in levels() {
        // The finest octave has cells of 8 pixels, so none fades.
        let fbm = noise(0, &[size(1024.0), octaves(8)]);
        compare("fbm, 8 octaves", &fbm, 1024.0, 8, level, true);
        compare("fbm, 8 octaves, no filter", &fbm, 1024.0, 8, level, false);
        let one = noise(0, &[size(32.0), octaves(1)]);
        compare("one octave", &one, 32.0, 1, level, true);
        // The finest octaves are finer than a pixel.
        let fading = noise(0, &[size(32.0), octaves(8)]);
        compare("fbm, 8 octaves, 3 fading", &fading, 32.0, 8, level, true);
        for form in ["ridged", "billow"] {
            let name = format!("{form}, 8 octaves");
            let form = ("form", Value::Choice(form));
            let field = noise(0, &[size(1024.0), octaves(8), form]);
            compare(&name, &field, 1024.0, 8, level, true);
        }
        let vector = noise(1, &[size(1024.0), octaves(8)]);
        compare("vector, 8 octaves", &vector, 1024.0, 8, level, true);
    }
}
