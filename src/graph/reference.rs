//! References to parameters: `"$name"` wherever a literal of the parameter's type can stand.

use super::described::described_unit;
use super::literal::{Reader, Slot};
use super::names::{is_name, shown};
use crate::diagnostics::{Code, Span};
use crate::value::{Type, Unit, Value};

impl Reader<'_> {
    /// The value of a parameter, if it suits the input.
    pub(super) fn parameter(&mut self, name: &str, span: Span, slot: Slot<'_>) -> Option<Value> {
        let Some(declared) = self.parameters.refer(name) else {
            return self.refuse_unknown_parameter(name, span);
        };
        let (unit, value_type, value) =
            (declared.unit, declared.value_type?, declared.value.clone()?);
        let value = match (value, slot.value_type) {
            (Value::Number(number), Type::Number(wanted)) if unit == wanted => {
                Value::Number(number)
            }
            (Value::Whole(whole), Type::Number(wanted)) if unit == wanted => {
                Value::Number(whole as f64)
            }
            (Value::Vector(vector), Type::Vector(wanted)) if unit == wanted => {
                Value::Vector(vector)
            }
            (Value::Number(_) | Value::Whole(_), Type::Number(wanted))
            | (Value::Vector(_), Type::Vector(wanted)) => {
                return self.refuse_unit(name, span, slot, (unit, wanted));
            }
            (Value::Text(text), Type::Choice(names)) => {
                return self.choose(&text, span, slot, names);
            }
            (Value::Text(text), Type::Text | Type::File) => Value::Text(text),
            (value @ Value::Whole(_), Type::Whole)
            | (value @ Value::Toggle(_), Type::Toggle)
            | (value @ Value::Colour(_), Type::Colour) => value,
            _ => return self.refuse_parameter(name, span, slot, value_type),
        };
        self.all_in_range(&value, span, slot).map(|()| value)
    }

    pub(super) fn all_in_range(&mut self, value: &Value, span: Span, slot: Slot<'_>) -> Option<()> {
        let parts = match value {
            Value::Number(number) => vec![*number],
            Value::Whole(whole) => vec![*whole as f64],
            Value::Vector(vector) => vector.to_array().to_vec(),
            Value::Colour(colour) => colour.to_vec(),
            _ => vec![],
        };
        parts
            .into_iter()
            .try_for_each(|part| self.in_range(part, span.clone(), slot).map(|_| ()))
    }

    pub(super) fn refuse_unknown_parameter<T>(&mut self, name: &str, span: Span) -> Option<T> {
        let message = format!("the recipe has no parameter {}", shown(name));
        let nearest = self.parameters.nearest(name);
        self.refuse(
            Code::UnknownParameter,
            message,
            span,
            "not declared",
            |error| {
                let error = error.nearest(nearest);
                match is_name(name) {
                    true => error,
                    false => error.hint("write `$$` for a dollar sign at the beginning of text"),
                }
            },
        )
    }

    fn refuse_unit(
        &mut self,
        name: &str,
        span: Span,
        slot: Slot<'_>,
        (found, expected): (Unit, Unit),
    ) -> Option<Value> {
        let (input, name) = (shown(slot.name), shown(name));
        let label = format!("is {}", described_unit(found));
        let message = format!(
            "{input} is {}, parameter {name} {label}",
            described_unit(expected)
        );
        self.refuse(Code::UnitMismatch, message, span, label, |error| {
            error.expected(expected.symbol(), found.symbol())
        })
    }

    fn refuse_parameter(
        &mut self,
        name: &str,
        span: Span,
        slot: Slot<'_>,
        found: Type,
    ) -> Option<Value> {
        let (input, expected) = (shown(slot.name), slot.value_type.to_string());
        let message = format!(
            "expected {expected} for {input}, found parameter {} of type {found}",
            shown(name)
        );
        let label = format!("expected {expected}");
        self.refuse(Code::TypeMismatch, message, span, label, |error| {
            error.expected(expected, found)
        })
    }
}
