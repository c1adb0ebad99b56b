//! What is said about text that is not a recipe's.

use super::{DEPTH, Parser, VALUES};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::graph::lexer::{Bracket, TokenKind, unclosed};
use crate::graph::names::{shown, shown_letter};
use crate::graph::tree::{Shape, Tree};
use crate::value::Unit;

impl Parser<'_, '_> {
    /// Keeps a mistake, unless an unclosed string before it on the line explains it.
    pub(super) fn add(&mut self, diagnostic: Diagnostic) {
        let place = diagnostic
            .label
            .as_ref()
            .map_or(0, |label| label.span.start);
        if !self.lexer.is_explained(place) {
            self.report.add(diagnostic);
        }
    }

    /// Reports that something else was expected than the token.
    pub(super) fn expected(&mut self, what: &str) {
        if self.gave_up || self.token.follows_mistake {
            return;
        }
        let found = self.found();
        let message = format!("expected {what}, found {found}");
        let label = format!("expected {what}");
        let span = self.token.span.clone();
        let error = self.report.error(Code::Syntax, message, span, label);
        self.add(error.expected(what, found));
    }

    pub(super) fn found(&self) -> String {
        match &self.token.kind {
            TokenKind::Open(bracket) => shown_letter(bracket.open()),
            TokenKind::Close(bracket) => shown_letter(bracket.close()),
            TokenKind::Colon => "`:`".to_owned(),
            TokenKind::Comma => "`,`".to_owned(),
            TokenKind::End => "the end of the file".to_owned(),
            _ => shown(&self.report.source.text[self.token.span.clone()]),
        }
    }

    /// Whether the token is a unit behind a number.
    pub(super) fn is_unit(&self) -> bool {
        let text = &self.report.source.text;
        let behind_number = text[..self.end].ends_with(|letter: char| letter.is_ascii_digit());
        behind_number && Unit::from_symbol(&text[self.token.span.clone()]).is_some()
    }

    /// Reports a number that is written with its unit.
    pub(super) fn refuse_unit(&mut self) {
        let unit = self.found();
        let message = format!("a literal is written without its unit, found {unit}");
        let span = self.token.span.clone();
        let error = self.report.error(Code::Syntax, message, span, "a unit");
        self.add(error.expected("`,`", unit).hint(
            "write the number alone, in the unit of the input; only arithmetic has units: `\"= 20 mm\"`",
        ));
    }

    pub(super) fn refuse_many(&mut self) {
        if !self.gave_up {
            let message = format!("a recipe has at most {VALUES} values");
            let span = self.token.span.clone();
            let error = self
                .report
                .error(Code::TooLarge, message, span, "one too many");
            self.add(error);
        }
        self.give_up();
    }

    /// Reports brackets that are too deep and skips to the end of the file.
    pub(super) fn refuse_depth(&mut self) {
        if !self.gave_up {
            let message = format!("brackets are nested more than {DEPTH} levels deep");
            let span = self.token.span.clone();
            let label = format!("this is level {}", DEPTH + 1);
            let error = self.report.error(Code::NestedTooDeep, message, span, label);
            self.add(error);
        }
        self.give_up();
    }

    pub(super) fn refuse_value_among_fields(&mut self, value: &Tree) {
        if !matches!(value.shape, Shape::Missing) {
            let span = value.span.clone();
            let found = shown(&self.report.source.text[span.clone()]);
            let message = format!("expected `name: value`, found {found}");
            let error = self
                .report
                .error(Code::Syntax, message, span, "this has no name");
            self.add(error.expected("`name: value`", found));
        }
    }

    /// Reports a bracket that closes another sort than the one that is open.
    pub(super) fn refuse_closing(&mut self, bracket: Bracket, opening: &Span) {
        let (expected, found) = (shown_letter(bracket.close()), self.found());
        let message = format!("expected {expected}, found {found}");
        let label = format!("expected {expected}");
        let span = self.token.span.clone();
        let error = self.report.error(Code::Syntax, message, span, label);
        self.add(
            error
                .expected(expected, found)
                .and_at(opening.clone(), "opened here"),
        );
    }

    /// Reports a bracket that closes nothing: what is open was opened on lines that are less indented.
    pub(super) fn refuse_extra(&mut self) {
        let found = self.found();
        let message = format!("this {found} closes nothing");
        let span = self.token.span.clone();
        let error = self
            .report
            .error(Code::Syntax, message, span, "one too many");
        self.add(error);
    }

    /// Reports the innermost bracket that is not closed; at the end of the file it stands for all, and
    /// where a declaration begins, for those around it that are closed by it as well.
    pub(super) fn refuse_unclosed(&mut self, bracket: Bracket, opening: &Span) {
        let is_explained = self.token.kind == TokenKind::End && self.lexer.found_unclosed
            || self.lexer.explains_bracket(opening.start);
        if self.gave_up || is_explained || self.token.follows_mistake {
            return;
        }
        let what = format!("`{}`", bracket.open());
        let mut error = unclosed(self.report, opening.clone(), &what);
        if self.token.kind == TokenKind::End {
            self.gave_up = true;
        } else {
            let label = format!("expected `{}` before this", bracket.close());
            error = error.and_at(self.token.span.clone(), label);
        }
        self.add(error);
    }
}
