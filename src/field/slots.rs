//! Gives columns their buffers: a buffer is free again after the last step that reads its column.

use super::compile::{POSITION, Program, Step};

/// Rewrites a program whose columns are all different into one that reuses buffers.
pub(super) fn assign(mut program: Program) -> Program {
    let last_read = last_reads(&program);
    let mut slots = Slots::new(&program);
    program.remainder = program.remainder.map(|column| slots.of[column]);
    program
        .constants
        .iter_mut()
        .for_each(|(column, _)| *column = slots.of[*column]);
    for (index, step) in program.steps.iter_mut().enumerate() {
        let guard = &mut program.guards[index];
        let dying: Vec<usize> = step
            .reads()
            .into_iter()
            .chain(guard.map(|guard| guard.column))
            .filter(|column| last_read[*column] == index)
            .collect();
        let unread: Vec<usize> = step
            .writes()
            .into_iter()
            .filter(|column| last_read[*column] == 0)
            .collect();
        step.writes()
            .into_iter()
            .for_each(|column| slots.take(column));
        step.rename(&slots.of);
        if let Some(guard) = guard {
            guard.column = slots.of[guard.column];
        }
        dying
            .into_iter()
            .chain(unread)
            .for_each(|column| slots.release(column));
    }
    program
        .outputs
        .iter_mut()
        .flatten()
        .for_each(|column| *column = slots.of[*column]);
    program.slots = slots.count;
    program
}

/// For every column the last step that reads it; outputs are read after the last step.
fn last_reads(program: &Program) -> Vec<usize> {
    let mut last = vec![0; program.slots];
    for (index, step) in program.steps.iter().enumerate() {
        let guard = program.guards[index].map(|guard| guard.column);
        step.reads()
            .into_iter()
            .chain(guard)
            .for_each(|column| last[column] = index);
    }
    let pinned = program.constants.iter().map(|(column, _)| column);
    for column in program
        .outputs
        .iter()
        .flatten()
        .chain(pinned)
        .chain(&POSITION)
        .chain(&program.remainder)
    {
        last[*column] = usize::MAX;
    }
    last
}

struct Slots {
    of: Vec<usize>,
    free: Vec<usize>,
    released: Vec<bool>,
    count: usize,
}

impl Slots {
    fn new(program: &Program) -> Slots {
        let columns = program.slots;
        let mut slots = Slots {
            of: vec![usize::MAX; columns],
            free: vec![],
            released: vec![false; columns],
            count: 0,
        };
        POSITION
            .iter()
            .chain(program.constants.iter().map(|(column, _)| column))
            .chain(&program.remainder)
            .for_each(|c| slots.take(*c));
        slots
    }

    fn take(&mut self, column: usize) {
        self.of[column] = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
    }

    fn release(&mut self, column: usize) {
        if !std::mem::replace(&mut self.released[column], true) {
            self.free.push(self.of[column]);
        }
    }
}

impl Step {
    pub(super) fn reads(&self) -> Vec<usize> {
        match self {
            Step::Spread { of, joins, .. } => {
                let joins = joins.iter().flatten();
                joins.chain([of]).copied().collect()
            }
            Step::Joins { charts, .. } => charts.clone(),
            Step::Kernel(step) => {
                let spreads = step.spreads.iter().flatten().flatten();
                let read = step.inputs.iter().chain(&step.charts);
                read.chain(spreads).copied().collect()
            }
        }
    }

    pub(super) fn writes(&self) -> Vec<usize> {
        match self {
            Step::Spread { along, .. } => along.to_vec(),
            Step::Joins { joins, .. } => joins.to_vec(),
            Step::Kernel(step) => step.outputs.clone(),
        }
    }

    fn rename(&mut self, slot_of: &[usize]) {
        let rename = |column: &mut usize| *column = slot_of[*column];
        match self {
            Step::Joins { charts, joins } => charts.iter_mut().chain(joins).for_each(rename),
            Step::Spread {
                of, along, joins, ..
            } => {
                rename(of);
                joins.iter_mut().flatten().for_each(rename);
                along.iter_mut().for_each(rename);
            }
            Step::Kernel(step) => {
                step.inputs.iter_mut().for_each(rename);
                step.charts.iter_mut().for_each(rename);
                step.spreads.iter_mut().flatten().flatten().for_each(rename);
                step.outputs.iter_mut().for_each(rename);
            }
        }
    }
}
