//! The types that a declaration can have.

use super::super::literal::{Reader, Slot};
use super::super::names::shown;
use super::super::recipe::{Declaration, Role};
use super::super::report::Report;
use super::super::tree::{Shape, Tree};
use super::Parameters;
use crate::diagnostics::{Code, nearest};
use crate::node::interned;
use crate::value::{Type, Unit, Value};

/// The types of both, then those that only inputs of compounds have.
const TYPES: [&str; 18] = [
    "number",
    "whole",
    "toggle",
    "text",
    "colour",
    "vector",
    "pair",
    "choice",
    "file",
    "material",
    "skeleton",
    "climate",
    "ring_series",
    "mesh",
    "patches",
    "colour_pattern",
    "region",
    "partition",
];

fn types(role: Role) -> &'static [&'static str] {
    match role {
        Role::Recipe => &TYPES[..6],
        Role::Compound => &TYPES,
    }
}

/// The type that a declaration names; `of` are the names of a choice.
pub(super) fn read(
    report: &mut Report,
    role: Role,
    declaration: &Declaration<'_>,
    unit: Unit,
    of: Option<&Tree>,
) -> Option<Type> {
    let kind = declaration.kind?;
    if !types(role).contains(&kind.text.as_str()) {
        return refuse(report, role, declaration);
    }
    Some(match kind.text.as_str() {
        "number" => Type::Number(unit),
        "whole" => Type::Whole,
        "toggle" => Type::Toggle,
        "text" => Type::Text,
        "colour" => Type::Colour,
        "vector" => Type::Vector(unit),
        "pair" => Type::Pair(unit),
        "choice" => return choice(report, declaration, of),
        "file" => Type::File,
        "material" => Type::Material,
        "skeleton" => Type::Skeleton,
        "climate" => Type::Climate,
        "ring_series" => Type::RingSeries,
        "mesh" => Type::Mesh,
        "patches" => Type::Patches,
        "region" => Type::Region,
        "partition" => Type::Partition,
        _ => Type::ColourPattern,
    })
}

fn choice(report: &mut Report, declaration: &Declaration<'_>, of: Option<&Tree>) -> Option<Type> {
    let Some(tree) = of else {
        let message = format!("{} has nothing to choose from", shown(declaration.name));
        let span = declaration.span.clone();
        let error = report.error(Code::MissingField, message, span, "`of` is missing");
        report.add(error.hint("write `choice(of: [first, second])`"));
        return None;
    };
    let slot = Slot {
        name: "of",
        value_type: Type::Names,
        range: None,
    };
    let mut none = Parameters::default();
    match Reader::new(&mut none, report, None).literal(tree, slot)? {
        Value::Names(names) if !names.is_empty() => Some(Type::Choice(interned::names(&names))),
        _ => {
            let message = "a choice has at least one name";
            let span = tree.span.clone();
            report.add(report.error(Code::WrongLength, message, span, "no names"));
            None
        }
    }
}

fn refuse(report: &mut Report, role: Role, declaration: &Declaration<'_>) -> Option<Type> {
    let kind = declaration.kind?;
    let (unknown, what) = (&kind.text, role.declared());
    let message = format!("there is no type of {what}s called {}", shown(unknown));
    let span = kind.span.clone();
    let label = format!("not a type of {what}s");
    report.add(
        report
            .error(Code::NotANode, message, span, label)
            .nearest(nearest(unknown, types(role).iter().copied()))
            .hint(format!("the types are {}", types(role).join(", "))),
    );
    None
}

/// The unit that a declaration names, with or without quotes.
pub(super) fn read_unit(report: &mut Report, tree: &Tree) -> Option<Unit> {
    let known = Unit::ALL.map(Unit::symbol);
    let written = match &tree.shape {
        Shape::Text(text) => text.value.clone(),
        _ => report.source.text[tree.span.clone()].to_owned(),
    };
    let unit = Unit::from_symbol(&written);
    if unit.is_none() {
        let message = format!("there is no unit {}", shown(&written));
        report.add(
            report
                .error(Code::UnknownUnit, message, tree.span.clone(), "not a unit")
                .nearest(nearest(&written, known))
                .hint(format!("the units are {}", known.join(", "))),
        );
    }
    unit
}
