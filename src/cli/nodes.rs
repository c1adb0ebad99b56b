//! `yosegi nodes`: what kinds of nodes there are.

use super::{Exit, report};
use serde_json::{Value, json};
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
            let kinds: Vec<Value> = KINDS.iter().map(|kind| describe_json(kind)).collect();
            report::line(&format!("{:#}", Value::Array(kinds)));
        }
        None => list(),
        Some(name) => match kind(name) {
            Some(kind) if arguments.json => report::line(&format!("{:#}", describe_json(kind))),
            Some(kind) => report::line(&describe(kind)),
            None => {
                let names = nearest(name, KINDS.iter().map(|kind| kind.name));
                let hint = match names.first() {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "`yosegi nodes` lists all kinds".to_owned(),
                };
                report::problem(&format!("there is no kind `{name}`; {hint}"));
                return Exit::Wrong;
            }
        },
    }
    Exit::Done
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

fn describe_json(kind: &Kind) -> Value {
    json!({
        "name": kind.name,
        "version": kind.version,
        "about": kind.about,
        "source": kind.source,
        "example": kind.example,
        "inputs": kind.inputs.iter().map(input_json).collect::<Vec<_>>(),
        "outputs": kind.outputs.iter().map(|output| json!({
            "name": output.name,
            "type": output.value_type.to_string(),
            "varies": output.varies == Varies::PerPoint,
            "domain": output.domain.map(|domain| domain.to_string()),
            "about": output.about,
        })).collect::<Vec<_>>(),
    })
}

fn input_json(input: &Input) -> Value {
    let default = match input.presence {
        Presence::Default(literal) => Some(literal),
        _ => None,
    };
    json!({
        "name": input.name,
        "type": input.value_type.to_string(),
        "per_point": input.varies == Varies::PerPoint,
        "domain": input.domain.map(|domain| domain.to_string()),
        "required": input.presence == Presence::Required,
        "default": default,
        "range": input.range.map(|(low, high)| [low, high]),
        "about": input.about,
        "parts": parts(input.value_type).iter().map(input_json).collect::<Vec<_>>(),
    })
}
