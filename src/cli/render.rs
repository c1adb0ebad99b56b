//! `yosegi render`: recipes into maps.

use super::{EngineArguments, Exit, RecipeArguments, Recipes, report};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use yosegi::engine::{Cancel, Engine, Event, Options, Render, RenderedMap};
use yosegi::world::Disk;

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    recipes: Recipes,
    /// Folder for the maps; with several recipes each gets a folder in it.
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    output: PathBuf,
    /// Size of the maps in pixels, instead of what the recipe states.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<[u32; 2]>,
    /// Only this output; may be given several times.
    #[arg(long, value_name = "OUTPUT")]
    only: Vec<String>,
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    engine: EngineArguments,
    /// Neither look into the store of earlier results nor add to it.
    #[arg(long)]
    no_cache: bool,
    /// Folder of the store [default: yosegi in the user's cache folder].
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    cache: Option<PathBuf>,
    /// Side of a tile in pixels; the result is the same.
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u32).range(8..=512))]
    tile: u32,
    /// Most pixels that a map may have.
    #[arg(long, value_name = "N", default_value_t = 1 << 30)]
    max_pixels: u64,
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
    let options = match options(arguments) {
        Ok(options) => options,
        Err(problem) => {
            report::problem(&problem);
            return Exit::Wrong;
        }
    };
    let engine = match Engine::new(Arc::new(Disk), options) {
        Ok(engine) => engine,
        Err(error) => {
            report::problem(&format!("cannot start threads: {error}"));
            return Exit::Files;
        }
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
    let bar = progress_bar(json);
    let listener = |event: Event| hear(&bar, json, &event);
    let result = engine.render(&Render {
        graph: &graph,
        folder: folder_of(arguments, recipe),
        only: arguments.only.clone(),
        pixels: arguments.size,
        listener: &listener,
        cancel: cancel.clone(),
    });
    bar.finish_and_clear();
    match result {
        Ok(maps) => {
            announce(&maps, json);
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

/// A bar on a terminal, nothing elsewhere.
fn progress_bar(json: bool) -> ProgressBar {
    let target = if json {
        ProgressDrawTarget::hidden()
    } else {
        ProgressDrawTarget::stderr()
    };
    let bar = ProgressBar::with_draw_target(Some(0), target);
    let style = ProgressStyle::with_template("{msg:20!} {bar:40} {percent:>3} %  {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

fn hear(bar: &ProgressBar, json: bool, event: &Event) {
    if json && let Ok(text) = serde_json::to_string(event) {
        // Events are not the result: whoever stops listening does not stop the run.
        let _ = writeln!(std::io::stdout().lock(), "{text}");
    }
    let say = |text: String| bar.suspend(|| eprintln!("{text}"));
    match event {
        Event::Progress {
            output,
            done,
            total,
        } => {
            bar.set_length(*total as u64);
            bar.set_position(*done as u64);
            bar.set_message(output.clone());
        }
        // A map that was there already has the faults it was written with.
        Event::MapWritten {
            channel,
            path,
            not_finite,
            clamped,
            ..
        }
        | Event::MapUpToDate {
            channel,
            path,
            not_finite,
            clamped,
            ..
        }
        | Event::MapRestored {
            channel,
            path,
            not_finite,
            clamped,
            ..
        } if !json => {
            if *not_finite > 0 {
                say(format!(
                    "warning: {not_finite} samples of {} are not finite",
                    path.display()
                ));
            }
            if *clamped > 0 {
                say(format!(
                    "warning: {clamped} samples of {} were clamped; widen the range of `{channel}`, or write EXR",
                    path.display()
                ));
            }
        }
        Event::Warning { node, message } if !json => {
            say(report::warning_of(node, message));
        }
        Event::StoreFailed { reason } if !json => {
            say(format!(
                "warning: the store of earlier results cannot be used: {reason}"
            ));
        }
        _ => {}
    }
}

fn options(arguments: &Arguments) -> Result<Options, String> {
    let store = match (&arguments.cache, arguments.no_cache) {
        (Some(folder), _) => Some(folder.clone()),
        (None, true) => None,
        (None, false) => default_store(),
    };
    Ok(Options {
        threads: arguments.engine.threads.map(usize::from),
        tile: arguments.tile,
        level: arguments.engine.level()?,
        // One run has no use for columns of another: each output has samples of its own.
        memory: 0,
        store,
        largest_output: arguments.max_pixels,
        ..Options::default()
    })
}

/// The user's cache folder, by the conventions of the system.
fn default_store() -> Option<PathBuf> {
    let variable = |name: &str| {
        std::env::var_os(name)
            .filter(|it| !it.is_empty())
            .map(PathBuf::from)
    };
    let folder = variable("XDG_CACHE_HOME")
        .filter(|folder| folder.is_absolute())
        .or_else(|| variable("LOCALAPPDATA"))
        .or_else(|| variable("HOME").map(|home| home.join(".cache")))?;
    Some(folder.join("yosegi"))
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| match text.trim().parse() {
        Ok(side) if (1..=65_536).contains(&side) => Ok(side),
        _ => Err(format!(
            "expected a whole number from 1 to 65536, found `{text}`"
        )),
    };
    let (width, height) = text
        .split_once(['x', 'X'])
        .ok_or("expected WxH, for example 1024x512")?;
    Ok([side(width)?, side(height)?])
}
