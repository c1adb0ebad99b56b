//! Programs that give fields inside single pixels, where kernels cannot filter.

use super::compile::{Compiler, Program};
use super::{Field, Kernel};
use crate::cancel::Cancel;
use std::collections::HashMap;
use std::sync::{Mutex, OnceLock};

/// The program that gives some fields at its samples' own positions, and behind them their charts, compiled when it is
/// first needed: each holds the whole way to its fields, so a long chain of kernels that cannot filter would grow with
/// the square of its length.
///
/// Fields that depend on the same costly kernel share a program, since where one of them is wanted inside a pixel
/// the others mostly are as well.
#[derive(Debug)]
pub(super) struct Within {
    fields: Vec<Field>,
    charts: Vec<Field>,
    program: OnceLock<Program>,
    compiling: Mutex<()>,
}

/// Where the values of a step inside pixels are found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    /// Index of the program.
    pub(super) within: usize,
    /// Index of the first column among those of all its fields.
    pub(super) column: usize,
}

impl Within {
    /// Number of columns of all fields.
    pub(super) fn width(&self) -> usize {
        self.fields.iter().map(Field::width).sum()
    }

    /// Number of fields.
    pub(super) fn fields(&self) -> usize {
        self.fields.len()
    }

    /// `None` if the run is cancelled before it is compiled.
    pub(super) fn program(&self, cancel: Option<&Cancel>) -> Option<&Program> {
        if let Some(program) = self.program.get() {
            return Some(program);
        }
        // One thread compiles, the others wait for it.
        let _compiling = self.compiling.lock();
        if self.program.get().is_none() {
            let fields = [&self.fields[..], &self.charts].concat();
            let compiled = Compiler::new(false, &self.charts).compile(&fields, cancel)?;
            let _ = self.program.set(compiled);
        }
        self.program.get()
    }
}

/// Most fields that share a program.
const MOST: usize = 16;

/// A field may be so many times as costly as the first of those that it shares a program with.
const MOST_MORE: f32 = 2.0;

/// Sorts the fields that are wanted inside pixels into programs, while they are compiled.
#[derive(Debug, Default)]
pub(super) struct Sharing {
    programs: Vec<Within>,
    /// What each column depends on.
    ways: HashMap<usize, Way>,
    /// By the costliest kernel on the way, and whether means mix charts: the program that is open, and what its first
    /// field costs.
    open: HashMap<(usize, bool), (usize, f32)>,
}

/// The kernels that a column depends on.
#[derive(Clone, Copy, Debug, Default)]
struct Way {
    /// The first column of the costliest, and its nanoseconds.
    costliest: (usize, f32),
    /// Nanoseconds along the costliest way, at least.
    cost: f32,
}

impl Sharing {
    /// Notes a kernel with its columns.
    pub(super) fn note(&mut self, kernel: &dyn Kernel, inputs: &[usize], outputs: &[usize]) {
        let own = kernel.nanoseconds();
        let first = outputs.first().copied().unwrap_or_default();
        let mut way = Way::default();
        for of_input in inputs.iter().filter_map(|column| self.ways.get(column)) {
            way.cost = way.cost.max(of_input.cost);
            if of_input.costliest.1 > way.costliest.1 {
                way.costliest = of_input.costliest;
            }
        }
        if own > way.costliest.1 {
            way.costliest = (first, own);
        }
        way.cost += own;
        self.ways
            .extend(outputs.iter().map(|column| (*column, way)));
    }

    /// Puts a field, whose columns were noted, into a program.
    pub(super) fn join(
        &mut self,
        field: Field,
        first: usize,
        charts: &[Field],
        mixes: bool,
    ) -> Member {
        let way = self.ways.get(&first).copied().unwrap_or_default();
        let place = (way.costliest.0, mixes);
        if let Some((within, cost)) = self.open.get(&place).copied() {
            let program = &mut self.programs[within];
            if program.fields.len() < MOST && way.cost <= MOST_MORE * cost {
                let column = program.width();
                program.fields.push(field);
                return Member { within, column };
            }
        }
        let within = self.programs.len();
        self.open.insert(place, (within, way.cost));
        self.programs.push(Within {
            fields: vec![field],
            charts: charts.to_vec(),
            program: OnceLock::new(),
            compiling: Mutex::new(()),
        });
        Member { within, column: 0 }
    }

    /// All programs.
    pub(super) fn programs(self) -> Vec<Within> {
        self.programs
    }
}
