//! From weather to rings: files as they come, the model's known numbers, and rings of real weather.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod model;
mod statistics;
mod weather;

use std::path::Path;
use std::sync::{Arc, Mutex};
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Settings, load_text};
use yosegi::node::{Build, Failure, Inputs, Kind};
use yosegi::nodes::rings::{growth_model, weather as weather_kind};
use yosegi::value::{Climate, FileContents, RingSeries, Value};
use yosegi::world::Memory;

/// The value that a node of a kind gives; its defaults are among what is given.
fn built(
    kind: &'static Kind,
    recipe_seed: u64,
    given: Vec<(&str, Value)>,
) -> Result<Value, Failure> {
    let mut values = vec![None; kind.inputs.len()];
    for (name, value) in given {
        values[kind.input(name).unwrap().0] = Some(value);
    }
    let build = Build {
        node: &Arc::from("test"),
        seed: recipe_seed,
        cancel: None,
    };
    Ok((kind.build)(&Inputs::new(kind, &values), &build)?.remove(0))
}

/// The climate that a file holds.
fn read(file: impl Into<Vec<u8>>, given: &[(&str, Value)]) -> Result<Arc<Climate>, Failure> {
    let file = FileContents {
        path: "weather.txt".into(),
        bytes: file.into().into(),
    };
    let mut values = vec![
        ("file", Value::File(file)),
        ("longest_gap", Value::Whole(36)),
    ];
    values.extend(given.iter().cloned());
    match built(&weather_kind::KIND, 0, values)? {
        Value::Climate(climate) => Ok(climate),
        other => panic!("found a {}", other.type_name()),
    }
}

/// The rings of a climate with the defaults, but for what is given.
fn grown(
    climate: &Arc<Climate>,
    recipe_seed: u64,
    given: &[(&str, Value)],
) -> Result<Arc<RingSeries>, Failure> {
    let mut values = vec![
        ("climate", Value::Climate(Arc::clone(climate))),
        ("temperature", Value::Pair([4.0, 14.0])),
        ("moisture", Value::Pair([0.02, 0.3])),
        ("window", Value::Pair([1.0, 12.0])),
        ("sunshine", Value::Toggle(true)),
        ("reserve", Value::Number(0.3)),
        ("seed", Value::Whole(0)),
    ];
    values.extend(given.iter().cloned());
    match built(&growth_model::KIND, recipe_seed, values)? {
        Value::RingSeries(series) => Ok(series),
        other => panic!("found a {}", other.type_name()),
    }
}

/// What a recipe with one `weather` of these inputs warns of when it is checked.
fn warned(file: impl Into<Vec<u8>>, inputs: &str) -> Vec<String> {
    let world = Memory::default();
    world.insert(Path::new("recipes/weather.txt"), file.into());
    let recipe = format!("(nodes: {{ \"sky\": weather(file: \"weather.txt\", {inputs}) }})");
    let graph = load_text("recipes/recipe.ron", recipe, &Settings::default())
        .unwrap_or_else(|wrong| panic!("{}", yosegi::diagnostics::render_all(&wrong)))
        .graph;
    let told = Mutex::new(vec![]);
    let listener = |event: Event| {
        if let Event::Warning { message, .. } = event {
            told.lock().unwrap().push(message);
        }
    };
    let engine = Engine::new(Arc::new(world), Options::default()).unwrap();
    let checked = engine.check(&Render {
        graph: &graph,
        folder: "out".into(),
        only: vec![],
        pixels: None,
        listener: &listener,
        cancel: Cancel::new(),
    });
    checked.unwrap();
    told.into_inner().unwrap()
}

fn project_file(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

fn oxford() -> Arc<Climate> {
    read(project_file("assets/weather/oxforddata.txt"), &[]).unwrap()
}

fn tokyo() -> Arc<Climate> {
    let name = "assets/weather/tokyo_monthly_1961_2017.csv";
    read(project_file(name), &[]).unwrap()
}

const SITE: &str = "tests/data/weather/vslite_site3.csv";

fn site() -> Arc<Climate> {
    read(project_file(SITE), &[]).unwrap()
}

/// The widths of the rings in mm.
fn widths(series: &RingSeries) -> Vec<f64> {
    let mut before = 0.0;
    let width = |radius: f64| radius - std::mem::replace(&mut before, radius);
    series.radii().map(width).collect()
}
