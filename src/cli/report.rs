//! What is said to the user: diagnostics, results, and the exit code that follows from them.

use super::Exit;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use yosegi::diagnostics::{Code, Diagnostic, render_all, render_all_styled, render_json};
use yosegi::engine::RunError;
use yosegi::graph::{Graph, Settings, load};
use yosegi::world::Disk;

/// Loads a recipe; says what is wrong with it.
///
/// # Errors
/// The exit code that follows.
pub(super) fn load_recipe(path: &Path, settings: &Settings, json: bool) -> Result<Graph, Exit> {
    match load(&Disk, path, settings) {
        Ok(loaded) => {
            diagnostics(&loaded.warnings, json);
            Ok(loaded.graph)
        }
        Err(errors) => {
            diagnostics(&errors, json);
            Err(exit_of_load(&errors))
        }
    }
}

fn exit_of_load(errors: &[Diagnostic]) -> Exit {
    match errors.first().map(|error| error.code) {
        Some(Code::FileNotRead) if errors.len() == 1 => Exit::Files,
        Some(Code::TooLarge) if errors.len() == 1 => Exit::Limit,
        _ => Exit::Wrong,
    }
}

/// Says why a run ended; gives the exit code.
pub(super) fn run_error(error: &RunError, json: bool) -> Exit {
    diagnostics(error.diagnostics(), json);
    match error {
        RunError::Nodes(_) => Exit::NodeFailed,
        RunError::Files(_) => Exit::Files,
        RunError::Limit(_) => Exit::Limit,
        RunError::Request(_) => Exit::Wrong,
        RunError::Cancelled => Exit::Interrupted,
    }
}

/// Says what is wrong: as text to stderr, or as JSON to stdout.
pub(super) fn diagnostics(list: &[Diagnostic], json: bool) {
    if list.is_empty() {
        return;
    }
    if json {
        list.iter()
            .for_each(|diagnostic| line(&render_json(diagnostic)));
        return;
    }
    let stderr = anstream::stderr();
    let is_terminal = io::IsTerminal::is_terminal(&io::stderr());
    let text = if is_terminal {
        render_all_styled(list)
    } else {
        render_all(list)
    };
    // Nobody is left to tell that stderr is closed.
    let _ = writeln!(stderr.lock(), "{}", text.trim_end());
}

/// Says something about the call itself.
pub(super) fn problem(text: &str) {
    note(&format!("error: {text}"));
}

/// Prints a line to stderr.
pub(super) fn note(text: &str) {
    // Nobody is left to tell that stderr is closed.
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// What kept the first line from being printed that was not.
static NOT_PRINTED: OnceLock<String> = OnceLock::new();

/// Whether the reader of stdout has gone.
static UNREAD: AtomicBool = AtomicBool::new(false);

/// Whether nobody reads stdout any more.
pub(super) fn is_unread() -> bool {
    UNREAD.load(Ordering::Relaxed)
}

/// Prints a line of the result. A reader that has seen enough is no failure, and does not stop the
/// program; any other fault is told by [`at_the_end`].
pub(super) fn line(text: &str) {
    match writeln!(io::stdout().lock(), "{text}") {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            NOT_PRINTED.get_or_init(|| error.to_string());
        }
        Err(_) => UNREAD.store(true, Ordering::Relaxed),
        Ok(()) => {}
    }
}

/// Prints a result as JSON, on one line.
pub(super) fn json(result: &impl Serialize) {
    match serde_json::to_string(result) {
        Ok(text) => line(&text),
        Err(error) => {
            NOT_PRINTED.get_or_init(|| error.to_string());
        }
    }
}

/// The exit code of the program, given that of the command: a result that could not be printed is a
/// fault of files.
pub(super) fn at_the_end(exit: Exit) -> Exit {
    let Some(error) = NOT_PRINTED.get() else {
        return exit;
    };
    problem(&format!("cannot write the result: {error}"));
    if exit == Exit::Done {
        Exit::Files
    } else {
        exit
    }
}
