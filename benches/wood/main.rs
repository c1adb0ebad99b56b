//! Two claims about models of wood: the curved skeleton against the straight one as nodes are added, and virtual
//! energy as burls are added.
//!
//! `cargo bench --bench wood` prints nanoseconds of processor time per pixel on one thread, and ratios, which are
//! medians of pairs measured one right after the other.

#[path = "../support/clock.rs"]
mod clock;
mod scene;

use clock::{median, seconds};
use fearless_simd::Level;
use scene::{Cut, coloured, energy, time};
use std::hint::black_box;
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};

const TILE: u32 = 128;
const PAIRS: usize = 11;

fn main() {
    nodes();
    burls();
}

/// Momoi & Takatera 2014, figure 14: 512 x 512 pixels, three branches, more and more nodes.
fn nodes() {
    println!("straight and curved skeleton, colour, 512 x 512, three branches (figure 14)");
    println!(
        "{:>6} {:>12} {:>12} {:>18} {:>26}",
        "nodes", "straight", "curved", "straight / curved", "curved, against 8 nodes"
    );
    let cut = Cut { pixels: 512 };
    let mut few = Painter::new(&coloured(time("growth_field", 8)), cut);
    for count in [8, 32, 128, 1024] {
        let mut straight = Painter::new(&coloured(time("straight_growth_field", count)), cut);
        let mut curved = Painter::new(&coloured(time("growth_field", count)), cut);
        let against_straight = compare(&mut straight, &mut curved);
        let against_few = compare(&mut curved, &mut few);
        println!(
            "{count:>6} {:>9.2} ns {:>9.2} ns {:>18.2} {:>26.2}",
            against_straight.first,
            against_straight.second,
            against_straight.ratio,
            against_few.ratio
        );
    }
}

/// Burls beside a trunk, three branches and four waves: 1024 x 1024 pixels with colour.
fn burls() {
    println!("\nvirtual energy, trunk, three branches, four waves and colour, 1024 x 1024");
    println!(
        "{:>6} {:>12} {:>22} {:>26}",
        "burls", "", "against none (< 4)", "more for each burl"
    );
    let cut = Cut { pixels: 1024 };
    let mut none = Painter::new(&coloured(energy(0)), cut);
    for count in [50, 100, 200, 400, 800] {
        let mut many = Painter::new(&coloured(energy(count)), cut);
        let pair = compare(&mut many, &mut none);
        let more = (pair.first - pair.second) / count as f64;
        println!(
            "{count:>6} {:>9.2} ns {:>22.2} {more:>23.3} ns",
            pair.first, pair.ratio
        );
    }
}

/// A field that is painted tile by tile.
struct Painter {
    program: Program,
    scratch: Scratch,
    cut: Cut,
}

impl Painter {
    fn new(field: &Field, cut: Cut) -> Painter {
        Painter {
            program: Program::compile(std::slice::from_ref(field)),
            scratch: Scratch::default(),
            cut,
        }
    }

    fn run(&mut self) {
        let context = RunContext {
            level: Level::new(),
            cache: None,
            filtering: true,
            cancel: None,
        };
        let [side, _] = self.cut.pixels();
        let corners = || (0..side).step_by(TILE as usize);
        for corner in corners().flat_map(|y| corners().map(move |x| [x, y])) {
            let grid = PixelGrid::tile(corner, [TILE, TILE], self.program.margin());
            let samples = Samples::Grid {
                target: &self.cut,
                grid,
            };
            self.program.run(&samples, &mut self.scratch, &context);
            black_box(self.program.output(&self.scratch, 0, 0));
        }
    }

    /// Nanoseconds for a pixel of one run.
    fn nanoseconds(&mut self) -> f64 {
        let area = f64::from(self.cut.pixels) * f64::from(self.cut.pixels);
        seconds(&mut || self.run()) * 1e9 / area
    }
}

/// Medians of pairs.
struct Pair {
    first: f64,
    second: f64,
    ratio: f64,
}

fn compare(first: &mut Painter, second: &mut Painter) -> Pair {
    let pairs: Vec<[f64; 2]> = (0..PAIRS)
        .map(|_| [first.nanoseconds(), second.nanoseconds()])
        .collect();
    let middle = |number: &dyn Fn(&[f64; 2]) -> f64| median(pairs.iter().map(number).collect());
    Pair {
        first: middle(&|pair| pair[0]),
        second: middle(&|pair| pair[1]),
        ratio: middle(&|pair| pair[0] / pair[1]),
    }
}
