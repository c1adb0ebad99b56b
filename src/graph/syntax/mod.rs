//! The tree of a recipe: every name, key and value with the bytes it covers.
//!
//! It is lossless by its spans: what is between them stays in the text, so an edit replaces a range of
//! bytes and keeps all comments. Reading never fails: what is wrong is reported, several mistakes at
//! once, and the tree has what could be understood. It accepts more than RON does; [`super::text`]
//! asks the `ron` crate about the rest.

mod mistakes;
mod recovery;

use super::lexer::{Bracket, Lexer, Token, TokenKind};
use super::names::shown;
use super::number;
use super::report::Report;
use super::tree::{Entry, Field, Shape, Tree, Word};
use crate::diagnostics::{Code, Span};
use recovery::Open;

/// Values that are read.
const VALUES: usize = 4_000_000;
/// Levels of brackets that are read.
pub(super) const DEPTH: usize = 64;

/// An item between parentheses.
enum Item {
    Value(Tree),
    Field(Field),
}

/// Reads the text of `report`; `None` if there is nothing in it but space and comments.
pub(super) fn parse(report: &mut Report) -> Option<Tree> {
    let source = std::sync::Arc::clone(&report.source);
    let mut lexer = Lexer::new(&source.text, report);
    let token = lexer.next(report);
    let ahead = lexer.next(report);
    let mut parser = Parser {
        lexer,
        token,
        ahead,
        open: vec![],
        starts_line: true,
        indent: 0,
        values: 0,
        end: 0,
        report,
        gave_up: false,
    };
    let tree = parser.file();
    report.keep_first_of_lines();
    tree
}

struct Parser<'t, 'r> {
    lexer: Lexer<'t>,
    token: Token,
    ahead: Token,
    /// The brackets around the token.
    open: Vec<Open>,
    /// Whether the token is the first of its line.
    starts_line: bool,
    /// Bytes before the first token of the token's line.
    indent: usize,
    /// Values that have been read.
    values: usize,
    /// Where the last taken token ended.
    end: usize,
    report: &'r mut Report,
    /// Whether the rest is not worth reporting.
    gave_up: bool,
}

impl Parser<'_, '_> {
    fn file(&mut self) -> Option<Tree> {
        if self.token.kind == TokenKind::End {
            return None;
        }
        let tree = self.value();
        if self.token.kind != TokenKind::End {
            self.expected("the end of the file");
        }
        Some(tree)
    }

    /// Takes the token.
    fn advance(&mut self) -> Token {
        if self.report.is_full() {
            self.give_up();
        }
        let next = self.lexer.next(self.report);
        let ahead = std::mem::replace(&mut self.ahead, next);
        let token = std::mem::replace(&mut self.token, ahead);
        self.end = token.span.end;
        self.find_line();
        token
    }

    fn give_up(&mut self) {
        self.gave_up = true;
        self.lexer.stop();
        let end = self.report.source.text.len();
        self.ahead = Token {
            kind: TokenKind::End,
            span: end..end,
            follows_mistake: true,
        };
        self.token = self.ahead.clone();
    }

    fn value(&mut self) -> Tree {
        let start = self.token.span.start;
        self.values += 1;
        if self.values > VALUES {
            self.refuse_many();
        }
        let shape = match &self.token.kind {
            TokenKind::Open(bracket) => {
                let bracket = *bracket;
                self.bracket(bracket, None)
            }
            TokenKind::Name(_) => self.name(),
            TokenKind::Number => self.number(),
            TokenKind::Other => self.leaf(Shape::Other),
            TokenKind::Text(text) => {
                let shape = Shape::Text(text.clone());
                self.leaf(shape)
            }
            _ => {
                self.expected("a value");
                return Tree {
                    shape: Shape::Missing,
                    span: start..start,
                };
            }
        };
        Tree {
            shape,
            span: start..self.end,
        }
    }

    fn number(&mut self) -> Shape {
        let span = self.token.span.clone();
        let text = &self.report.source.text[span.clone()];
        if number::read(text).is_none() {
            let message = format!("{} is not a number", shown(text));
            self.add(
                self.report
                    .error(Code::Syntax, message, span, "not a number"),
            );
        }
        self.leaf(Shape::Number)
    }

    fn leaf(&mut self, shape: Shape) -> Shape {
        self.advance();
        shape
    }

    /// A bare name, or the name of a record or tuple.
    fn name(&mut self) -> Shape {
        let word = self.word();
        let is_field = self.ahead.kind == TokenKind::Colon;
        match self.token.kind {
            TokenKind::Open(Bracket::Round) => self.bracket(Bracket::Round, Some(word)),
            TokenKind::Name(_) if is_field && self.is_in_map() => self.record_without_open(word),
            _ => Shape::Name(word.text),
        }
    }

    /// Takes a name, or a text that stands for one.
    fn word(&mut self) -> Word {
        let token = self.advance();
        let text = match token.kind {
            TokenKind::Name(text) => text,
            TokenKind::Text(text) => text.value,
            _ => String::new(),
        };
        Word {
            text,
            span: token.span,
        }
    }

    fn bracket(&mut self, bracket: Bracket, name: Option<Word>) -> Shape {
        if self.open.len() >= DEPTH {
            self.refuse_depth();
            return Shape::Missing;
        }
        let opening = self.token.span.clone();
        self.push(bracket, self.indent);
        self.advance();
        let shape = match bracket {
            Bracket::Round => self.parentheses(name, &opening),
            Bracket::Square => Shape::List(self.items(bracket, &opening, Self::value)),
            Bracket::Curly => Shape::Map(self.items(bracket, &opening, Self::entry)),
        };
        self.open.pop();
        shape
    }

    fn parentheses(&mut self, name: Option<Word>, opening: &Span) -> Shape {
        let items = self.items(Bracket::Round, opening, Self::item);
        let is_record = items.iter().any(|item| matches!(item, Item::Field(_)));
        let (mut values, mut fields) = (vec![], vec![]);
        for item in items {
            match item {
                Item::Value(value) if is_record => self.refuse_value_among_fields(&value),
                Item::Value(value) => values.push(value),
                Item::Field(field) => fields.push(field),
            }
        }
        if is_record {
            Shape::Record(name, fields)
        } else {
            Shape::Tuple(name, values)
        }
    }

    /// Items with commas between them, up to the closing bracket.
    fn items<T>(&mut self, bracket: Bracket, opening: &Span, item: fn(&mut Self) -> T) -> Vec<T> {
        let mut items = vec![];
        loop {
            match self.token.kind {
                TokenKind::Close(closing) if closing == bracket => {
                    self.advance();
                    return items;
                }
                TokenKind::Close(closing) if self.closes_nothing(closing) => {
                    self.refuse_extra();
                    self.advance();
                }
                TokenKind::Close(closing) if !self.is_open(closing) => {
                    self.refuse_closing(bracket, opening);
                    self.advance();
                    return items;
                }
                _ if self.leaves(bracket) => {
                    self.refuse_unclosed(bracket, opening);
                    self.token.follows_mistake = true;
                    return items;
                }
                TokenKind::Close(_) | TokenKind::End => {
                    self.refuse_unclosed(bracket, opening);
                    return items;
                }
                TokenKind::Comma | TokenKind::Colon => {
                    self.expected("a value");
                    self.advance();
                    continue;
                }
                _ => items.push(item(self)),
            }
            self.separator();
        }
    }

    /// A comma, unless the bracket closes.
    fn separator(&mut self) {
        match self.token.kind {
            TokenKind::Comma => {
                self.advance();
            }
            TokenKind::Close(_) | TokenKind::End | TokenKind::Colon => {}
            _ if self.gave_up || self.token.follows_mistake => {}
            _ if self.is_unit() => self.refuse_unit(),
            _ => {
                let found = self.found();
                let message = format!("expected `,`, found {found}");
                let error = self.report.error(
                    Code::Syntax,
                    message,
                    self.end..self.end,
                    "a comma is missing here",
                );
                self.add(error.expected("`,`", found));
            }
        }
    }

    fn item(&mut self) -> Item {
        let is_field = self.ahead.kind == TokenKind::Colon;
        match self.token.kind {
            TokenKind::Name(_) if is_field => Item::Field(self.field()),
            TokenKind::Text(_) if is_field => {
                let found = self.found();
                let message = format!("expected the name of a field, found {found}");
                let span = self.token.span.clone();
                let error = self.report.error(Code::Syntax, message, span, "in quotes");
                self.add(
                    error
                        .expected("the name of a field", found)
                        .hint("write names of fields and inputs without quotes"),
                );
                Item::Field(self.field())
            }
            _ => Item::Value(self.value()),
        }
    }

    fn field(&mut self) -> Field {
        if let Some(open) = self.open.last_mut() {
            open.has_fields = true;
        }
        let name = self.word();
        self.advance();
        let begins_entry =
            matches!(self.token.kind, TokenKind::Text(_)) && self.ahead.kind == TokenKind::Colon;
        let value = if begins_entry {
            self.map_without_brace()
        } else {
            self.value()
        };
        Field { name, value }
    }

    fn entry(&mut self) -> Entry {
        let key = self.value();
        if self.token.kind != TokenKind::Colon && self.ahead.kind == TokenKind::Colon {
            self.expected("`:`");
            self.advance();
        }
        if self.token.kind == TokenKind::Colon {
            self.advance();
            return Entry {
                key,
                value: self.value(),
            };
        }
        self.expected("`:`");
        let closes = matches!(
            self.token.kind,
            TokenKind::Comma | TokenKind::Close(_) | TokenKind::End
        );
        let here = self.end..self.end;
        let value = if closes {
            Tree {
                shape: Shape::Missing,
                span: here,
            }
        } else {
            self.value()
        };
        Entry { key, value }
    }
}
