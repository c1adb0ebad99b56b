//! Supersampling: where a kernel cannot filter, the smallest program that gives its outputs is run
//! on a fixed grid inside the sample, and the results are averaged.

use super::compile::KernelStep;
use super::run::{RunContext, Scratch};
use super::spread::{self, Inside};
use super::within::Within;
use super::{PixelGrid, Samples, Sampling};
use fearless_simd::{Level, dispatch};

/// Samples along each side of a supersampled pixel.
const SIDE: usize = 4;

/// Pixels that are supersampled in one go: their samples are a block of some thousand.
const PIXELS_AT_ONCE: usize = 128;

/// Replaces the outputs of `step` in the pixels where it does not filter well.
pub(super) fn supersample(
    scratch: &mut Scratch,
    step: &KernelStep,
    within: &Within,
    samples: &Samples<'_>,
    context: &RunContext<'_>,
    outputs: &mut [Vec<f32>],
) {
    let Samples::Grid { target, grid } = samples else {
        return;
    };
    let pixels = pixels_to_supersample(scratch, step, grid, context.level);
    if pixels.is_empty() {
        return;
    }
    let Some(within) = within.program(context.cancel) else {
        return;
    };
    let mut inner = scratch.within.take().unwrap_or_default();
    for pixels in pixels.chunks(PIXELS_AT_ONCE) {
        let grid = grid.within_pixels(pixels, SIDE, within.margin());
        let area = grid.width * grid.height;
        within.run(
            &Samples::Grid {
                target: *target,
                grid,
            },
            &mut inner,
            context,
        );
        if context.is_cancelled() {
            break;
        }
        let charts = |index: usize| (within.output(&inner, 1 + index, 0), step.charts[index]);
        let charts: Vec<(&[f32], usize)> = (0..step.charts.len()).map(charts).collect();
        for (column, output) in outputs.iter_mut().enumerate() {
            let values = within.output(&inner, 0, column);
            for (index, (values, pixel)) in values.chunks_exact(area).zip(pixels).enumerate() {
                let mean = match charts.is_empty() {
                    true => Some(mean_inside(values, within.margin())),
                    false => {
                        let is_of_chart = |sample: usize| {
                            charts.iter().all(|(inside, slot)| {
                                inside[index * area + sample].floor()
                                    == scratch.column(*slot)[*pixel as usize].floor()
                            })
                        };
                        mean_of_chart(values, within.margin(), is_of_chart)
                    }
                };
                if let Some(mean) = mean {
                    output[*pixel as usize] = mean;
                }
            }
        }
    }
    for (node, work) in inner.take_work() {
        scratch.note(&node, work);
    }
    scratch.within = Some(inner);
}

/// Indices of the samples where the kernel needs help, in order. Only samples that somebody reads and
/// whose neighbours are known are looked at, so the answer does not depend on the tile.
fn pixels_to_supersample(
    scratch: &Scratch,
    step: &KernelStep,
    grid: &PixelGrid,
    level: Level,
) -> Vec<u32> {
    let inside = &Inside {
        width: grid.width,
        height: grid.height,
        border: grid.margin.saturating_sub(step.margin).max(1),
    };
    let mut pixels = vec![];
    let list = &mut pixels;
    match step.kernel.sampling() {
        Sampling::Filtered => {}
        Sampling::Supersampled => {
            let columns: Vec<&[f32]> = step
                .inputs
                .iter()
                .map(|slot| scratch.column(*slot))
                .collect();
            dispatch!(level, simd => spread::list_varying(simd, &columns, inside, list));
        }
        Sampling::FilteredWhereEven { column, absolute } => {
            let values = scratch.column(step.inputs[column]);
            dispatch!(level, simd => spread::list_uneven(simd, values, inside, absolute, list));
        }
        Sampling::FilteredWhereStraight {
            column,
            absolute,
            relative,
        } => {
            let (values, allowed) = (scratch.column(step.inputs[column]), [absolute, relative]);
            dispatch!(level, simd => spread::list_bent(simd, values, inside, allowed, list));
        }
    }
    pixels
}

/// The mean of a pixel's samples without their margin, added up in a fixed order.
fn mean_inside(values: &[f32], margin: usize) -> f32 {
    let width = SIDE + 2 * margin;
    let rows = values.chunks_exact(width).skip(margin).take(SIDE);
    let sum: f32 = rows.flat_map(|row| &row[margin..margin + SIDE]).sum();
    sum / (SIDE * SIDE) as f32
}

/// The mean of those of a pixel's samples that are of its chart; `None` if there are none.
fn mean_of_chart(
    values: &[f32],
    margin: usize,
    is_of_chart: impl Fn(usize) -> bool,
) -> Option<f32> {
    let width = SIDE + 2 * margin;
    let rows = (margin..margin + SIDE).map(|row| row * width + margin);
    let samples = rows.flat_map(|start| start..start + SIDE);
    let (mut sum, mut count) = (0.0, 0u8);
    for sample in samples.filter(|sample| is_of_chart(*sample)) {
        sum += values[sample];
        count += 1;
    }
    (count > 0).then(|| sum / f32::from(count))
}
