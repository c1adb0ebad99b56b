//! Arithmetic in strings: `"= 0.03 * look.position + $height"`.
//!
//! Numbers, `$parameters`, links, `+ - * /` with the usual precedence, parentheses and functions. Numbers
//! are taken as they are: the result is in the unit of the input. What is constant is folded.

mod fold;
mod words;

use super::links::Linker;
use super::literal::Slot;
use super::names::shown;
use super::syntax::DEPTH;
use super::text_literal::TextLiteral;
use super::tree::Tree;
use super::{Arithmetic, Operator, Source};
use crate::diagnostics::{Code, Span};
use crate::node::Input;
use crate::value::Value;

/// Operators between the root of an expression and its deepest part.
const OPERATORS: usize = 256;

/// Parts of the expressions that the inputs of a compound stand for: each level could double them.
const PASSED: usize = 10_000;

/// An expression and how deep it is.
type Deep = (Arithmetic, usize);

impl Linker<'_, '_> {
    /// The arithmetic that `text` holds behind its `=`.
    pub(super) fn arithmetic(
        &mut self,
        tree: &Tree,
        text: &TextLiteral,
        input: &Input,
    ) -> Option<Source> {
        let mut parser = Parser {
            linker: self,
            tree,
            text,
            input,
            at: 1,
            depth: 0,
            passed: 0,
        };
        let (result, _) = parser.sum()?;
        if parser.peek().is_some() {
            return parser.expected("an operator or the end");
        }
        match result {
            Arithmetic::Number(number) => {
                let slot = Slot::from(input);
                let number = self.reader.in_range(number, tree.span.clone(), slot)?;
                Some(Source::Literal(Value::Number(number)))
            }
            result => Some(Source::Arithmetic(result)),
        }
    }
}

struct Parser<'p, 'c, 's> {
    linker: &'p mut Linker<'c, 's>,
    tree: &'p Tree,
    text: &'p TextLiteral,
    input: &'p Input,
    at: usize,
    depth: usize,
    /// Parts of the expressions that the inputs of a compound stand for.
    passed: usize,
}

impl Parser<'_, '_, '_> {
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

    /// The place in the recipe of bytes of the text; the whole literal if it is written with escapes.
    fn place(&self, bytes: Span) -> Span {
        match self.text.verbatim {
            Some(start) => start + bytes.start..start + bytes.end,
            None => self.tree.span.clone(),
        }
    }

    fn refuse<T>(&mut self, message: String, bytes: Span, label: &str) -> Option<T> {
        let span = self.place(bytes);
        self.linker
            .reader
            .refuse(Code::InvalidArithmetic, message, span, label, |error| error)
    }

    fn expected<T>(&mut self, what: &str) -> Option<T> {
        let letter = self.peek();
        let found = letter.map_or("the end".to_owned(), super::names::shown_letter);
        let message = format!("expected {what}, found {found}");
        let bytes = self.at..self.at + letter.map_or(0, char::len_utf8);
        let span = self.place(bytes);
        let label = format!("expected {what}");
        self.linker
            .reader
            .refuse(Code::InvalidArithmetic, message, span, label, |error| {
                error.expected(what, found)
            })
    }

    fn sum(&mut self) -> Option<Deep> {
        self.chain(
            Self::product,
            [('+', Operator::Add), ('-', Operator::Subtract)],
        )
    }

    fn product(&mut self) -> Option<Deep> {
        self.chain(
            Self::factor,
            [('*', Operator::Multiply), ('/', Operator::Divide)],
        )
    }

    /// Operators of one precedence, from left to right.
    fn chain(
        &mut self,
        part: fn(&mut Self) -> Option<Deep>,
        operators: [(char, Operator); 2],
    ) -> Option<Deep> {
        let mut left = part(self)?;
        loop {
            let next = self.peek();
            let start = self.at;
            let Some((letter, operator)) = operators.into_iter().find(|(o, _)| Some(*o) == next)
            else {
                return Some(left);
            };
            self.take(letter);
            let right = part(self)?;
            let depth = 1 + left.1.max(right.1);
            let parts = [left.0, right.0];
            let whole = Arithmetic::Binary(operator, Box::new(parts));
            left = (self.folded(whole, start)?, self.shallow(depth, start)?);
        }
    }

    /// A number, parameter, link, call or sum in parentheses, perhaps with a minus sign.
    fn factor(&mut self) -> Option<Deep> {
        if self.depth >= DEPTH {
            let message = format!("arithmetic is nested more than {DEPTH} levels deep");
            let span = self.place(self.at..self.at);
            return self
                .linker
                .reader
                .refuse(Code::NestedTooDeep, message, span, "here", |e| e);
        }
        self.depth += 1;
        let result = self.factor_at_depth();
        self.depth -= 1;
        result
    }

    fn factor_at_depth(&mut self) -> Option<Deep> {
        let start = self.at;
        match self.peek() {
            Some('-') => {
                self.take('-');
                let (of, depth) = self.factor()?;
                let whole = Arithmetic::Negate(Box::new(of));
                Some((self.folded(whole, start)?, depth + 1))
            }
            Some('(') => {
                self.take('(');
                let sum = self.sum()?;
                self.take(')')
                    .then_some(sum)
                    .or_else(|| self.expected("`)`"))
            }
            Some('0'..='9' | '.') => self.number(),
            Some('$') => self.parameter(),
            Some(letter) if letter.is_alphabetic() || letter == '_' => self.word(),
            _ => self.expected("a number, a `$parameter`, a link or `(`"),
        }
    }

    /// The number that a constant expression gives; others stay as they are.
    fn folded(&mut self, expression: Arithmetic, start: usize) -> Option<Arithmetic> {
        match expression.fold() {
            Arithmetic::Number(number) if !number.is_finite() => self.refuse_not_finite(start),
            folded => Some(folded),
        }
    }

    fn refuse_not_finite<T>(&mut self, start: usize) -> Option<T> {
        let span = self.place(start..self.at);
        let message = format!(
            "{} must be finite, found arithmetic that is not",
            shown(self.input.name)
        );
        self.linker.reader.refuse(
            Code::NotFinite,
            message,
            span,
            "not a finite number",
            |error| error.expected("a finite number", "infinity or no number"),
        )
    }

    fn shallow(&mut self, depth: usize, start: usize) -> Option<usize> {
        if depth <= OPERATORS {
            return Some(depth);
        }
        let message = format!("arithmetic has more than {OPERATORS} operators in a row");
        let span = self.place(start..self.at);
        self.linker
            .reader
            .refuse(Code::NestedTooDeep, message, span, "here", |error| {
                error.hint("make a node of a part of it")
            })
    }
}
