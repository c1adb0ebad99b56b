//! Colour patterns: the tables, the lookup and its filter, and photographs of wood.

#![allow(clippy::unwrap_used)] // helpers of tests

mod lookup;
mod nodes;
mod photographs;

use fearless_simd::Level;
use std::sync::Arc;
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};
use yosegi::key::Key;
use yosegi::node::{Build, Failure, Inputs};

use yosegi::value::{ColourPattern, Value};

/// Builds a node of a kind from named inputs; the others are left out.
fn build(kind: &str, inputs: &[(&str, Value)]) -> Result<Vec<Value>, Failure> {
    let kind = yosegi::nodes::kind(kind).unwrap();
    let value = |name: &str| {
        inputs
            .iter()
            .find(|input| input.0 == name)
            .map(|input| input.1.clone())
    };
    let values: Vec<_> = kind.inputs.iter().map(|input| value(input.name)).collect();
    assert!(
        inputs.iter().all(|input| kind.input(input.0).is_some()),
        "unknown input"
    );
    (kind.build)(
        &Inputs::new(kind, &values),
        &Build {
            node: &Arc::from("test"),
            seed: 0,
            cancel: None,
        },
    )
}

/// The columns of the lookup for a field of times: red, green, blue, position, inside.
fn look_up(pattern: &ColourPattern, time: Field) -> Vec<Field> {
    let pattern = Value::ColourPattern(Arc::new(pattern.clone()));
    let outputs = build(
        "pattern_lookup",
        &[("time", Value::Field(time)), ("pattern", pattern)],
    );
    let field = |value| match value {
        Value::Field(field) => field,
        other => panic!("found a {}", other.type_name()),
    };
    outputs.unwrap().into_iter().map(field).collect()
}

/// The columns of `fields` at `samples`.
fn columns(fields: &[Field], samples: &Samples<'_>) -> Vec<Vec<f32>> {
    columns_with(Level::new(), fields, samples)
}

/// The columns of `fields` at `samples`, computed with the given vector instructions.
fn columns_with(level: Level, fields: &[Field], samples: &Samples<'_>) -> Vec<Vec<f32>> {
    let context = RunContext {
        level,
        cache: None,
        filtering: true,
        cancel: None,
    };
    let program = Program::compile(fields);
    let mut scratch = Scratch::default();
    program.run(samples, &mut scratch, &context);
    let column = |field, column| program.output(&scratch, field, column)[..samples.len()].to_vec();
    let all = fields.iter().enumerate();
    all.flat_map(|(field, of)| (0..of.width()).map(move |part| column(field, part)))
        .collect()
}

/// A picture in which the first coordinate is `start + step * x + skew * y`.
struct Slope {
    start: f64,
    step: f64,
    skew: f64,
}

impl Slope {
    fn at(&self, x: f64, y: f64) -> f32 {
        (self.start + self.step * x + self.skew * y) as f32
    }
}

impl Target for Slope {
    fn key(&self) -> Key {
        Key::of_bytes(b"slope")
    }

    fn pixels(&self) -> [u32; 2] {
        [1 << 16, 1 << 16]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        for (index, value) in u.iter_mut().enumerate() {
            *value = self.at(x + index as f64 * step, y);
        }
        v.fill(0.0);
        w.fill(0.0);
    }
}

fn grid(target: &dyn Target, size: [u32; 2]) -> Samples<'_> {
    Samples::Grid {
        target,
        grid: PixelGrid::tile([0, 0], size, 1),
    }
}
