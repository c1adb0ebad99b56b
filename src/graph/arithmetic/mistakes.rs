//! What is said about arithmetic that is wrong.

use super::units::Quantity;
use super::{OPERATORS, Parser, Part};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::graph::described::described_unit;
use crate::graph::names::{shown, shown_letter};
use crate::value::Unit;

/// How to get from one unit to another.
const CONVERSION: &str = "units are not converted; multiply or divide by a number or a parameter with a unit, such as `20 mm` or `3 mm/year`";

impl Parser<'_, '_, '_> {
    /// The place in the recipe of bytes of the text; the whole literal if it is written with escapes.
    pub(super) fn place(&self, bytes: Span) -> Span {
        match self.text.verbatim {
            Some(start) => start + bytes.start..start + bytes.end,
            None => self.tree.span.clone(),
        }
    }

    pub(super) fn refuse<T>(&mut self, message: String, bytes: Span, label: &str) -> Option<T> {
        let span = self.place(bytes);
        self.reader()
            .refuse(Code::InvalidArithmetic, message, span, label, |error| error)
    }

    pub(super) fn expected<T>(&mut self, what: &str) -> Option<T> {
        let letter = self.peek();
        let found = letter.map_or("the end".to_owned(), shown_letter);
        let message = format!("expected {what}, found {found}");
        let bytes = self.at..self.at + letter.map_or(0, char::len_utf8);
        let span = self.place(bytes);
        let label = format!("expected {what}");
        self.reader()
            .refuse(Code::InvalidArithmetic, message, span, label, |error| {
                error.expected(what, found)
            })
    }

    pub(super) fn refuse_not_finite<T>(&mut self, bytes: Span, by_zero: bool) -> Option<T> {
        let span = self.place(bytes);
        let (found, label) = match by_zero {
            true => ("a division by 0", "divides by 0"),
            false => ("arithmetic that is not", "not a finite number"),
        };
        let message = format!("{} must be finite, found {found}", shown(self.slot.name));
        self.reader()
            .refuse(Code::NotFinite, message, span, label, |error| {
                error.expected("a finite number", "infinity or no number")
            })
    }

    pub(super) fn refuse_long<T>(&mut self, bytes: Span) -> Option<T> {
        let message = format!("arithmetic has more than {OPERATORS} operators in a row");
        let span = self.place(bytes);
        self.reader()
            .refuse(Code::NestedTooDeep, message, span, "here", |error| {
                error.hint("make a node of a part of it")
            })
    }

    /// The unit that the parts share; `what` takes them.
    pub(super) fn one_unit(&mut self, what: &str, parts: &[&Part]) -> Option<Quantity> {
        let mut common = Quantity::WRITTEN;
        let mut first: Option<&Part> = None;
        for part in parts {
            let Some(both) = common.and(part.quantity) else {
                return self.refuse_units(what, first.unwrap_or(part), part);
            };
            if both != common {
                first = first.or(Some(part));
            }
            common = both;
        }
        Some(common)
    }

    fn refuse_units<T>(&mut self, what: &str, first: &Part, other: &Part) -> Option<T> {
        let [a, b] = [first, other].map(|part| part.quantity.counted());
        let message = format!("`{what}` needs numbers of one unit, found {a} and {b}");
        let [before, span] = [first, other].map(|part| self.place(part.bytes.clone()));
        let (known, found) = (first.quantity, other.quantity);
        let is_verbatim = self.text.verbatim.is_some();
        self.refuse_unit(message, span, other, |error| {
            let error = error.expected(known, found);
            // Without exact places both are the whole literal.
            match is_verbatim {
                true => error.and_at(before, format!("is {}", known.described())),
                false => error,
            }
        })
    }

    pub(super) fn refuse_result<T>(&mut self, result: &Part, unit: Unit) -> Option<T> {
        let (expected, found) = (described_unit(unit), result.quantity.described());
        let message = format!(
            "{} is {expected}, its arithmetic is {found}",
            shown(self.slot.name)
        );
        let span = self.place(result.bytes.clone());
        let found = result.quantity;
        self.refuse_unit(message, span, result, |error| {
            error.expected(unit.symbol(), found)
        })
    }

    pub(super) fn refuse_amount<T>(&mut self, amount: &Part) -> Option<T> {
        let message = format!(
            "the amount of `mix` is a plain number, found {}",
            amount.quantity.counted()
        );
        let span = self.place(amount.bytes.clone());
        let found = amount.quantity;
        self.refuse_unit(message, span, amount, |error| error.expected("1", found))
    }

    fn refuse_unit<T>(
        &mut self,
        message: String,
        span: Span,
        blamed: &Part,
        complete: impl FnOnce(Diagnostic) -> Diagnostic,
    ) -> Option<T> {
        let label = format!("is {}", blamed.quantity.described());
        self.reader()
            .refuse(Code::UnitMismatch, message, span, label, |error| {
                complete(error).hint(CONVERSION)
            })
    }
}
