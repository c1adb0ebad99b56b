//! Inputs in words, as short as a recipe would write them.

use crate::colour::to_srgb;
use crate::graph::{Arithmetic, Graph, Link, Operator, Source};
use crate::value::Value;

/// Letters after which a text is cut.
const LONGEST: usize = 60;

/// The value of an input or where it comes from; long ones are cut.
pub(super) fn source(graph: &Graph, source: &Source) -> String {
    let text = match source {
        Source::Absent => "nothing".to_owned(),
        Source::Literal(literal) => value(literal),
        Source::File(file) => format!("\"{}\"", file.path.display()),
        Source::Link(link) => format!("`{}`", name(graph, link)),
        Source::Arithmetic(arithmetic) => format!("= {}", expression(graph, arithmetic)),
        Source::Channels(channels) => {
            let part =
                |(name, part): &(String, Source)| format!("{name}: {}", self::source(graph, part));
            format!(
                "{{{}}}",
                channels.iter().map(part).collect::<Vec<_>>().join(", ")
            )
        }
    };
    if text.chars().count() <= LONGEST {
        return text;
    }
    let cut: String = text.chars().take(LONGEST - 3).collect();
    format!("{cut}...")
}

fn value(literal: &Value) -> String {
    let list = |parts: Vec<String>| parts.join(", ");
    let numbers =
        |numbers: &[f64]| format!("({})", list(numbers.iter().map(f64::to_string).collect()));
    match literal {
        Value::Number(number) => number.to_string(),
        Value::Whole(number) => number.to_string(),
        Value::Toggle(toggle) => toggle.to_string(),
        Value::Choice(name) => (*name).to_owned(),
        Value::Text(text) => format!("{text:?}"),
        Value::Colour(colour) => hexadecimal(colour).unwrap_or_else(|| numbers(colour)),
        Value::Vector(vector) => numbers(&vector.to_array()),
        Value::Pair(pair) => numbers(pair),
        Value::List(items) => format!("[{}]", list(items.iter().map(value).collect())),
        Value::Names(names) => format!("[{}]", names.join(", ")),
        Value::Record(parts) => {
            let part = |(name, part): &(&str, Value)| format!("{name}: {}", value(part));
            format!("({})", list(parts.iter().map(part).collect()))
        }
        other => format!("a {}", other.type_name()),
    }
}

/// A colour as `#rrggbb`, if it is one that can be written so.
fn hexadecimal(colour: &[f64; 3]) -> Option<String> {
    let bytes = colour.map(|linear| 255.0 * to_srgb(linear));
    let is_whole =
        |byte: &f64| (byte - byte.round()).abs() < 1e-6 && (0.0..=255.0).contains(&byte.round());
    let digits = |byte: f64| format!("{:02x}", byte.round() as u8);
    bytes
        .iter()
        .all(is_whole)
        .then(|| format!("\"#{}\"", bytes.map(digits).concat()))
}

/// The name of what a link leads to, with the output if it is not the first.
fn name(graph: &Graph, link: &Link) -> String {
    let node = &graph.nodes[link.node];
    match node.kind.outputs.get(link.output) {
        Some(output) if link.output > 0 => format!("{}.{}", node.name, output.name),
        _ => node.name.to_string(),
    }
}

fn expression(graph: &Graph, arithmetic: &Arithmetic) -> String {
    let operand = |inner: &Arithmetic| match inner {
        Arithmetic::Binary(..) => format!("({})", expression(graph, inner)),
        _ => expression(graph, inner),
    };
    match arithmetic {
        Arithmetic::Number(number) => number.to_string(),
        Arithmetic::Link(link) => name(graph, link),
        Arithmetic::Negate(inner) => format!("-{}", operand(inner)),
        Arithmetic::Binary(operator, sides) => {
            let [left, right] = [operand(&sides[0]), operand(&sides[1])];
            format!("{left} {} {right}", sign(*operator))
        }
        Arithmetic::Call(function, arguments) => {
            let arguments: Vec<_> = arguments.iter().map(|it| expression(graph, it)).collect();
            format!("{}({})", function.name(), arguments.join(", "))
        }
    }
}

fn sign(operator: Operator) -> &'static str {
    match operator {
        Operator::Add => "+",
        Operator::Subtract => "-",
        Operator::Multiply => "*",
        Operator::Divide => "/",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::from_srgb;

    #[test]
    fn a_colour_is_written_as_it_was() {
        let colour = |bytes: [u8; 3]| bytes.map(|byte| from_srgb(f64::from(byte) / 255.0));
        for bytes in [[0, 0, 0], [255, 255, 255], [232, 199, 155], [1, 2, 3]] {
            let [r, g, b] = bytes;
            let expected = format!("\"#{r:02x}{g:02x}{b:02x}\"");
            assert_eq!(value(&Value::Colour(colour(bytes))), expected);
        }
        assert_eq!(value(&Value::Colour([0.1, 0.25, 2.0])), "(0.1, 0.25, 2)");
    }

    #[test]
    fn lists_and_records_are_written_as_in_a_recipe() {
        let stop = Value::Record(vec![
            ("at", Value::Number(0.5)),
            ("on", Value::Toggle(true)),
        ]);
        assert_eq!(value(&Value::List(vec![stop])), "[(at: 0.5, on: true)]");
        assert_eq!(value(&Value::Text("a \"b\"".to_owned())), r#""a \"b\"""#);
        assert_eq!(value(&Value::Pair([1.0, -2.5])), "(1, -2.5)");
    }
}
