//! Fields at points of the caller's own, unfiltered and on all threads.

use super::{Field, Program, RunContext, Samples, Scratch};
use rayon::prelude::*;

/// Points evaluated in one go.
const BLOCK: usize = 4096;

/// The values of fields at `points`: for each field its columns, for each column its values. They mean nothing if the run is
/// cancelled meanwhile.
pub(crate) fn at_points(
    fields: &[Field],
    points: &[[f64; 3]],
    context: &RunContext<'_>,
) -> Vec<Vec<Vec<f32>>> {
    let program = Program::compile(fields);
    let sample = |scratch: &mut Scratch, points: &[[f64; 3]]| {
        program.run(&Samples::Points(points), scratch, context);
        // A cancelled run leaves columns that are too short.
        let taken = |column: &[f32]| column.iter().copied().take(points.len()).collect();
        let columns = |output| program.columns(scratch, output).into_iter().map(taken);
        (0..fields.len())
            .map(|output| columns(output).collect())
            .collect()
    };
    let blocks = points.par_chunks(BLOCK);
    let blocks: Vec<Vec<Vec<Vec<f32>>>> = blocks.map_init(Scratch::default, sample).collect();
    let column = |output: usize, column: usize| {
        let parts = blocks.iter().map(|block| block[output][column].as_slice());
        parts.collect::<Vec<_>>().concat()
    };
    let columns = |(output, field): (usize, &Field)| {
        let columns = 0..field.width();
        columns.map(|index| column(output, index)).collect()
    };
    fields.iter().enumerate().map(columns).collect()
}
