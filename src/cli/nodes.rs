//! `yosegi nodes`: what kinds of nodes there are.

use super::kind_json::KindJson;
use super::{Exit, report};
use yosegi::diagnostics::nearest;
use yosegi::node::{Input, Kind, Output, Presence, Varies};
use yosegi::nodes::{KINDS, kind};
use yosegi::value::Type;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The kind to describe; without it all kinds are listed.
    kind: Option<String>,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    match &arguments.kind {
        None if arguments.json => {
            let kinds: Vec<KindJson> = KINDS.iter().map(|kind| KindJson::from(*kind)).collect();
            report::json(&kinds);
        }
        None => list(),
        Some(name) => match kind(name) {
            Some(kind) if arguments.json => report::json(&KindJson::from(kind)),
            Some(kind) => report::line(&describe(kind)),
            None => {
                let hint = hint(&near(name));
                report::problem(&format!("there is no kind `{name}`; {hint}"));
                return Exit::Wrong;
            }
        },
    }
    Exit::Done
}

/// The kinds that may have been meant: by the whole name, or else by one of its words.
fn near(wrong: &str) -> Vec<String> {
    let names = || KINDS.iter().map(|kind| kind.name);
    let whole = nearest(wrong, names());
    if !whole.is_empty() {
        return whole;
    }
    let words = nearest(wrong, names().flat_map(|name| name.split('_')));
    let has_word = |name: &&str| {
        words
            .iter()
            .any(|word| name.split('_').any(|it| it == word))
    };
    names().filter(has_word).map(str::to_owned).collect()
}

fn hint(near: &[String]) -> String {
    let quoted: Vec<String> = near.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((only, [])) => format!("did you mean {only}?"),
        Some((last, rest)) => format!("did you mean {} or {last}?", rest.join(", ")),
        None => "`yosegi nodes` lists all kinds".to_owned(),
    }
}

fn list() {
    let width = KINDS.iter().map(|kind| kind.name.len()).max().unwrap_or(0);
    for kind in KINDS {
        report::line(&format!("{:width$}  {}", kind.name, kind.about));
    }
}

fn describe(kind: &Kind) -> String {
    let mut text = format!(
        "{} (version {})\n{}\n\nInputs\n",
        kind.name, kind.version, kind.about
    );
    kind.inputs
        .iter()
        .for_each(|input| describe_input(&mut text, input, 2));
    text += "\nOutputs\n";
    for output in kind.outputs {
        text += &format!(
            "  {}: {}\n      {}\n",
            output.name,
            output_type(output),
            output.about
        );
    }
    text += &format!("\nSource\n  {}\n\nExample\n", kind.source);
    for line in kind.example.lines() {
        text += &format!("  {line}\n");
    }
    text.trim_end().to_owned()
}

fn describe_input(text: &mut String, input: &Input, indent: usize) {
    let varies = match input.varies {
        Varies::Constant => "",
        Varies::PerPoint => ", may differ from point to point",
    };
    let domain = input
        .domain
        .map(|domain| format!(" ({domain})"))
        .unwrap_or_default();
    let presence = match input.presence {
        Presence::Required => String::new(),
        Presence::Optional => "; may be left out".to_owned(),
        Presence::Default(literal) => format!("; default {literal}"),
    };
    let range = input
        .range
        .map(|(low, high)| format!("; from {low} to {high}"))
        .unwrap_or_default();
    let indentation = " ".repeat(indent);
    *text += &format!(
        "{indentation}{}: {}{domain}{varies}{range}{presence}\n{indentation}    {}\n",
        input.name, input.value_type, input.about
    );
    for part in parts(input.value_type) {
        describe_input(text, part, indent + 4);
    }
}

/// The parts of a record, or of a list of records.
fn parts(value_type: Type) -> &'static [Input] {
    match value_type {
        Type::Record(parts) => parts,
        Type::List(item) => parts(*item),
        _ => &[],
    }
}

fn output_type(output: &Output) -> String {
    let domain = match (output.varies, output.domain) {
        (Varies::Constant, _) => return output.value_type.to_string(),
        (Varies::PerPoint, Some(domain)) => format!(", {domain}"),
        (Varies::PerPoint, None) => ", defined where the inputs are".to_owned(),
    };
    format!("{}{domain}", output.value_type)
}
