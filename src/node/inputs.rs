//! What a build function receives: checked inputs by name, and how it reports that it cannot go on.

use super::Kind;
use super::ledger::{Budget, Ledger};
use crate::cancel::Cancel;
use crate::field::{Field, Kernel, RunContext, at_points};
use crate::value::{
    Climate, ColourPattern, Domain, FileContents, Material, Mesh, Partition, Patches, Region,
    RingSeries, Skeleton, Value,
};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// The inputs of one node, checked against its kind: absent optional ones are missing, defaults filled in.
///
/// The typed readers take the names that the kind declares. Asking for a name or a type that the kind
/// does not declare is a mistake in the node's file, found by the test that builds every kind's example.
#[derive(Debug)]
pub struct Inputs<'a> {
    kind: &'static Kind,
    values: &'a [Option<Value>],
    ledger: Ledger,
    budget: Arc<Budget>,
    progress: Option<Progress<'a>>,
}

/// Who hears how far a node is.
struct Progress<'a>(&'a (dyn Fn(f64) + Sync));

impl std::fmt::Debug for Progress<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Progress")
    }
}

/// Why a node could not be built, in terms of the recipe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// What is wrong, in lower case and without a full stop.
    pub message: String,
    /// The input to blame, if it is one.
    pub input: Option<&'static str>,
    /// Which item of the input, if it is a list.
    pub item: Option<usize>,
    /// What to do.
    pub hint: Option<String>,
}

impl Failure {
    /// A failure that no single input causes.
    pub fn new(message: impl Into<String>) -> Failure {
        Failure {
            message: message.into(),
            input: None,
            item: None,
            hint: None,
        }
    }

    /// A failure caused by input `input`.
    pub fn of_input(input: &'static str, message: impl Into<String>) -> Failure {
        Failure {
            message: message.into(),
            input: Some(input),
            item: None,
            hint: None,
        }
    }

    /// Blames one item of the input, counted from 0.
    pub fn at_item(mut self, item: usize) -> Failure {
        self.item = Some(item);
        self
    }

    /// Adds what to do.
    pub fn with_hint(mut self, hint: impl Into<String>) -> Failure {
        self.hint = Some(hint.into());
        self
    }
}

/// What surrounds a node that is being built.
#[derive(Debug)]
pub struct Build<'a> {
    /// The node's name, under which its kernels report what they did.
    pub node: &'a Arc<str>,
    /// The seed of the recipe.
    pub seed: u64,
    /// Stops the run; `None` for one that is not stopped.
    pub cancel: Option<&'a Cancel>,
}

impl Build<'_> {
    /// The columns that `kernel` computes from `inputs`.
    pub fn kernel(&self, kernel: impl Kernel + 'static, inputs: Vec<Field>) -> Field {
        Field::kernel(self.node, Arc::new(kernel), inputs)
    }

    /// The values of a field of the plane at points in mm, column by column and unfiltered: for structures that are made
    /// along a field.
    ///
    /// # Errors
    /// If the run was cancelled, as of [`Build::go_on`].
    pub fn sample(&self, field: &Field, points: &[DVec2]) -> Result<Vec<Vec<f32>>, Failure> {
        let context = RunContext {
            level: fearless_simd::Level::new(),
            cache: None,
            filtering: false,
            cancel: self.cancel,
        };
        let points: Vec<[f64; 3]> = points.iter().map(|at| [at.x, at.y, 0.0]).collect();
        let mut values = at_points(std::slice::from_ref(field), &points, &context);
        self.go_on()?;
        Ok(values.swap_remove(0))
    }

    /// The same of the field that is linked to input `name`, if all values are finite.
    ///
    /// # Errors
    /// If one of them is not finite, or the run was cancelled.
    pub fn sample_finite(
        &self,
        name: &'static str,
        field: &Field,
        points: &[DVec2],
    ) -> Result<Vec<Vec<f32>>, Failure> {
        let columns = self.sample(field, points)?;
        for (point, value) in columns.iter().flat_map(|column| points.iter().zip(column)) {
            if !value.is_finite() {
                let [x, y] = point.to_array();
                let message =
                    format!("expected finite numbers, found {value} at ({x:.3}, {y:.3}) mm");
                return Err(Failure::of_input(name, message)
                    .with_hint("look for a division by 0 in what is linked here"));
            }
        }
        Ok(columns)
    }

    /// To be asked in loops that may take longer than some milliseconds.
    ///
    /// # Errors
    /// If the run was cancelled. What is returned then counts for nothing: it is not reported, and the node
    /// is built again by the next run.
    pub fn go_on(&self) -> Result<(), Failure> {
        match self.cancel {
            Some(cancel) if cancel.is_cancelled() => Err(Failure::new("the run was cancelled")),
            _ => Ok(()),
        }
    }
}

macro_rules! readers {
    ($($(#[$doc:meta])* $reader:ident, $pattern:pat => $result:expr, $type:ty;)*) => {
        $(
            $(#[$doc])*
            pub fn $reader(&self, name: &str) -> $type {
                match self.required(name) {
                    $pattern => $result,
                    other => self.mistake(name, other),
                }
            }
        )*
    };
}

impl<'a> Inputs<'a> {
    /// Pairs the values with the kind that declares them.
    pub fn new(kind: &'static Kind, values: &'a [Option<Value>]) -> Inputs<'a> {
        Inputs::within(kind, values, Arc::default())
    }

    /// As [`Inputs::new`], with the memory for decoded files that the run has left.
    pub(crate) fn within(
        kind: &'static Kind,
        values: &'a [Option<Value>],
        budget: Arc<Budget>,
    ) -> Inputs<'a> {
        Inputs {
            kind,
            values,
            ledger: Ledger::default(),
            budget,
            progress: None,
        }
    }

    /// Lets `hear` know how far the node is.
    pub(crate) fn telling(self, hear: &'a (dyn Fn(f64) + Sync)) -> Inputs<'a> {
        Inputs {
            progress: Some(Progress(hear)),
            ..self
        }
    }

    /// Tells how much of the node is done, from 0 to 1: for structures that take longer than some tenths of a second. It may be
    /// called as often as is handy.
    pub fn progress(&self, fraction: f64) {
        if let Some(Progress(hear)) = &self.progress {
            hear(fraction);
        }
    }

    /// Warns of something that the recipe's author should know, in lower case and without a full stop. Every
    /// run repeats it, also one that finds the result of an earlier one.
    pub fn warn(&self, message: impl Into<String>) {
        self.ledger.warn(message.into());
    }

    /// The values of the field in input `name` at points of the plane in mm, column by column, as [`Build::sample`] gives them.
    ///
    /// # Errors
    /// If one of them is not finite, or the run was cancelled.
    pub fn sample(
        &self,
        name: &'static str,
        build: &Build<'_>,
        points: &[DVec2],
    ) -> Result<Vec<Vec<f32>>, Failure> {
        build.sample_finite(name, &self.field(name), points)
    }

    /// Takes memory for what is decoded from the file of input `input`: to be asked before decoding.
    ///
    /// # Errors
    /// If the files of the recipe would take more than a run may.
    pub fn take_memory(&self, input: &'static str, bytes: u64) -> Result<(), Failure> {
        self.ledger.take(&self.budget, input, bytes)
    }

    /// The warnings, and the memory taken.
    pub(crate) fn close(self) -> (Vec<String>, u64) {
        self.ledger.close()
    }

    /// The value of an input, unless the recipe left it out.
    pub fn get(&self, name: &str) -> Option<&'a Value> {
        let Some((index, _)) = self.kind.input(name) else {
            panic!("kind `{}` declares no input `{name}`", self.kind.name)
        };
        self.values[index].as_ref()
    }

    readers! {
        /// A constant number, in the unit that the input declares.
        number, Value::Number(number) => *number, f64;
        /// A whole number.
        whole, Value::Whole(number) => *number, i64;
        /// A toggle.
        toggle, Value::Toggle(toggle) => *toggle, bool;
        /// The chosen name.
        choice, Value::Choice(name) => name, &'static str;
        /// Text.
        text, Value::Text(text) => text, &'a str;
        /// A file with its contents.
        file, Value::File(file) => file, &'a FileContents;
        /// A constant linear colour.
        colour, Value::Colour(colour) => *colour, [f64; 3];
        /// A constant vector.
        vector, Value::Vector(vector) => *vector, DVec3;
        /// A pair of numbers.
        pair, Value::Pair(pair) => *pair, [f64; 2];
        /// The items of a list.
        list, Value::List(items) => items, &'a [Value];
        /// Names of channels.
        names, Value::Names(names) => names, &'a [String];
        /// Named values.
        channels, Value::Channels(channels) => channels, &'a [(String, Value)];
        /// A skeleton.
        skeleton, Value::Skeleton(skeleton) => skeleton, &'a Arc<Skeleton>;
        /// A colour pattern.
        colour_pattern, Value::ColourPattern(pattern) => pattern, &'a Arc<ColourPattern>;
        /// A climate.
        climate, Value::Climate(climate) => climate, &'a Arc<Climate>;
        /// A ring series.
        ring_series, Value::RingSeries(series) => series, &'a Arc<RingSeries>;
        /// A mesh.
        mesh, Value::Mesh(mesh) => mesh, &'a Arc<Mesh>;
        /// Patches.
        patches, Value::Patches(patches) => patches, &'a Arc<Patches>;
        /// A region.
        region, Value::Region(region) => region, &'a Arc<Region>;
        /// A partition.
        partition, Value::Partition(partition) => partition, &'a Arc<Partition>;
        /// A material.
        material, Value::Material(material) => material, &'a Arc<Material>;
    }

    /// A per-point input as a field, whether the recipe gave a literal or a link.
    pub fn field(&self, name: &str) -> Field {
        let value = self.required(name);
        field_of(value).unwrap_or_else(|| self.mistake(name, value))
    }

    /// A per-point input as a field, unless the recipe left it out.
    pub fn optional_field(&self, name: &str) -> Option<Field> {
        self.get(name).map(|_| self.field(name))
    }

    fn required(&self, name: &str) -> &'a Value {
        self.get(name).unwrap_or_else(|| {
            panic!(
                "input `{name}` of kind `{}` has no value: declare a default",
                self.kind.name
            )
        })
    }

    fn mistake(&self, name: &str, found: &Value) -> ! {
        let found = found.type_name();
        panic!(
            "input `{name}` of kind `{}` holds a {found}: use another reader",
            self.kind.name
        )
    }
}

/// A number, vector or colour as a field.
pub(crate) fn field_of(value: &Value) -> Option<Field> {
    match value {
        Value::Number(number) => Some(Field::constant(*number)),
        Value::Whole(number) => Some(Field::constant(*number as f64)),
        Value::Colour(colour) => Some(Field::constants(colour)),
        Value::Vector(vector) => Some(Field::constants(&vector.to_array())),
        Value::Field(field) => Some(field.clone()),
        _ => None,
    }
}

/// The domain that fields share; `Everywhere` if all are constant.
pub fn common_domain<'f>(fields: impl IntoIterator<Item = &'f Field>) -> Domain {
    fields
        .into_iter()
        .map(Field::domain)
        .find(|domain| *domain != Domain::Everywhere)
        .unwrap_or(Domain::Everywhere)
}
