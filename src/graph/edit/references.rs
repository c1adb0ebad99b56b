//! Where a recipe refers to nodes and parameters: links, `$names`, and both within arithmetic.

use crate::diagnostics::Span;
use crate::graph::arithmetic::written_unit;
use crate::graph::literal::parameter_name;
use crate::graph::text_literal::TextLiteral;
use crate::graph::tree::{Field, Shape, Tree};
use crate::node::{Input, Kind};
use crate::value::{Type, Unit};

/// A name in a text that stands for a node or a parameter.
#[derive(Clone, Debug)]
pub(super) struct Reference<'t> {
    /// The text in quotes that it is in.
    pub(super) tree: &'t Tree,
    /// The same, decoded.
    pub(super) text: &'t TextLiteral,
    /// The name within the decoded text.
    pub(super) bytes: Span,
    /// Whether it stands for a parameter.
    pub(super) is_parameter: bool,
}

/// Every reference in the inputs of an instance of `kind`.
pub(super) fn of_instance<'t>(kind: &Kind, instance: &'t Tree) -> Vec<Reference<'t>> {
    let mut references = vec![];
    if let Shape::Record(_, fields) = &instance.shape {
        add_fields(&mut references, kind.inputs, fields);
    }
    references
}

fn add_fields<'t>(references: &mut Vec<Reference<'t>>, inputs: &[Input], fields: &'t [Field]) {
    for field in fields {
        let input = inputs.iter().find(|input| input.name == field.name.text);
        if let Some(input) = input {
            add(references, input.value_type, &field.value);
        }
    }
}

/// What a value of a type refers to; the same reading as when the recipe is checked.
fn add<'t>(references: &mut Vec<Reference<'t>>, value_type: Type, tree: &'t Tree) {
    match (value_type, &tree.shape) {
        (_, Shape::Text(text)) => add_text(references, value_type, tree, text),
        (Type::List(item), Shape::List(items) | Shape::Tuple(None, items)) => {
            items.iter().for_each(|tree| add(references, *item, tree));
        }
        (Type::Record(parts), Shape::Record(None, fields)) => {
            add_fields(references, parts, fields);
        }
        (Type::Names, Shape::List(items) | Shape::Tuple(None, items)) => {
            items
                .iter()
                .for_each(|tree| add(references, Type::Text, tree));
        }
        (Type::Channels | Type::Materials, Shape::Map(entries)) => {
            for entry in entries {
                add_channel(references, &entry.value);
            }
        }
        (_, Shape::List(items) | Shape::Tuple(None, items)) => {
            let part = Type::Number(Unit::One);
            items.iter().for_each(|tree| add(references, part, tree));
        }
        _ => {}
    }
}

/// A channel is a number or a colour, whichever it is.
fn add_channel<'t>(references: &mut Vec<Reference<'t>>, tree: &'t Tree) {
    let is_colour = matches!(&tree.shape, Shape::Text(text) if text.value.starts_with('#'));
    if !is_colour {
        add(references, Type::Number(Unit::One), tree);
    }
}

fn add_text<'t>(
    references: &mut Vec<Reference<'t>>,
    value_type: Type,
    tree: &'t Tree,
    text: &'t TextLiteral,
) {
    let whole = 0..text.value.len();
    let mut refer = |bytes: Span, is_parameter| {
        references.push(Reference {
            tree,
            text,
            bytes,
            is_parameter,
        });
    };
    let is_text = matches!(
        value_type,
        Type::Text | Type::File | Type::Choice(_) | Type::Names
    );
    if parameter_name(&text.value).is_some() {
        refer(1..whole.end, true);
    } else if is_text || value_type == Type::Colour && text.value.starts_with('#') {
        // Text refers to nothing.
    } else if text.value.starts_with('=') {
        for (bytes, is_parameter) in words(&text.value) {
            refer(bytes, is_parameter);
        }
    } else {
        refer(0..node_length(&text.value), false);
    }
}

/// Bytes of the node in a link.
fn node_length(link: &str) -> usize {
    link.find('.').unwrap_or(link.len())
}

/// The parameters and the nodes in arithmetic: the bytes of their names, and whether it is a parameter.
fn words(text: &str) -> Vec<(Span, bool)> {
    let belongs = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '.';
    let mut found = vec![];
    let mut at = 1;
    while let Some(letter) = text[at..].chars().next() {
        let start = at + usize::from(letter == '$');
        let word = &text[start..];
        let length = word.find(|letter| !belongs(letter)).unwrap_or(word.len());
        let rest = word[length..].trim_start();
        let word = &word[..length];
        if letter == '$' {
            found.push((start..start + length, true));
        } else if (letter.is_alphabetic() || letter == '_') && !rest.starts_with('(') {
            found.push((start..start + node_length(word), false));
        }
        at = if belongs(letter) || letter == '$' {
            start + length
        } else {
            start + letter.len_utf8()
        };
        if letter.is_ascii_digit() || letter == '.' {
            at += written_unit(&text[at..]).map_or(0, |(_, length)| length);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_arithmetic_are_nodes_and_parameters() {
        let text = "= 2e3 mm * look.position + max($w, a_1) - .5*$look - luminance( max.colour )";
        let found: Vec<_> = words(text)
            .into_iter()
            .map(|(bytes, is_parameter)| (&text[bytes], is_parameter))
            .collect();
        let expected = [
            ("look", false),
            ("w", true),
            ("a_1", false),
            ("look", true),
            ("max", false),
        ];
        assert_eq!(found, expected);
    }
}
