//! Steps that need not run where nobody chooses what they give: kernels that choose among their inputs say so by
//! [`Kernel::alternatives`](super::Kernel::alternatives).

use super::compile::Step;

/// A column and one of its values: where no sample of a block has it, nor [`Alternatives::ALL`], the step need not run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Guard {
    /// The column with the choice.
    pub(super) column: usize,
    /// The value that asks for the step.
    pub(super) value: f32,
}

/// Who reads a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Readers {
    Nobody,
    /// Only what is chosen by this value.
    Under(Guard),
    /// What always runs, or more than one choice.
    Several,
}

impl Readers {
    fn and(self, other: Readers) -> Readers {
        match (self, other) {
            (Readers::Nobody, one) | (one, Readers::Nobody) => one,
            (one, other) if one == other => one,
            _ => Readers::Several,
        }
    }
}

/// The guard of each step, if it has one.
pub(super) fn guards(steps: &[Step], outputs: &[Vec<usize>], columns: usize) -> Vec<Option<Guard>> {
    let mut readers = vec![Readers::Nobody; columns];
    let mut written_by = vec![0; columns];
    for (index, step) in steps.iter().enumerate() {
        step.writes()
            .iter()
            .for_each(|column| written_by[*column] = index);
    }
    for column in outputs.iter().flatten() {
        readers[*column] = Readers::Several;
    }
    let mut guards = vec![None; steps.len()];
    for (index, step) in steps.iter().enumerate().rev() {
        let writes = step.writes();
        let of_step = writes
            .iter()
            .fold(Readers::Nobody, |all, column| all.and(readers[*column]));
        let of_step = match of_step {
            // The choice has to be known before.
            Readers::Under(guard) if written_by[guard.column] >= index => Readers::Several,
            known => known,
        };
        if let Readers::Under(guard) = of_step {
            guards[index] = Some(guard);
        }
        for (column, reader) in read_by(step, of_step) {
            readers[column] = readers[column].and(reader);
        }
    }
    guards
}

/// The columns that a step reads, and on whose behalf.
fn read_by(step: &Step, of_step: Readers) -> Vec<(usize, Readers)> {
    let always = |columns: Vec<usize>| {
        columns
            .into_iter()
            .map(|column| (column, of_step))
            .collect()
    };
    let (Step::Kernel(kernel), Readers::Several) = (step, of_step) else {
        return always(step.reads());
    };
    let Some(alternatives) = kernel.kernel.alternatives() else {
        return always(step.reads());
    };
    let choice = kernel.inputs[alternatives.choice];
    let under = |column: usize| {
        let past = column.checked_sub(alternatives.first)?;
        let value = (past / alternatives.width) as f32;
        Some(Readers::Under(Guard {
            column: choice,
            value,
        }))
    };
    let inputs = kernel.inputs.iter().enumerate();
    let inputs = inputs.map(|(column, read)| (*read, under(column).unwrap_or(of_step)));
    let spreads = kernel.spreads.iter().flatten().flatten();
    let others = spreads.chain(&kernel.charts).map(|read| (*read, of_step));
    inputs.chain(others).collect()
}

/// Inputs of which a kernel reads only those that one of its columns chooses, sample by sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alternatives {
    /// The input with the choice: whole numbers from 0 on, or [`Alternatives::ALL`]; inputs up to it have one column each.
    pub choice: usize,
    /// The first column of the first alternative; the others follow to the end.
    pub first: usize,
    /// Columns of each alternative.
    pub width: usize,
}

impl Alternatives {
    /// The choice of samples that read all alternatives.
    pub const ALL: f32 = -1.0;
}

impl Guard {
    /// Whether the choices of a block ask for the step.
    pub(super) fn is_wanted(&self, choices: &[f32]) -> bool {
        choices
            .iter()
            .any(|choice| *choice == self.value || *choice == Alternatives::ALL)
    }
}
