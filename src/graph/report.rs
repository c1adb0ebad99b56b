//! Collects what is wrong with one text.

use crate::diagnostics::{Code, Diagnostic, Severity, SourceFile, Span};
use std::collections::HashSet;
use std::sync::Arc;

/// Mistakes that are kept; beyond, a file is not worth more memory.
const LIMIT: usize = 2000;

/// What is wrong with one text.
#[derive(Debug)]
pub(super) struct Report {
    /// The text.
    pub(super) source: Arc<SourceFile>,
    diagnostics: Vec<Diagnostic>,
    left_out: bool,
}

impl Report {
    /// Nothing is wrong yet.
    pub(super) fn new(source: &Arc<SourceFile>) -> Report {
        Report {
            source: Arc::clone(source),
            diagnostics: vec![],
            left_out: false,
        }
    }

    /// An error at a place, to be completed and then added.
    pub(super) fn error(
        &self,
        code: Code,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::error(code, message).at(&self.source, span, label)
    }

    /// A warning at a place, to be completed and then added.
    pub(super) fn warning(
        &self,
        code: Code,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::warning(code, message).at(&self.source, span, label)
    }

    /// Keeps a diagnostic.
    pub(super) fn add(&mut self, diagnostic: Diagnostic) {
        if self.diagnostics.len() < LIMIT {
            self.diagnostics.push(diagnostic);
        } else {
            self.left_out = true;
        }
    }

    /// Leaves out all but the first that was found on each line: what is read behind a mistake is often
    /// misread.
    pub(super) fn keep_first_of_lines(&mut self) {
        let mut lines = HashSet::new();
        self.diagnostics.retain(|one| {
            let start = one.label.as_ref().map_or(0, |label| label.span.start);
            lines.insert(self.source.line_of(start))
        });
    }

    /// Whether nothing more is kept.
    pub(super) fn is_full(&self) -> bool {
        self.left_out
    }

    /// Whether there is an error among the diagnostics.
    pub(super) fn has_errors(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|one| one.severity == Severity::Error)
    }

    /// The diagnostics, sorted by place.
    pub(super) fn finish(mut self) -> Vec<Diagnostic> {
        if self.left_out {
            let message = format!("there are more than {LIMIT} mistakes; the rest is left out");
            self.diagnostics
                .push(Diagnostic::error(Code::TooLarge, message));
        }
        crate::diagnostics::sort(&mut self.diagnostics);
        self.diagnostics
    }
}
