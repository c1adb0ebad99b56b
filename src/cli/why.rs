//! `yosegi why`: what a render would do with a node, and why.

use super::listen::Listen;
use super::options::{self, SizeArguments, StoreArguments};
use super::{Exit, RecipeArguments, report};
use std::path::PathBuf;
use yosegi::engine::{Cancel, Explained, Render, Why};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The recipe.
    #[arg(value_name = "RECIPE")]
    recipe_path: PathBuf,
    /// A node or an output of it.
    node: String,
    /// Folder of the maps, as for `render`.
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    output: PathBuf,
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    size: SizeArguments,
    #[command(flatten)]
    store: StoreArguments,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let json = arguments.recipe.json;
    let settings = arguments.recipe.settings();
    let graph = match report::load_recipe(&arguments.recipe_path, &settings, json) {
        Ok(graph) => graph,
        Err(exit) => return exit,
    };
    let engine = match options::start(options::once(&arguments.size, &arguments.store)) {
        Ok(engine) => engine,
        Err(exit) => return exit,
    };
    let request = Render {
        graph: &graph,
        folder: arguments.output.clone(),
        only: vec![],
        pixels: arguments.size.size,
        listener: &Listen::new(json),
        cancel: Cancel::new(),
    };
    match engine.why(&request, &arguments.node) {
        Ok(why) if json => report::json(&why),
        Ok(why) => print(&why),
        Err(error) => return report::run_error(&error, json),
    }
    Exit::Done
}

fn print(why: &Why) {
    report::line(&sentence(&why.of));
    if let Some(first) = why.first_cause.as_ref().filter(|first| **first != why.of) {
        report::line(&format!("the first cause: {}", sentence(first)));
    }
    if !why.earlier_run {
        report::line("nothing is known of an earlier run of this recipe with this store");
    }
    group("read by the outputs", &why.outputs);
    group("it depends on", &why.inputs);
}

fn group(title: &str, all: &[Explained]) {
    if all.is_empty() {
        return;
    }
    report::line(&format!("\n{title}"));
    all.iter()
        .for_each(|explained| report::line(&format!("  {}", sentence(explained))));
}

/// "`time` (growth_field) is evaluated: input `elongation` changed: 420 -> 430".
fn sentence(explained: &Explained) -> String {
    let cause = explained.cause.as_ref();
    format!(
        "`{}` ({}) {}{}",
        explained.name,
        explained.kind,
        explained.fate,
        cause.map(|cause| format!(": {cause}")).unwrap_or_default()
    )
}
