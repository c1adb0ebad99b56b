//! Supersampling: where a kernel cannot filter, the smallest program that gives its outputs is run
//! on a fixed grid inside the sample, and the results are averaged.

use super::compile::KernelStep;
use super::run::{RunContext, Scratch};
use super::spread::{self, Inside};
use super::within::{Member, Within};
use super::{PixelGrid, Program, Samples, Sampling};
use fearless_simd::{Level, dispatch};
use std::collections::BTreeMap;

/// Samples along each side of a supersampled pixel.
const SIDE: usize = 4;

/// Samples along each side of pixels that are more than so many times as wide as a kernel says.
const FINER: [(f32, usize); 2] = [(14.0, 16), (8.0, 8)];

/// Samples that are computed in one go, without margins.
const SAMPLES_AT_ONCE: usize = 2048;

/// What a program for single pixels has given in this run.
#[derive(Debug, Default)]
pub(super) struct Averages {
    /// For each pixel the row of its means, [`UNKNOWN`] or [`NONE`]; empty before the first.
    rows: Vec<u32>,
    /// For each pixel how many samples along a side they are means of.
    sides: Vec<u8>,
    /// The means of all columns of the program, row after row.
    means: Vec<f32>,
}

/// Not asked for yet.
const UNKNOWN: u32 = u32::MAX;

/// No sample of the pixel is of its chart.
const NONE: u32 = u32::MAX - 1;

impl Averages {
    /// Forgets everything, for another run.
    pub(super) fn clear(&mut self) {
        self.rows.clear();
        self.sides.clear();
        self.means.clear();
    }

    /// Those of the pixels that are not known from `side` samples along a side or more.
    fn unknown(&mut self, pixels: &[u32], side: usize, length: usize) -> Vec<u32> {
        self.rows.resize(length, UNKNOWN);
        self.sides.resize(length, 0);
        let is_unknown = |pixel: &u32| usize::from(self.sides[*pixel as usize]) < side;
        pixels.iter().copied().filter(is_unknown).collect()
    }

    /// The mean of a column in a pixel, if there is one.
    fn mean(&self, pixel: u32, column: usize, width: usize) -> Option<f32> {
        let row = self.rows[pixel as usize];
        let is_known = row != UNKNOWN && row != NONE;
        is_known.then(|| self.means[row as usize * width + column])
    }
}

/// Replaces the outputs of `step` in the pixels where it does not filter well.
pub(super) fn supersample(
    scratch: &mut Scratch,
    step: &KernelStep,
    (within, member): (&Within, Member),
    samples: &Samples<'_>,
    context: &RunContext<'_>,
    outputs: &mut [Vec<f32>],
) {
    let Samples::Grid { grid, .. } = samples else {
        return;
    };
    let pixels = pixels_to_supersample(scratch, step, grid, context.level);
    if pixels.is_empty() {
        return;
    }
    let mut averages = std::mem::take(scratch.averages(member.within));
    for (side, pixels) in by_side(scratch, step, grid.width, &pixels) {
        let unknown = averages.unknown(&pixels, side, grid.len());
        if !unknown.is_empty()
            && let Some(program) = within.program(context.cancel)
        {
            let run = InnerRun {
                program,
                fields: within.fields(),
                charts: &step.charts,
                side,
            };
            run.average(scratch, samples, context, &unknown, &mut averages);
        }
    }
    let width = within.width();
    for (column, output) in (member.column..).zip(outputs) {
        for pixel in &pixels {
            if let Some(mean) = averages.mean(*pixel, column, width) {
                output[*pixel as usize] = mean;
            }
        }
    }
    *scratch.averages(member.within) = averages;
}

/// A program for single pixels.
struct InnerRun<'a> {
    program: &'a Program,
    /// How many outputs come before the charts.
    fields: usize,
    /// The slots of the pixels' charts, if means stay in them.
    charts: &'a [usize],
    /// Samples along each side of a pixel.
    side: usize,
}

impl InnerRun<'_> {
    /// Runs the program for some pixels and notes the means of its fields.
    fn average(
        &self,
        scratch: &mut Scratch,
        samples: &Samples<'_>,
        context: &RunContext<'_>,
        pixels: &[u32],
        averages: &mut Averages,
    ) {
        let Samples::Grid { target, grid } = samples else {
            return;
        };
        let (target, mut inner) = (*target, scratch.within.take().unwrap_or_default());
        for pixels in pixels.chunks(SAMPLES_AT_ONCE / (self.side * self.side)) {
            let grid = grid.within_pixels(pixels, self.side, self.program.margin());
            let area = grid.width * grid.height;
            let samples = Samples::Grid { target, grid };
            self.program.run(&samples, &mut inner, context);
            if context.is_cancelled() {
                break;
            }
            self.note_means(scratch, &inner, area, pixels, averages);
        }
        for (node, work) in inner.take_work() {
            scratch.note(&node, work);
        }
        scratch.within = Some(inner);
    }

    /// Notes the means of pixels whose samples `inner` has, `area` of each.
    fn note_means(
        &self,
        scratch: &Scratch,
        inner: &Scratch,
        area: usize,
        pixels: &[u32],
        averages: &mut Averages,
    ) {
        let columns: Vec<&[f32]> = (0..self.fields)
            .flat_map(|field| self.program.columns(inner, field))
            .collect();
        let chart = |index: usize| {
            let inside = self.program.output(inner, self.fields + index, 0);
            (inside, scratch.column(self.charts[index]))
        };
        let charts: Vec<_> = (0..self.charts.len()).map(chart).collect();
        let all = inside(self.side, self.program.margin());
        for (index, pixel) in pixels.iter().enumerate() {
            let is_of_chart = |sample: &usize| {
                charts.iter().all(|(inside, whole)| {
                    inside[index * area + *sample].floor() == whole[*pixel as usize].floor()
                })
            };
            let of_chart =
                (!charts.is_empty()).then(|| all.iter().copied().filter(is_of_chart).collect());
            let chosen: &Vec<usize> = of_chart.as_ref().unwrap_or(&all);
            let row = (averages.means.len() / columns.len()) as u32;
            averages.sides[*pixel as usize] = self.side as u8;
            averages.rows[*pixel as usize] = if chosen.is_empty() { NONE } else { row };
            if !chosen.is_empty() {
                let values = |column: &&[f32]| mean(&column[index * area..][..area], chosen);
                averages.means.extend(columns.iter().map(values));
            }
        }
    }
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

/// The pixels by how many samples along their sides they need, in order of these.
fn by_side(
    scratch: &Scratch,
    step: &KernelStep,
    width: usize,
    pixels: &[u32],
) -> BTreeMap<usize, Vec<u32>> {
    let Some((column, widest)) = step.kernel.widest() else {
        return BTreeMap::from([(SIDE, pixels.to_vec())]);
    };
    let values = scratch.column(step.inputs[column]);
    let mut by_side: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for pixel in pixels {
        let change = spread::change(values, width, *pixel as usize);
        let finer = FINER.iter().find(|(times, _)| change > times * widest);
        let side = finer.map_or(SIDE, |(_, side)| *side);
        by_side.entry(side).or_default().push(*pixel);
    }
    by_side
}

/// A pixel's samples, so many along each side, without their margin.
fn inside(side: usize, margin: usize) -> Vec<usize> {
    let width = side + 2 * margin;
    let rows = (margin..margin + side).map(|row| row * width + margin);
    rows.flat_map(|start| start..start + side).collect()
}

/// The mean of some samples, added up in their order.
fn mean(values: &[f32], chosen: &[usize]) -> f32 {
    let sum: f32 = chosen.iter().map(|sample| values[*sample]).sum();
    sum / chosen.len() as f32
}
