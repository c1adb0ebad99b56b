//! Literals: values that a recipe writes out, read as the type of their input.

use super::described::{described_number, described_range};
use super::instead::instead;
use super::names::shown;
use super::number::{self, Written};
use super::parameters::Parameters;
use super::report::Report;
use super::tree::{Shape, Tree};
use crate::diagnostics::{Code, Diagnostic, Span, nearest};
use crate::value::{Type, Value};

/// What a literal is for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot<'n> {
    /// The name of the input.
    pub(super) name: &'n str,
    /// What it accepts.
    pub(super) value_type: Type,
    /// Smallest and largest number.
    pub(super) range: Option<(f64, f64)>,
}

impl Slot<'_> {
    /// The same input, of another type.
    pub(super) fn of(self, value_type: Type) -> Self {
        Slot { value_type, ..self }
    }
}

/// Reads the literals of one node. What is wrong is reported, and the value is `None`.
#[derive(Debug)]
pub(super) struct Reader<'c> {
    /// What `$name` refers to.
    pub(super) parameters: &'c mut Parameters,
    /// Where mistakes go.
    pub(super) report: &'c mut Report,
    /// The name of the node; `None` in a parameter.
    pub(super) node: Option<&'c str>,
}

/// What a text is at its beginning: `$name` a parameter, `$$` a dollar sign.
pub(super) fn parameter_name(text: &str) -> Option<&str> {
    text.strip_prefix('$').filter(|name| !name.starts_with('$'))
}

impl<'c> Reader<'c> {
    /// A reader for the node called `node`, or for a parameter.
    pub(super) fn new(
        parameters: &'c mut Parameters,
        report: &'c mut Report,
        node: Option<&'c str>,
    ) -> Reader<'c> {
        Reader {
            parameters,
            report,
            node,
        }
    }

    /// The value of a literal or of a parameter.
    pub(super) fn literal(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<Value> {
        if self.report.is_full() {
            return None;
        }
        if let Shape::Text(text) = &tree.shape
            && let Some(name) = parameter_name(&text.value)
        {
            let value = self.parameter(name, tree.span.clone(), slot)?;
            return self.allowed_file(value, tree, slot);
        }
        match slot.value_type {
            Type::Number(_) => self.number(tree, slot).map(Value::Number),
            Type::Whole => self.whole(tree, slot).map(Value::Whole),
            Type::Toggle => self.toggle(tree, slot),
            Type::Choice(names) => self.choice(tree, slot, names),
            Type::Text => self.text_for(tree, slot).map(Value::Text),
            Type::File => self.file_name(tree, slot).map(Value::Text),
            Type::Colour => self.colour(tree, slot).map(Value::Colour),
            Type::Vector(unit) => {
                let parts = self.numbers(tree, slot, Type::Number(unit))?;
                Some(Value::Vector(glam::DVec3::from_array(parts)))
            }
            Type::Pair(unit) => self
                .numbers(tree, slot, Type::Number(unit))
                .map(Value::Pair),
            Type::List(item) => self.list(tree, slot, *item).map(Value::List),
            Type::Record(parts) => self.record(tree, slot, parts).map(Value::Record),
            Type::Names => self.names(tree, slot).map(Value::Names),
            Type::Channels
            | Type::Skeleton
            | Type::ColourPattern
            | Type::Climate
            | Type::RingSeries
            | Type::Mesh
            | Type::Patches
            | Type::Region
            | Type::Partition
            | Type::Material
            | Type::Materials
            | Type::Maps => self.mismatch(tree, slot),
        }
    }

    /// Reports a literal of another type.
    pub(super) fn mismatch<T>(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<T> {
        let found = tree.described(&self.report.source.text);
        let expected = slot.value_type.to_string();
        let message = format!(
            "expected {expected} for {}, found {found}",
            shown(slot.name)
        );
        let label = format!("expected {expected}");
        self.refuse(
            Code::TypeMismatch,
            message,
            tree.span.clone(),
            label,
            |error| {
                let error = error.expected(&expected, &found);
                let instead = instead(tree, slot);
                instead.into_iter().fold(error, Diagnostic::hint)
            },
        )
    }

    /// Reports a mistake in the node.
    pub(super) fn refuse<T>(
        &mut self,
        code: Code,
        message: String,
        span: Span,
        label: impl Into<String>,
        complete: impl FnOnce(Diagnostic) -> Diagnostic,
    ) -> Option<T> {
        let mut error = self.report.error(code, message, span, label);
        error.node = self.node.map(str::to_owned);
        self.report.add(complete(error));
        None
    }

    fn number(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<f64> {
        let text = self.report.source.text[tree.span.clone()].to_owned();
        let number = match &tree.shape {
            Shape::Number => number::read(&text).map(|written| written.as_f64(&text)),
            Shape::Name(name) if name.starts_with("inf") || name.starts_with("NaN") => {
                Some(f64::INFINITY)
            }
            Shape::Text(text) if text.value.starts_with('=') => {
                return self.constant_arithmetic(tree, text, slot);
            }
            Shape::Text(_) => return self.refuse_link(tree, slot),
            _ => return self.mismatch(tree, slot),
        };
        let Some(number) = number else {
            return self.mismatch(tree, slot);
        };
        self.in_range(number, tree.span.clone(), slot)
    }

    /// A finite number within the range of the input.
    pub(super) fn in_range(&mut self, number: f64, span: Span, slot: Slot<'_>) -> Option<f64> {
        let name = shown(slot.name);
        if !number.is_finite() {
            let found = shown(&self.report.source.text[span.clone()]);
            let message = format!("{name} must be finite, found {found}");
            return self.refuse(
                Code::NotFinite,
                message,
                span,
                "not a finite number",
                |error| error.expected("a finite number", found),
            );
        }
        match slot.range {
            Some((low, high)) if number < low || number > high => {
                let range = described_range((low, high));
                let number = described_number(number);
                let message = format!("{name} must be {range}, found {number}");
                self.refuse(
                    Code::OutOfRange,
                    message,
                    span,
                    format!("must be {range}"),
                    |error| error.expected(range, number),
                )
            }
            _ => Some(number),
        }
    }

    fn whole(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<i64> {
        let text = self.report.source.text[tree.span.clone()].to_owned();
        match &tree.shape {
            Shape::Number => match number::read(&text) {
                Some(Written::Whole(Some(whole))) => self
                    .in_range(whole as f64, tree.span.clone(), slot)
                    .map(|_| whole),
                Some(Written::Whole(None)) => {
                    let message = format!(
                        "{} does not fit into 64 bits, found {}",
                        shown(slot.name),
                        shown(&text)
                    );
                    let span = tree.span.clone();
                    self.refuse(Code::OutOfRange, message, span, "too large", |error| {
                        error.expected("a whole number of 64 bits", shown(&text))
                    })
                }
                _ => self.mismatch(tree, slot),
            },
            Shape::Text(text) if text.value.starts_with('=') => {
                let number = self.constant_arithmetic(tree, text, slot)?;
                self.whole_of(number, tree.span.clone(), slot)
            }
            Shape::Text(_) => self.refuse_link(tree, slot),
            _ => self.mismatch(tree, slot),
        }
    }

    /// The whole number that arithmetic gives, if it gives one.
    fn whole_of(&mut self, number: f64, span: Span, slot: Slot<'_>) -> Option<i64> {
        // Beyond 2^53 not every whole number is a 64-bit float.
        if number.fract() == 0.0 && number.abs() <= 9_007_199_254_740_992.0 {
            return Some(number as i64);
        }
        let number = described_number(number);
        let message = format!(
            "expected a whole number for {}, found arithmetic that gives {number}",
            shown(slot.name)
        );
        let label = format!("gives {number}");
        self.refuse(Code::TypeMismatch, message, span, label, |error| {
            error.expected("a whole number", number)
        })
    }

    fn toggle(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<Value> {
        match &tree.shape {
            Shape::Name(name) if name == "true" => Some(Value::Toggle(true)),
            Shape::Name(name) if name == "false" => Some(Value::Toggle(false)),
            Shape::Text(_) => self.refuse_link(tree, slot),
            _ => self.mismatch(tree, slot),
        }
    }

    fn choice(
        &mut self,
        tree: &Tree,
        slot: Slot<'_>,
        names: &'static [&'static str],
    ) -> Option<Value> {
        let written = match &tree.shape {
            Shape::Name(name) => name,
            Shape::Text(text) => &text.value,
            _ => return self.mismatch(tree, slot),
        };
        self.choose(written, tree.span.clone(), slot, names)
    }

    pub(super) fn choose(
        &mut self,
        written: &str,
        span: Span,
        slot: Slot<'_>,
        names: &'static [&'static str],
    ) -> Option<Value> {
        if let Some(name) = names.iter().find(|name| **name == written) {
            return Some(Value::Choice(name));
        }
        let (found, list) = (shown(written), names.join(", "));
        let message = format!("{} must be one of {list}, found {found}", shown(slot.name));
        self.refuse(
            Code::UnknownChoice,
            message,
            span,
            "not one of them",
            |error| {
                error
                    .expected(format!("one of {list}"), found)
                    .nearest(nearest(written, names.iter().copied()))
            },
        )
    }

    /// Text without its first dollar sign if there are two.
    pub(super) fn text_for(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<String> {
        match &tree.shape {
            Shape::Text(text) if text.value.starts_with("$$") => Some(text.value[1..].to_owned()),
            Shape::Text(text) => Some(text.value.clone()),
            _ => self.mismatch(tree, slot),
        }
    }

    /// Reports a link or arithmetic where only a literal or a parameter can stand.
    pub(super) fn refuse_link<T>(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<T> {
        let found = shown(&self.report.source.text[tree.span.clone()]);
        let expected = format!("{} or `\"$parameter\"`", slot.value_type);
        let message = format!("expected {expected} in {}, found {found}", shown(slot.name));
        let span = tree.span.clone();
        self.refuse(
            Code::LinkNotAllowed,
            message,
            span,
            "no link can stand here",
            |error| {
                error
                    .expected(expected, found)
                    .hint("link whole inputs only; write this part as a literal or as a parameter")
            },
        )
    }
}
