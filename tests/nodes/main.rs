//! Nodes of fields, images and materials: known values, laws, and the resolution contract of each.

#![allow(clippy::unwrap_used)] // helpers of tests

mod blends;
mod colours;
mod images;
mod numbers;
mod transforms;
mod trees;

use fearless_simd::Level;
use std::path::Path;
use std::sync::Arc;
use yosegi::engine::{Engine, Options, RunError};
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};
use yosegi::graph::{Settings, load_text};
use yosegi::key::Key;
use yosegi::world::Memory;

/// The output `name` of the node `example` of a recipe with these nodes, and files beside it.
fn field_with(files: &[(&str, Vec<u8>)], nodes: &str, name: &str) -> Result<Field, String> {
    let world = Memory::default();
    for (path, bytes) in files {
        world.insert(Path::new("recipes").join(path), bytes.clone());
    }
    let recipe = format!("(nodes: {{ {nodes} }})");
    let loaded = load_text("recipes/recipe.ron", recipe, &Settings::default())
        .map_err(|wrong| yosegi::diagnostics::render_all(&wrong))?;
    let engine = Engine::new(Arc::new(world), Options::default()).unwrap();
    let fields = engine
        .fields(&loaded.graph, "example", &|_| {})
        .map_err(|error: RunError| yosegi::diagnostics::render_all(error.diagnostics()))?;
    let sampled = fields.iter().find(|sampled| {
        let column = &sampled.columns[0];
        column == name || column.starts_with(&format!("{name}."))
    });
    let columns: Vec<_> = fields.iter().map(|sampled| &sampled.columns).collect();
    Ok(sampled
        .unwrap_or_else(|| panic!("no `{name}` among {columns:?}"))
        .field
        .clone())
}

fn field(nodes: &str, name: &str) -> Field {
    field_with(&[], nodes, name).unwrap_or_else(|message| panic!("{message}"))
}

/// What is said about a recipe that cannot be built.
fn refused(nodes: &str) -> String {
    field_with(&[], nodes, "").unwrap_err()
}

fn context(filtering: bool) -> RunContext<'static> {
    RunContext {
        level: Level::new(),
        cache: None,
        filtering,
        cancel: None,
    }
}

/// The columns of a field at points.
fn at(field: &Field, points: &[[f64; 3]]) -> Vec<Vec<f32>> {
    let program = Program::compile(std::slice::from_ref(field));
    let mut scratch = Scratch::default();
    program.run(&Samples::Points(points), &mut scratch, &context(true));
    let column = |column| program.output(&scratch, 0, column)[..points.len()].to_vec();
    (0..field.width()).map(column).collect()
}

/// The value of a field of one column at points.
fn number(field: &Field, points: &[[f64; 3]]) -> Vec<f32> {
    assert_eq!(field.width(), 1);
    at(field, points).remove(0)
}

/// A square piece of `side` mm, or a cut through a solid at z = 7 mm, as `pixels` x `pixels` pixels.
struct Square {
    side: f64,
    pixels: u32,
}

impl Target for Square {
    fn key(&self) -> Key {
        Key::of_bytes(format!("{} {}", self.side, self.pixels).as_bytes())
    }

    fn pixels(&self) -> [u32; 2] {
        [self.pixels; 2]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        let pixel = self.side / f64::from(self.pixels);
        for (index, value) in u.iter_mut().enumerate() {
            *value = ((x + index as f64 * step) * pixel) as f32;
        }
        v.fill((self.side - y * pixel) as f32);
        w.fill(7.0);
    }
}

const TILE: u32 = 64;

/// The columns of a field over a square, averaged over boxes of `side` x `side` pixels.
fn painted(field: &Field, target: &Square, side: u32, filtering: bool) -> Vec<Vec<f64>> {
    let program = Program::compile(std::slice::from_ref(field));
    let mut scratch = Scratch::default();
    let (margin, width) = (program.margin(), target.pixels / side);
    let mut sums = vec![vec![0.0; (width * width) as usize]; field.width()];
    for corner in 0..(target.pixels / TILE).pow(2) {
        let [left, top] = [
            corner % (target.pixels / TILE),
            corner / (target.pixels / TILE),
        ]
        .map(|tile| tile * TILE);
        let grid = PixelGrid::tile([left, top], [TILE; 2], margin);
        let row = grid.width;
        program.run(
            &Samples::Grid { target, grid },
            &mut scratch,
            &context(filtering),
        );
        for (column, sums) in sums.iter_mut().enumerate() {
            let values = program.output(&scratch, 0, column);
            for (x, y) in (0..TILE * TILE).map(|pixel| (pixel % TILE, pixel / TILE)) {
                let value = values[(y as usize + margin) * row + x as usize + margin];
                let pixel = (top + y) / side * width + (left + x) / side;
                sums[pixel as usize] += f64::from(value) / f64::from(side * side);
            }
        }
    }
    sums
}

/// Mean and 99.9 % quantile of the differences in 1/255 of `scale`.
fn difference(expected: &[Vec<f64>], found: &[Vec<f64>], scale: f64) -> [f64; 2] {
    let pairs = expected.iter().flatten().zip(found.iter().flatten());
    let mut apart: Vec<f64> = pairs.map(|(a, b)| 255.0 * (a - b).abs() / scale).collect();
    apart.sort_by(f64::total_cmp);
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    [mean, apart[(apart.len() - 1) * 999 / 1000]]
}

/// The resolution contract over a square of `side` mm: 64 pixels look like 1024 scaled down; what a field does
/// from black to white is `scale`. Without filtering it must not hold.
fn keeps_the_contract(what: &str, field: &Field, side: f64, scale: f64) {
    let square = |pixels| Square { side, pixels };
    let large = painted(field, &square(1024), 16, true);
    let small = painted(field, &square(64), 1, true);
    let found = difference(&large, &small, scale);
    let bare = difference(&large, &painted(field, &square(64), 1, false), scale);
    println!(
        "{what}: mean {:.3}, 99.9 % {:.2}; without filtering {bare:.2?}",
        found[0], found[1]
    );
    assert!(found[0] <= 2.0 && found[1] <= 12.0, "{what}: {found:?}");
    assert!(
        bare[0] > 2.0 || bare[1] > 12.0,
        "{what} needs no filter: {bare:?}"
    );
}
