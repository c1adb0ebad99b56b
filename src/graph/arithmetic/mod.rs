//! Arithmetic in strings: `"= 0.03 * look.position + $height"`.
//!
//! **What it may hold.** Numbers, `$parameters`, links to numbers, `+ - * /` with the usual precedence
//! and from left to right, a minus sign, parentheses, and `min(a, b)`, `max(a, b)`, `abs(a)`, `sqrt(a)`,
//! `clamp(a, low, high)`, `mix(a, b, amount)` and `luminance(colour)`.
//!
//! **Where it may stand.** In place of a number. What is made of numbers and parameters only is constant:
//! it is computed when the recipe is read and can stand in any number and any whole number, also within
//! a vector, a list or a record. What holds links stands for a whole input: for a constant input the
//! links have to be constant as well, an input per point takes links that differ from point to point.
//!
//! **Units.** `*` and `/` multiply and divide units, `sqrt` takes the root of the unit; `+`, `-`, `min`,
//! `max`, `clamp`, and the first two of `mix` need one unit, which is that of the result; the amount of
//! `mix` is a plain number, and so is `luminance`. A written number may have a unit behind it, `20 mm` or
//! `3 mm/year`. One without, and what is made of such alone, takes the unit of what it is added to or
//! compared with; in products it is plain. The
//! whole has to have the unit of its input; if no unit occurs in it anywhere, it is taken to be in the
//! unit of the input: `"= 0.05 * look.position"` is a height in mm. Units are never converted: to get
//! from years to millimetres, multiply by a rate: `"= 3 mm/year * time"`.
//!
//! **Results** have to be finite. The square root of a negative number is 0.

mod calls;
mod fold;
mod mistakes;
mod units;
mod words;

pub(super) use units::written_unit;

use super::links::Linker;
use super::literal::{Reader, Slot};
use super::syntax::DEPTH;
use super::text_literal::TextLiteral;
use super::tree::Tree;
use super::{Arithmetic, Operator, Source};
use crate::diagnostics::{Code, Span};
use crate::node::Input;
use crate::value::{Type, Unit, Value};
use units::Quantity;

/// Operators between the root of an expression and its deepest part.
const OPERATORS: usize = 256;

/// A part of an expression.
#[derive(Debug)]
struct Part {
    expression: Arithmetic,
    /// Operators to its deepest part.
    depth: usize,
    quantity: Quantity,
    /// Where it stands in the text.
    bytes: Span,
}

impl Linker<'_, '_> {
    /// What the arithmetic in `text` gives for an input, or for the part of it that `slot` describes.
    pub(super) fn arithmetic(
        &mut self,
        tree: &Tree,
        text: &TextLiteral,
        input: &Input,
        slot: Slot<'_>,
    ) -> Option<Source> {
        let mut parser = Parser::new(Context::Input(self, input), tree, text, slot);
        match parser.whole()? {
            Arithmetic::Number(number) => {
                let number = self.reader.in_range(number, tree.span.clone(), slot)?;
                Some(Source::Literal(Value::Number(number)))
            }
            result => Some(Source::Arithmetic(result)),
        }
    }
}

impl Reader<'_> {
    /// The number that arithmetic without links gives.
    pub(super) fn constant_arithmetic(
        &mut self,
        tree: &Tree,
        text: &TextLiteral,
        slot: Slot<'_>,
    ) -> Option<f64> {
        let result = Parser::new(Context::Constant(self), tree, text, slot).whole()?;
        self.in_range(result.as_number()?, tree.span.clone(), slot)
    }
}

/// Where the expression stands.
enum Context<'p, 'c, 's> {
    /// In place of an input, where links are allowed.
    Input(&'p mut Linker<'c, 's>, &'p Input),
    /// In place of a part, where only numbers and parameters are.
    Constant(&'p mut Reader<'c>),
}

struct Parser<'p, 'c, 's> {
    context: Context<'p, 'c, 's>,
    tree: &'p Tree,
    text: &'p TextLiteral,
    slot: Slot<'p>,
    at: usize,
    depth: usize,
}

impl<'p, 'c, 's> Parser<'p, 'c, 's> {
    fn new(
        context: Context<'p, 'c, 's>,
        tree: &'p Tree,
        text: &'p TextLiteral,
        slot: Slot<'p>,
    ) -> Self {
        Parser {
            context,
            tree,
            text,
            slot,
            // Behind the `=`.
            at: 1,
            depth: 0,
        }
    }

    fn reader(&mut self) -> &mut Reader<'c> {
        match &mut self.context {
            Context::Input(linker, _) => &mut linker.reader,
            Context::Constant(reader) => reader,
        }
    }

    fn whole(&mut self) -> Option<Arithmetic> {
        let result = self.sum()?;
        if self.peek().is_some() {
            return self.expected("an operator or the end");
        }
        let unit = match self.slot.value_type {
            Type::Number(unit) => unit,
            Type::Whole => Unit::One,
            _ => return Some(result.expression),
        };
        if result.quantity.fits(unit) {
            return Some(result.expression);
        }
        self.refuse_result(&result, unit)
    }

    /// The next letter that is not a space.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text.value[self.at..];
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed.chars().next()
    }

    /// Takes the next letter if it is `letter`.
    fn take(&mut self, letter: char) -> bool {
        let is_next = self.peek() == Some(letter);
        if is_next {
            self.at += letter.len_utf8();
        }
        is_next
    }

    fn sum(&mut self) -> Option<Part> {
        self.chain(
            Self::product,
            [('+', Operator::Add), ('-', Operator::Subtract)],
        )
    }

    fn product(&mut self) -> Option<Part> {
        self.chain(
            Self::factor,
            [('*', Operator::Multiply), ('/', Operator::Divide)],
        )
    }

    /// Operators of one precedence, from left to right.
    fn chain(
        &mut self,
        part: fn(&mut Self) -> Option<Part>,
        operators: [(char, Operator); 2],
    ) -> Option<Part> {
        let mut left = part(self)?;
        loop {
            let next = self.peek();
            let Some((letter, operator)) = operators.into_iter().find(|(o, _)| Some(*o) == next)
            else {
                return Some(left);
            };
            self.take(letter);
            let right = part(self)?;
            let quantity = match operator {
                Operator::Multiply => left.quantity.times(right.quantity),
                Operator::Divide => left.quantity.over(right.quantity),
                Operator::Add | Operator::Subtract => {
                    self.one_unit(&letter.to_string(), &[&left, &right])?
                }
            };
            let bytes = left.bytes.start..right.bytes.end;
            let depth = 1 + left.depth.max(right.depth);
            let parts = [left.expression, right.expression];
            let whole = Arithmetic::Binary(operator, Box::new(parts));
            left = self.part(whole, depth, quantity, bytes)?;
        }
    }

    /// A number, parameter, link, call or sum in parentheses, perhaps with a minus sign.
    fn factor(&mut self) -> Option<Part> {
        if self.depth >= DEPTH {
            let message = format!("arithmetic is nested more than {DEPTH} levels deep");
            let span = self.place(self.at..self.at);
            let reader = self.reader();
            return reader.refuse(Code::NestedTooDeep, message, span, "here", |e| e);
        }
        self.depth += 1;
        let result = self.factor_at_depth();
        self.depth -= 1;
        result
    }

    fn factor_at_depth(&mut self) -> Option<Part> {
        let next = self.peek();
        let start = self.at;
        match next {
            Some('-') => {
                self.take('-');
                let of = self.factor()?;
                let whole = Arithmetic::Negate(Box::new(of.expression));
                self.part(whole, of.depth + 1, of.quantity, start..of.bytes.end)
            }
            Some('(') => {
                self.take('(');
                let mut sum = self.sum()?;
                if !self.take(')') {
                    return self.expected("`)`");
                }
                sum.bytes = start..self.at;
                Some(sum)
            }
            Some('0'..='9' | '.') => self.number(),
            Some('$') => self.parameter(),
            Some(letter) if letter.is_alphabetic() || letter == '_' => self.word(),
            _ => self.expected("a number, a `$parameter`, a link or `(`"),
        }
    }

    /// A part whose constant parts are computed, if it is finite and not too deep.
    fn part(
        &mut self,
        expression: Arithmetic,
        depth: usize,
        quantity: Quantity,
        bytes: Span,
    ) -> Option<Part> {
        let by_zero = expression.divides_by_zero();
        let expression = match expression.fold() {
            Arithmetic::Number(number) if !number.is_finite() => {
                return self.refuse_not_finite(bytes, by_zero);
            }
            folded => folded,
        };
        if depth > OPERATORS {
            return self.refuse_long(bytes);
        }
        Some(Part {
            expression,
            depth,
            quantity,
            bytes,
        })
    }
}
