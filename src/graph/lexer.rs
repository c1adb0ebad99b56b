//! Tokens of a recipe, with the bytes they cover.

use super::report::Report;
use super::text_literal::{self, Found, TextLiteral};
use crate::diagnostics::{Code, Span};

/// The three sorts of brackets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bracket {
    /// `( )`
    Round,
    /// `[ ]`
    Square,
    /// `{ }`
    Curly,
}

impl Bracket {
    /// The letter that opens it.
    pub(super) fn open(self) -> char {
        ['(', '[', '{'][self as usize]
    }

    /// The letter that closes it.
    pub(super) fn close(self) -> char {
        [')', ']', '}'][self as usize]
    }
}

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TokenKind {
    /// An opening bracket.
    Open(Bracket),
    /// A closing bracket.
    Close(Bracket),
    /// `:`
    Colon,
    /// `,`
    Comma,
    /// A bare name, without the `r#` of a raw one.
    Name(String),
    /// A number, with its sign and suffix.
    Number,
    /// Text in quotes.
    Text(TextLiteral),
    /// Valid RON that no recipe uses: characters, bytes, ranges.
    Other,
    /// The end of the file.
    End,
}

/// A token and the bytes it covers.
#[derive(Clone, Debug)]
pub(super) struct Token {
    /// What it is.
    pub(super) kind: TokenKind,
    /// Where it is.
    pub(super) span: Span,
    /// Whether something without meaning stands before it, which is reported.
    pub(super) follows_mistake: bool,
}

/// Cuts a text into tokens, one at a time.
#[derive(Debug)]
pub(super) struct Lexer<'t> {
    text: &'t str,
    at: usize,
    /// Whether a string or a comment was not closed, so that brackets may be missing.
    pub(super) found_unclosed: bool,
    /// Whether one of them went on to the end of the file.
    took_rest: bool,
    /// From unclosed strings to the ends of their lines: what is wrong there is explained by them.
    explained: Vec<Span>,
}

impl<'t> Lexer<'t> {
    /// Starts behind the byte order mark and the attributes of the file.
    pub(super) fn new(text: &'t str, report: &mut Report) -> Lexer<'t> {
        let at = if text.starts_with('\u{feff}') { 3 } else { 0 };
        let mut lexer = Lexer {
            text,
            at,
            found_unclosed: false,
            took_rest: false,
            explained: vec![],
        };
        lexer.skip_space(report);
        while lexer.skip_attribute(report) {}
        lexer
    }

    /// Gives up: the next token is the end.
    pub(super) fn stop(&mut self) {
        self.at = self.text.len();
    }

    /// The next token; space and comments before it are skipped.
    pub(super) fn next(&mut self, report: &mut Report) -> Token {
        let mut follows_mistake = false;
        loop {
            self.skip_space(report);
            let start = self.at;
            if let Some(kind) = self.token(report) {
                return Token {
                    kind,
                    span: start..self.at,
                    follows_mistake,
                };
            }
            follows_mistake = true;
        }
    }

    fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    /// Takes one token; `None` if there was only something that has no meaning.
    fn token(&mut self, report: &mut Report) -> Option<TokenKind> {
        let rest = self.rest();
        let Some(letter) = rest.chars().next() else {
            return Some(TokenKind::End);
        };
        if let Some(kind) = punctuation(letter) {
            self.at += 1;
            return Some(kind);
        }
        if let Some(found) = text_literal::read(rest) {
            let start = self.at;
            self.at += match found.is_closed {
                true => found.length,
                false => self.refuse_unclosed(report, &found),
            };
            let text = |literal: TextLiteral| TokenKind::Text(literal.moved(start));
            return Some(found.literal.map_or(TokenKind::Other, text));
        }
        let length = number_length(rest);
        if length > 0 || rest.starts_with("..") {
            self.at += length;
            return Some(self.number_or_range());
        }
        let (name, length) = name(rest);
        if length > 0 {
            self.at += length;
            return Some(TokenKind::Name(name.to_owned()));
        }
        self.refuse(report);
        None
    }

    /// Reports an unclosed string; gives the bytes that are taken for it.
    fn refuse_unclosed(&mut self, report: &mut Report, found: &Found) -> usize {
        let start = self.at;
        let opening = start..start + found.opening;
        let is_explained = self.is_explained(start);
        if !is_explained {
            report.add(unclosed(report, opening, "string"));
        }
        self.found_unclosed = true;
        // To look through the rest again and again would take long.
        if found.takes_rest && std::mem::replace(&mut self.took_rest, true) {
            return found.length;
        }
        let rest = self.rest();
        let line = rest.find(['\n', '\r']).unwrap_or(rest.len());
        self.explained.push(start..start + line + 1);
        let length = text_literal::likely_length(rest, found.opening);
        let is_closed_otherwise = rest[length..].starts_with('"');
        length + usize::from(is_closed_otherwise && found.opening > 1)
    }

    /// Whether a mistake at `byte` follows from an unclosed string before it on the line.
    pub(super) fn is_explained(&self, byte: usize) -> bool {
        let next = self.explained.partition_point(|line| line.start <= byte);
        next > 0 && self.explained[next - 1].contains(&byte)
    }

    /// Whether a bracket at `byte` may be unclosed since a string behind it on its line is.
    pub(super) fn explains_bracket(&self, byte: usize) -> bool {
        let next = self.explained.partition_point(|line| line.start < byte);
        self.explained.get(next).is_some_and(|line| {
            let between = self.text.get(byte..line.start).unwrap_or("\n");
            !between.contains(['\n', '\r'])
        })
    }

    /// A number, unless it begins a range such as `0..5`.
    fn number_or_range(&mut self) -> TokenKind {
        if !self.rest().starts_with("..") {
            return TokenKind::Number;
        }
        self.at += if self.rest().starts_with("..=") { 3 } else { 2 };
        self.at += number_length(self.rest());
        TokenKind::Other
    }

    /// Reports a run of letters that begin no token.
    fn refuse(&mut self, report: &mut Report) {
        let begins_token = |(at, letter): &(usize, char)| {
            letter.is_whitespace()
                || letter.is_alphanumeric()
                || punctuation(*letter).is_some()
                || "\"/_+-".contains(*letter) && *at > 0
        };
        let rest = self.rest();
        let length = rest
            .char_indices()
            .skip(1)
            .find(begins_token)
            .map_or(rest.len(), |(at, _)| at);
        let start = self.at;
        self.at += length;
        if self.is_explained(start) {
            return;
        }
        let letter = rest.chars().next().unwrap_or(' ');
        let shown = super::names::shown_letter(letter);
        let message = format!("expected a value, a name or a bracket, found {shown}");
        let mut diagnostic = report.error(
            Code::Syntax,
            message,
            start..self.at,
            "this means nothing here",
        );
        let hint = match letter {
            '#' => Some("write colours in quotes: `\"#c8a06e\"`"),
            '=' => Some("write `name: value`, and arithmetic in quotes: `\"= 2 * $x\"`"),
            '\'' => Some("write text in double quotes"),
            _ => None,
        };
        diagnostic.hints.extend(hint.map(str::to_owned));
        report.add(diagnostic);
    }

    fn skip_space(&mut self, report: &mut Report) {
        loop {
            let rest = self.rest();
            self.at += rest.len() - rest.trim_start_matches(is_space).len();
            let rest = self.rest();
            if rest.starts_with("//") {
                self.at += rest.find(['\n', '\r']).unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.skip_block_comment(report);
            } else {
                return;
            }
        }
    }

    /// Block comments hold block comments.
    fn skip_block_comment(&mut self, report: &mut Report) {
        let bytes = self.rest().as_bytes();
        let (mut depth, mut at) = (1, 2);
        while depth > 0 && at < bytes.len() {
            match bytes.get(at..at + 2) {
                Some(b"/*") => (depth, at) = (depth + 1, at + 2),
                Some(b"*/") => (depth, at) = (depth - 1, at + 2),
                _ => at += 1,
            }
        }
        if depth > 0 {
            self.found_unclosed = true;
            report.add(unclosed(report, self.at..self.at + 2, "comment"));
        }
        self.at += at;
    }

    /// Skips `#![..]`; what stands in it is for the `ron` crate to judge.
    fn skip_attribute(&mut self, report: &mut Report) -> bool {
        let rest = self.rest();
        let is_attribute = rest
            .strip_prefix('#')
            .is_some_and(|rest| rest.trim_start_matches(is_space).starts_with('!'));
        if is_attribute {
            self.at += rest.find(']').map_or(rest.len(), |end| end + 1);
            self.skip_space(report);
        }
        is_attribute
    }
}

/// The mistake of something that is opened and never closed.
pub(super) fn unclosed(
    report: &Report,
    opening: Span,
    what: &str,
) -> crate::diagnostics::Diagnostic {
    report.error(
        Code::Unclosed,
        format!("this {what} is never closed"),
        opening,
        "opened here",
    )
}

fn punctuation(letter: char) -> Option<TokenKind> {
    Some(match letter {
        '(' => TokenKind::Open(Bracket::Round),
        ')' => TokenKind::Close(Bracket::Round),
        '[' => TokenKind::Open(Bracket::Square),
        ']' => TokenKind::Close(Bracket::Square),
        '{' => TokenKind::Open(Bracket::Curly),
        '}' => TokenKind::Close(Bracket::Curly),
        ':' => TokenKind::Colon,
        ',' => TokenKind::Comma,
        _ => return None,
    })
}

/// The white space of RON.
fn is_space(letter: char) -> bool {
    matches!(
        letter,
        '\t'..='\r' | ' ' | '\u{85}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}'
    )
}

/// Bytes of the number that `text` begins with; whether it is a valid one is seen later.
fn number_length(text: &str) -> usize {
    let unsigned = text.trim_start_matches(['+', '-']);
    let sign = text.len() - unsigned.len();
    let begins = unsigned.starts_with(|letter: char| letter.is_ascii_digit())
        || unsigned.starts_with('.') && unsigned[1..].starts_with(|c: char| c.is_ascii_digit())
        || sign > 0 && (unsigned.starts_with("inf") || unsigned.starts_with("NaN"));
    if !begins || sign > 1 {
        return 0;
    }
    let bytes = unsigned.as_bytes();
    let is_plain = !matches!(bytes.get(1), Some(b'x' | b'b' | b'o'));
    let belongs = |at: &usize| match bytes[*at] {
        b'.' => bytes.get(at + 1) != Some(&b'.'),
        b'+' | b'-' => is_plain && unsigned[..*at].trim_end_matches('_').ends_with(['e', 'E']),
        byte => byte.is_ascii_alphanumeric() || byte == b'_',
    };
    sign + 1 + (1..bytes.len()).take_while(belongs).count()
}

/// The name that `text` begins with, and how many bytes it takes.
fn name(text: &str) -> (&str, usize) {
    let plain = text.strip_prefix("r#").unwrap_or(text);
    let prefix = text.len() - plain.len();
    let is_raw = |letter: char| prefix > 0 && ".+-".contains(letter);
    let belongs = |letter: char| letter.is_alphanumeric() || letter == '_' || is_raw(letter);
    if plain.starts_with(|letter: char| letter.is_alphabetic() || letter == '_' || prefix > 0) {
        let length = plain.find(|letter| !belongs(letter)).unwrap_or(plain.len());
        if length > 0 {
            return (&plain[..length], prefix + length);
        }
    }
    ("", 0)
}
