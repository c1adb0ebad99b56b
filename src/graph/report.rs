//! Collects what is wrong with a recipe and the compounds it uses.

use super::Origin;
use crate::cancel::Cancel;
use crate::diagnostics::{Code, Diagnostic, Severity, SourceFile, Span, Use};
use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::Arc;

/// Mistakes that are kept; beyond, a file is not worth more memory.
const LIMIT: usize = 2000;

/// Parts of expressions that compounds pass on, in a whole recipe: each level could double them.
pub(super) const PASSED: usize = 1_000_000;

/// What is wrong with a recipe and the compounds it uses.
#[derive(Debug)]
pub(super) struct Report {
    /// The text that is being looked at.
    pub(super) source: Arc<SourceFile>,
    /// Whether the caller lets files be anywhere.
    pub(super) allow_outside: bool,
    /// The use of the compound that is being looked at.
    uses: Option<Arc<Use>>,
    /// Mistakes in compounds: the second use of one has the same.
    seen: HashSet<(PathBuf, Code, usize, String)>,
    diagnostics: Vec<Diagnostic>,
    left_out: bool,
    /// Parts of expressions that the uses of compounds have passed on.
    passed: usize,
    /// Ends the reading.
    pub(super) cancel: Cancel,
}

impl Report {
    /// Nothing is wrong yet.
    pub(super) fn new(source: &Arc<SourceFile>) -> Report {
        Report {
            source: Arc::clone(source),
            allow_outside: false,
            uses: None,
            seen: HashSet::new(),
            diagnostics: vec![],
            left_out: false,
            passed: 0,
            cancel: Cancel::new(),
        }
    }

    /// Goes on where a node comes from.
    pub(super) fn enter(&mut self, origin: &Origin) {
        self.source = Arc::clone(&origin.source);
        self.uses.clone_from(&origin.uses);
    }

    /// An error at a place, to be completed and then added.
    pub(super) fn error(
        &self,
        code: Code,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::error(code, message)
            .at(&self.source, span, label)
            .used_by(self.uses.clone())
    }

    /// A warning at a place, to be completed and then added.
    pub(super) fn warning(
        &self,
        code: Code,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::warning(code, message)
            .at(&self.source, span, label)
            .used_by(self.uses.clone())
    }

    /// Takes over what is wrong with the file of a compound, of which `uses` is a use.
    pub(super) fn absorb(&mut self, other: Report, uses: &Option<Arc<Use>>) {
        for diagnostic in other.diagnostics {
            self.add(diagnostic.used_by(uses.clone()));
        }
        self.left_out |= other.left_out;
    }

    /// Keeps a diagnostic.
    pub(super) fn add(&mut self, diagnostic: Diagnostic) {
        if self.is_repeated(&diagnostic) {
            return;
        }
        if self.diagnostics.len() < LIMIT {
            self.diagnostics.push(diagnostic);
        } else {
            self.left_out = true;
        }
    }

    /// Whether another use of the same compound has had the same mistake.
    fn is_repeated(&mut self, diagnostic: &Diagnostic) -> bool {
        let (Some(_), Some(source), Some(label)) =
            (&diagnostic.uses, &diagnostic.source, &diagnostic.label)
        else {
            return false;
        };
        let path = source.path.clone();
        let mistake = (
            path,
            diagnostic.code,
            label.span.start,
            diagnostic.message.clone(),
        );
        !self.seen.insert(mistake)
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

    /// Counts parts of expressions that compounds pass on; false if there are too many.
    pub(super) fn may_pass(&mut self, parts: usize) -> bool {
        self.passed = self.passed.saturating_add(parts);
        self.passed <= PASSED
    }

    /// Whether nothing more is kept, or wanted.
    pub(super) fn is_full(&self) -> bool {
        self.left_out || self.cancel.is_cancelled()
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
