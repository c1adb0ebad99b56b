//! Compiles fields into one linear program of column operations.
//!
//! Equal expressions of one domain share their columns. A field that is evaluated elsewhere
//! ([`Field::at`]) opens a new domain, whose position is three columns of the old one. Columns get
//! slots by liveness, so a program needs as many buffers as are alive at once.

use super::charts::Charts;
use super::guards::{self, Guard};
use super::places::{ColumnsOf, Places};
use super::within::{Member, Sharing, Within};
use super::{Field, Kernel, Operation, Sampling};
use crate::cancel::Cancel;
use crate::key::{Key, KeyHasher};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// A linear list of column operations that gives the columns of some fields.
#[derive(Debug)]
pub struct Program {
    pub(super) steps: Vec<Step>,
    /// For each step which choice it is needed for, if it is not needed always.
    pub(super) guards: Vec<Option<Guard>>,
    /// Programs that give fields inside single pixels.
    pub(super) within: Vec<Within>,
    pub(super) slots: usize,
    /// Slots that hold one number throughout, with that number.
    pub(super) constants: Vec<(usize, f32)>,
    /// The slot of what rounding took from the position, if anything reads it.
    pub(super) remainder: Option<usize>,
    pub(super) outputs: Vec<Vec<usize>>,
    pub(super) margin: usize,
    pub(super) key: Key,
}

/// One operation of a program. Columns are slot numbers.
#[derive(Debug)]
pub(super) enum Step {
    /// The change of a column from sample to sample.
    Spread {
        of: usize,
        along: [usize; 2],
        /// Which neighbours are of one chart, where there are charts.
        joins: Option<[usize; 2]>,
        /// Whether it is the larger of the changes to both sides where they differ much.
        has_kinks: bool,
    },
    /// Which samples are of one chart with the next, along rows and columns.
    Joins {
        charts: Vec<usize>,
        joins: [usize; 2],
    },
    /// A kernel.
    Kernel(Box<KernelStep>),
}

/// A kernel with its columns.
#[derive(Debug)]
pub(super) struct KernelStep {
    pub(super) kernel: Arc<dyn Kernel>,
    pub(super) node: Arc<str>,
    pub(super) key: Key,
    pub(super) inputs: Vec<usize>,
    /// For every input the slots of its spread, if the kernel reads it.
    pub(super) spreads: Vec<Option<[usize; 2]>>,
    pub(super) outputs: Vec<usize>,
    /// Where the outputs inside single pixels are found, if the kernel cannot filter.
    pub(super) within: Option<Member>,
    /// The charts of the samples, if that is where the outputs are averaged.
    pub(super) charts: Vec<usize>,
    /// How many samples beyond the tile the outputs are read.
    pub(super) margin: usize,
}

/// Slots 0 to 2 hold the position of the samples.
pub(super) const POSITION: [usize; 3] = [0, 1, 2];

impl Program {
    /// Compiles a program whose outputs are the columns of `fields`, in order.
    pub fn compile(fields: &[Field]) -> Program {
        Program::compile_in_charts(fields, &[])
    }

    /// As [`Program::compile`], of a piece on which samples are neighbours only if all of `charts` have the same
    /// values at both: spreads do not reach from one to the other, nor do means unless they differ in fractions only.
    pub fn compile_in_charts(fields: &[Field], charts: &[Field]) -> Program {
        let program = Compiler::new(true, charts).compile(fields, None);
        program.expect("nobody cancels it")
    }

    /// As [`Program::compile_in_charts`]; `None` if the run is cancelled meanwhile.
    pub(crate) fn compile_until(
        fields: &[Field],
        charts: &[Field],
        cancel: &Cancel,
    ) -> Option<Program> {
        Compiler::new(true, charts).compile(fields, Some(cancel))
    }

    /// Identifies the program: two with the same key do the same.
    pub fn key(&self) -> Key {
        self.key
    }
}

pub(super) struct Compiler {
    supersampling: bool,
    charts: Charts,
    places: Places,
    columns_of: ColumnsOf,
    spread_of: HashMap<(usize, bool), [usize; 2]>,
    constant_of: HashMap<u32, usize>,
    constant_columns: HashSet<usize>,
    constants: Vec<(usize, f32)>,
    remainder: Option<usize>,
    steps: Vec<Step>,
    sharing: Sharing,
    columns: usize,
}

impl Compiler {
    pub(super) fn new(supersampling: bool, charts: &[Field]) -> Compiler {
        Compiler {
            supersampling,
            charts: Charts::of(charts),
            places: Places::new(),
            columns_of: HashMap::new(),
            spread_of: HashMap::new(),
            constant_of: HashMap::new(),
            constant_columns: HashSet::new(),
            constants: Vec::new(),
            remainder: None,
            steps: Vec::new(),
            sharing: Sharing::default(),
            columns: POSITION.len(),
        }
    }

    /// `None` if the run is cancelled meanwhile.
    pub(super) fn compile(mut self, fields: &[Field], cancel: Option<&Cancel>) -> Option<Program> {
        let mut key = KeyHasher::new("program", 1);
        key.whole(i64::from(self.supersampling));
        self.charts.add_to_key(&mut key);
        self.divide_into_charts(cancel)?;
        let outputs: Option<Vec<Vec<usize>>> = fields
            .iter()
            .map(|field| {
                key.key(field.key());
                self.columns(field, cancel)
            })
            .collect();
        let margin = super::cost::assign_margins(&mut self.steps, self.columns);
        let outputs = outputs?;
        let program = Program {
            guards: guards::guards(&self.steps, &outputs, self.columns),
            steps: self.steps,
            within: self.sharing.programs(),
            slots: self.columns,
            constants: self.constants,
            remainder: self.remainder,
            outputs,
            margin,
            key: key.finish(),
        };
        Some(super::slots::assign(program))
    }

    /// Finds out which samples are of one chart; `None` if the run is cancelled meanwhile.
    fn divide_into_charts(&mut self, cancel: Option<&Cancel>) -> Option<()> {
        for chart in self.charts.fields.clone() {
            let columns = self.columns(&chart, cancel)?;
            self.charts.columns.extend(columns);
        }
        if !self.charts.columns.is_empty() {
            let (charts, joins) = (
                self.charts.columns.clone(),
                [self.new_column(), self.new_column()],
            );
            self.steps.push(Step::Joins { charts, joins });
            self.charts.joins = Some(joins);
        }
        Some(())
    }

    /// The columns of a field in the root place, with everything it depends on.
    fn columns(&mut self, field: &Field, cancel: Option<&Cancel>) -> Option<Vec<usize>> {
        // A loop instead of recursion: recipes may chain a hundred thousand nodes.
        let mut pending = vec![(field.clone(), 0)];
        while let Some((field, place)) = pending.last().cloned() {
            if cancel.is_some_and(Cancel::is_cancelled) {
                return None;
            }
            if self.columns_of.contains_key(&(field.key(), place)) {
                pending.pop();
                continue;
            }
            let missing = self.missing(&field, place);
            if missing.is_empty() {
                let columns = self.emit(&field, place);
                self.columns_of.insert((field.key(), place), columns);
                pending.pop();
            } else {
                pending.extend(missing);
            }
        }
        Some(self.columns_of[&(field.key(), 0)].clone())
    }

    /// The dependencies of a field that have no columns yet.
    fn missing(&mut self, field: &Field, place: usize) -> Vec<(Field, usize)> {
        let wanted = match &field.0.operation {
            Operation::Constant(_) | Operation::Position | Operation::Remainder => vec![],
            Operation::Part { of, .. } => vec![(of.clone(), place)],
            Operation::Kernel { kernel, inputs, .. } => {
                let choice = kernel.alternatives().map(|it| inputs[it.choice].clone());
                match choice.filter(|it| !self.columns_of.contains_key(&(it.key(), place))) {
                    // The choice comes before what is chosen, which then may be left out.
                    Some(choice) => vec![(choice, place)],
                    None => inputs.iter().map(|input| (input.clone(), place)).collect(),
                }
            }
            Operation::At { field, opening } => {
                match self.places.open(place, opening, &self.columns_of) {
                    Some(inner) => vec![(field.clone(), inner)],
                    None => opening.fields().map(|it| (it.clone(), place)).collect(),
                }
            }
            Operation::Given { name, otherwise } => {
                match self.places.given(name, field.width(), place) {
                    Some(_) => vec![],
                    None => vec![(otherwise.clone(), place)],
                }
            }
        };
        let unknown =
            |wanted: &(Field, usize)| !self.columns_of.contains_key(&(wanted.0.key(), wanted.1));
        wanted.into_iter().filter(unknown).collect()
    }

    /// Emits the step of a field whose dependencies have columns; gives its columns.
    fn emit(&mut self, field: &Field, place: usize) -> Vec<usize> {
        match &field.0.operation {
            Operation::Constant(values) => {
                values.iter().map(|value| self.constant(*value)).collect()
            }
            Operation::Position => self.places.position(place).to_vec(),
            Operation::Remainder => vec![self.remainder(place)],
            Operation::Part { of, first } => {
                self.columns_of[&(of.key(), place)][*first..*first + field.width()].to_vec()
            }
            Operation::At { field, opening } => {
                let inner = self.places.inner(place, opening);
                self.columns_of[&(field.key(), inner)].clone()
            }
            Operation::Given { name, otherwise } => {
                let given = self.places.given(name, field.width(), place);
                let meant = given.unwrap_or((otherwise.key(), place));
                self.columns_of[&meant].clone()
            }
            Operation::Kernel {
                kernel,
                inputs,
                node,
            } => {
                let columns = inputs
                    .iter()
                    .flat_map(|input| self.columns_of[&(input.key(), place)].clone())
                    .collect();
                self.emit_kernel(field, place, Arc::clone(kernel), Arc::clone(node), columns)
            }
        }
    }

    fn emit_kernel(
        &mut self,
        field: &Field,
        place: usize,
        kernel: Arc<dyn Kernel>,
        node: Arc<str>,
        inputs: Vec<usize>,
    ) -> Vec<usize> {
        let spreads = inputs
            .iter()
            .enumerate()
            .map(|(column, of)| {
                let has_kinks = kernel.has_kinks(column) && !self.supersampling;
                kernel
                    .reads_spread(column)
                    .then(|| self.spread(*of, has_kinks))
            })
            .collect();
        let outputs: Vec<usize> = (0..kernel.width()).map(|_| self.new_column()).collect();
        self.sharing.note(&*kernel, &inputs, &outputs);
        let within = self.may_be_supersampled(&*kernel, &inputs).then(|| {
            let seen = self.places.seen_from_root(field, place);
            let mixes = kernel.mixes_charts();
            self.sharing
                .join(seen, outputs[0], &self.charts.fields, mixes)
        });
        let mut key = KeyHasher::new("step", 1);
        key.key(field.key()).key(self.places.key(place));
        self.charts.add_to_key(&mut key);
        let charts = match within {
            Some(_) if !kernel.mixes_charts() => self.charts.columns.clone(),
            _ => vec![],
        };
        let step = KernelStep {
            kernel,
            node,
            key: key.finish(),
            inputs,
            spreads,
            outputs: outputs.clone(),
            within,
            charts,
            margin: 0,
        };
        self.steps.push(Step::Kernel(Box::new(step)));
        outputs
    }

    /// Whether the kernel cannot filter and reads what may change from sample to sample.
    fn may_be_supersampled(&self, kernel: &dyn Kernel, inputs: &[usize]) -> bool {
        let varies = |column: &usize| !self.constant_columns.contains(column);
        let needs_samples = match kernel.sampling() {
            Sampling::Filtered => false,
            Sampling::FilteredWhereEven { column, .. }
            | Sampling::FilteredWhereStraight { column, .. } => varies(&inputs[column]),
            Sampling::Supersampled => inputs.iter().any(varies),
        };
        self.supersampling && needs_samples
    }

    fn spread(&mut self, of: usize, has_kinks: bool) -> [usize; 2] {
        if let Some(known) = self.spread_of.get(&(of, has_kinks)) {
            return *known;
        }
        let along = [self.new_column(), self.new_column()];
        let joins = self.charts.joins;
        self.steps.push(Step::Spread {
            of,
            along,
            joins,
            has_kinks,
        });
        self.spread_of.insert((of, has_kinks), along);
        along
    }

    fn constant(&mut self, value: f32) -> usize {
        if let Some(known) = self.constant_of.get(&value.to_bits()) {
            return *known;
        }
        let column = self.new_column();
        self.constant_of.insert(value.to_bits(), column);
        self.constants.push((column, value));
        self.constant_columns.insert(column);
        column
    }

    /// The column of what rounding took from the position: of a place that a field opens nothing is known.
    fn remainder(&mut self, place: usize) -> usize {
        if !self.places.is_root(place) {
            return self.constant(0.0);
        }
        let known = self.remainder.unwrap_or_else(|| self.new_column());
        self.remainder = Some(known);
        known
    }

    fn new_column(&mut self) -> usize {
        self.columns += 1;
        self.columns - 1
    }
}
