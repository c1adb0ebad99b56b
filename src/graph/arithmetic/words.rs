//! The words of arithmetic: numbers, parameters and links.

use super::units::written_unit;
use super::{Context, Parser, Part, Quantity};
use crate::diagnostics::{Code, Span};
use crate::graph::literal::Slot;
use crate::graph::names::shown;
use crate::graph::{Arithmetic, Function, Source};
use crate::value::{Type, Unit, Value};

impl Parser<'_, '_, '_> {
    /// A number, perhaps with its unit: `20 mm`.
    pub(super) fn number(&mut self) -> Option<Part> {
        let bytes = &self.text.value.as_bytes()[self.at..];
        let belongs = |at: &usize| match bytes[*at] {
            b'+' | b'-' => *at > 0 && matches!(bytes[at - 1], b'e' | b'E'),
            byte => byte.is_ascii_alphanumeric() || byte == b'.' || byte == b'_',
        };
        let length = (0..bytes.len()).take_while(belongs).count();
        let range = self.at..self.at + length;
        self.at = range.end;
        let written = &self.text.value[range.clone()];
        match written.parse::<f64>() {
            Ok(number) => {
                let rest = &self.text.value[range.end..];
                let (quantity, length) = match written_unit(rest) {
                    Some((unit, length)) => (Quantity::of(unit), length),
                    None => (Quantity::WRITTEN, 0),
                };
                self.at += length;
                let bytes = range.start..self.at;
                self.part(Arithmetic::Number(number), 0, quantity, bytes)
            }
            Err(_) => {
                let message = format!("{} is not a number", shown(written));
                self.refuse(message, range, "not a number")
            }
        }
    }

    /// The letters of a name or a link.
    pub(super) fn letters(&mut self) -> Span {
        let rest = &self.text.value[self.at..];
        let belongs = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '.';
        let length = rest.find(|letter| !belongs(letter)).unwrap_or(rest.len());
        let range = self.at..self.at + length;
        self.at = range.end;
        range
    }

    pub(super) fn parameter(&mut self) -> Option<Part> {
        let start = self.at;
        self.take('$');
        let range = self.letters();
        let bytes = start..range.end;
        let name = &self.text.value[range];
        let span = self.place(bytes.clone());
        let reader = self.reader();
        let Some((declared, source)) = reader.parameters.refer(name) else {
            return reader.refuse_unknown_parameter(name, span);
        };
        let value_type = declared.value_type?;
        let quantity = Quantity::of(declared.unit);
        let number = match source?.clone() {
            Source::Literal(Value::Number(number)) => number,
            Source::Literal(Value::Whole(whole)) => whole as f64,
            Source::Absent => return self.refuse_left_out(name, span),
            source @ (Source::Link(_) | Source::Arithmetic(_)) if value_type.is_number() => {
                let (expression, depth) = self.passed(name, source, span)?;
                return self.part(expression, depth, quantity, bytes);
            }
            _ => {
                let message = format!(
                    "expected a number, found parameter {} of type {value_type}",
                    shown(name)
                );
                let reader = self.reader();
                return reader.refuse(Code::TypeMismatch, message, span, "not a number", |error| {
                    error.expected("a number", value_type)
                });
            }
        };
        self.part(Arithmetic::Number(number), 0, quantity, bytes)
    }

    fn refuse_left_out<T>(&mut self, name: &str, span: Span) -> Option<T> {
        let input = self.slot.name;
        self.reader().refuse_left_out(name, span, input)
    }

    /// What the use of a compound gives to an input, a link or arithmetic of its own, and how deep it is.
    pub(super) fn passed(
        &mut self,
        name: &str,
        source: Source,
        span: Span,
    ) -> Option<(Arithmetic, usize)> {
        let slot = self.slot;
        let (linker, input) = match &mut self.context {
            Context::Input(linker, input) => (linker, *input),
            Context::Constant(reader) => return reader.refuse_passed(name, span, slot),
        };
        linker.may_vary(name, span.clone(), input)?;
        let expression = match source {
            Source::Arithmetic(expression) => expression,
            Source::Link(link) => Arithmetic::Link(link),
            _ => return None,
        };
        let (depth, size) = expression.measure();
        let reader = self.reader();
        if reader.report.may_pass(size) {
            return Some((expression, depth));
        }
        reader.refuse_many_parts(span)
    }

    /// A function if parentheses follow, otherwise a link.
    pub(super) fn word(&mut self) -> Option<Part> {
        let range = self.letters();
        if self.take('(') {
            return self.call(range);
        }
        let name = &self.text.value[range.clone()];
        if Function::from_name(name).is_some() && !self.has_node(name) {
            return self.expected(&format!("`(` after {}", shown(name)));
        }
        self.link(range, Type::is_number, Type::Number(Unit::One))
    }

    fn has_node(&self, name: &str) -> bool {
        match &self.context {
            Context::Input(linker, _) => linker.scope.layout.slot(name).is_some(),
            Context::Constant(_) => false,
        }
    }

    /// A link to what `suits`; `wanted` is the type that a message names.
    pub(super) fn link(
        &mut self,
        bytes: Span,
        suits: fn(Type) -> bool,
        wanted: Type,
    ) -> Option<Part> {
        let text = &self.text.value[bytes.clone()];
        let span = self.place(bytes.clone());
        let (linker, input) = match &mut self.context {
            Context::Input(linker, input) => (linker, *input),
            Context::Constant(reader) => {
                let message = format!(
                    "expected numbers and parameters in {}, found a link to {}",
                    shown(self.slot.name),
                    shown(text)
                );
                return reader.refuse(
                    Code::LinkNotAllowed,
                    message,
                    span,
                    "no link can stand here",
                    |error| error.expected("numbers and parameters", shown(text)),
                );
            }
        };
        let found = linker.find(text, span.clone())?;
        if !suits(found.output.value_type) {
            let slot = Slot {
                name: self.slot.name,
                value_type: wanted,
                range: None,
            };
            return linker.refuse_type(&found, text, span, slot);
        }
        linker.constant(&found, text, span, input)?;
        let quantity = match found.output.value_type {
            Type::Number(unit) => Quantity::of(unit),
            _ => Quantity::of(Unit::One),
        };
        self.part(Arithmetic::Link(found.link), 0, quantity, bytes)
    }
}
