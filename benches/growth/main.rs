//! Growth time and colour of a 2048 x 2048 picture: the library's way against loops written by hand.
//!
//! `cargo bench --bench growth` prints nanoseconds per pixel on one thread. Ratios are medians of
//! pairs measured one right after the other, so they hold on a busy machine as well.

#[path = "../support/clock.rs"]
mod clock;
mod hand;
mod hand_colour;
mod scene;

use clock::{median, seconds};
use fearless_simd::Level;
use hand::Tree;
use hand_colour::{Filter, Table};
use scene::{Plane, SIZE, model, tall, year};
use std::hint::black_box;
use std::sync::Arc;
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch};
use yosegi::node::{Build, Inputs};
use yosegi::nodes::wood::growth::{GrowthKernel, GrowthModel, Reach};
use yosegi::output::{Encoder, MapKind};
use yosegi::value::{ColourPattern, Domain, MapFormat, Value};

const TILE: u32 = 128;
const PAIRS: usize = 9;

/// The library's way: a field compiled into a program, run tile by tile.
struct Library {
    program: Program,
    scratch: Scratch,
    level: Level,
    encoder: Option<Encoder>,
}

impl Library {
    /// Growth time and share of the branches.
    fn times(model: &GrowthModel, level: Level) -> Library {
        Library::of(&growth(model), level, None)
    }

    /// Colour by growth time.
    fn colours(model: &GrowthModel, level: Level) -> Library {
        Library::of(&colour(growth(model).part(0, 1), year()), level, None)
    }

    /// The same as bytes of sRGB.
    fn bytes(model: &GrowthModel, level: Level) -> Library {
        let encoder = Encoder::new(MapKind::Colour, MapFormat::Png8, None);
        Library::of(
            &colour(growth(model).part(0, 1), year()),
            level,
            Some(encoder),
        )
    }

    fn of(field: &Field, level: Level, encoder: Option<Encoder>) -> Library {
        Library {
            program: Program::compile(std::slice::from_ref(field)),
            scratch: Scratch::default(),
            level,
            encoder,
        }
    }

    fn run(&mut self) {
        let context = RunContext {
            level: self.level,
            cache: None,
            filtering: true,
            cancel: None,
        };
        let corners = || (0..SIZE).step_by(TILE as usize);
        for corner in corners().flat_map(|y| corners().map(move |x| [x, y])) {
            let grid = PixelGrid::tile(corner, [TILE, TILE], self.program.margin());
            let samples = Samples::Grid {
                target: &Plane,
                grid,
            };
            self.program.run(&samples, &mut self.scratch, &context);
            self.encode();
            black_box(self.program.output(&self.scratch, 0, 0));
        }
    }

    fn encode(&self) {
        let Some(encoder) = self.encoder else { return };
        let columns = self.program.columns(&self.scratch, 0);
        let (margin, width) = (self.program.margin(), TILE as usize);
        let mut bytes = vec![0; 3 * width];
        for row in 0..width {
            let start = (row + margin) * (width + 2 * margin) + margin;
            let columns = [0, 1, 2].map(|part| &columns[part][start..start + width]);
            black_box(encoder.encode(&columns, &mut bytes));
            black_box(&bytes);
        }
    }
}

fn growth(model: &GrowthModel) -> Field {
    let kernel = Arc::new(GrowthKernel::new(model.clone()));
    Field::kernel(
        &Arc::from("bench"),
        kernel,
        vec![Field::position(Domain::Solid)],
    )
}

fn colour(time: Field, pattern: ColourPattern) -> Field {
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
    match &outputs[0] {
        Value::Field(colour) => colour.clone(),
        _ => unreachable!("the first output is the colour"),
    }
}

/// Prints a row of medians of pairs: A, B and A / B.
fn compare(name: &str, mut a: impl FnMut(), mut b: impl FnMut()) {
    a();
    b();
    let pixel = |work: &mut dyn FnMut()| seconds(work) * 1e9 / f64::from(SIZE * SIZE);
    let pairs: Vec<[f64; 2]> = (0..PAIRS).map(|_| [pixel(&mut a), pixel(&mut b)]).collect();
    let of = |part: fn(&[f64; 2]) -> f64| median(pairs.iter().map(part).collect());
    let [first, second, ratio] = [of(|p| p[0]), of(|p| p[1]), of(|p| p[0] / p[1])];
    println!("{name:<56} {first:>7.2} {second:>7.2} {ratio:>7.2}");
}

fn levels() -> Vec<(&'static str, Level)> {
    let best = Level::new();
    let mut levels = vec![("baseline", Level::baseline())];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_avx2().map(|avx2| ("avx2", Level::Avx2(avx2))));
        levels.extend(
            best.as_avx512()
                .map(|avx512| ("avx512", Level::Avx512(avx512))),
        );
    }
    levels
}

/// The library against the loops by hand, on a tree of so many nodes.
fn against_hand(nodes: usize, name: &str, level: Level) {
    let model = model(nodes, 3, None, 2.0);
    let (tree, table, codes) = (Tree::new(&model), Table::new(&year()), hand_colour::srgb());
    let by_hand = |filter, codes| hand_colour::colours(&tree, &table, level, filter, codes);
    let name = |what: &str| format!("{what}, {nodes} nodes, {name}: library, hand");
    let mut library = Library::times(&model, level);
    compare(
        &name("growth time"),
        || library.run(),
        || hand::times(&tree, level),
    );
    let mut library = Library::colours(&model, level);
    let two = || by_hand(Filter::TwoBoxes, None);
    compare(&name("colour"), || library.run(), two);
    let one = || by_hand(Filter::OneBox, None);
    compare(&name("colour, hand with one box"), || library.run(), one);
    let mut library = Library::bytes(&model, level);
    let bytes = || by_hand(Filter::TwoBoxes, Some(&codes));
    compare(&name("sRGB bytes"), || library.run(), bytes);
}

fn nodes_and_branches(level: Level) {
    for nodes in [64, 1024, 10_000] {
        let few = model(10, 3, None, 2.0);
        let many = model(nodes, 3, None, 2.0);
        let (mut a, mut b) = (Library::times(&many, level), Library::times(&few, level));
        compare(
            &format!("growth time: {nodes} nodes, 10"),
            || a.run(),
            || b.run(),
        );
        let (mut a, mut b) = (
            Library::colours(&many, level),
            Library::colours(&few, level),
        );
        compare(
            &format!("colour: {nodes} nodes, 10"),
            || a.run(),
            || b.run(),
        );
    }
    let reach = Some(Reach {
        along: 150.0,
        across: 25.0,
    });
    for branches in [1000, 10_000] {
        // A taller tree: the picture shows as many branches as before.
        let mut hundred = Library::times(&tall(1, reach), level);
        let mut many = Library::times(&tall(branches / 100, reach), level);
        let name = format!("growth time: {branches} branches, 100, equally dense");
        compare(&name, || many.run(), || hundred.run());
    }
    let mut sparse = Library::times(&model(64, 100, reach, 2.0), level);
    let mut dense = Library::times(&model(64, 1000, reach, 2.0), level);
    let name = "growth time: 1000 branches, 100, ten times as dense";
    compare(name, || dense.run(), || sparse.run());
    for sharpness in [4.0, 3.3] {
        let mut two = Library::times(&model(64, 3, None, 2.0), level);
        let mut other = Library::times(&model(64, 3, None, sharpness), level);
        let name = format!("growth time: sharpness {sharpness}, 2");
        compare(&name, || other.run(), || two.run());
    }
}

fn main() {
    println!(
        "{SIZE} x {SIZE}, tiles of {TILE}, one thread; ns/pixel of CPU, medians of {PAIRS} pairs\n"
    );
    println!("{:<56} {:>7} {:>7} {:>7}", "what: A, B", "A", "B", "A / B");
    for (name, level) in levels() {
        against_hand(64, name, level);
    }
    if std::env::args().any(|argument| argument == "--short") {
        return;
    }
    for nodes in [10, 1024, 10_000] {
        for (name, level) in levels() {
            against_hand(nodes, name, level);
        }
    }
    nodes_and_branches(Level::new());
}
