//! Functions in arithmetic: `clamp(x, 0, 1)`.

use super::{Parser, Part, Quantity};
use crate::colour::luminance;
use crate::diagnostics::{Code, Span, nearest};
use crate::graph::literal::Slot;
use crate::graph::names::shown;
use crate::graph::{Arithmetic, Function, Source};
use crate::value::{Type, Unit, Value};

impl Parser<'_, '_, '_> {
    /// What stands behind `name` and an opening parenthesis.
    pub(super) fn call(&mut self, name: Span) -> Option<Part> {
        let written = &self.text.value[name.clone()];
        match Function::from_name(written) {
            None => self.refuse_function(name),
            Some(Function::Luminance) => self.luminance(name.start),
            Some(function) => self.call_of_numbers(function, name.start),
        }
    }

    fn refuse_function<T>(&mut self, name: Span) -> Option<T> {
        let written = &self.text.value[name.clone()];
        let names = Function::ALL.map(Function::name);
        let message = format!("there is no function {}", shown(written));
        let near = nearest(written, names);
        let span = self.place(name);
        self.reader().refuse(
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
    fn call_of_numbers(&mut self, function: Function, start: usize) -> Option<Part> {
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
        let quantity = self.quantity(function, &arguments)?;
        let depth = 1 + arguments.iter().map(|part| part.depth).max().unwrap_or(0);
        let numbers = arguments.into_iter().map(|part| part.expression).collect();
        self.part(
            Arithmetic::Call(function, numbers),
            depth,
            quantity,
            start..self.at,
        )
    }

    /// What the function gives; arguments that are compared need one unit.
    fn quantity(&mut self, function: Function, arguments: &[Part]) -> Option<Quantity> {
        let compared = match (function, arguments) {
            (Function::Sqrt, [of]) => return Some(of.quantity.root()),
            (Function::Mix, [_, _, amount]) => {
                if !amount.quantity.is_plain() {
                    return self.refuse_amount(amount);
                }
                &arguments[..2]
            }
            _ => arguments,
        };
        let compared: Vec<&Part> = compared.iter().collect();
        self.one_unit(function.name(), &compared)
    }

    /// Of a link to a colour, or of a parameter that is one; `start` is where the call begins.
    fn luminance(&mut self, start: usize) -> Option<Part> {
        let mut of = match self.peek() {
            Some('$') => self.luminance_of_parameter()?,
            _ => {
                let range = self.letters();
                let link = self.link(range, |found| found == Type::Colour, Type::Colour)?;
                let call = Arithmetic::Call(Function::Luminance, vec![link.expression]);
                self.part(call, link.depth + 1, link.quantity, link.bytes)?
            }
        };
        if !self.take(')') {
            return self.expected("`)`");
        }
        of.bytes = start..self.at;
        Some(of)
    }

    fn luminance_of_parameter(&mut self) -> Option<Part> {
        let start = self.at;
        self.take('$');
        let range = self.letters();
        let span = self.place(start..range.end);
        let slot = Slot {
            name: "luminance",
            value_type: Type::Colour,
            range: None,
        };
        let name = &self.text.value[range.clone()];
        let quantity = Quantity::of(Unit::One);
        if let Some((_, Some(source @ Source::Link(_)))) = self.reader().parameters.refer(name) {
            let source = source.clone();
            self.reader().fits(name, span.clone(), slot)?;
            let (link, depth) = self.passed(name, source, span)?;
            let call = Arithmetic::Call(Function::Luminance, vec![link]);
            return self.part(call, depth + 1, quantity, start..range.end);
        }
        let value = self.reader().parameter(name, span, slot)?;
        let Value::Colour(colour) = value else {
            return None;
        };
        let number = f64::from(luminance(colour.map(|part| part as f32)));
        self.part(Arithmetic::Number(number), 0, quantity, start..range.end)
    }
}

impl Type {
    pub(in crate::graph) fn is_number(self) -> bool {
        matches!(self, Type::Number(_))
    }
}
