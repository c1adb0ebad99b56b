//! `yosegi render`: recipes into maps.

use super::listen::Listen;
use super::options::{self, EngineArguments, SizeArguments, StoreArguments};
use super::{Exit, RecipeArguments, Recipes, report, signals};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use yosegi::engine::{Cancel, Engine, Options, Render};

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    pub(super) recipes: Recipes,
    /// Folder for the maps; with several recipes each gets a folder in it.
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    output: PathBuf,
    #[command(flatten)]
    pub(super) size: SizeArguments,
    /// Only this output; may be given several times.
    #[arg(long, value_name = "OUTPUT")]
    pub(super) only: Vec<String>,
    #[command(flatten)]
    pub(super) recipe: RecipeArguments,
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
    let signals = signals::listen(move || switch.cancel());
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
        if let Some(exit) = signals.exit() {
            return exit;
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
            announce(maps.into_iter().map(|map| map.path), json);
            if listener.was_up_to_date() && !json {
                report::note(&format!("{} is up to date", recipe.display()));
            }
            Exit::Done
        }
        Err(error) => {
            announce(listener.placed(), json);
            report::run_error(&error, json)
        }
    }
}

/// Names the maps that are in place.
fn announce(maps: impl IntoIterator<Item = PathBuf>, json: bool) {
    if !json {
        maps.into_iter()
            .for_each(|map| report::line(&map.display().to_string()));
    }
}

/// The folder for the maps; of several recipes each has one of its own, since outputs may share names.
pub(super) fn folder_of(arguments: &Arguments, recipe: &Path) -> PathBuf {
    match recipe.file_stem() {
        Some(stem) if arguments.recipes.recipes.len() > 1 => arguments.output.join(stem),
        _ => arguments.output.clone(),
    }
}

/// Refuses recipes that would put their maps into one folder, where they could replace each other's.
fn refuse_shared_folders(arguments: &Arguments) -> Result<(), String> {
    let mut taken = BTreeMap::new();
    for recipe in &arguments.recipes.recipes {
        let folder = folder_of(arguments, recipe);
        if let Some(other) = taken.insert(folder.clone(), recipe) {
            let (other, recipe) = (other.display(), recipe.display());
            return Err(format!(
                "the maps of `{other}` and of `{recipe}` would both go to `{}`: name each recipe once, \
                 and recipes with equal file names in calls of their own",
                folder.display()
            ));
        }
    }
    Ok(())
}

/// How an engine works for these arguments.
///
/// # Errors
/// If two recipes would share a folder, or if this machine lacks the vector instructions that are asked for.
pub(super) fn engine_options(arguments: &Arguments) -> Result<Options, String> {
    refuse_shared_folders(arguments)?;
    Ok(Options {
        threads: arguments.engine.threads.map(usize::from),
        tile: arguments.tile,
        level: arguments.engine.level()?,
        verify: arguments.verify_cache,
        ..options::once(&arguments.size, &arguments.store)
    })
}
