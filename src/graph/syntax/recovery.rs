//! Going on after a bracket that is missing or one too many, by how lines are indented.
//!
//! None of it changes how valid text is read, except that the keys of a map within parentheses may not
//! be bare names at the beginnings of lines that are less indented than the map: no recipe has such.

use super::Parser;
use crate::graph::lexer::{Bracket, TokenKind};
use crate::graph::tree::{Shape, Tree, Word};

/// A bracket that is open.
#[derive(Clone, Copy)]
pub(super) struct Open {
    pub(super) bracket: Bracket,
    /// Bytes before the first token of its line.
    pub(super) indent: usize,
    /// Whether fields have been read in it.
    pub(super) has_fields: bool,
}

impl Parser<'_, '_> {
    /// Notes whether the token begins a line.
    pub(super) fn find_line(&mut self) {
        let source = &self.report.source.text;
        let before = source.get(self.end..self.token.span.start).unwrap_or("");
        let last_end = before.rfind(['\n', '\r']);
        self.starts_line = last_end.is_some();
        if let Some(end) = last_end {
            self.indent = before.len() - end - 1;
        }
    }

    pub(super) fn push(&mut self, bracket: Bracket, indent: usize) {
        self.open.push(Open {
            bracket,
            indent,
            has_fields: false,
        });
    }

    pub(super) fn is_in_map(&self) -> bool {
        let last = self.open.last();
        last.is_some_and(|open| open.bracket == Bracket::Curly)
    }

    /// Fields of an instance whose opening parenthesis was forgotten.
    pub(super) fn record_without_open(&mut self, word: Word) -> Shape {
        self.expected("`(`");
        let opening = self.end..self.end;
        self.push(Bracket::Round, self.indent.saturating_sub(1));
        let shape = self.parentheses(Some(word), &opening);
        self.open.pop();
        shape
    }

    pub(super) fn is_open(&self, bracket: Bracket) -> bool {
        self.open.iter().any(|open| open.bracket == bracket)
    }

    /// Whether the closing bracket is one too many: its line is more indented than that of what it could
    /// close, or of the innermost bracket if it could close none.
    pub(super) fn closes_nothing(&self, closing: Bracket) -> bool {
        let mut inner = self.open.iter().rev();
        let closed = inner.find(|open| open.bracket == closing);
        let closed = closed.or(self.open.last());
        closed.is_some_and(|open| open.indent < self.indent)
    }

    /// Whether what begins here, by its place and the colon behind it, belongs around the bracket.
    pub(super) fn leaves(&self, bracket: Bracket) -> bool {
        let [Some(open), around] = [0, 1].map(|nth| self.open.iter().rev().nth(nth)) else {
            return false;
        };
        let is_less_indented = self.starts_line && self.indent <= open.indent;
        let is_in = |wanted| around.is_some_and(|around| around.bracket == wanted);
        let has_colon = self.ahead.kind == TokenKind::Colon;
        match (&self.token.kind, bracket) {
            // The next record of a list of records.
            (TokenKind::Open(Bracket::Round), Bracket::Round) => {
                open.has_fields && is_less_indented && !is_in(Bracket::Curly)
            }
            (TokenKind::Name(_), Bracket::Square) => has_colon && is_in(Bracket::Round),
            (TokenKind::Name(_), Bracket::Curly) => {
                has_colon && is_less_indented && open.indent > 0 && is_in(Bracket::Round)
            }
            // Only a map has keys in quotes.
            (TokenKind::Text(_), Bracket::Round | Bracket::Square) => {
                has_colon && is_less_indented && self.is_open(Bracket::Curly)
            }
            _ => false,
        }
    }

    /// Entries whose opening brace was forgotten.
    pub(super) fn map_without_brace(&mut self) -> Tree {
        self.expected("`{`");
        let opening = self.end..self.end;
        self.push(Bracket::Curly, self.indent.saturating_sub(1));
        let entries = self.items(Bracket::Curly, &opening, Self::entry);
        self.open.pop();
        Tree {
            shape: Shape::Map(entries),
            span: opening.start..self.end,
        }
    }
}
