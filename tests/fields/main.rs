//! Laws of field programs, with small kernels of the tests' own.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod cells;
mod pictures;
mod programs;

use fearless_simd::Level;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use yosegi::engine::FlatPiece;
use yosegi::field::{
    Block, ColumnCache, Columns, Field, Kernel, PixelGrid, Program, RunContext, Samples, Sampling,
    Scratch,
};
use yosegi::key::{Key, KeyHasher};
use yosegi::value::Domain;

/// A kernel that is one function.
#[derive(Clone, Debug)]
struct Test {
    name: &'static str,
    width: usize,
    function: fn(&mut Block<'_>),
    spread: bool,
    sampling: Sampling,
    nanoseconds: f32,
    calls: Arc<AtomicUsize>,
}

impl Test {
    fn new(name: &'static str, width: usize, function: fn(&mut Block<'_>)) -> Test {
        Test {
            name,
            width,
            function,
            spread: false,
            sampling: Sampling::Filtered,
            nanoseconds: 1.0,
            calls: Arc::default(),
        }
    }

    fn of(&self, inputs: &[&Field]) -> Field {
        let inputs = inputs.iter().map(|field| (*field).clone()).collect();
        Field::kernel(&Arc::from(self.name), Arc::new(self.clone()), inputs)
    }

    fn calls(&self) -> usize {
        self.calls.load(Ordering::Relaxed)
    }
}

impl Kernel for Test {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text(self.name);
    }

    fn width(&self) -> usize {
        self.width
    }

    fn reads_spread(&self, _: usize) -> bool {
        self.spread
    }

    fn sampling(&self) -> Sampling {
        self.sampling
    }

    fn nanoseconds(&self) -> f32 {
        self.nanoseconds
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        self.calls.fetch_add(1, Ordering::Relaxed);
        (self.function)(block);
    }
}

/// `f(a, b)` of the first two columns.
fn two(block: &mut Block<'_>, f: fn(f32, f32) -> f32) {
    for index in 0..block.outputs[0].len() {
        block.outputs[0][index] = f(block.inputs[0].values[index], block.inputs[1].values[index]);
    }
}

fn mean() -> Test {
    Test::new("mean", 1, |block| two(block, |a, b| 0.5 * (a + b)))
}

fn product() -> Test {
    Test::new("product", 1, |block| two(block, |a, b| a * b))
}

fn smaller() -> Test {
    Test::new("smaller", 1, |block| two(block, f32::min))
}

/// All input columns as one field.
fn join() -> Test {
    Test::new("join", 3, |block| {
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            output.copy_from_slice(input.values);
        }
    })
}

/// The change of a column from pixel to pixel along the rows.
fn rise() -> Test {
    let rise = Test::new("rise", 1, |block| {
        block.outputs[0].copy_from_slice(block.inputs[0].spread[0])
    });
    Test {
        spread: true,
        ..rise
    }
}

/// 1 where the column is below 0.
fn below_zero() -> Test {
    let step = Test::new("below_zero", 1, |block| {
        for (output, value) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = f32::from(u8::from(*value < 0.0));
        }
    });
    Test {
        sampling: Sampling::Supersampled,
        nanoseconds: 9.0,
        ..step
    }
}

fn context() -> RunContext<'static> {
    RunContext {
        level: Level::new(),
        cache: None,
        filtering: true,
        cancel: None,
    }
}

fn axis(domain: Domain, axis: usize) -> Field {
    Field::position(domain).part(axis, 1)
}

/// The values of one-column fields at points.
fn at_points(fields: &[Field], points: &[[f64; 3]]) -> Vec<Vec<f32>> {
    let program = Program::compile(fields);
    let mut scratch = Scratch::default();
    program.run(&Samples::Points(points), &mut scratch, &context());
    (0..fields.len())
        .map(|index| program.output(&scratch, index, 0)[..points.len()].to_vec())
        .collect()
}

/// A one-column field on a picture of 1 mm pixels, painted in tiles of `side` pixels.
fn painted(
    fields: &[Field],
    pixels: [u32; 2],
    side: u32,
    context: &RunContext<'_>,
) -> Vec<Vec<f32>> {
    let program = Program::compile(fields);
    let target = FlatPiece::new(pixels, pixels.map(f64::from));
    let mut scratch = Scratch::default();
    let mut pictures = vec![vec![f32::NAN; (pixels[0] * pixels[1]) as usize]; fields.len()];
    for y in (0..pixels[1]).step_by(side as usize) {
        for x in (0..pixels[0]).step_by(side as usize) {
            let size = [side.min(pixels[0] - x), side.min(pixels[1] - y)];
            let grid = PixelGrid::tile([x, y], size, program.margin());
            let (stride, margin) = (grid.width, program.margin());
            program.run(
                &Samples::Grid {
                    target: &target,
                    grid,
                },
                &mut scratch,
                context,
            );
            for (index, picture) in pictures.iter_mut().enumerate() {
                for row in 0..size[1] as usize {
                    let from = (row + margin) * stride + margin;
                    let to = (y as usize + row) * pixels[0] as usize + x as usize;
                    let values = program.output(&scratch, index, 0);
                    picture[to..to + size[0] as usize]
                        .copy_from_slice(&values[from..from + size[0] as usize]);
                }
            }
        }
    }
    pictures
}

fn bits(pictures: &[Vec<f32>]) -> Vec<Vec<u32>> {
    pictures
        .iter()
        .map(|picture| picture.iter().map(|value| value.to_bits()).collect())
        .collect()
}
