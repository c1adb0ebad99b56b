//! What the benchmark paints: fields as recipes make them, on a quarter-sawn cut through the tree.

use std::sync::Arc;
use yosegi::engine::{Engine, Options};
use yosegi::field::{Field, Target};
use yosegi::graph::{Settings, load};
use yosegi::key::{Key, KeyHasher};
use yosegi::node::{Build, Inputs};
use yosegi::value::{AfterEnd, ColourPattern, Value};
use yosegi::world::Memory;

/// A plane 400 mm wide and high through the axis of a trunk, slightly turned.
#[derive(Clone, Copy)]
pub(crate) struct Cut {
    pub(crate) pixels: u32,
}

impl Target for Cut {
    fn key(&self) -> Key {
        KeyHasher::new("bench cut", 1)
            .whole(i64::from(self.pixels))
            .finish()
    }

    fn pixels(&self) -> [u32; 2] {
        [self.pixels; 2]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        let scale = 400.0 / f64::from(self.pixels);
        for (index, (u, v)) in (0i32..).zip(u.iter_mut().zip(v)) {
            let across = (x + f64::from(index) * step) * scale - 200.0;
            (*u, *v) = (across as f32, (0.1 * across) as f32);
        }
        w.fill((1400.0 - y * scale) as f32);
    }
}

const BRANCHES: &str = "[
    (at: 900, direction: (1, 0.2, 0.5), half_width: 11, at_distance: 90, length: 400),
    (at: 1150, direction: (-1, 0.4, 0.4), half_width: 9, at_distance: 90, length: 400),
    (at: 1300, direction: (0.2, 1, 0.6), half_width: 10, at_distance: 90, length: 400),
]";

/// The growth time of a tree with so many nodes, by one of the models of skeletons.
pub(crate) fn time(kind: &str, nodes: usize) -> Field {
    let node = |index: usize| {
        let share = index as f64 / (nodes - 1) as f64;
        let (x, y) = (25.0 * libm::sin(9.0 * share), 18.0 * libm::cos(7.0 * share));
        format!("({x}, {y}, {})", 2400.0 * share)
    };
    let trunk: Vec<String> = (0..nodes).map(node).collect();
    let recipe = format!(
        r#""tree": skeleton(trunk: [{}], branches: {BRANCHES}),
        "time": {kind}(skeleton: "tree", elongation: 420, thickening: 2.4),"#,
        trunk.join(", ")
    );
    field(&recipe, "time.time")
}

/// The growth time of a tree with so many burls, by virtual energy.
pub(crate) fn energy(burls: usize) -> Field {
    let recipe = format!(
        r#""tree": skeleton(trunk: [(0, 0, 0), (12, 4, 900), (-6, 9, 2400)], branches: {BRANCHES}),
        "rings": ring_series(years: 80, radius: 190),
        "time": virtual_energy(skeleton: "tree", rings: "rings", random_burls: {burls}, burl_heights: (900, 1500), waves: [
            (amplitude: 1.6, length: 26, turns: 2), (amplitude: 0.9, length: 17, turns: -3, phase: 70),
            (amplitude: 0.6, length: 11, turns: 5, phase: 20), (amplitude: 2, length: 140, turns: 1)]),"#
    );
    field(&recipe, "time.time")
}

/// A field of a recipe.
fn field(nodes: &str, name: &str) -> Field {
    let world = Memory::default();
    let path = std::path::Path::new("recipe.ron");
    world.insert(path, format!("(nodes: {{ {nodes} }})"));
    let graph = load(&world, path, &Settings::default())
        .expect("the recipe is right")
        .graph;
    let engine = Engine::new(Arc::new(world), Options::default()).expect("there are threads");
    let fields = engine.fields(&graph, name, &|_: yosegi::engine::Event| {});
    fields.expect("the node can be built").remove(0).field
}

/// The colour at a growth time, as `pattern_lookup` gives it.
pub(crate) fn coloured(time: Field) -> Field {
    let colour = |index: u16| {
        let late = f32::from(index) / 256.0;
        [
            0.7 - 0.4 * late * late,
            0.5 - 0.3 * late,
            0.3 - 0.2 * late * late,
        ]
    };
    let pattern = ColourPattern {
        colours: (0..256).map(colour).collect(),
        years: 1.0,
        ring_starts: vec![0.0],
        after_end: AfterEnd::Repeat,
        smooth: true,
    };
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
    let Some(Value::Field(colour)) = outputs.into_iter().next() else {
        unreachable!("the first output is the colour")
    };
    colour
}
