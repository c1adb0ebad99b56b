//! Arithmetic in strings: `"= 0.03 * look.position + $height"`.
//!
//! Numbers, `$parameters`, links, `+ - * /` with the usual precedence, parentheses and functions. Numbers
//! are taken as they are: the result is in the unit of the input. What is constant is folded.

use super::links::Linker;
use super::literal::Slot;
use super::names::shown;
use super::syntax::{DEPTH, Tree};
use super::text_literal::TextLiteral;
use super::{Arithmetic, Function, Operator, Source};
use crate::colour::luminance;
use crate::diagnostics::{Code, Span, nearest};
use crate::node::Input;
use crate::value::{Type, Value};

/// Operators between the root of an expression and its deepest part.
const OPERATORS: usize = 256;

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

    fn number(&mut self) -> Option<Deep> {
        let bytes = self.text.value[self.at..].as_bytes();
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

    fn parameter(&mut self) -> Option<Deep> {
        let start = self.at;
        self.take('$');
        let range = self.letters();
        let name = &self.text.value[range.clone()];
        let span = self.place(start..range.end);
        let reader = &mut self.linker.reader;
        let Some(declared) = reader.parameters.refer(name) else {
            return reader.refuse_unknown_parameter(name, span);
        };
        let value_type = declared.value_type?;
        match declared.value.as_ref()? {
            Value::Number(number) => Some((Arithmetic::Number(*number), 0)),
            Value::Whole(whole) => Some((Arithmetic::Number(*whole as f64), 0)),
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

    /// A function if parentheses follow, otherwise a link.
    fn word(&mut self) -> Option<Deep> {
        let range = self.letters();
        if self.take('(') {
            return self.call(range);
        }
        let name = &self.text.value[range.clone()];
        if Function::from_name(name).is_some() && !self.linker.scope.nodes.contains_key(name) {
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
        let Some(function) = Function::from_name(written) else {
            let names = Function::ALL.map(Function::name);
            let message = format!("there is no function {}", shown(written));
            let near = nearest(written, names);
            let span = self.place(name);
            return self.linker.reader.refuse(
                Code::InvalidArithmetic,
                message,
                span,
                "not a function",
                |error| {
                    error
                        .nearest(near)
                        .hint(format!("the functions are {}", names.join(", ")))
                },
            );
        };
        if function == Function::Luminance {
            return self.luminance();
        }
        let mut arguments = vec![self.sum()?];
        while self.take(',') {
            arguments.push(self.sum()?);
        }
        if !self.take(')') {
            return self.expected("`,` or `)`");
        }
        let (wanted, found) = (function.arguments(), arguments.len());
        if found != wanted {
            let message = format!("{} takes {wanted} numbers, found {found}", shown(written));
            return self.refuse(
                message,
                name.start..self.at,
                &format!("expected {wanted} numbers"),
            );
        }
        let depth = 1 + arguments.iter().map(|(_, depth)| *depth).max().unwrap_or(0);
        let arguments = arguments
            .into_iter()
            .map(|(argument, _)| argument)
            .collect();
        let whole = Arithmetic::Call(function, arguments);
        Some((
            self.folded(whole, name.start)?,
            self.shallow(depth, name.start)?,
        ))
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
        let value = self
            .linker
            .reader
            .parameter(&self.text.value[range], span, slot)?;
        let Value::Colour(colour) = value else {
            return None;
        };
        let number = f64::from(luminance(colour.map(|part| part as f32)));
        Some((Arithmetic::Number(number), 0))
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

impl Arithmetic {
    /// A number, if all parts are numbers.
    fn fold(self) -> Arithmetic {
        use Arithmetic::{Binary, Call, Negate, Number};
        match &self {
            Negate(of) => match **of {
                Number(number) => Number(-number),
                _ => self,
            },
            Binary(operator, parts) => match **parts {
                [Number(a), Number(b)] => Number(operator.apply(a, b)),
                _ => self,
            },
            Call(function, arguments) => {
                let numbers: Option<Vec<f64>> =
                    arguments.iter().map(Arithmetic::as_number).collect();
                numbers
                    .and_then(|numbers| function.apply(&numbers))
                    .map_or(self, Number)
            }
            _ => self,
        }
    }

    fn as_number(&self) -> Option<f64> {
        match self {
            Arithmetic::Number(number) => Some(*number),
            _ => None,
        }
    }
}

impl Operator {
    /// What it makes of two numbers.
    fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Operator::Add => a + b,
            Operator::Subtract => a - b,
            Operator::Multiply => a * b,
            Operator::Divide => a / b,
        }
    }
}

impl Function {
    /// Every function.
    pub const ALL: [Function; 7] = [
        Function::Min,
        Function::Max,
        Function::Abs,
        Function::Sqrt,
        Function::Clamp,
        Function::Mix,
        Function::Luminance,
    ];

    /// The name in recipes.
    pub fn name(self) -> &'static str {
        ["min", "max", "abs", "sqrt", "clamp", "mix", "luminance"][self as usize]
    }

    /// The function called `name`.
    pub fn from_name(name: &str) -> Option<Function> {
        Function::ALL
            .into_iter()
            .find(|function| function.name() == name)
    }

    /// Numbers that it takes.
    pub fn arguments(self) -> usize {
        match self {
            Function::Abs | Function::Sqrt | Function::Luminance => 1,
            Function::Min | Function::Max => 2,
            Function::Clamp | Function::Mix => 3,
        }
    }

    /// What it makes of numbers; luminance is of colours.
    fn apply(self, numbers: &[f64]) -> Option<f64> {
        Some(match (self, numbers) {
            (Function::Min, [a, b]) => a.min(*b),
            (Function::Max, [a, b]) => a.max(*b),
            (Function::Abs, [a]) => a.abs(),
            (Function::Sqrt, [a]) => a.max(0.0).sqrt(),
            (Function::Clamp, [a, low, high]) => a.max(*low).min(*high),
            (Function::Mix, [a, b, amount]) => a + (b - a) * amount,
            _ => return None,
        })
    }
}

impl Type {
    fn is_number(self) -> bool {
        matches!(self, Type::Number(_))
    }
}
