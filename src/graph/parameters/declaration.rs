//! One declaration: `"name": number(default: 1, range: (0, 2), unit: "mm", about: "..")`.

use super::super::literal::{Reader, Slot};
use super::super::names::shown;
use super::super::recipe::{Declaration, Role, report_duplicate_field};
use super::super::report::Report;
use super::super::tree::{Field, Tree};
use super::super::{NamedFile, Source};
use super::Parameters;
use super::types;
use crate::diagnostics::{Code, Span, nearest};
use crate::node::Varies;
use crate::value::{Domain, Type, Unit, Value};
use std::collections::HashMap;

/// A parameter or an input, and what checking needs to know of it.
#[derive(Debug)]
pub(in crate::graph) struct Declared {
    /// The name.
    pub(in crate::graph) name: String,
    /// Where the name is.
    pub(in crate::graph) span: Span,
    /// The type; `None` if the declaration is wrong.
    pub(in crate::graph) value_type: Option<Type>,
    /// The unit of a number, whole number, vector or pair.
    pub(in crate::graph) unit: Unit,
    /// Whether it may differ from point to point.
    pub(in crate::graph) varies: Varies,
    /// Where a field or material must be defined.
    pub(in crate::graph) domain: Option<Domain>,
    /// What it is when it is not given; `None` if it must be given, or the declaration is wrong.
    pub(in crate::graph) default: Option<Source>,
    /// The default as it is written.
    pub(in crate::graph) default_text: Option<String>,
    /// Smallest and largest value.
    pub(in crate::graph) range: Option<(f64, f64)>,
    /// What it means.
    pub(in crate::graph) about: String,
}

/// The fields of a declaration, by name.
type Fields<'t> = HashMap<&'t str, &'t Tree>;

impl Declared {
    /// Reads a declaration; what is wrong is reported and stays as it is in an empty one.
    pub(super) fn read(report: &mut Report, role: Role, declaration: &Declaration<'_>) -> Declared {
        let fields = find_fields(report, role, declaration);
        let unit = match fields.get("unit") {
            Some(tree) => types::read_unit(report, tree),
            None => Some(Unit::One),
        };
        let value_type = unit.and_then(|unit| {
            types::read(report, role, declaration, unit, fields.get("of").copied())
        });
        let mut declared = Declared {
            name: declaration.name.to_owned(),
            span: declaration.span.clone(),
            value_type,
            unit: unit.unwrap_or(Unit::One),
            varies: Varies::Constant,
            domain: None,
            default: None,
            default_text: None,
            range: None,
            about: String::new(),
        };
        declared.read_fields(report, &fields);
        declared.refuse_no_default(report, role, declaration, &fields);
        declared
    }

    fn read_fields(&mut self, report: &mut Report, fields: &Fields<'_>) {
        let about = literal(report, fields, "about", Type::Text, None);
        if let Some(Value::Text(about)) = about {
            self.about = about;
        }
        let Some(value_type) = self.value_type else {
            return;
        };
        let range = literal(report, fields, "range", Type::Pair(self.unit), None);
        if let (Some(Value::Pair(range)), Some(tree)) = (range, fields.get("range")) {
            self.range = check_range(report, range.into(), tree, value_type);
        }
        self.read_default(report, fields, value_type);
        self.read_point_fields(report, fields, value_type);
        let optional = literal(report, fields, "optional", Type::Toggle, None);
        match (optional, fields.get("optional"), &self.default) {
            (Some(Value::Toggle(true)), _, None) => self.default = Some(Source::Absent),
            (Some(Value::Toggle(true)), Some(tree), Some(_)) => {
                let message = format!("{} is optional and has a default", shown(&self.name));
                let span = tree.span.clone();
                let error = report.error(Code::DuplicateField, message, span, "one too many");
                report.add(error.hint("remove one of them: with a default it need not be given"));
            }
            _ => {}
        }
    }

    fn read_default(&mut self, report: &mut Report, fields: &Fields<'_>, value_type: Type) {
        let Some(tree) = fields.get("default").copied() else {
            return;
        };
        if !value_type.has_literals() {
            let message = format!("{} has no default: it is a {value_type}", shown(&self.name));
            let span = tree.span.clone();
            let error = report.error(Code::TypeMismatch, message, span, "not a literal");
            report.add(error.hint("leave the default out; the user of the compound links it"));
            return;
        }
        let value = literal(report, fields, "default", value_type, None);
        let slot = Slot {
            name: "default",
            value_type,
            range: self.range,
        };
        let mut none = Parameters::default();
        let mut reader = Reader::new(&mut none, report, None);
        if let Some(value) = &value {
            // A default outside the range is reported and is there, so that nothing follows from it.
            reader.all_in_range(value, tree.span.clone(), slot);
        }
        let source = &report.source;
        self.default = value.map(|value| match (value_type, value) {
            (Type::File, Value::Text(path)) => Source::File(NamedFile::beside(source, path.into())),
            (_, value) => Source::Literal(value),
        });
        self.default_text = Some(report.source.text[tree.span.clone()].to_owned());
    }

    /// Whether it may be a field, and where.
    fn read_point_fields(&mut self, report: &mut Report, fields: &Fields<'_>, value_type: Type) {
        let per_point = literal(report, fields, "per_point", Type::Toggle, None);
        let can_vary = matches!(value_type, Type::Number(_) | Type::Vector(_) | Type::Colour);
        if matches!(per_point, Some(Value::Toggle(true))) {
            self.varies = Varies::PerPoint;
        }
        if self.varies == Varies::PerPoint
            && !can_vary
            && let Some(tree) = fields.get("per_point")
        {
            let message = format!("no {value_type} differs from point to point");
            let span = tree.span.clone();
            let error = report.error(
                Code::TypeMismatch,
                message,
                span,
                "for numbers, vectors and colours",
            );
            report.add(error.hint("leave `per_point` out"));
        }
        let domains = Type::Choice(&["solid", "plane"]);
        self.domain = match literal(report, fields, "domain", domains, None) {
            Some(Value::Choice("solid")) => Some(Domain::Solid),
            Some(Value::Choice(_)) => Some(Domain::Plane),
            _ => None,
        };
    }

    fn refuse_no_default(
        &mut self,
        report: &mut Report,
        role: Role,
        declaration: &Declaration<'_>,
        fields: &Fields<'_>,
    ) {
        let (Role::Recipe, None, Some(kind)) = (role, fields.get("default"), declaration.kind)
        else {
            return;
        };
        let message = format!("parameter {} has no default", shown(declaration.name));
        let span = kind.span.clone();
        report.add(
            report
                .error(Code::MissingField, message, span, "`default` is missing")
                .hint(format!("write `{}(default: ..)`", kind.text)),
        );
    }
}

/// The value of a field, if it is there and right.
fn literal(
    report: &mut Report,
    fields: &Fields<'_>,
    name: &str,
    value_type: Type,
    range: Option<(f64, f64)>,
) -> Option<Value> {
    let slot = Slot {
        name,
        value_type,
        range,
    };
    let mut none = Parameters::default();
    Reader::new(&mut none, report, None).literal(fields.get(name)?, slot)
}

fn find_fields<'t>(report: &mut Report, role: Role, declaration: &Declaration<'t>) -> Fields<'t> {
    let mut fields = Fields::new();
    let mut spans: HashMap<&str, Span> = HashMap::new();
    for field in declaration.fields {
        let name = field.name.text.as_str();
        if let Some(first) = spans.insert(name, field.name.span.clone()) {
            report_duplicate_field(report, &field.name, first);
        }
        match role.declaration_fields().contains(&name) {
            true => drop(fields.insert(name, &field.value)),
            false => refuse_field(report, role, field),
        }
    }
    fields
}

fn refuse_field(report: &mut Report, role: Role, field: &Field) {
    let name = &field.name.text;
    let (fields, what) = (role.declaration_fields(), with_article(role));
    let message = format!("{what} has no field {}", shown(name));
    let span = field.name.span.clone();
    let label = format!("not a field of {what}");
    report.add(
        report
            .error(Code::UnknownField, message, span, label)
            .nearest(nearest(name, fields.iter().copied()))
            .hint(format!("the fields of {what} are {}", fields.join(", "))),
    );
}

fn with_article(role: Role) -> &'static str {
    match role {
        Role::Recipe => "a parameter",
        Role::Compound => "an input",
    }
}

/// The range, if it is for numbers and its smaller end comes first.
fn check_range(
    report: &mut Report,
    (low, high): (f64, f64),
    tree: &Tree,
    value_type: Type,
) -> Option<(f64, f64)> {
    let has_range = matches!(
        value_type,
        Type::Number(_) | Type::Whole | Type::Vector(_) | Type::Pair(_) | Type::Colour
    );
    let label = match has_range {
        false => "a range is for numbers".to_owned(),
        true if low > high => format!("{low} is larger than {high}"),
        true => return Some((low, high)),
    };
    let message = "a range is two numbers, the smaller first";
    let span = tree.span.clone();
    report.add(report.error(Code::InvalidRange, message, span, label));
    None
}
