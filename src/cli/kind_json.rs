//! Kinds as JSON: everything that a declaration says, under names that do not change.

use serde::Serialize;
use yosegi::node::{Input, Kind, Output, Presence, Varies};
use yosegi::value::{Domain, Type, Unit};

/// A kind.
#[derive(Serialize)]
pub(super) struct KindJson {
    name: &'static str,
    version: u32,
    about: &'static str,
    source: &'static str,
    inputs: Vec<InputJson>,
    outputs: Vec<OutputJson>,
    /// A whole recipe in which a node of the kind is called `example`.
    example: &'static str,
    /// The file of a compound; `null` for what is written in Rust.
    pub(super) file: Option<String>,
}

/// An input, or a part of a record.
#[derive(Serialize)]
struct InputJson {
    name: &'static str,
    #[serde(flatten)]
    value: TypeJson,
    /// `constant` or `per_point`.
    varies: &'static str,
    /// `solid` or `plane`; `null` takes any.
    domain: Option<String>,
    /// `required`, `optional` or `default`.
    presence: &'static str,
    /// What is taken when it is left out, as a recipe writes it.
    default: Option<&'static str>,
    /// Smallest and largest literal.
    range: Option<[f64; 2]>,
    about: &'static str,
}

/// An output.
#[derive(Serialize)]
struct OutputJson {
    name: &'static str,
    #[serde(flatten)]
    value: TypeJson,
    varies: &'static str,
    /// `solid`, `plane` or `constant`; `null` is that of the inputs.
    domain: Option<String>,
    about: &'static str,
}

/// A type.
#[derive(Serialize)]
struct TypeJson {
    #[serde(rename = "type")]
    name: String,
    /// Of numbers, vectors and pairs; `1` for a plain ratio.
    unit: Option<&'static str>,
    /// Of choices.
    choices: Option<&'static [&'static str]>,
    /// Of lists: the type of an item.
    item: Option<Box<TypeJson>>,
    /// Of records.
    parts: Option<Vec<InputJson>>,
}

impl From<&Kind> for KindJson {
    fn from(kind: &Kind) -> KindJson {
        KindJson {
            name: kind.name,
            version: kind.version,
            about: kind.about,
            source: kind.source,
            inputs: kind.inputs.iter().map(InputJson::from).collect(),
            outputs: kind.outputs.iter().map(OutputJson::from).collect(),
            example: kind.example,
            file: None,
        }
    }
}

impl From<&Input> for InputJson {
    fn from(input: &Input) -> InputJson {
        let (presence, default) = match input.presence {
            Presence::Required => ("required", None),
            Presence::Optional => ("optional", None),
            Presence::Default(literal) => ("default", Some(literal)),
        };
        InputJson {
            name: input.name,
            value: input.value_type.into(),
            varies: varies(input.varies),
            domain: input.domain.as_ref().map(Domain::to_string),
            presence,
            default,
            range: input.range.map(|(low, high)| [low, high]),
            about: input.about,
        }
    }
}

impl From<&Output> for OutputJson {
    fn from(output: &Output) -> OutputJson {
        OutputJson {
            name: output.name,
            value: output.value_type.into(),
            varies: varies(output.varies),
            domain: output.domain.as_ref().map(Domain::to_string),
            about: output.about,
        }
    }
}

impl From<Type> for TypeJson {
    fn from(value_type: Type) -> TypeJson {
        let plain = |name: &str| TypeJson {
            name: name.to_owned(),
            unit: None,
            choices: None,
            item: None,
            parts: None,
        };
        let with_unit = |name, unit: Unit| TypeJson {
            unit: Some(unit.symbol()),
            ..plain(name)
        };
        match value_type {
            Type::Number(unit) => with_unit("number", unit),
            Type::Vector(unit) => with_unit("vector", unit),
            Type::Pair(unit) => with_unit("pair", unit),
            Type::Whole => plain("whole"),
            Type::Toggle => plain("toggle"),
            Type::File => plain("file"),
            Type::Names => plain("names"),
            Type::Channels => plain("channels"),
            Type::Materials => plain("materials"),
            Type::Choice(choices) => TypeJson {
                choices: Some(choices),
                ..plain("choice")
            },
            Type::List(item) => TypeJson {
                item: Some(Box::new((*item).into())),
                ..plain("list")
            },
            Type::Record(parts) => TypeJson {
                parts: Some(parts.iter().map(InputJson::from).collect()),
                ..plain("record")
            },
            // What has no literals is called as in messages.
            other => plain(&other.to_string().replace(' ', "_")),
        }
    }
}

fn varies(varies: Varies) -> &'static str {
    match varies {
        Varies::Constant => "constant",
        Varies::PerPoint => "per_point",
    }
}
