//! Diagnostics as JSON, for programs.

use super::{Code, Diagnostic, Position, Severity, Use};
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
    used_by: Vec<UsedBy<'a>>,
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

/// A use of the compound that holds the place, the innermost first.
#[derive(Serialize)]
struct UsedBy<'a> {
    file: String,
    line: usize,
    column: usize,
    node: &'a str,
    kind: &'a str,
}

impl<'a> UsedBy<'a> {
    fn new(one: &'a Use) -> UsedBy<'a> {
        let Position { line, column } = one.source.position(one.span.start);
        UsedBy {
            file: one.source.path.display().to_string(),
            line,
            column,
            node: &one.node,
            kind: &one.kind,
        }
    }
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
        used_by: diagnostic
            .uses
            .iter()
            .flat_map(|uses| uses.chain())
            .map(UsedBy::new)
            .collect(),
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
