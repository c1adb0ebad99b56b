//! The interface of a compound: the kind that its uses see.

use super::super::links::{Found, Linker, Scope};
use super::super::literal::Reader;
use super::super::names::shown;
use super::super::parameters::{Declared, Interface, Parameters};
use super::super::recipe::{Outlet, Recipe};
use super::super::report::Report;
use super::super::{Link, Source};
use super::layout::Place;
use super::{File, Layout, Library};
use crate::diagnostics::Code;
use crate::node::{Input, Kind, Output, Presence, Varies, interned};
use crate::value::{Domain, Type, Value};
use petgraph::graph::NodeIndex;

/// Mixed into every random stream inside: an input of every compound.
const SEED: Input = Input::new(
    "seed",
    Type::Whole,
    "Another number gives other random results in all that is inside; 0 changes nothing",
)
.default("0");

/// The outputs, and where each lies; what is wrong is reported and has no place.
pub(super) fn outputs(
    report: &mut Report,
    library: &Library<'_>,
    recipe: &Recipe<'_>,
    layout: &Layout<'_>,
) -> (Vec<Output>, Vec<Option<Place>>) {
    let scope = Scope { layout, base: 0 };
    let mut none = Parameters::default();
    let mut outputs = vec![];
    for outlet in &recipe.outlets {
        let mut linker = Linker {
            reader: Reader::new(&mut none, report, None),
            scope: &scope,
            index: NodeIndex::end(),
        };
        let found = outlet_of(&mut linker, outlet);
        let about = found.map_or(outlet.about, |found| match outlet.about {
            "" => found.output.about,
            about => about,
        });
        let output = Output {
            name: interned::text(outlet.name),
            about: library.described(about),
            ..found.map_or(UNKNOWN, |found| *found.output)
        };
        let place = found.map(|found| Place {
            offset: found.link.node.index(),
            output: found.link.output,
        });
        outputs.push((output, place));
    }
    outputs.into_iter().unzip()
}

/// The output of a node that an output of the compound is.
fn outlet_of(linker: &mut Linker<'_, '_>, outlet: &Outlet<'_>) -> Option<Found> {
    let span = outlet.span.clone();
    let (what, hint) = match outlet.of.chars().next() {
        Some('=') => (
            "arithmetic",
            "make a node of it first, for example `remap(value: \"= ..\", beyond: extend)`",
        ),
        Some('$') => (
            "an input",
            "its user has that already; link a node that is made of it",
        ),
        _ => return linker.find(outlet.of, span),
    };
    let message = format!(
        "expected `node.output` for {}, found {what}",
        shown(outlet.name)
    );
    let label = "not an output of a node";
    linker
        .reader
        .refuse(Code::NotANode, message, span, label, |error| {
            error.expected("`node.output`", what).hint(hint)
        })
}

/// Stands where an output is wrong, so that links to it are not reported as well.
const UNKNOWN: Output = Output::field("", Type::Material, "");

/// The kind; `None` if an output or an input is wrong, which is reported.
pub(super) fn kind(
    report: &mut Report,
    library: &Library<'_>,
    file: &File,
    recipe: &Recipe<'_>,
    interface: &Interface,
    outputs: Vec<Output>,
) -> Option<&'static Kind> {
    if outputs.is_empty() {
        let message = format!("compound {} has no outputs", shown(&file.name));
        let start = file.tree.as_ref()?.span.start;
        let error = report.error(
            Code::MissingField,
            message,
            start..start + 1,
            "`outputs` is missing here or empty",
        );
        report.add(error.hint("add `outputs: { \"name\": \"node.output\" }`"));
        return None;
    }
    let inputs = interface.declared.iter();
    let inputs: Option<Vec<_>> = inputs.map(|one| input(library, one)).collect();
    let mut inputs = inputs?;
    if let Some(own) = interface.declared.iter().find(|one| one.name == SEED.name) {
        let message = "every compound has an input `seed`, which is not declared";
        let span = own.span.clone();
        let error = report.error(Code::DuplicateName, message, span, "declared here");
        report.add(error.hint("remove it: `seed` changes all random results inside"));
        return None;
    }
    inputs.push(SEED);
    Some(interned::kind(interned::Interface {
        name: &file.name,
        version: recipe.version,
        about: library.described(&recipe.about),
        source: library.described(&recipe.source),
        inputs,
        outputs,
    }))
}

fn input(library: &Library<'_>, declared: &Declared) -> Option<Input> {
    let presence = match (&declared.default_text, &declared.default) {
        (Some(text), _) => Presence::Default(library.described(text)),
        (None, Some(_)) => Presence::Optional,
        (None, None) => Presence::Required,
    };
    Some(Input {
        name: interned::text(&declared.name),
        value_type: declared.value_type?,
        varies: declared.varies,
        domain: declared.domain,
        presence,
        range: declared.range,
        about: library.described(&declared.about),
    })
}

/// What stands for an input that has no default while a compound is checked by itself: a valid literal, or
/// an output of the node `inputs`, if there is one.
pub(in crate::graph) fn stand_in(
    declared: &Declared,
    position: usize,
    inputs: Option<NodeIndex>,
) -> Option<Source> {
    if let Some(default) = &declared.default {
        return Some(default.clone());
    }
    let value_type = declared.value_type?;
    let (low, high) = declared.range.unwrap_or((0.0, 1.0));
    let number = 1_f64.clamp(low, high);
    let literal = match value_type {
        _ if declared.varies == Varies::PerPoint => None,
        Type::Number(_) => Some(Value::Number(number)),
        Type::Whole => Some(Value::Whole(number as i64)),
        Type::Toggle => Some(Value::Toggle(false)),
        Type::Choice(names) => names.first().map(|name| Value::Choice(name)),
        Type::Text => Some(Value::Text("text".to_owned())),
        Type::Colour => Some(Value::Colour([number; 3])),
        Type::Vector(_) => Some(Value::Vector(glam::DVec3::splat(number))),
        Type::Pair(_) => Some(Value::Pair([number; 2])),
        _ => None,
    };
    if let Some(literal) = literal {
        return Some(Source::Literal(literal));
    }
    Some(Source::Link(Link {
        node: inputs?,
        output: position,
    }))
}

/// The kind of the node `inputs`: every input of the compound as an output.
pub(in crate::graph) fn inputs_kind(kind: &Kind) -> &'static Kind {
    let output = |input: &Input| Output {
        name: input.name,
        value_type: input.value_type,
        varies: input.varies,
        domain: Some(input.domain.unwrap_or(Domain::Everywhere)),
        about: input.about,
    };
    interned::kind(interned::Interface {
        name: "inputs",
        version: 1,
        about: "What a compound is given",
        source: "own construction",
        inputs: vec![],
        outputs: kind.inputs.iter().map(output).collect(),
    })
}
