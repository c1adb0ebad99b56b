//! `yosegi watch`: renders recipes, and again whenever something that they read has changed.

use super::listen::Listen;
use super::{Exit, bytes, options, render, report, signals};
use serde_json::{Value as Json, json};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;
use yosegi::diagnostics::{Diagnostic, render_json};
use yosegi::engine::{Listener, Options};
use yosegi::watch::{self, Followed, Rendered, Stop, Told, Watch};
use yosegi::world::{Disk, abandon_unfinished};

#[derive(clap::Args)]
#[group(skip)]
pub(super) struct Arguments {
    #[command(flatten)]
    render: render::Arguments,
    /// Write a small NAME.preview.png of each changed output first.
    #[arg(long)]
    preview: bool,
    /// Look at the files this often, in milliseconds, instead of waiting for notices of the system.
    #[arg(long, value_name = "MS", value_parser = clap::value_parser!(u64).range(1..=60_000))]
    poll: Option<u64>,
    /// Memory for what can be used again after a change.
    #[arg(long, value_name = "SIZE", default_value = "512MiB", value_parser = bytes::parse)]
    memory: u64,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let options = match render::engine_options(&arguments.render) {
        Ok(options) => options,
        Err(problem) => {
            report::problem(&problem);
            return Exit::Wrong;
        }
    };
    let options = Options {
        memory: usize::try_from(arguments.memory).unwrap_or(usize::MAX),
        // The next save brings the next map: nobody waits for a disk in between.
        durable: false,
        ..options
    };
    let engine = match options::start(options) {
        Ok(engine) => engine,
        Err(exit) => return exit,
    };
    let recipes = &arguments.render.recipes.recipes;
    let followed = recipes.iter().map(|recipe| followed(arguments, recipe));
    let screen = Arc::new(Screen::new(arguments.render.recipe.json));
    let audience = Arc::clone(&screen);
    let watch = Watch::new(
        engine,
        Arc::new(Disk),
        followed.collect(),
        watch::Options {
            preview: arguments.preview,
            poll: arguments.poll.map(Duration::from_millis),
        },
        Arc::new(move |recipe, told| audience.show(recipe, told)),
    );
    let stop = watch.stop();
    screen.stop.get_or_init(|| stop.clone());
    let signals = signals::listen(move || stop.stop());
    let watched = watch.run();
    // A run that could not stop may still be writing.
    abandon_unfinished();
    if let Err(error) = watched {
        report::problem(&format!("cannot start a thread: {error}"));
        return Exit::Files;
    }
    // Without a signal it ends only because nobody reads what it says.
    signals.exit().unwrap_or(Exit::Done)
}

fn followed(arguments: &Arguments, recipe: &Path) -> Followed {
    Followed {
        recipe: recipe.to_owned(),
        folder: render::folder_of(&arguments.render, recipe),
        settings: arguments.render.recipe.settings(),
        only: arguments.render.only.clone(),
        pixels: arguments.render.size.size,
    }
}

/// Shows what happens, as text or as JSON.
struct Screen {
    json: bool,
    /// Of the run that is going on.
    listen: Mutex<Listen>,
    /// Ends the watch when nobody reads what it prints.
    stop: OnceLock<Stop>,
}

impl Screen {
    fn new(json: bool) -> Screen {
        Screen {
            json,
            listen: Mutex::new(Listen::new(json)),
            stop: OnceLock::new(),
        }
    }

    fn show(&self, recipe: &Path, told: Told) {
        if self.json {
            lines(told).into_iter().for_each(|line| print(recipe, line));
        } else {
            self.tell(recipe, told);
        }
        if report::is_unread()
            && let Some(stop) = self.stop.get()
        {
            stop.stop();
        }
    }

    fn tell(&self, recipe: &Path, told: Told) {
        let mut listen = self.listen.lock().unwrap_or_else(PoisonError::into_inner);
        if let Told::Run(event) = told {
            listen.hear(event);
            return;
        }
        listen.finish();
        let placed = listen.placed();
        *listen = Listen::new(false);
        let name = recipe.display();
        match told {
            Told::Run(_) => {}
            Told::Previewed {
                paths,
                milliseconds,
            } => {
                let paths = some_of(&shown(&paths));
                report::line(&format!("{name}: {paths} after {milliseconds:.0} ms"));
            }
            Told::PreviewFailed(diagnostics) => report::diagnostics(&diagnostics, false),
            Told::Rendered(rendered) => {
                report::diagnostics(&rendered.warnings, false);
                report::line(&format!("{name}: {}", sentence(&rendered)));
            }
            Told::Failed(failed) => {
                report::diagnostics(failed.diagnostics(), false);
                if !placed.is_empty() {
                    let paths = some_of(&shown(&placed));
                    report::line(&format!("{name}: {paths} do not depend on that"));
                }
            }
            Told::Waiting(paths) => report::line(&format!(
                "{name}: waiting for a change of {}",
                some_of(&shown(&paths))
            )),
            Told::Polling {
                reason,
                milliseconds,
            } => report::note(&format!(
                "{name}: there are no notices of changes: {reason}; looking every {milliseconds} ms"
            )),
        }
    }
}

fn shown(paths: &[PathBuf]) -> Vec<String> {
    let paths = paths.iter().map(|path| path.display().to_string());
    paths.collect()
}

/// `43 ms, wrote out/board_height.png, ran bar, board, reused tree and 3 more`.
fn sentence(rendered: &Rendered) -> String {
    let mut parts = vec![format!("{:.0} ms", rendered.times.total)];
    let mut say = |verb: &str, names: &[String]| {
        if !names.is_empty() {
            parts.push(format!("{verb} {}", some_of(names)));
        }
    };
    say("wrote", &shown(&rendered.written));
    say("restored", &shown(&rendered.restored));
    say("ran", &rendered.ran);
    say("reused", &rendered.reused);
    if rendered.written.is_empty() && rendered.restored.is_empty() {
        parts.push("nothing changed".to_owned());
    }
    parts.join(", ")
}

/// The first few of some names.
fn some_of(names: &[String]) -> String {
    const FEW: usize = 3;
    let few = names.iter().take(FEW).cloned().collect::<Vec<_>>();
    match names.len().saturating_sub(FEW) {
        0 => few.join(" "),
        more => format!("{} and {more} more", few.join(" ")),
    }
}

/// What is told, as objects.
fn lines(told: Told) -> Vec<Json> {
    match told {
        // A path that is not Unicode cannot be told.
        Told::Run(event) => serde_json::to_value(event).into_iter().collect(),
        Told::Previewed {
            paths,
            milliseconds,
        } => {
            vec![
                json!({ "event": "previewed", "paths": shown(&paths), "milliseconds": milliseconds }),
            ]
        }
        Told::PreviewFailed(diagnostics) => {
            let diagnostics = diagnostics.iter().map(object);
            diagnostics
                .chain([json!({ "event": "preview_failed" })])
                .collect()
        }
        Told::Rendered(rendered) => {
            let warnings = rendered.warnings.iter().map(object);
            let mut done = json!(rendered);
            done["event"] = json!("rendered");
            warnings.chain([done]).collect()
        }
        Told::Failed(failed) => {
            let diagnostics = failed.diagnostics().iter().map(object);
            diagnostics.chain([json!({ "event": "failed" })]).collect()
        }
        Told::Waiting(paths) => vec![json!({ "event": "waiting", "paths": shown(&paths) })],
        Told::Polling {
            reason,
            milliseconds,
        } => {
            vec![json!({ "event": "polling", "reason": reason, "milliseconds": milliseconds })]
        }
    }
}

/// As `render --json` prints it.
fn object(diagnostic: &Diagnostic) -> Json {
    serde_json::from_str(&render_json(diagnostic)).unwrap_or_default()
}

fn print(recipe: &Path, mut line: Json) {
    if let Json::Object(fields) = &mut line {
        fields.insert("recipe".to_owned(), json!(recipe.to_string_lossy()));
    }
    report::json(&line);
}
