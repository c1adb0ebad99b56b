//! What is said to the user: diagnostics, results, and the exit code that follows from them.

use super::Exit;
use std::io::{self, Write};
use std::path::Path;
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
    let _ = writeln!(io::stderr().lock(), "error: {text}");
}

/// A warning that a node gives while it is built.
pub(super) fn warning_of(node: &str, message: &str) -> String {
    format!("warning: node `{node}`: {message}")
}

/// Prints a line of the result; a closed pipe ends the program quietly.
pub(super) fn line(text: &str) {
    if writeln!(io::stdout().lock(), "{text}").is_err() {
        std::process::exit(Exit::Done as i32);
    }
}
