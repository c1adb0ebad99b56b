//! `yosegi nodes`: what kinds of nodes there are.

use super::kind_json::KindJson;
use super::{Exit, report};
use std::path::{Path, PathBuf};
use yosegi::diagnostics::nearest;
use yosegi::graph::compounds;
use yosegi::node::{Input, Kind, Output, Presence, Varies};
use yosegi::nodes::KINDS;
use yosegi::value::Type;
use yosegi::world::Disk;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The kind to describe; without it all kinds are listed.
    kind: Option<String>,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let all = all();
    match &arguments.kind {
        None if arguments.json => {
            let kinds: Vec<KindJson> = all.iter().map(Listed::json).collect();
            report::json(&kinds);
        }
        None => list(&all),
        Some(name) => match all.iter().find(|one| one.kind.name == name) {
            Some(one) if arguments.json => report::json(&one.json()),
            Some(one) => report::line(&one.describe()),
            None => {
                let problem = match broken(name) {
                    Some(file) => format!(
                        "the compound in `{0}` has mistakes: `yosegi check {0}`",
                        file.display()
                    ),
                    None => format!("there is no kind `{name}`; {}", hint(&near(name, &all))),
                };
                report::problem(&problem);
                return Exit::Wrong;
            }
        },
    }
    Exit::Done
}

/// A kind, and the file of a compound.
struct Listed {
    kind: &'static Kind,
    file: Option<PathBuf>,
}

/// The kinds that a recipe in this folder can use.
fn all() -> Vec<Listed> {
    let native = KINDS.iter().map(|kind| Listed { kind, file: None });
    let compounds = compounds(&Disk, Path::new("")).into_iter();
    let compounds = compounds.map(|compound| Listed {
        kind: compound.kind,
        file: Some(compound.path),
    });
    native.chain(compounds).collect()
}

/// The file of a compound that is not listed, so something is wrong with it.
fn broken(name: &str) -> Option<PathBuf> {
    let files = ["nodes", "../nodes"].map(|folder| Path::new(folder).join(format!("{name}.ron")));
    files.into_iter().find(|file| file.is_file())
}

/// The kinds that may have been meant: by the whole name, or else by one of its words.
fn near(wrong: &str, all: &[Listed]) -> Vec<String> {
    let names = || all.iter().map(|one| one.kind.name);
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

fn list(all: &[Listed]) {
    let width = all.iter().map(|one| one.kind.name.len()).max().unwrap_or(0);
    let mut is_compound = false;
    for Listed { kind, file } in all {
        if file.is_some() && !is_compound {
            is_compound = true;
            report::line("\nCompounds");
        }
        report::line(&format!("{:width$}  {}", kind.name, kind.about));
    }
}

impl Listed {
    fn json(&self) -> KindJson {
        let mut json = KindJson::from(self.kind);
        json.file = self.file.as_ref().map(|file| file.display().to_string());
        json
    }

    fn describe(&self) -> String {
        describe(self.kind, self.file.as_deref())
    }
}

fn describe(kind: &Kind, file: Option<&Path>) -> String {
    let mut text = format!("{} (version {})\n{}\n", kind.name, kind.version, kind.about);
    if let Some(file) = file {
        text += &format!("A compound: {}\n", file.display());
    }
    text += "\nInputs\n";
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
    if !kind.source.is_empty() {
        text += &format!("\nSource\n  {}\n", kind.source);
    }
    // A compound has none in its file: its use is shown with what has to be stated.
    let example = match kind.example {
        "" => use_of(kind),
        example => example.to_owned(),
    };
    text += "\nExample\n";
    for line in example.lines() {
        text += &format!("  {line}\n");
    }
    text.trim_end().to_owned()
}

/// A node of a kind with the inputs that have no default, each called after what it takes.
fn use_of(kind: &Kind) -> String {
    let required = kind
        .inputs
        .iter()
        .filter(|input| matches!(input.presence, Presence::Required));
    let stated: Vec<String> = required
        .map(|input| format!("{}: {}", input.name, stand_in(input)))
        .collect();
    let ports: Vec<String> = kind
        .outputs
        .iter()
        .map(|output| format!("\"example.{}\"", output.name))
        .collect();
    let (node, ports) = (
        format!("{}({})", kind.name, stated.join(", ")),
        ports.join(", "),
    );
    format!("\"example\": {node},\nLinks to it: {ports}; \"example\" is the first")
}

/// A value for an input: a literal where a number or a colour is stated, else a link to a node of the input's name.
fn stand_in(input: &Input) -> String {
    match (input.value_type, input.varies) {
        (Type::Number(_) | Type::Whole, Varies::Constant) => {
            input.range.map_or(1.0, |(low, _)| low.max(0.0)).to_string()
        }
        (Type::Colour, _) => "\"#c8a06e\"".to_owned(),
        _ => format!("\"{}\"", input.name),
    }
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
