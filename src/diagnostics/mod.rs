//! What is wrong with a recipe or a run: one type for the terminal, for JSON and for tests.

mod codes;
mod excerpt;
mod json;
mod nearest;
mod render;
mod source;

pub use codes::Code;
pub(crate) use excerpt::is_unsafe;
pub use json::render_json;
pub use nearest::nearest;
pub use render::{render_all, render_all_styled, render_styled, render_text, sort};
pub use source::{Position, SourceFile};

use std::ops::Range;
use std::sync::Arc;

/// Bytes of a source text.
pub type Span = Range<usize>;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Nothing can be rendered.
    Error,
    /// Worth knowing; the result stands.
    Warning,
}

/// A place in the source with a few words about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is to be seen there; may be empty.
    pub text: String,
}

/// Where a compound is used; the chain leads outwards to the recipe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Use {
    /// The file that uses it.
    pub source: Arc<SourceFile>,
    /// The name of the node there.
    pub span: Span,
    /// The node, with the nodes it lies in: `board/planks`.
    pub node: Arc<str>,
    /// The compound.
    pub kind: Arc<str>,
    /// Where the compound that holds the node is used; `None` in the recipe itself.
    pub outer: Option<Arc<Use>>,
}

impl Use {
    /// This use and those around it, from the inside out.
    pub fn chain(&self) -> impl Iterator<Item = &Use> {
        std::iter::successors(Some(self), |inner| inner.outer.as_deref())
    }
}

/// One thing that is wrong: code, place, what was expected and found, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The stable name of this kind of mistake.
    pub code: Code,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in lower case and without a full stop: "expected X, found Y".
    pub message: String,
    /// The file, and where in it; `None` if it is about no place in a recipe.
    pub source: Option<Arc<SourceFile>>,
    /// The place to blame.
    pub label: Option<Label>,
    /// Other places that explain it.
    pub context: Vec<Label>,
    /// The name of the node it is about.
    pub node: Option<String>,
    /// The use of the compound whose file it is about; `None` if that file is the recipe.
    pub uses: Option<Arc<Use>>,
    /// What was expected.
    pub expected: Option<String>,
    /// What was found.
    pub found: Option<String>,
    /// Valid names, the nearest first.
    pub nearest: Vec<String>,
    /// What to do, one sentence each, in the imperative.
    pub hints: Vec<String>,
}

impl Diagnostic {
    /// An error about no place in particular.
    pub fn error(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            code,
            severity: Severity::Error,
            message: message.into(),
            source: None,
            label: None,
            context: vec![],
            node: None,
            uses: None,
            expected: None,
            found: None,
            nearest: vec![],
            hints: vec![],
        }
    }

    /// A warning about no place in particular.
    pub fn warning(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Warning,
            ..Diagnostic::error(code, message)
        }
    }

    /// Points at a place.
    pub fn at(
        mut self,
        source: &Arc<SourceFile>,
        span: Span,
        text: impl Into<String>,
    ) -> Diagnostic {
        self.source = Some(Arc::clone(source));
        self.label = Some(Label {
            span,
            text: text.into(),
        });
        self
    }

    /// Points at another place of the same file that explains it.
    pub fn and_at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.context.push(Label {
            span,
            text: text.into(),
        });
        self
    }

    /// Names the node it is about.
    pub fn in_node(mut self, node: impl Into<String>) -> Diagnostic {
        self.node = Some(node.into());
        self
    }

    /// States through which uses of compounds the recipe comes to this place.
    pub fn used_by(mut self, uses: Option<Arc<Use>>) -> Diagnostic {
        self.uses = uses;
        self
    }

    /// States what was expected and what was found.
    pub fn expected(mut self, expected: impl ToString, found: impl ToString) -> Diagnostic {
        self.expected = Some(expected.to_string());
        self.found = Some(found.to_string());
        self
    }

    /// Lists valid names, the nearest first.
    pub fn nearest(mut self, names: Vec<String>) -> Diagnostic {
        self.nearest = names;
        self
    }

    /// Says what to do.
    pub fn hint(mut self, hint: impl Into<String>) -> Diagnostic {
        self.hints.push(hint.into());
        self
    }
}
