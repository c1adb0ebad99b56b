//! Fields: values defined at every point, held as nodes of an expression graph.
//!
//! A [`Field`] is neither a closure nor an image. It is an expression that [`Program`] compiles,
//! together with all the other fields of an output, into one linear list of column operations.
//! Two fields with the same [`Field::key`] have the same values, so they are computed once.

mod charts;
mod compile;
mod cost;
mod given;
mod guards;
mod kernel;
mod lost;
mod periods;
mod places;
mod points;
mod run;
mod samples;
mod slots;
mod spread;
mod supersample;
mod transpose;
mod within;

pub use compile::Program;
pub(crate) use given::names_read;
pub use guards::Alternatives;
pub use kernel::{Block, InputColumn, Kernel, Sampling};
pub use lost::lost_of_sum;
pub(crate) use points::at_points;
pub use run::{ColumnCache, Columns, RunContext, Scratch, Work};
pub(crate) use samples::remainder;
pub use samples::{PixelGrid, Samples, Target};
pub(crate) use transpose::transposed;

use crate::key::{Key, KeyHasher};
use crate::value::Domain;
use std::sync::Arc;

/// A number (one column), a vector or a colour (three columns) for every point of a domain.
#[derive(Clone, Debug)]
pub struct Field(Arc<Expression>);

/// One node of the expression graph.
#[derive(Debug)]
struct Expression {
    key: Key,
    width: usize,
    domain: Domain,
    operation: Operation,
    /// See [`Field::lost`].
    lost: Option<Field>,
    /// See [`Field::widest`].
    widest: Option<(Field, f32)>,
}

/// How an expression gets its columns.
#[derive(Debug)]
enum Operation {
    /// The same values everywhere.
    Constant(Vec<f32>),
    /// The position of the sample in its domain, in mm.
    Position,
    /// What rounding took from the first part of the position.
    Remainder,
    /// Some columns of a wider field.
    Part { of: Field, first: usize },
    /// A kernel over the columns of other fields.
    Kernel {
        kernel: Arc<dyn Kernel>,
        inputs: Vec<Field>,
        node: Arc<str>,
    },
    /// A field of another domain, evaluated where an opening leads.
    At { field: Field, opening: Arc<Opening> },
    /// What the nearest opening around gives under this name; `otherwise` if none does.
    Given { name: Arc<str>, otherwise: Field },
}

/// A way into another domain: where its points are, and what is known there of the domain that it was opened in.
#[derive(Debug)]
struct Opening {
    key: Key,
    position: Field,
    /// Fields of the domain around, by the names under which fields inside read them.
    given: Vec<(Arc<str>, Field)>,
}

impl Field {
    /// The same number everywhere.
    pub fn constant(number: f64) -> Field {
        Field::constants(&[number])
    }

    /// The same vector or colour everywhere.
    pub fn constants(numbers: &[f64]) -> Field {
        let values: Vec<f32> = numbers.iter().map(|number| *number as f32 + 0.0).collect();
        let mut key = KeyHasher::new("constant", 1);
        values.iter().for_each(|value| {
            key.number(f64::from(*value));
        });
        Field::new(
            key.finish(),
            values.len(),
            Domain::Everywhere,
            Operation::Constant(values),
        )
    }

    /// The position of the sample in mm: (x, y, z) in a solid, (u, v, 0) on a plane.
    pub fn position(domain: Domain) -> Field {
        let key = KeyHasher::new("position", 1)
            .text(&domain.to_string())
            .finish();
        Field::new(key, 3, domain, Operation::Position)
    }

    /// What rounding to f32 took from the first part of the position on a plane: the sum of both is exact along pieces
    /// of hundreds of metres. Where a piece has been moved by another field it is 0.
    pub fn remainder() -> Field {
        let key = KeyHasher::new("remainder", 1).finish();
        Field::new(key, 1, Domain::Plane, Operation::Remainder)
    }

    /// The columns that `kernel` computes from `inputs`, on behalf of the node called `node`.
    ///
    /// The field is defined where its inputs are.
    ///
    /// # Panics
    /// If inputs are of different domains, which checking the recipe has ruled out.
    pub fn kernel(node: &Arc<str>, kernel: Arc<dyn Kernel>, inputs: Vec<Field>) -> Field {
        let mut key = KeyHasher::new("kernel", 1);
        kernel.add_to_key(&mut key);
        inputs.iter().for_each(|input| {
            key.key(input.key());
        });
        let domain = crate::node::common_domain(&inputs);
        assert!(
            inputs
                .iter()
                .all(|input| [domain, Domain::Everywhere].contains(&input.domain())),
            "the kernel of `{node}` reads fields of different domains"
        );
        let width = kernel.width();
        let (lost, widest) = (
            kernel.lost(node, &inputs),
            lost::widest_of(&*kernel, &inputs),
        );
        let node = Arc::clone(node);
        let operation = Operation::Kernel {
            kernel,
            inputs,
            node,
        };
        Field::new(key.finish(), width, domain, operation).having(lost, widest)
    }

    /// Columns `first .. first + width` of this field.
    pub fn part(&self, first: usize, width: usize) -> Field {
        if first == 0 && width == self.width() {
            return self.clone();
        }
        let key = KeyHasher::new("part", 1)
            .key(self.key())
            .whole(first as i64)
            .whole(width as i64)
            .finish();
        let lost = self.lost().map(|lost| lost.part(first, width));
        let widest = self.widest().cloned();
        let operation = Operation::Part {
            of: self.clone(),
            first,
        };
        Field::new(key, width, self.domain(), operation).having(lost, widest)
    }

    /// This field where `position` points: the way from a plane into the solid it cuts.
    pub fn at(&self, position: &Field) -> Field {
        match self.domain() {
            Domain::Everywhere => self.clone(),
            _ => self.through(&Arc::new(Opening::new(position, vec![]))),
        }
    }

    /// This field where `position` points, while fields made by [`Field::given`] have the values that `given` has for
    /// them around: the way into a cell.
    pub fn at_given(&self, position: &Field, given: &[(Arc<str>, Field)]) -> Field {
        match self.as_constant() {
            Some(_) => self.clone(),
            None => self.through(&Arc::new(Opening::new(position, given.to_vec()))),
        }
    }

    /// What the place around says under `name`, for a field that is used in many places: in the first one outwards
    /// that was opened by [`Field::at_given`] with this name and as many columns. `otherwise` where there is none.
    pub fn given(name: &str, otherwise: &Field) -> Field {
        let key = KeyHasher::new("given", 1)
            .text(name)
            .key(otherwise.key())
            .finish();
        let (width, domain) = (otherwise.width(), otherwise.domain());
        let operation = Operation::Given {
            name: name.into(),
            otherwise: otherwise.clone(),
        };
        Field::new(key, width, domain, operation)
    }

    fn through(&self, opening: &Arc<Opening>) -> Field {
        let key = KeyHasher::new("at", 1)
            .key(self.key())
            .key(opening.key)
            .finish();
        let operation = Operation::At {
            field: self.clone(),
            opening: Arc::clone(opening),
        };
        let lost = self.lost().map(|lost| lost.through(opening));
        let widest = self.widest().map(|(of, by)| (of.through(opening), *by));
        Field::new(key, self.width(), opening.position.domain(), operation).having(lost, widest)
    }

    /// The hash that identifies the field's values.
    pub fn key(&self) -> Key {
        self.0.key
    }

    /// Number of columns: 1 for numbers, 3 for vectors and colours.
    pub fn width(&self) -> usize {
        self.0.width
    }

    /// Where the field is defined.
    pub fn domain(&self) -> Domain {
        self.0.domain
    }

    /// The values, if they are the same everywhere.
    pub fn as_constant(&self) -> Option<&[f32]> {
        match &self.0.operation {
            Operation::Constant(values) => Some(values),
            _ => None,
        }
    }

    fn new(key: Key, width: usize, domain: Domain, operation: Operation) -> Field {
        Field(Arc::new(Expression {
            key,
            width,
            domain,
            operation,
            lost: None,
            widest: None,
        }))
    }

    /// This field, just made, with what is known of its pixels.
    fn having(mut self, lost: Option<Field>, widest: Option<(Field, f32)>) -> Field {
        if let Some(expression) = Arc::get_mut(&mut self.0) {
            (expression.lost, expression.widest) = (lost, widest);
        }
        self
    }
}

impl Opening {
    fn new(position: &Field, given: Vec<(Arc<str>, Field)>) -> Opening {
        let mut key = KeyHasher::new("opening", 1);
        key.key(position.key());
        for (name, field) in &given {
            key.text(name).key(field.key());
        }
        Opening {
            key: key.finish(),
            position: position.clone(),
            given,
        }
    }

    /// The fields of the domain around.
    fn fields(&self) -> impl Iterator<Item = &Field> {
        std::iter::once(&self.position).chain(self.given.iter().map(|(_, field)| field))
    }
}

impl Operation {
    /// Moves the fields this operation depends on into `fields`.
    fn release_into(&mut self, fields: &mut Vec<Field>) {
        match std::mem::replace(self, Operation::Position) {
            Operation::Constant(_) | Operation::Position | Operation::Remainder => {}
            Operation::Part { of, .. } => fields.push(of),
            Operation::Kernel { inputs, .. } => fields.extend(inputs),
            Operation::At { field, opening } => {
                fields.push(field);
                if let Some(opening) = Arc::into_inner(opening) {
                    fields.push(opening.position);
                    fields.extend(opening.given.into_iter().map(|(_, field)| field));
                }
            }
            Operation::Given { otherwise, .. } => fields.push(otherwise),
        }
    }
}

impl Expression {
    /// Moves all fields this one depends on into `fields`.
    fn release_into(&mut self, fields: &mut Vec<Field>) {
        self.operation.release_into(fields);
        fields.extend(self.lost.take());
        fields.extend(self.widest.take().map(|(field, _)| field));
    }
}

impl Drop for Expression {
    /// Releases long chains in a loop: the default would recurse once for every link.
    fn drop(&mut self) {
        let mut pending = Vec::new();
        self.release_into(&mut pending);
        while let Some(Field(shared)) = pending.pop() {
            if let Ok(mut expression) = Arc::try_unwrap(shared) {
                expression.release_into(&mut pending);
            }
        }
    }
}
