//! Literals that are made of parts: tuples, colours, lists, records and lists of names.

use super::literal::{Reader, Slot, parameter_name};
use super::names::{check_name, look_alike, shown};
use super::recipe::{report_duplicate_field, report_duplicate_name};
use super::report::Report;
use super::text;
use super::tree::{Field, Shape, Tree};
use crate::colour::from_srgb;
use crate::diagnostics::{Code, SourceFile, Span, nearest};
use crate::node::{Input, Presence};
use crate::value::{Type, Unit, Value};
use std::collections::HashMap;
use std::sync::Arc;

impl Tree {
    /// The items of a tuple or a list; the two stand for each other.
    pub(super) fn items(&self) -> Option<&[Tree]> {
        match &self.shape {
            Shape::Tuple(None, items) | Shape::List(items) => Some(items),
            _ => None,
        }
    }

    /// The fields of a record without a name; an empty tuple has none.
    fn fields(&self) -> Option<&[Field]> {
        match &self.shape {
            Shape::Record(None, fields) => Some(fields),
            Shape::Tuple(None, items) if items.is_empty() => Some(&[]),
            _ => None,
        }
    }
}

/// Whether items are lists of numbers: where lists of points are wanted, brackets are missing.
fn is_flat(items: &[Tree]) -> bool {
    let is_number = |part: &Tree| matches!(part.shape, Shape::Number);
    let is_point = |item: &Tree| {
        item.items()
            .is_some_and(|parts| !parts.is_empty() && parts.iter().all(is_number))
    };
    !items.is_empty() && items.iter().all(is_point)
}

impl Reader<'_> {
    /// As many numbers as are asked for.
    pub(super) fn numbers<const N: usize>(
        &mut self,
        tree: &Tree,
        slot: Slot<'_>,
        part: Type,
    ) -> Option<[f64; N]> {
        let items = match (&tree.shape, tree.items()) {
            (Shape::Text(_), _) => return self.refuse_link(tree, slot),
            (_, None) => return self.mismatch(tree, slot),
            (_, Some(items)) => items,
        };
        if items.len() != N {
            return self.refuse_length(tree, slot, N, items.len());
        }
        let parts: Vec<_> = items
            .iter()
            .map(|item| self.literal(item, slot.of(part)))
            .collect();
        let mut numbers = [0.0; N];
        for (number, part) in numbers.iter_mut().zip(parts) {
            let Some(Value::Number(part)) = part else {
                return None;
            };
            *number = part;
        }
        Some(numbers)
    }

    fn refuse_length<T>(
        &mut self,
        tree: &Tree,
        slot: Slot<'_>,
        expected: usize,
        found: usize,
    ) -> Option<T> {
        let name = shown(slot.name);
        let message = format!("{name} takes {expected} numbers, found {found}");
        let label = format!("expected {}", slot.value_type);
        self.refuse(
            Code::WrongLength,
            message,
            tree.span.clone(),
            label,
            |error| error.expected(format!("{expected} numbers"), found),
        )
    }

    /// `(r, g, b)` linear, or `"#rrggbb"` in sRGB.
    pub(super) fn colour(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<[f64; 3]> {
        let Shape::Text(text) = &tree.shape else {
            return self.numbers(tree, slot, Type::Number(Unit::One));
        };
        let Some(colour) = hexadecimal_colour(&text.value) else {
            let found = shown(&text.value);
            let message = format!(
                "expected a colour such as `#c8a06e` for {}, found {found}",
                shown(slot.name)
            );
            let span = tree.span.clone();
            return self.refuse(
                Code::InvalidColour,
                message,
                span,
                "not a colour",
                |error| {
                    let error = error.expected("a colour such as `#c8a06e`", found);
                    match six_digits(&text.value) {
                        Some(digits) => error.hint(format!("write all six digits: `\"{digits}\"`")),
                        None => error,
                    }
                },
            );
        };
        Some(colour)
    }

    /// Items of one type.
    pub(super) fn list(&mut self, tree: &Tree, slot: Slot<'_>, item: Type) -> Option<Vec<Value>> {
        let Some(items) = tree.items() else {
            return self.mismatch(tree, slot);
        };
        if matches!(item, Type::List(Type::Pair(_) | Type::Vector(_))) && is_flat(items) {
            return self.mismatch(tree, slot);
        }
        let values: Vec<_> = items
            .iter()
            .map(|tree| self.literal(tree, slot.of(item)))
            .collect();
        values.into_iter().collect()
    }

    /// Named parts; those that are left out and have no default are missing.
    pub(super) fn record(
        &mut self,
        tree: &Tree,
        slot: Slot<'_>,
        parts: &'static [Input],
    ) -> Option<Vec<(&'static str, Value)>> {
        let Some(fields) = tree.fields() else {
            return self.mismatch(tree, slot);
        };
        let owner = format!("a part of {}", shown(slot.name));
        let found = self.assign(&owner, parts, fields);
        let mut values = vec![];
        let mut is_valid = true;
        for (part, found) in parts.iter().zip(found) {
            let slot = Slot::from(part);
            let value = match (found, part.presence) {
                (Some(tree), _) => self.literal(tree, slot),
                (None, Presence::Default(text)) => Some(default_literal(part, text)),
                (None, Presence::Optional) => continue,
                (None, Presence::Required) => self.refuse_missing(&owner, part, tree.span.clone()),
            };
            is_valid &= value.is_some();
            values.extend(value.map(|value| (part.name, value)));
        }
        is_valid.then_some(values)
    }

    /// The field for each of the inputs; fields that are none of them, or are written twice, are reported.
    pub(super) fn assign<'t>(
        &mut self,
        owner: &str,
        inputs: &'static [Input],
        fields: &'t [Field],
    ) -> Vec<Option<&'t Tree>> {
        let mut found: Vec<Option<&Field>> = vec![None; inputs.len()];
        let mut unknown: HashMap<&str, Span> = HashMap::new();
        for field in fields {
            let name = field.name.text.as_str();
            let index = inputs.iter().position(|input| input.name == name);
            let first = match index {
                Some(index) => found[index]
                    .replace(field)
                    .map(|field| field.name.span.clone()),
                None => unknown.insert(name, field.name.span.clone()),
            };
            match (index, first) {
                (_, Some(first)) => report_duplicate_field(self.report, &field.name, first),
                (None, None) => self.refuse_unknown_input(owner, inputs, field),
                _ => {}
            }
        }
        found
            .into_iter()
            .map(|field| field.map(|field| &field.value))
            .collect()
    }

    fn refuse_unknown_input(&mut self, owner: &str, inputs: &'static [Input], field: &Field) {
        let name = &field.name.text;
        let names: Vec<_> = inputs.iter().map(|input| input.name).collect();
        let message = format!("{} is not {owner}", shown(name));
        let span = field.name.span.clone();
        let label = look_alike(name, "unknown");
        self.refuse::<()>(Code::UnknownInput, message, span, label, |error| {
            let error = error.nearest(nearest(name, names.iter().copied()));
            match names.is_empty() {
                true => error.hint("it takes no inputs"),
                false => error.hint(format!("valid names are {}", names.join(", "))),
            }
        });
    }

    /// Reports an input that is left out.
    pub(super) fn refuse_missing<T>(
        &mut self,
        owner: &str,
        input: &Input,
        span: Span,
    ) -> Option<T> {
        let name = shown(input.name);
        let message = format!("{name}, {owner}, is missing");
        let label = format!("{name} is missing: {}", input.value_type);
        self.refuse(Code::MissingInput, message, span, label, |error| {
            error.expected(input.value_type, "nothing")
        })
    }

    /// Names of channels, in the order of the recipe.
    pub(super) fn names(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<Vec<String>> {
        let Some(items) = tree.items() else {
            return self.mismatch(tree, slot);
        };
        let mut names: Vec<(String, Span)> = vec![];
        for item in items {
            let Some(name) = self.channel_name(item, slot) else {
                continue;
            };
            check_name(self.report, "a channel", &name, item.span.clone());
            if let Some((_, first)) = names.iter().find(|(known, _)| *known == name) {
                let (span, first) = (item.span.clone(), first.clone());
                report_duplicate_name(self.report, "channel", &name, span, first);
            }
            names.push((name, item.span.clone()));
        }
        let is_valid = names.len() == items.len();
        is_valid.then(|| names.into_iter().map(|(name, _)| name).collect())
    }

    fn channel_name(&mut self, item: &Tree, slot: Slot<'_>) -> Option<String> {
        match &item.shape {
            Shape::Name(name) => Some(name.clone()),
            Shape::Text(text) if parameter_name(&text.value).is_none() => Some(text.value.clone()),
            Shape::Text(_) => match self.literal(item, slot.of(Type::Text))? {
                Value::Text(text) => Some(text),
                _ => None,
            },
            _ => self.mismatch(item, slot),
        }
    }
}

impl<'n> From<&'n Input> for Slot<'n> {
    fn from(input: &'n Input) -> Slot<'n> {
        Slot {
            name: input.name,
            value_type: input.value_type,
            range: input.range,
        }
    }
}

/// The linear colour that `#rrggbb` means in sRGB.
fn hexadecimal_colour(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#')?;
    if digits.len() != 6 || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let number = u32::from_str_radix(digits, 16).ok()?;
    let [_, bytes @ ..] = number.to_be_bytes();
    Some(bytes.map(|byte| from_srgb(f64::from(byte) / 255.0)))
}

/// What stylesheets write as `#rgb` with all its digits.
fn six_digits(text: &str) -> Option<String> {
    let digits = text.trim_start_matches('#');
    let is_short = digits.len() == 3 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let both = |digit: char| [digit, digit];
    is_short.then(|| {
        std::iter::once('#')
            .chain(digits.chars().flat_map(both))
            .collect()
    })
}

/// The value of a default that a kind declares.
///
/// # Panics
/// If it is not a literal of the input's type: a mistake in the kind, which the tests look for.
pub(super) fn default_literal(input: &Input, literal: &str) -> Value {
    let mut report = Report::new(&Arc::new(SourceFile::new("", literal)));
    let mut none = super::parameters::Parameters::default();
    let value = text::read(&mut report).and_then(|tree| {
        Reader::new(&mut none, &mut report, None).literal(&tree, Slot::from(input))
    });
    value.unwrap_or_else(|| {
        let problems = crate::diagnostics::render_all(&report.finish());
        panic!(
            "the default of input `{}` is not a literal of its type: {problems}",
            input.name
        )
    })
}
