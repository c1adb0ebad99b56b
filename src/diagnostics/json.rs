//! Diagnostics as JSON, for programs.

use super::{Code, Diagnostic, Position, Severity};
use serde::Serialize;

/// What one line of JSON holds; the names of the fields never change.
#[derive(Serialize)]
struct Line<'a> {
    code: Code,
    severity: &'static str,
    message: &'a str,
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    end: Option<End>,
    node: Option<&'a str>,
    expected: Option<&'a str>,
    found: Option<&'a str>,
    nearest: &'a [String],
    hints: &'a [String],
}

/// Where the place to blame ends: the first character behind it.
#[derive(Serialize)]
struct End {
    line: usize,
    column: usize,
}

/// The diagnostic as one line of JSON; what it does not have is `null`.
pub fn render_json(diagnostic: &Diagnostic) -> String {
    let place = diagnostic.source.as_ref().zip(diagnostic.label.as_ref());
    let start = place.map(|(source, label)| source.position(label.span.start));
    let end = place.map(|(source, label)| source.position(label.span.end));
    let line = Line {
        code: diagnostic.code,
        severity: diagnostic.severity.name(),
        message: &diagnostic.message,
        file: diagnostic
            .source
            .as_ref()
            .map(|source| source.path.display().to_string()),
        line: start.map(|position| position.line),
        column: start.map(|position| position.column),
        end: end.map(|Position { line, column }| End { line, column }),
        node: diagnostic.node.as_deref(),
        expected: diagnostic.expected.as_deref(),
        found: diagnostic.found.as_deref(),
        nearest: &diagnostic.nearest,
        hints: &diagnostic.hints,
    };
    serde_json::to_string(&line).expect("text and numbers always have a JSON form")
}

impl Severity {
    /// The name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
        }
    }
}
