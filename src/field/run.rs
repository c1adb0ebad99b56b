//! Runs a program over one block of samples.

use super::compile::{KernelStep, POSITION, Program, Step};
use super::guards::Guard;
use super::supersample::{Averages, supersample};
use super::{Block, InputColumn, Kernel, Samples, charts, spread};
use crate::cancel::Cancel;
use crate::key::{Key, KeyHasher};
use fearless_simd::Level;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Samples per vector, at most: columns are padded to a multiple of it.
const PADDING: usize = 16;

/// A kernel dearer than this many nanoseconds a sample is worth keeping columns of.
const DEAR: f32 = 4.0;

/// Nanoseconds of work between two looks at the switch that cancels the run, as far as kernels know them.
const LONGEST_PIECE: f32 = 2e6;

/// The columns of one kernel for one block of samples.
pub type Columns = Arc<[Vec<f32>]>;

/// Keeps columns of expensive kernels between runs.
pub trait ColumnCache: Send + Sync {
    /// The columns stored under `key`.
    fn get(&self, key: &Key) -> Option<Columns>;

    /// An empty column with room for `length` values, for [`ColumnCache::put`].
    fn column(&self, length: usize) -> Vec<f32> {
        Vec::with_capacity(length)
    }

    /// Stores columns of `node` that took about `nanoseconds` to compute.
    fn put(&self, node: &str, key: Key, columns: Columns, nanoseconds: f64);
}

/// What a run needs besides the program and the samples.
#[derive(Clone, Copy)]
pub struct RunContext<'a> {
    /// The vector instructions to use; results do not depend on it.
    pub level: Level,
    /// Where columns of expensive kernels are kept, if anywhere.
    pub cache: Option<&'a dyn ColumnCache>,
    /// Whether kernels see the spread of their inputs and are supersampled where they bend.
    /// Switched off only to show what filtering is good for.
    pub filtering: bool,
    /// Stops a run; `None` for one that is not stopped.
    pub cancel: Option<&'a Cancel>,
}

impl RunContext<'_> {
    /// Whether what is computed is not wanted any more.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(Cancel::is_cancelled)
    }
}

/// What the nodes did for one block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// A kernel of the node ran.
    pub computed: bool,
    /// Columns of the node came from the cache.
    pub reused: bool,
}

/// The buffers of a thread that runs programs; kept between runs.
#[derive(Default)]
pub struct Scratch {
    slots: Vec<Vec<f32>>,
    filled: Option<(Key, usize)>,
    /// The buffers for supersampling.
    pub(super) within: Option<Box<Scratch>>,
    /// What programs for single pixels have given in this run.
    averages: Vec<Averages>,
    work: BTreeMap<Arc<str>, Work>,
}

impl Scratch {
    /// The column in slot `slot`.
    pub(super) fn column(&self, slot: usize) -> &[f32] {
        &self.slots[slot]
    }

    /// What a program for single pixels has given in this run.
    pub(super) fn averages(&mut self, within: usize) -> &mut Averages {
        &mut self.averages[within]
    }

    /// What every node did since the last call.
    pub fn take_work(&mut self) -> BTreeMap<Arc<str>, Work> {
        std::mem::take(&mut self.work)
    }

    pub(super) fn note(&mut self, node: &Arc<str>, work: Work) {
        let entry = self.work.entry(Arc::clone(node)).or_default();
        entry.computed |= work.computed;
        entry.reused |= work.reused;
    }

    /// Prepares the buffers for a program over `padded` samples.
    fn prepare(&mut self, program: &Program, samples: &Samples<'_>, padded: usize) {
        self.averages.iter_mut().for_each(Averages::clear);
        let most = self.averages.len().max(program.within.len());
        self.averages.resize_with(most, Averages::default);
        if self.filled != Some((program.key, padded)) {
            self.slots
                .resize_with(self.slots.len().max(program.slots), Vec::new);
            for (slot, value) in &program.constants {
                self.slots[*slot].clear();
                self.slots[*slot].resize(padded, *value);
            }
            self.filled = Some((program.key, padded));
        }
        let mut position = POSITION.map(|slot| std::mem::take(&mut self.slots[slot]));
        samples.write_positions(&mut position, padded);
        for (slot, column) in POSITION.into_iter().zip(position) {
            self.slots[slot] = column;
        }
        if let Some(slot) = program.remainder {
            samples.write_remainders(&mut self.slots[slot], padded);
        }
    }
}

impl Program {
    /// Evaluates the program at `samples`; the results are read with [`Program::output`]. If the run is
    /// cancelled meanwhile, it ends early and there are none.
    pub fn run(&self, samples: &Samples<'_>, scratch: &mut Scratch, context: &RunContext<'_>) {
        let padded = samples.len().next_multiple_of(PADDING);
        scratch.prepare(self, samples, padded);
        let stored = self.stored(samples, context);
        let needed = self.needed(&stored);
        let steps = self.steps.iter().zip(&self.guards);
        for (((step, guard), stored), needed) in steps.zip(&stored).zip(needed) {
            if context.is_cancelled() {
                return;
            }
            let is_wanted = |guard: &Guard| guard.is_wanted(scratch.column(guard.column));
            match (step, stored) {
                _ if !needed || !guard.as_ref().is_none_or(is_wanted) => {}
                (
                    Step::Spread {
                        of,
                        along,
                        joins,
                        has_kinks,
                    },
                    _,
                ) => {
                    let shape = shape(samples, context);
                    write_columns(scratch, *along, |scratch, columns| {
                        let values = scratch.column(*of);
                        let joins = joins.map(|joins| joins.map(|slot| scratch.column(slot)));
                        match *has_kinks {
                            true => {
                                let change = spread::change_at_kinks;
                                charts::write_spread_between(values, joins, shape, columns, change);
                            }
                            false => {
                                let change = spread::mean_change;
                                charts::write_spread_between(values, joins, shape, columns, change);
                            }
                        }
                    });
                }
                (Step::Joins { charts, joins }, _) => {
                    let shape = shape(samples, context);
                    write_columns(scratch, *joins, |scratch, columns| {
                        let charts = charts.iter().map(|slot| scratch.column(*slot));
                        charts::write_joins(&charts.collect::<Vec<_>>(), shape, columns);
                    });
                }
                (Step::Kernel(step), Stored::Columns(columns)) => load(scratch, step, columns),
                (Step::Kernel(step), Stored::Under(key)) => {
                    compute(scratch, self, step, samples, context, padded);
                    store(scratch, step, *key, context, padded);
                }
                (Step::Kernel(step), Stored::Nowhere) => {
                    compute(scratch, self, step, samples, context, padded);
                }
            }
        }
    }

    /// Column `column` of output `output` after a run; longer than the samples by some padding.
    pub fn output<'a>(&self, scratch: &'a Scratch, output: usize, column: usize) -> &'a [f32] {
        scratch.column(self.outputs[output][column])
    }

    /// All columns of output `output` after a run.
    pub fn columns<'a>(&self, scratch: &'a Scratch, output: usize) -> Vec<&'a [f32]> {
        self.outputs[output]
            .iter()
            .map(|slot| scratch.column(*slot))
            .collect()
    }

    /// Looks up the columns that a cache may hold.
    fn stored(&self, samples: &Samples<'_>, context: &RunContext<'_>) -> Vec<Stored> {
        let Some(cache) = context.cache else {
            return self.steps.iter().map(|_| Stored::Nowhere).collect();
        };
        let samples_key = samples.key();
        let look_up = |step: &Step| match step {
            Step::Kernel(step) if step.kernel.nanoseconds() >= DEAR => {
                // Beyond its margin a column is neither supersampled nor has it true spreads.
                let key = KeyHasher::new("columns", 1)
                    .key(step.key)
                    .key(samples_key)
                    .whole(step.margin as i64)
                    .finish();
                cache.get(&key).map_or(Stored::Under(key), Stored::Columns)
            }
            _ => Stored::Nowhere,
        };
        self.steps.iter().map(look_up).collect()
    }

    /// Which steps have to run, given what is stored.
    fn needed(&self, stored: &[Stored]) -> Vec<bool> {
        let mut wanted = vec![false; self.slots];
        self.outputs
            .iter()
            .flatten()
            .for_each(|slot| wanted[*slot] = true);
        let mut needed = vec![false; self.steps.len()];
        for (index, step) in self.steps.iter().enumerate().rev() {
            let writes = step.writes();
            needed[index] = writes.iter().any(|slot| wanted[*slot]);
            if !needed[index] {
                continue;
            }
            // Before this step its slots belong to other columns.
            writes.iter().for_each(|slot| wanted[*slot] = false);
            if !matches!(stored[index], Stored::Columns(_)) {
                let guard = self.guards[index].map(|guard| guard.column);
                let reads = step.reads().into_iter().chain(guard);
                reads.for_each(|slot| wanted[slot] = true);
            }
        }
        needed
    }
}

/// What the cache has of a step.
enum Stored {
    Nowhere,
    /// Nothing yet; this is the key to store it under.
    Under(Key),
    Columns(Columns),
}

/// Width and height of the grids in which samples have neighbours.
fn shape(samples: &Samples<'_>, context: &RunContext<'_>) -> [usize; 2] {
    match context.filtering {
        true => samples.shape(),
        false => [1, 1],
    }
}

/// Lets `write` fill two columns, while it reads the others.
fn write_columns(
    scratch: &mut Scratch,
    slots: [usize; 2],
    write: impl FnOnce(&Scratch, &mut [Vec<f32>; 2]),
) {
    let mut columns = slots.map(|slot| std::mem::take(&mut scratch.slots[slot]));
    write(scratch, &mut columns);
    for (slot, column) in slots.into_iter().zip(columns) {
        scratch.slots[slot] = column;
    }
}

fn compute(
    scratch: &mut Scratch,
    program: &Program,
    step: &KernelStep,
    samples: &Samples<'_>,
    context: &RunContext<'_>,
    padded: usize,
) {
    let mut outputs: Vec<Vec<f32>> = step
        .outputs
        .iter()
        .map(|slot| std::mem::take(&mut scratch.slots[*slot]))
        .collect();
    outputs
        .iter_mut()
        .for_each(|column| column.resize(padded, 0.0));
    let inputs: Vec<InputColumn<'_>> = step
        .inputs
        .iter()
        .zip(&step.spreads)
        .map(|(slot, spread)| InputColumn {
            values: &scratch.slots[*slot],
            spread: spread.map_or([&[], &[]], |along| {
                along.map(|slot| &scratch.slots[slot][..])
            }),
        })
        .collect();
    evaluate(&*step.kernel, &inputs, &mut outputs, context);
    scratch.note(
        &step.node,
        Work {
            computed: true,
            reused: false,
        },
    );
    if let (Some(member), true) = (step.within, context.filtering) {
        let within = (&program.within[member.within], member);
        supersample(scratch, step, within, samples, context, &mut outputs);
    }
    for (slot, column) in step.outputs.iter().zip(outputs) {
        scratch.slots[*slot] = column;
    }
}

/// Evaluates a kernel; a slow one in pieces, so that a cancelled run need not wait for the whole block.
fn evaluate(
    kernel: &dyn Kernel,
    inputs: &[InputColumn<'_>],
    outputs: &mut [Vec<f32>],
    context: &RunContext<'_>,
) {
    let level = context.level;
    let length = outputs.first().map_or(0, Vec::len);
    let longest = (LONGEST_PIECE / kernel.nanoseconds()) as usize / PADDING * PADDING;
    let longest = longest.max(PADDING);
    if length <= longest {
        kernel.evaluate(&mut Block {
            level,
            inputs,
            outputs,
        });
        return;
    }
    let mut piece = vec![vec![]; outputs.len()];
    for start in (0..length).step_by(longest) {
        if context.is_cancelled() {
            return;
        }
        let range = start..length.min(start + longest);
        let inputs: Vec<_> = inputs.iter().map(|input| input.part(&range)).collect();
        piece
            .iter_mut()
            .for_each(|column| column.resize(range.len(), 0.0));
        kernel.evaluate(&mut Block {
            level,
            inputs: &inputs,
            outputs: &mut piece,
        });
        for (output, piece) in outputs.iter_mut().zip(&piece) {
            output[range.clone()].copy_from_slice(piece);
        }
    }
}

fn load(scratch: &mut Scratch, step: &KernelStep, columns: &Columns) {
    for (slot, column) in step.outputs.iter().zip(columns.iter()) {
        scratch.slots[*slot].clear();
        scratch.slots[*slot].extend_from_slice(column);
    }
    scratch.note(
        &step.node,
        Work {
            computed: false,
            reused: true,
        },
    );
}

fn store(scratch: &Scratch, step: &KernelStep, key: Key, context: &RunContext<'_>, padded: usize) {
    if context.is_cancelled() {
        // The columns may be half computed.
        return;
    }
    let Some(cache) = context.cache else {
        return;
    };
    let copy = |slot: &usize| {
        let mut column = cache.column(scratch.slots[*slot].len());
        column.extend_from_slice(&scratch.slots[*slot]);
        column
    };
    let columns: Columns = step.outputs.iter().map(copy).collect();
    let nanoseconds = f64::from(step.kernel.nanoseconds()) * padded as f64;
    cache.put(&step.node, key, columns, nanoseconds);
}
