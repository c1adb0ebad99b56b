//! Sampling a partition: id and border distance of 100 and of 100,000 cells on a map of 4096 x 4096 pixels; and what each
//! further material of `per_cell` costs, where tiles hold few cells.
//!
//! `cargo bench --bench cells` prints nanoseconds of processor time per pixel on one thread, and ratios, which are
//! medians of pairs measured one right after the other.

#[path = "support/clock.rs"]
mod clock;

use clock::{median, seconds};
use fearless_simd::Level;
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use yosegi::engine::{Engine, Event, FlatPiece, Options};
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch};
use yosegi::graph::{Settings, load};
use yosegi::world::Memory;

const SIDE: u32 = 4096;
const TILE: u32 = 128;
const PAIRS: usize = 5;

fn main() {
    println!("id and border distance, {SIDE} x {SIDE} pixels");
    let [mut few, mut many] = [100, 100_000].map(|count| {
        let nodes = format!(
            r#""cells": voronoi_split(size: (1000, 1000), count: {count}), "at": cell_fields(cells: "cells"),"#
        );
        Painter::new(&fields(&nodes, &["at.id", "at.border"]))
    });
    compare("100,000 cells", &mut many, "100 cells", &mut few, "< 1.5");
    println!("\na material of noise in each of 100 cells");
    let [mut one, mut four] = [1, 4].map(|count| {
        let noise = |index: i32| {
            format!(
                r#""n{index}": solid_noise(size: (9, 9, 9), octaves: 5, seed: {index}),
                "m{index}": material(base_color: "c{index}"), "c{index}": mix(a: "black", b: "white", amount: "n{index}.value"),"#
            )
        };
        let noises: String = (0..count).map(noise).collect();
        let of: Vec<String> = (0..count).map(|index| format!(r#""m{index}": "m{index}""#)).collect();
        let nodes = format!(
            r##"{} "cells": voronoi_split(size: (1000, 1000), count: 100),
            "laid": per_cell(cells: "cells", of: {{ {} }}),"##,
            noises.replace(r#""black""#, r##""#000000""##).replace(r#""white""#, r##""#ffffff""##),
            of.join(", ")
        );
        Painter::new(&fields(&nodes, &["laid.base_color"]))
    });
    compare(
        "four materials",
        &mut four,
        "one material",
        &mut one,
        "4 if all were computed",
    );
}

/// Fields of a recipe with these nodes.
fn fields(nodes: &str, names: &[&str]) -> Vec<Field> {
    let world = Memory::default();
    let path = Path::new("recipe.ron");
    world.insert(path, format!("(nodes: {{ {nodes} }})"));
    let graph = load(&world, path, &Settings::default())
        .expect("the recipe is right")
        .graph;
    let engine = Engine::new(Arc::new(world), Options::default()).expect("there are threads");
    let field = |name: &&str| {
        let fields = engine.fields(&graph, name, &|_: Event| {});
        fields.expect("the node can be built").remove(0).field
    };
    names.iter().map(field).collect()
}

/// Fields that are painted tile by tile.
struct Painter {
    program: Program,
    scratch: Scratch,
}

impl Painter {
    fn new(fields: &[Field]) -> Painter {
        Painter {
            program: Program::compile(fields),
            scratch: Scratch::default(),
        }
    }

    fn run(&mut self) {
        let context = RunContext {
            level: Level::new(),
            cache: None,
            filtering: true,
            cancel: None,
        };
        let target = FlatPiece::new([SIDE; 2], [1000.0; 2]);
        let corners = || (0..SIDE).step_by(TILE as usize);
        for corner in corners().flat_map(|y| corners().map(move |x| [x, y])) {
            let grid = PixelGrid::tile(corner, [TILE; 2], self.program.margin());
            let samples = Samples::Grid {
                target: &target,
                grid,
            };
            self.program.run(&samples, &mut self.scratch, &context);
            black_box(self.program.output(&self.scratch, 0, 0));
        }
    }

    /// Nanoseconds for a pixel of one run.
    fn nanoseconds(&mut self) -> f64 {
        seconds(&mut || self.run()) * 1e9 / (f64::from(SIDE) * f64::from(SIDE))
    }
}

/// Prints both and their ratio.
fn compare(name: &str, first: &mut Painter, other: &str, second: &mut Painter, wanted: &str) {
    // Cells are made ready to be found by the first run.
    first.run();
    second.run();
    let pairs: Vec<[f64; 2]> = (0..PAIRS)
        .map(|_| [first.nanoseconds(), second.nanoseconds()])
        .collect();
    let middle = |number: &dyn Fn(&[f64; 2]) -> f64| median(pairs.iter().map(number).collect());
    println!(
        "{name}: {:.1} ns, {other}: {:.1} ns, ratio {:.2} ({wanted})",
        middle(&|pair| pair[0]),
        middle(&|pair| pair[1]),
        middle(&|pair| pair[0] / pair[1]),
    );
}
