//! References to parameters and to the inputs of compounds: `"$name"`.

use super::Source;
use super::described::described_unit;
use super::links::{Linker, units};
use super::literal::{Reader, Slot, parameter_name};
use super::names::{is_name, shown};
use super::report::PASSED;
use super::tree::{Shape, Tree};
use crate::diagnostics::{Code, Span};
use crate::node::{Input, Varies};
use crate::value::{Type, Unit, Value};

impl Linker<'_, '_> {
    /// What the use of a compound gives to the input that `tree` names, unless that is a literal: those are
    /// read where they stand. `Some(None)` if it is wrong, which is reported.
    pub(super) fn passed(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<Option<Source>> {
        let Shape::Text(text) = &tree.shape else {
            return None;
        };
        let name = parameter_name(&text.value)?;
        let (_, source) = self.reader.parameters.refer(name)?;
        match source? {
            Source::Literal(_) => None,
            Source::Absent => {
                let span = tree.span.clone();
                Some(self.reader.refuse_left_out(name, span, slot.name))
            }
            source => {
                let source = source.clone();
                if let Source::Arithmetic(expression) = &source
                    && !self.reader.report.may_pass(expression.measure().1)
                {
                    return Some(self.reader.refuse_many_parts(tree.span.clone()));
                }
                Some(
                    self.reader
                        .fits(name, tree.span.clone(), slot)
                        .map(|()| source),
                )
            }
        }
    }

    /// Whether `tree` names an input that the use of the compound has left out.
    pub(super) fn is_left_out(&mut self, tree: &Tree) -> bool {
        let name = match &tree.shape {
            Shape::Text(text) => parameter_name(&text.value),
            _ => None,
        };
        let source = name.and_then(|name| self.reader.parameters.refer(name)?.1);
        matches!(source, Some(Source::Absent))
    }

    /// Refuses an input of a compound that may differ from point to point where a constant is needed.
    pub(super) fn may_vary(&mut self, name: &str, span: Span, input: &Input) -> Option<()> {
        let declared = self
            .reader
            .parameters
            .refer(name)
            .map(|(declared, _)| declared.varies);
        if declared != Some(Varies::PerPoint) || input.varies == Varies::PerPoint {
            return Some(());
        }
        let message = format!(
            "{} must be constant, input {} may differ from point to point",
            shown(input.name),
            shown(name)
        );
        let label = "may differ from point to point";
        self.reader
            .refuse(Code::NotConstant, message, span, label, |error| {
                error
                    .expected("a constant", "an input with `per_point: true`")
                    .hint("leave `per_point` out where the input is declared")
            })
    }
}

impl Reader<'_> {
    /// Whether the declared type of an input suits the slot.
    pub(super) fn fits(&mut self, name: &str, span: Span, slot: Slot<'_>) -> Option<()> {
        let given = self.parameters.refer(name)?.0.value_type?;
        if given == slot.value_type {
            return Some(());
        }
        match units(slot.value_type, given) {
            Some((wanted, given)) => self.refuse_unit(name, span, slot, (given, wanted)),
            None => self.refuse_parameter(name, span, slot, given),
        }
    }

    /// The value of a parameter, if it suits the input.
    pub(super) fn parameter(&mut self, name: &str, span: Span, slot: Slot<'_>) -> Option<Value> {
        let Some((declared, source)) = self.parameters.refer(name) else {
            return self.refuse_unknown_parameter(name, span);
        };
        let (unit, value_type) = (declared.unit, declared.value_type?);
        let has_default = declared.default.is_some();
        let value = match source?.clone() {
            Source::Literal(value) => value,
            Source::Absent => return self.refuse_left_out(name, span, slot.name),
            _ => return self.refuse_passed(name, span, slot),
        };
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
            (Value::Pair(pair), Type::Pair(wanted)) if unit == wanted => Value::Pair(pair),
            (Value::Pair(_), Type::Pair(wanted)) => {
                return self.refuse_unit(name, span, slot, (unit, wanted));
            }
            (Value::Choice(choice), Type::Choice(names)) => {
                return self.choose(choice, span, slot, names);
            }
            (Value::Number(_) | Value::Whole(_), Type::Number(wanted))
            | (Value::Vector(_), Type::Vector(wanted)) => {
                return self.refuse_unit(name, span, slot, (unit, wanted));
            }
            (Value::Text(text), Type::Choice(names)) => {
                if self.parameters.are_stand_ins && !has_default {
                    return names.first().map(|name| Value::Choice(name));
                }
                return self.choose(&text, span, slot, names);
            }
            (Value::Text(text), Type::Text | Type::File) => Value::Text(text),
            (value @ Value::Whole(_), Type::Whole)
            | (value @ Value::Toggle(_), Type::Toggle)
            | (value @ Value::Colour(_), Type::Colour) => value,
            _ => return self.refuse_parameter(name, span, slot, value_type),
        };
        // What stands for any value may be one that is not allowed here.
        if self.parameters.are_stand_ins && !has_default {
            return Some(value);
        }
        self.all_in_range(&value, span, slot).map(|()| value)
    }

    pub(super) fn all_in_range(&mut self, value: &Value, span: Span, slot: Slot<'_>) -> Option<()> {
        let parts = match value {
            Value::Number(number) => vec![*number],
            Value::Whole(whole) => vec![*whole as f64],
            Value::Vector(vector) => vector.to_array().to_vec(),
            Value::Pair(pair) => pair.to_vec(),
            Value::Colour(colour) => colour.to_vec(),
            _ => vec![],
        };
        parts
            .into_iter()
            .try_for_each(|part| self.in_range(part, span.clone(), slot).map(|_| ()))
    }

    pub(super) fn refuse_unknown_parameter<T>(&mut self, name: &str, span: Span) -> Option<T> {
        let role = self.parameters.interface.role;
        let message = format!(
            "the {} has no {} {}",
            role.name(),
            role.declared(),
            shown(name)
        );
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

    /// Reports that compounds pass on too much arithmetic.
    pub(super) fn refuse_many_parts<T>(&mut self, span: Span) -> Option<T> {
        let message = format!("arithmetic that compounds pass on has more than {PASSED} parts");
        self.refuse(Code::TooLarge, message, span, "here", |error| {
            error.hint("make a node of the arithmetic, and link that")
        })
    }

    /// Reports an input that the use of a compound has left out, where a value is needed.
    pub(super) fn refuse_left_out<T>(&mut self, name: &str, span: Span, input: &str) -> Option<T> {
        let message = format!(
            "{} needs a value, {} is left out",
            shown(input),
            shown(name)
        );
        self.refuse(
            Code::MissingInput,
            message,
            span,
            "has no value here",
            |error| {
                error.hint("give it a default where it is declared, in place of `optional: true`")
            },
        )
    }

    /// Reports an input that the use of a compound links, where only a literal can stand.
    pub(super) fn refuse_passed<T>(&mut self, name: &str, span: Span, slot: Slot<'_>) -> Option<T> {
        let message = format!(
            "expected a constant {} in {}, found {}, which is linked",
            slot.value_type,
            shown(slot.name),
            shown(name)
        );
        let label = "no link can stand here";
        self.refuse(Code::LinkNotAllowed, message, span, label, |error| {
            error.hint("link whole inputs only; give the compound a literal or a parameter")
        })
    }

    pub(super) fn refuse_unit<T>(
        &mut self,
        name: &str,
        span: Span,
        slot: Slot<'_>,
        (found, expected): (Unit, Unit),
    ) -> Option<T> {
        let (input, name) = (shown(slot.name), shown(name));
        let label = format!("is {}", described_unit(found));
        let message = format!(
            "{input} is {}, {} {name} {label}",
            described_unit(expected),
            self.parameters.interface.role.declared()
        );
        self.refuse(Code::UnitMismatch, message, span, label, |error| {
            error.expected(expected.symbol(), found.symbol())
        })
    }

    pub(super) fn refuse_parameter<T>(
        &mut self,
        name: &str,
        span: Span,
        slot: Slot<'_>,
        found: Type,
    ) -> Option<T> {
        let (input, expected) = (shown(slot.name), slot.value_type.to_string());
        let message = format!(
            "expected {expected} for {input}, found {} {} of type {found}",
            self.parameters.interface.role.declared(),
            shown(name)
        );
        let label = format!("expected {expected}");
        self.refuse(Code::TypeMismatch, message, span, label, |error| {
            error.expected(expected, found)
        })
    }
}
