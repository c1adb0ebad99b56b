//! Regions: literals, files, meshes and fields, against known areas and by the rules of repair.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "regions/cells.rs"]
mod cells;
#[path = "regions/files.rs"]
mod files;
#[path = "regions/literals.rs"]
mod literals;
#[path = "support/node.rs"]
mod node;

use std::path::Path;
use std::sync::{Arc, Mutex};
use yosegi::engine::{Cancel, Engine, Event, Options, Render};
use yosegi::graph::{Settings, load_text};
use yosegi::node::{Failure, Kind};
use yosegi::value::{Region, Value};
use yosegi::world::Memory;

/// What a node of a kind gives; its defaults are among what is given.
fn built(kind: &'static Kind, given: Vec<(&str, Value)>) -> Result<Vec<Value>, Failure> {
    node::built(kind, &node::inputs(kind, &given), 0, None)
}

fn region_of(values: Vec<Value>) -> Arc<Region> {
    match &values[0] {
        Value::Region(region) => Arc::clone(region),
        other => panic!("found a {}", other.type_name()),
    }
}

/// The area of a region in mm², by Gauss's formula about the origin.
fn area(region: &Region) -> f64 {
    let ring = |ring: &[glam::DVec2]| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter()
            .zip(next)
            .map(|(a, b)| (a.x * b.y - a.y * b.x) / 2.0)
            .sum()
    };
    region.rings().map(ring).sum()
}

/// The lowest and the highest coordinates.
fn bounds(region: &Region) -> [glam::DVec2; 2] {
    let corners = region.rings().flatten().copied();
    let none = [glam::DVec2::INFINITY, glam::DVec2::NEG_INFINITY];
    corners.fold(none, |[low, high], at| [low.min(at), high.max(at)])
}

/// What a recipe with these nodes and files warns of, or what is wrong with it.
fn told(files: &[(&str, &str)], nodes: &str) -> Result<Vec<String>, String> {
    let world = Memory::default();
    for (name, text) in files {
        world.insert(Path::new("recipes").join(name), text.as_bytes().to_vec());
    }
    let recipe = format!("(nodes: {{ {nodes} }})");
    let graph = load_text("recipes/recipe.ron", recipe, &Settings::default())
        .map_err(|wrong| yosegi::diagnostics::render_all(&wrong))?
        .graph;
    let warnings = Mutex::new(vec![]);
    let listener = |event: Event| {
        if let Event::Warning { message, .. } = event {
            warnings.lock().unwrap().push(message);
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
    checked.map_err(|error| yosegi::diagnostics::render_all(error.diagnostics()))?;
    Ok(warnings.into_inner().unwrap())
}
