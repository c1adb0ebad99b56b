//! The parameters of a recipe: their declarations, what the caller sets, and what refers to them.

use super::described::described_unit;
use super::literal::{Reader, Slot};
use super::names::shown;
use super::number;
use super::recipe::{Declaration, report_duplicate_field};
use super::report::Report;
use super::tree::{Field, Shape, Tree};
use super::{Parameter, text};
use crate::diagnostics::{Code, Diagnostic, SourceFile, Span, nearest};
use crate::value::{Type, Unit, Value};
use std::collections::HashMap;
use std::sync::Arc;

/// The types a parameter can have.
const TYPES: [&str; 6] = ["number", "whole", "toggle", "text", "colour", "vector"];
/// The fields a parameter can have.
const FIELDS: [&str; 4] = ["default", "range", "unit", "about"];

/// The parameters of a recipe, by name.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    declared: Vec<Declared>,
    by_name: HashMap<String, usize>,
    /// Whether the caller lets files be anywhere.
    pub(super) allow_outside: bool,
}

/// A parameter, and what checking needs to know of it.
#[derive(Debug)]
pub(super) struct Declared {
    /// The name.
    name: String,
    /// Where the name is.
    span: Span,
    /// The type; `None` if the declaration is wrong.
    pub(super) value_type: Option<Type>,
    /// The unit of a number, whole number or vector.
    pub(super) unit: Unit,
    /// The value in force; `None` if the declaration is wrong.
    pub(super) value: Option<Value>,
    range: Option<(f64, f64)>,
    about: String,
    is_used: bool,
}

impl Parameters {
    /// Reads the declarations; `set` replaces defaults by literals, as the command line gives them.
    pub(super) fn read(
        report: &mut Report,
        declarations: &[Declaration<'_>],
        set: &[(String, String)],
    ) -> (Parameters, Vec<Diagnostic>) {
        let mut parameters = Parameters::default();
        for declaration in declarations {
            let declared = Declared::read(report, declaration);
            parameters
                .by_name
                .insert(declared.name.clone(), parameters.declared.len());
            parameters.declared.push(declared);
        }
        let problems = set
            .iter()
            .flat_map(|(name, text)| parameters.set(name, text))
            .collect();
        (parameters, problems)
    }

    /// The parameter called `name`, which counts as used from now on.
    pub(super) fn refer(&mut self, name: &str) -> Option<&Declared> {
        let index = *self.by_name.get(name)?;
        self.declared[index].is_used = true;
        self.declared.get(index)
    }

    /// Up to three names like `name`.
    pub(super) fn nearest(&self, name: &str) -> Vec<String> {
        nearest(
            name,
            self.declared.iter().map(|declared| declared.name.as_str()),
        )
    }

    /// Warns about parameters that nothing refers to.
    pub(super) fn report_unused(&self, report: &mut Report) {
        for declared in self.declared.iter().filter(|declared| !declared.is_used) {
            let message = format!("nothing uses parameter {}", shown(&declared.name));
            let span = declared.span.clone();
            report.add(report.warning(Code::UnusedParameter, message, span, "never used"));
        }
    }

    /// What the checked graph keeps; parameters whose declaration is wrong are left out.
    pub(super) fn finish(self) -> Vec<Parameter> {
        self.declared
            .into_iter()
            .filter_map(Declared::finish)
            .collect()
    }

    /// Replaces a default.
    fn set(&mut self, name: &str, literal: &str) -> Vec<Diagnostic> {
        let Some(index) = self.by_name.get(name) else {
            let message = format!("the recipe has no parameter {}", shown(name));
            return vec![
                Diagnostic::error(Code::UnknownParameter, message).nearest(self.nearest(name)),
            ];
        };
        let declared = &mut self.declared[*index];
        let Some(value_type) = declared.value_type else {
            return vec![];
        };
        if let Some(problem) = refuse_unit(declared, literal) {
            return vec![problem];
        }
        let literal = quoted(value_type, literal);
        let source = Arc::new(SourceFile::new(format!("--set {name}"), literal));
        let mut report = Report::new(&source);
        let mut none = Parameters::default();
        if let Some(tree) = text::read(&mut report) {
            let slot = Slot {
                name,
                value_type,
                range: declared.range,
            };
            declared.value = Reader::new(&mut none, &mut report, None).literal(&tree, slot);
        } else if !report.has_errors() {
            let message = format!(
                "expected {value_type} for parameter {}, found nothing",
                shown(name)
            );
            report.add(Diagnostic::error(Code::TypeMismatch, message));
        }
        report.finish()
    }
}

/// The mistake of writing a number with its unit.
fn refuse_unit(declared: &Declared, literal: &str) -> Option<Diagnostic> {
    let is_number = |text: &str| number::read(text).is_some();
    let (number, unit) = literal.trim().split_once([' ', '\t'])?;
    let (name, unit) = (shown(&declared.name), unit.trim());
    let may_have_unit = matches!(declared.value_type, Some(Type::Number(_) | Type::Whole));
    if !may_have_unit || !is_number(number) || unit.starts_with(['/', ',']) {
        return None;
    }
    let wanted = described_unit(declared.unit);
    let message = format!(
        "parameter {name} is {wanted}, found {}",
        shown(literal.trim())
    );
    let hint = match unit == declared.unit.symbol() {
        true => "write the number alone: its unit is known",
        false => "write the number alone, in the parameter's unit; units are not converted",
    };
    let error = Diagnostic::error(Code::UnitMismatch, message);
    let error = error.expected(format!("a number, {wanted}"), shown(literal.trim()));
    Some(error.hint(format!("{hint}: `--set {}={number}`", declared.name)))
}

/// Shells eat quotes: what can only be text gets them back.
fn quoted(value_type: Type, literal: &str) -> String {
    let is_quoted = literal.trim_start().starts_with(['"', '(', '[']);
    match value_type {
        Type::Text | Type::Colour if !is_quoted => {
            format!("\"{}\"", literal.replace('\\', "\\\\").replace('"', "\\\""))
        }
        _ => literal.to_owned(),
    }
}

impl Declared {
    fn read(report: &mut Report, declaration: &Declaration<'_>) -> Declared {
        let fields = Fields::find(report, declaration);
        let unit = match fields.unit {
            Some(tree) => read_unit(report, tree),
            None => Some(Unit::One),
        };
        let mut declared = Declared {
            name: declaration.name.to_owned(),
            span: declaration.span.clone(),
            value_type: type_of(report, declaration, unit.unwrap_or(Unit::One))
                .filter(|_| unit.is_some()),
            unit: unit.unwrap_or(Unit::One),
            value: None,
            range: None,
            about: String::new(),
            is_used: false,
        };
        declared.read_fields(report, &fields);
        declared
    }

    /// Reads what the declaration says; what is wrong stays as it is.
    fn read_fields(&mut self, report: &mut Report, fields: &Fields<'_>) {
        let mut none = Parameters::default();
        let mut reader = Reader::new(&mut none, report, None);
        let mut read = |tree: Option<&Tree>, name, value_type, range| {
            reader.literal(
                tree?,
                Slot {
                    name,
                    value_type,
                    range,
                },
            )
        };
        if let Some(Value::Text(about)) = read(fields.about, "about", Type::Text, None) {
            self.about = about;
        }
        let Some(value_type) = self.value_type else {
            return;
        };
        let range = read(fields.range, "range", Type::Pair(self.unit), None);
        self.value = read(fields.default, "default", value_type, None);
        if let (Some(Value::Pair(range)), Some(tree)) = (range, fields.range) {
            self.range = check_range(report, range.into(), tree, value_type);
        }
        if let (Some(value), Some(tree)) = (&self.value, fields.default) {
            let slot = Slot {
                name: "default",
                value_type,
                range: self.range,
            };
            Reader::new(&mut none, report, None).all_in_range(value, tree.span.clone(), slot);
        }
    }

    fn finish(self) -> Option<Parameter> {
        Some(Parameter {
            value: self.value?,
            unit: self.unit.symbol().to_owned(),
            name: self.name,
            range: self.range,
            about: self.about,
        })
    }
}

/// The fields of a declaration.
#[derive(Default)]
struct Fields<'t> {
    default: Option<&'t Tree>,
    range: Option<&'t Tree>,
    unit: Option<&'t Tree>,
    about: Option<&'t Tree>,
}

impl<'t> Fields<'t> {
    fn find(report: &mut Report, declaration: &Declaration<'t>) -> Fields<'t> {
        let mut fields = Fields::default();
        let mut spans: HashMap<&str, Span> = HashMap::new();
        for field in declaration.fields {
            if let Some(first) = spans.insert(&field.name.text, field.name.span.clone()) {
                report_duplicate_field(report, &field.name, first);
            }
            match field.name.text.as_str() {
                "default" => fields.default = Some(&field.value),
                "range" => fields.range = Some(&field.value),
                "unit" => fields.unit = Some(&field.value),
                "about" => fields.about = Some(&field.value),
                _ => refuse_field(report, field),
            }
        }
        if let (None, Some(kind)) = (fields.default, declaration.kind) {
            let message = format!("parameter {} has no default", shown(declaration.name));
            report.add(
                report
                    .error(
                        Code::MissingField,
                        message,
                        kind.span.clone(),
                        "`default` is missing",
                    )
                    .hint(format!("write `{}(default: ..)`", kind.text)),
            );
        }
        fields
    }
}

fn refuse_field(report: &mut Report, field: &Field) {
    let name = &field.name.text;
    let message = format!("a parameter has no field {}", shown(name));
    let span = field.name.span.clone();
    report.add(
        report
            .error(
                Code::UnknownField,
                message,
                span,
                "not a field of a parameter",
            )
            .nearest(nearest(name, FIELDS))
            .hint(format!(
                "the fields of a parameter are {}",
                FIELDS.join(", ")
            )),
    );
}

fn type_of(report: &mut Report, declaration: &Declaration<'_>, unit: Unit) -> Option<Type> {
    let kind = declaration.kind?;
    Some(match kind.text.as_str() {
        "number" => Type::Number(unit),
        "whole" => Type::Whole,
        "toggle" => Type::Toggle,
        "text" => Type::Text,
        "colour" => Type::Colour,
        "vector" => Type::Vector(unit),
        unknown => {
            let message = format!("there is no type of parameters called {}", shown(unknown));
            let span = kind.span.clone();
            report.add(
                report
                    .error(Code::NotANode, message, span, "not a type of parameters")
                    .nearest(nearest(unknown, TYPES))
                    .hint(format!("the types are {}", TYPES.join(", "))),
            );
            return None;
        }
    })
}

fn read_unit(report: &mut Report, tree: &Tree) -> Option<Unit> {
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

/// The range, if it is for numbers and its smaller end comes first.
fn check_range(
    report: &mut Report,
    (low, high): (f64, f64),
    tree: &Tree,
    value_type: Type,
) -> Option<(f64, f64)> {
    let label = match value_type {
        Type::Toggle | Type::Text => "a range is for numbers".to_owned(),
        _ if low > high => format!("{low} is larger than {high}"),
        _ => return Some((low, high)),
    };
    let message = "the range of a parameter is two numbers, the smaller first";
    let span = tree.span.clone();
    report.add(report.error(Code::InvalidRange, message, span, label));
    None
}
