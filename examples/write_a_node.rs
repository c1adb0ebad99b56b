//! Adds a kind of node from outside the crate: `radial_bands`, light and dark bands around the z axis.
//!
//! `cargo run --release --example write_a_node` reads a recipe that uses it next to Yosegi's own kinds, and
//! prints its values and the material's colour at four points. `render_from_rust` shows how to render one.

use std::error::Error;
use std::sync::Arc;
use yosegi::diagnostics::render_all;
use yosegi::engine::{Engine, Event, Options};
use yosegi::field::{Block, Field, Kernel, Sampling};
use yosegi::graph::{Settings, load_text_with};
use yosegi::key::KeyHasher;
use yosegi::node::{Build, Failure, Input, Inputs, Kind, Output};
use yosegi::nodes::KINDS;
use yosegi::value::{Domain, Type, Unit, Value};
use yosegi::world::Disk;

/// The declaration: the recipe reader, range checks and keys all follow from it.
static RADIAL_BANDS: Kind = Kind {
    name: "radial_bands",
    version: 1,
    about: "Bands around the z axis: 0 in even ones, 1 in odd ones.",
    source: "own construction",
    inputs: &[Input::number("width", Unit::Millimetre, "Width of a band.")
        .default("5")
        .range(0.01, 1000.0)],
    outputs: &[Output::field("band", Type::Number(Unit::One), "0 or 1.").on(Domain::Solid)],
    example: r#"(nodes: { "example": radial_bands(width: 4) })"#,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let width = inputs.number("width");
    let position = Field::position(Domain::Solid);
    Ok(vec![Value::Field(
        build.kernel(Bands { width }, vec![position]),
    )])
}

/// The maths: three columns of position in, one column out.
#[derive(Debug)]
struct Bands {
    width: f64,
}

impl Kernel for Bands {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("radial_bands").whole(1).number(self.width);
    }

    fn width(&self) -> usize {
        1
    }

    // A step is not linear, so the engine takes several samples where the position varies.
    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let (x, y) = (block.inputs[0].values, block.inputs[1].values);
        let bands_per_mm = (1.0 / self.width) as f32;
        for ((band, x), y) in block.outputs[0].iter_mut().zip(x).zip(y) {
            let number = ((x * x + y * y).sqrt() * bands_per_mm).floor();
            *band = number - 2.0 * (0.5 * number).floor();
        }
    }
}

const RECIPE: &str = r##"(
    nodes: {
        "bands": radial_bands(width: 4),
        "colour": mix(a: "#e8c79a", b: "#7a4524", amount: "bands"),
        "wood": material(base_color: "colour"),
    },
)"##;

fn main() -> Result<(), Box<dyn Error>> {
    let kinds: Vec<&'static Kind> = KINDS.iter().copied().chain([&RADIAL_BANDS]).collect();
    let loaded = load_text_with(&kinds, "radial_bands.ron", RECIPE, &Settings::default())
        .map_err(|errors| render_all(&errors))?;
    let engine = Engine::new(Arc::new(Disk), Options::default())?;
    let quiet = |_: Event| {};

    let points = [1.0, 5.0, 9.0, 13.0].map(|x| [x, 0.0, 0.0]);
    for name in ["bands", "wood.base_color"] {
        let fields = engine
            .fields(&loaded.graph, name, &quiet)
            .map_err(|error| render_all(error.diagnostics()))?;
        let values = &engine.sample(&fields, &points)[0];
        for (column, values) in fields[0].columns.iter().zip(values) {
            println!("{column} at x = 1, 5, 9, 13: {values:?}");
        }
    }
    Ok(())
}
