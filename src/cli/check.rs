//! `yosegi check`: what is wrong with recipes.

use super::{Exit, RecipeArguments, Recipes, report};

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    recipes: Recipes,
    #[command(flatten)]
    recipe: RecipeArguments,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let settings = arguments.recipe.settings();
    let mut worst = Exit::Done;
    for path in &arguments.recipes.recipes {
        match report::load_recipe(path, &settings, arguments.recipe.json) {
            Ok(graph) if !arguments.recipe.json => report::line(&format!(
                "{}: {}, {}, nothing wrong",
                path.display(),
                count(graph.by_name.len(), "node"),
                count(graph.outputs.len(), "output")
            )),
            Ok(_) => {}
            Err(exit) => worst = worst.max(exit),
        }
    }
    worst
}

/// A number of things, in words that fit it.
fn count(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}
