//! `yosegi render`: recipes into maps.

use super::listen::Listen;
use super::options::{self, EngineArguments, SizeArguments, StoreArguments};
use super::{Exit, RecipeArguments, Recipes, report};
use std::path::{Path, PathBuf};
use yosegi::engine::{Cancel, Engine, Options, Render, RenderedMap};

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    recipes: Recipes,
    /// Folder for the maps; with several recipes each gets a folder in it.
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    output: PathBuf,
    #[command(flatten)]
    size: SizeArguments,
    /// Only this output; may be given several times.
    #[arg(long, value_name = "OUTPUT")]
    only: Vec<String>,
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    engine: EngineArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// Compute everything that the store would give, and compare; what differs is an error and is replaced.
    #[arg(long, conflicts_with = "no_cache")]
    verify_cache: bool,
    /// Side of a tile in pixels; the result is the same.
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u32).range(8..=512))]
    tile: u32,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let cancel = Cancel::new();
    let switch = cancel.clone();
    if let Err(error) = ctrlc::set_handler(move || {
        if switch.is_cancelled() {
            // Asked twice: do not wait for the next tile.
            std::process::exit(Exit::Interrupted as i32);
        }
        switch.cancel();
    }) {
        report::problem(&format!("interrupts will end the program at once: {error}"));
    }
    let options = match engine_options(arguments) {
        Ok(options) => options,
        Err(problem) => {
            report::problem(&problem);
            return Exit::Wrong;
        }
    };
    let engine = match options::start(options) {
        Ok(engine) => engine,
        Err(exit) => return exit,
    };
    let mut worst = Exit::Done;
    for recipe in &arguments.recipes.recipes {
        worst = worst.max(render(arguments, &engine, recipe, &cancel));
        if cancel.is_cancelled() {
            return Exit::Interrupted;
        }
    }
    worst
}

fn render(arguments: &Arguments, engine: &Engine, recipe: &Path, cancel: &Cancel) -> Exit {
    let json = arguments.recipe.json;
    let graph = match report::load_recipe(recipe, &arguments.recipe.settings(), json) {
        Ok(graph) => graph,
        Err(exit) => return exit,
    };
    let listener = Listen::new(json);
    let result = engine.render(&Render {
        graph: &graph,
        folder: folder_of(arguments, recipe),
        only: arguments.only.clone(),
        pixels: arguments.size.size,
        listener: &listener,
        cancel: cancel.clone(),
    });
    listener.finish();
    match result {
        Ok(maps) => {
            announce(&maps, json);
            if listener.was_up_to_date() && !json {
                report::note(&format!("{} is up to date", recipe.display()));
            }
            Exit::Done
        }
        Err(error) => report::run_error(&error, json),
    }
}

fn announce(maps: &[RenderedMap], json: bool) {
    if !json {
        maps.iter()
            .for_each(|map| report::line(&map.path.display().to_string()));
    }
}

/// The folder for the maps; of several recipes each has one of its own, since outputs may share names.
fn folder_of(arguments: &Arguments, recipe: &Path) -> PathBuf {
    match recipe.file_stem() {
        Some(stem) if arguments.recipes.recipes.len() > 1 => arguments.output.join(stem),
        _ => arguments.output.clone(),
    }
}

fn engine_options(arguments: &Arguments) -> Result<Options, String> {
    Ok(Options {
        threads: arguments.engine.threads.map(usize::from),
        tile: arguments.tile,
        level: arguments.engine.level()?,
        verify: arguments.verify_cache,
        ..options::once(&arguments.size, &arguments.store)
    })
}
