//! What a recipe exposes: its parameters, or the inputs of a compound, and what they are bound to.

mod declaration;
mod types;

pub(super) use declaration::Declared;

use super::described::described_unit;
use super::literal::{Reader, Slot};
use super::names::shown;
use super::number;
use super::recipe::{Declaration, Role};
use super::report::Report;
use super::{Parameter, Source, text};
use crate::diagnostics::{Code, Diagnostic, SourceFile, nearest};
use crate::value::{Type, Value};
use std::collections::HashMap;
use std::sync::Arc;

/// The declarations of a file, by name.
#[derive(Debug, Default)]
pub(super) struct Interface {
    /// Whether they are parameters of a recipe or inputs of a compound.
    pub(super) role: Role,
    /// In the order of the file.
    pub(super) declared: Vec<Declared>,
    by_name: HashMap<String, usize>,
}

/// What `$name` means: the declarations, and what each is bound to.
#[derive(Clone, Debug, Default)]
pub(super) struct Parameters {
    /// The declarations.
    pub(super) interface: Arc<Interface>,
    /// One for each declaration; `None` where something is wrong, which is reported.
    sources: Vec<Option<Source>>,
    is_used: Vec<bool>,
    /// Whether what has no default stands for any value of its type.
    pub(super) are_stand_ins: bool,
}

impl Interface {
    /// Reads the declarations.
    pub(super) fn read(
        report: &mut Report,
        role: Role,
        declarations: &[Declaration<'_>],
    ) -> Interface {
        let declared: Vec<_> = declarations
            .iter()
            .map(|declaration| Declared::read(report, role, declaration))
            .collect();
        let names = declared.iter().map(|one| one.name.clone());
        Interface {
            role,
            by_name: names.zip(0..).collect(),
            declared,
        }
    }

    /// Warns about declarations that nothing refers to.
    pub(super) fn report_unused(&self, report: &mut Report, used: &[bool]) {
        let what = self.role.declared();
        for (declared, _) in self
            .declared
            .iter()
            .zip(used)
            .filter(|(_, is_used)| !**is_used)
        {
            let message = format!("nothing uses {what} {}", shown(&declared.name));
            let span = declared.span.clone();
            report.add(report.warning(Code::UnusedParameter, message, span, "never used"));
        }
    }

    /// Up to three names like `name`.
    fn nearest(&self, name: &str) -> Vec<String> {
        nearest(name, self.declared.iter().map(|one| one.name.as_str()))
    }
}

impl Parameters {
    /// Replaces some by literals, as the command line gives them.
    pub(super) fn set_all(&mut self, set: &[(String, String)]) -> Vec<Diagnostic> {
        set.iter()
            .flat_map(|(name, text)| self.set(name, text))
            .collect()
    }

    /// Binds each declaration to one of `sources`.
    pub(super) fn bound(interface: Arc<Interface>, sources: Vec<Option<Source>>) -> Parameters {
        Parameters {
            is_used: vec![false; interface.declared.len()],
            interface,
            sources,
            are_stand_ins: false,
        }
    }

    /// The declaration called `name`, which counts as used from now on, and what it is bound to.
    pub(super) fn refer(&mut self, name: &str) -> Option<(&Declared, Option<&Source>)> {
        let index = *self.interface.by_name.get(name)?;
        self.is_used[index] = true;
        let declared = &self.interface.declared[index];
        Some((declared, self.sources[index].as_ref()))
    }

    /// Up to three names like `name`.
    pub(super) fn nearest(&self, name: &str) -> Vec<String> {
        self.interface.nearest(name)
    }

    /// Adds which of the declarations something refers to; `used` is empty before the first.
    pub(super) fn add_used(&self, used: &mut Vec<bool>) {
        used.resize(self.is_used.len(), false);
        for (used, is_used) in used.iter_mut().zip(&self.is_used) {
            *used |= is_used;
        }
    }

    /// What the checked graph keeps; parameters whose declaration is wrong are left out.
    pub(super) fn finish(self) -> Vec<Parameter> {
        let declared = self.interface.declared.iter().zip(self.sources);
        let literal = |(declared, source): (&Declared, Option<Source>)| match source {
            Some(Source::Literal(value)) => Some(declared.parameter(value)),
            _ => None,
        };
        declared.filter_map(literal).collect()
    }

    /// Replaces a default.
    fn set(&mut self, name: &str, literal: &str) -> Vec<Diagnostic> {
        let Some(&index) = self.interface.by_name.get(name) else {
            let message = format!("the recipe has no parameter {}", shown(name));
            return vec![
                Diagnostic::error(Code::UnknownParameter, message).nearest(self.nearest(name)),
            ];
        };
        let declared = &self.interface.declared[index];
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
            let value = Reader::new(&mut none, &mut report, None).literal(&tree, slot);
            self.sources[index] = value.map(Source::Literal);
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
    /// The parameter with a value.
    fn parameter(&self, value: Value) -> Parameter {
        Parameter {
            value,
            unit: self.unit.symbol().to_owned(),
            name: self.name.clone(),
            range: self.range,
            about: self.about.clone(),
        }
    }
}
