//! `yosegi check`: what is wrong with recipes.

use super::listen::Listen;
use super::options::{self, SizeArguments, StoreArguments};
use super::{Exit, RecipeArguments, Recipes, report};
use std::path::Path;
use yosegi::engine::{Cancel, Engine, Render};
use yosegi::graph::Graph;

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    recipes: Recipes,
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    size: SizeArguments,
    #[command(flatten)]
    store: StoreArguments,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let engine = match options::start(options::once(&arguments.size, &arguments.store)) {
        Ok(engine) => engine,
        Err(exit) => return exit,
    };
    let recipes = arguments.recipes.recipes.iter();
    let exits = recipes.map(|path| check(arguments, &engine, path));
    exits.max().unwrap_or(Exit::Done)
}

fn check(arguments: &Arguments, engine: &Engine, path: &Path) -> Exit {
    let json = arguments.recipe.json;
    let graph = match report::load_recipe(path, &arguments.recipe.settings(), json) {
        Ok(graph) => graph,
        Err(exit) => return exit,
    };
    let request = Render {
        graph: &graph,
        folder: Default::default(),
        only: vec![],
        pixels: arguments.size.size,
        listener: &Listen::new(json),
        cancel: Cancel::new(),
    };
    if let Err(error) = engine.check(&request) {
        return report::run_error(&error, json);
    }
    if !json {
        report::line(&format!(
            "{}: {}, nothing wrong",
            path.display(),
            summary(&graph)
        ));
    }
    Exit::Done
}

/// What the recipe or the compound has, in numbers.
fn summary(graph: &Graph) -> String {
    let nodes = |inputs| count(graph.by_name.len() - inputs, "node");
    match graph.interface {
        None => format!("{}, {}", nodes(0), count(graph.outputs.len(), "output")),
        // One node stands for the inputs.
        Some(kind) => format!(
            "a compound with {}, {}, {}",
            // The seed that every compound has is not declared.
            count(kind.inputs.len() - 1, "input"),
            nodes(1),
            count(kind.outputs.len(), "output")
        ),
    }
}

/// A number of things, in words that fit it.
fn count(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}
