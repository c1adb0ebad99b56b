//! The words of arithmetic: numbers, parameters, links and functions.

use super::{Deep, PASSED, Parser};
use crate::colour::luminance;
use crate::diagnostics::{Code, Span, nearest};
use crate::graph::literal::Slot;
use crate::graph::names::shown;
use crate::graph::{Arithmetic, Function, Source};
use crate::value::{Type, Value};

impl Parser<'_, '_, '_> {
    pub(super) fn number(&mut self) -> Option<Deep> {
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
            Ok(number) if number.is_finite() => Some((Arithmetic::Number(number), 0)),
            Ok(_) => self.refuse_not_finite(range.start),
            Err(_) => {
                let message = format!("{} is not a number", shown(written));
                self.refuse(message, range, "not a number")
            }
        }
    }

    /// The letters of a name or a link.
    fn letters(&mut self) -> Span {
        let rest = &self.text.value[self.at..];
        let belongs = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '.';
        let length = rest.find(|letter| !belongs(letter)).unwrap_or(rest.len());
        let range = self.at..self.at + length;
        self.at = range.end;
        range
    }

    pub(super) fn parameter(&mut self) -> Option<Deep> {
        let start = self.at;
        self.take('$');
        let range = self.letters();
        let name = &self.text.value[range.clone()];
        let span = self.place(start..range.end);
        let reader = &mut self.linker.reader;
        let Some((declared, source)) = reader.parameters.refer(name) else {
            return reader.refuse_unknown_parameter(name, span);
        };
        let value_type = declared.value_type?;
        match source?.clone() {
            Source::Literal(Value::Number(number)) => Some((Arithmetic::Number(number), 0)),
            Source::Literal(Value::Whole(whole)) => Some((Arithmetic::Number(whole as f64), 0)),
            source @ (Source::Link(_) | Source::Arithmetic(_)) if value_type.is_number() => {
                self.linker.may_vary(name, span, self.input)?;
                self.passed(source, start)
            }
            Source::Absent => self
                .linker
                .reader
                .refuse_left_out(name, span, self.input.name),
            _ => {
                let message = format!(
                    "expected a number, found parameter {} of type {value_type}",
                    shown(name)
                );
                reader.refuse(Code::TypeMismatch, message, span, "not a number", |error| {
                    error.expected("a number", value_type)
                })
            }
        }
    }

    /// What the use of a compound gives to an input: a link, or arithmetic of its own.
    fn passed(&mut self, source: Source, start: usize) -> Option<Deep> {
        match source {
            Source::Link(link) => Some((Arithmetic::Link(link), 0)),
            Source::Arithmetic(expression) => {
                let (depth, size) = expression.measure();
                self.passed += size;
                if self.passed > PASSED {
                    let message =
                        format!("arithmetic that compounds pass on has more than {PASSED} parts");
                    let span = self.place(start..self.at);
                    return self.linker.reader.refuse(
                        Code::TooLarge,
                        message,
                        span,
                        "here",
                        |error| error,
                    );
                }
                Some((expression, self.shallow(depth, start)?))
            }
            _ => None,
        }
    }

    /// A function if parentheses follow, otherwise a link.
    pub(super) fn word(&mut self) -> Option<Deep> {
        let range = self.letters();
        if self.take('(') {
            return self.call(range);
        }
        let name = &self.text.value[range.clone()];
        if Function::from_name(name).is_some() && self.linker.scope.layout.slot(name).is_none() {
            return self.expected(&format!("`(` after {}", shown(name)));
        }
        self.link(range, Type::is_number, self.input.value_type)
    }

    fn link(&mut self, range: Span, suits: fn(Type) -> bool, wanted: Type) -> Option<Deep> {
        let text = &self.text.value[range.clone()];
        let span = self.place(range);
        let found = self.linker.find(text, span.clone())?;
        if !suits(found.output.value_type) {
            let slot = Slot {
                name: self.input.name,
                value_type: wanted,
                range: None,
            };
            return self.linker.refuse_type(&found, text, span, slot);
        }
        self.linker.constant(&found, text, span, self.input)?;
        Some((Arithmetic::Link(found.link), 0))
    }

    fn call(&mut self, name: Span) -> Option<Deep> {
        let written = &self.text.value[name.clone()];
        match Function::from_name(written) {
            None => self.refuse_function(name),
            Some(Function::Luminance) => self.luminance(),
            Some(function) => self.call_of_numbers(function, name.start),
        }
    }

    fn refuse_function<T>(&mut self, name: Span) -> Option<T> {
        let written = &self.text.value[name.clone()];
        let names = Function::ALL.map(Function::name);
        let message = format!("there is no function {}", shown(written));
        let near = nearest(written, names);
        let span = self.place(name);
        let reader = &mut self.linker.reader;
        reader.refuse(
            Code::InvalidArithmetic,
            message,
            span,
            "not a function",
            |error| {
                error
                    .nearest(near)
                    .hint(format!("the functions are {}", names.join(", ")))
            },
        )
    }

    /// The arguments behind the opening parenthesis.
    fn call_of_numbers(&mut self, function: Function, start: usize) -> Option<Deep> {
        let mut arguments = vec![self.sum()?];
        while self.take(',') {
            arguments.push(self.sum()?);
        }
        if !self.take(')') {
            return self.expected("`,` or `)`");
        }
        let (wanted, found) = (function.arguments(), arguments.len());
        if found != wanted {
            let message = format!(
                "`{}` takes {wanted} numbers, found {found}",
                function.name()
            );
            let label = format!("expected {wanted} numbers");
            return self.refuse(message, start..self.at, &label);
        }
        let (arguments, depths): (Vec<_>, Vec<_>) = arguments.into_iter().unzip();
        let depth = 1 + depths.into_iter().max().unwrap_or(0);
        let whole = self.folded(Arithmetic::Call(function, arguments), start)?;
        Some((whole, self.shallow(depth, start)?))
    }

    /// Of a link to a colour, or of a parameter that is one.
    fn luminance(&mut self) -> Option<Deep> {
        let of = match self.peek() {
            Some('$') => self.luminance_of_parameter()?,
            _ => {
                let range = self.letters();
                let (link, depth) =
                    self.link(range, |found| found == Type::Colour, Type::Colour)?;
                (Arithmetic::Call(Function::Luminance, vec![link]), depth + 1)
            }
        };
        self.take(')')
            .then_some(of)
            .or_else(|| self.expected("`)`"))
    }

    fn luminance_of_parameter(&mut self) -> Option<Deep> {
        let start = self.at;
        self.take('$');
        let range = self.letters();
        let span = self.place(start..range.end);
        let slot = Slot {
            name: "luminance",
            value_type: Type::Colour,
            range: None,
        };
        let name = &self.text.value[range];
        if let Some((_, Some(Source::Link(link)))) = self.linker.reader.parameters.refer(name) {
            let link = Arithmetic::Link(*link);
            self.linker.may_vary(name, span.clone(), self.input)?;
            self.linker.fits(name, span, slot)?;
            return Some((Arithmetic::Call(Function::Luminance, vec![link]), 1));
        }
        let value = self.linker.reader.parameter(name, span, slot)?;
        let Value::Colour(colour) = value else {
            return None;
        };
        let number = f64::from(luminance(colour.map(|part| part as f32)));
        Some((Arithmetic::Number(number), 0))
    }
}

impl Type {
    fn is_number(self) -> bool {
        matches!(self, Type::Number(_))
    }
}
