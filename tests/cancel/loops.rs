//! How much of a loop still runs after the run was cancelled within it.

use super::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use yosegi::diagnostics::render_all;
use yosegi::engine::{Engine, Render};
use yosegi::field::{
    Block, ColumnCache, Columns, Field, Kernel, PixelGrid, Program, RunContext, Samples, Sampling,
    Scratch,
};
use yosegi::graph::{Graph, Settings, load_text_with};
use yosegi::key::{Key, KeyHasher};
use yosegi::node::{Build, Failure, Input, Inputs, Kind, Output};
use yosegi::nodes::KINDS;
use yosegi::value::{Domain, Type, Unit, Value};
use yosegi::world::Memory;

/// A kernel that cancels the run at its call number `last`, and counts its calls.
#[derive(Clone, Debug)]
struct Canceller {
    cancel: Cancel,
    last: usize,
    nanoseconds: f32,
    sampling: Sampling,
    calls: Arc<AtomicUsize>,
}

impl Canceller {
    fn new(last: usize, nanoseconds: f32, sampling: Sampling) -> Canceller {
        Canceller {
            cancel: Cancel::new(),
            last,
            nanoseconds,
            sampling,
            calls: Arc::default(),
        }
    }

    fn call(&self) -> usize {
        let call = self.calls.fetch_add(1, Ordering::Relaxed) + 1;
        if call == self.last {
            self.cancel.cancel();
        }
        call
    }

    /// Runs the kernel on a block of 128 x 128 pixels; gives the calls and the columns that were kept.
    fn run(&self) -> (usize, usize) {
        let position = Field::position(Domain::Plane);
        let field = Field::kernel(&"test".into(), Arc::new(self.clone()), vec![position]);
        let target = yosegi::engine::FlatPiece::new([128, 128], [128.0, 128.0]);
        let kept = Kept::default();
        let context = RunContext {
            level: fearless_simd::Level::new(),
            cache: Some(&kept),
            filtering: true,
            cancel: Some(&self.cancel),
        };
        let program = Program::compile(&[field]);
        let grid = PixelGrid::tile([0, 0], [128, 128], program.margin());
        let target = &target;
        let samples = Samples::Grid { target, grid };
        program.run(&samples, &mut Scratch::default(), &context);
        (
            self.calls.load(Ordering::Relaxed),
            kept.0.lock().unwrap().len(),
        )
    }
}

impl Kernel for Canceller {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("canceller");
    }

    fn width(&self) -> usize {
        1
    }

    fn sampling(&self) -> Sampling {
        self.sampling
    }

    fn nanoseconds(&self) -> f32 {
        self.nanoseconds
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        self.call();
        block.outputs[0].copy_from_slice(block.inputs[0].values);
    }
}

#[derive(Default)]
struct Kept(Mutex<Vec<Key>>);

impl ColumnCache for Kept {
    fn get(&self, _: &Key) -> Option<Columns> {
        None
    }

    fn put(&self, _: &str, key: Key, _: Columns, _: f64) {
        self.0.lock().unwrap().push(key);
    }
}

#[test]
fn a_dear_kernel_ends_with_its_piece_and_is_not_remembered() {
    // 128 x 128 samples in pieces of 1024, about 2 ms each.
    let slow = 1950.0;
    let whole = Canceller::new(0, slow, Sampling::Filtered);
    assert_eq!(whole.run(), (16, 1));
    let stopped = Canceller::new(3, slow, Sampling::Filtered);
    assert_eq!(stopped.run(), (3, 0));
    // At the last piece there is nothing left to stop, and the columns could be kept; they are not.
    let late = Canceller::new(16, slow, Sampling::Filtered);
    assert_eq!(late.run(), (16, 0));
}

#[test]
fn supersampling_ends_with_its_block_of_pixels() {
    // The block itself, then 16 samples in each pixel, 128 pixels at once.
    let whole = Canceller::new(0, 1.0, Sampling::Supersampled);
    assert_eq!(whole.run(), (1 + 128, 0));
    let stopped = Canceller::new(5, 1.0, Sampling::Supersampled);
    assert_eq!(stopped.run(), (5, 0));
}

/// What the builds of `slow` tell of their steps.
static SCENE: Mutex<Option<Canceller>> = Mutex::new(None);

fn scene() -> Canceller {
    SCENE.lock().unwrap().clone().unwrap()
}

/// A structure that takes ten steps to build, of which one may cancel the run.
static SLOW: Kind = Kind {
    name: "slow",
    version: 1,
    about: "Counts its steps.",
    source: "own construction",
    inputs: &[Input::number("value", Unit::One, "A number.")],
    outputs: &[Output::new("pattern", Type::ColourPattern, "A pattern.")],
    example: "",
    build: build_slow,
};

fn build_slow(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    for _ in 0..10 {
        build.go_on()?;
        scene().call();
    }
    let pattern = yosegi::value::ColourPattern {
        colours: vec![[inputs.number("value") as f32; 3]; 2],
        years: 1.0,
        ring_starts: vec![0.0],
        after_end: yosegi::value::AfterEnd::Repeat,
        smooth: true,
    };
    Ok(vec![Value::ColourPattern(Arc::new(pattern))])
}

fn load(recipe: &str) -> Graph {
    let kinds: Vec<&'static Kind> = KINDS.iter().copied().chain([&SLOW]).collect();
    let loaded = load_text_with(&kinds, "slow.ron", recipe, &Settings::default());
    loaded
        .unwrap_or_else(|wrong| panic!("{}", render_all(&wrong)))
        .graph
}

#[test]
fn a_build_that_is_cancelled_is_neither_told_nor_kept_and_nothing_follows_it() {
    let recipe = r##"(
        nodes: {
            "slow": slow(value: 1),
            "look": pattern_lookup(time: 0.5, pattern: "slow"),
            "wood": material(base_color: "look"),
            "plank": slice_cut(of: "wood", cut: end_grain, origin: (0, 0, 0), size: (10, 10)),
        },
        outputs: { "board": maps(of: "plank", pixels: (8, 8)) },
    )"##;
    let graph = load(recipe);
    let engine = Engine::new(Arc::new(Memory::default()), Options::default()).unwrap();
    let run = |last: usize| {
        let canceller = Canceller::new(last, 1.0, Sampling::Filtered);
        *SCENE.lock().unwrap() = Some(canceller.clone());
        let events = Mutex::new(vec![]);
        let result = engine.render(&Render {
            graph: &graph,
            folder: "out".into(),
            only: vec![],
            pixels: None,
            listener: &|event| events.lock().unwrap().push(event),
            cancel: canceller.cancel.clone(),
        });
        let steps = canceller.calls.load(Ordering::Relaxed);
        (
            result.map(|maps| maps.len()),
            steps,
            events.into_inner().unwrap(),
        )
    };
    assert_eq!(
        run(4),
        (Err(RunError::Cancelled), 4, vec![Event::Cancelled])
    );
    // Not taken for a failure of the node: the next run builds it.
    let (result, steps, _) = run(0);
    assert_eq!((result, steps), (Ok(1), 10));
}
