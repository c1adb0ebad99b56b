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
                "{}: {} nodes, {} outputs, nothing wrong",
                path.display(),
                graph.by_name.len(),
                graph.outputs.len()
            )),
            Ok(_) => {}
            Err(exit) => worst = worst.max(exit),
        }
    }
    worst
}
