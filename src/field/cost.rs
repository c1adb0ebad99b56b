//! What running a program takes: neighbours around a tile, buffers, steps.

use super::Sampling;
use super::compile::{KernelStep, Program, Step};

impl Program {
    /// How many samples beyond a tile have to be evaluated with it.
    pub fn margin(&self) -> usize {
        self.margin
    }

    /// Number of column buffers in use at once.
    pub fn buffers(&self) -> usize {
        self.slots
    }

    /// Number of operations.
    pub fn length(&self) -> usize {
        self.steps.len()
    }

    /// Bytes of all columns of a tile of `side` pixels with its margin: what each thread holds.
    pub fn tile_bytes(&self, side: usize) -> usize {
        let side = side.saturating_add(2 * self.margin);
        let samples = side.saturating_mul(side);
        samples.saturating_mul(self.slots * size_of::<f32>())
    }

    /// A bound of the operations that this program and those for single pixels have together: each step that may be
    /// supersampled counts for a program as long as this one, though several may share theirs.
    pub fn most_operations(&self) -> usize {
        let may_be_supersampled =
            |step: &&Step| matches!(step, Step::Kernel(step) if step.within.is_some());
        let programs = 1 + self.steps.iter().filter(may_be_supersampled).count();
        programs.saturating_mul(self.steps.len())
    }
}

/// Finds how far beyond the tile every column is read; gives the largest distance.
pub(super) fn assign_margins(steps: &mut [Step], columns: usize) -> usize {
    let mut margins = vec![0; columns];
    for step in steps.iter_mut().rev() {
        match step {
            Step::Spread {
                of, along, joins, ..
            } => {
                let distance = margins[along[0]].max(margins[along[1]]) + 1;
                for read in joins.iter().flatten().chain([&*of]) {
                    margins[*read] = margins[*read].max(distance);
                }
            }
            Step::Joins { charts, joins } => {
                let distance = margins[joins[0]].max(margins[joins[1]]);
                for chart in charts {
                    margins[*chart] = margins[*chart].max(distance);
                }
            }
            Step::Kernel(step) => {
                let read = step.outputs.iter().map(|column| margins[*column]);
                step.margin = read.max().unwrap_or(0);
                let spreads = step.spreads.iter().flatten().flatten();
                let spreads = spreads.chain(&step.charts);
                spreads.for_each(|column| margins[*column] = margins[*column].max(step.margin));
                for (input, column) in step.inputs.iter().enumerate() {
                    let distance = step.margin + usize::from(looks_around(step, input));
                    margins[*column] = margins[*column].max(distance);
                }
            }
        }
    }
    margins.into_iter().max().unwrap_or(0)
}

/// Whether an input's neighbours are looked at to see where the step has to be supersampled.
fn looks_around(step: &KernelStep, input: usize) -> bool {
    let is_deciding = match step.kernel.sampling() {
        Sampling::Filtered => false,
        Sampling::FilteredWhereEven { column, .. }
        | Sampling::FilteredWhereStraight { column, .. } => column == input,
        Sampling::Supersampled => true,
    };
    let is_width = |(column, _)| column == input;
    step.within.is_some() && (is_deciding || step.kernel.widest().is_some_and(is_width))
}
