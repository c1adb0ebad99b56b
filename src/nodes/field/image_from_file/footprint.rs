//! The mean of a picture over what a sample covers of it.
//!
//! Where the sample's sides run along the picture's rows and columns the mean is separable and exact, on the largest
//! copy of which it covers few pixels. Elsewhere it is the mean of points spread evenly over the sample.

use super::near::Near;
use super::pyramid::Pyramid;
use super::weights::{self, Interpolation, Wrap, floor};
use super::window::{Buffers, Points, Window};

/// A picture in its place.
#[derive(Debug)]
pub(super) struct Sampler {
    pub(super) pyramid: Pyramid,
    /// Pixels per mm along u and v.
    pub(super) texels_per_mm: [f64; 2],
    /// Where the lower left corner is, in mm.
    pub(super) origin: [f64; 2],
    pub(super) wrap: Wrap,
    pub(super) interpolation: Interpolation,
}

/// Buffers for the weights of columns, rows and pixels.
#[derive(Default)]
pub(super) struct Scratch {
    columns: Vec<(Option<usize>, f32)>,
    rows: Vec<(Option<usize>, f32)>,
    buffers: Buffers,
}

/// Least number of pixels of a reduced copy that a sample covers along its shorter side.
const COVERED: f64 = 4.0;

/// Most of them along its longer side.
const LONGEST: f64 = 64.0;

/// Skewness, as a share of a sample's own sides, below which it counts as upright.
const UPRIGHT: f64 = 0.01;

/// Most pixels of a copy that are weighed at once.
const WINDOW: f64 = 4096.0;

/// Farthest from the picture that is computed, in pixels.
const FARTHEST: f64 = 1e12;

impl Sampler {
    /// Buffers for [`Sampler::mean`].
    pub(super) fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    /// The mean around a point in mm whose coordinates change by `spread` from sample to sample; the colour is
    /// multiplied by the opacity, which is the last part.
    #[inline(always)]
    pub(super) fn mean(
        &self,
        scratch: &mut Scratch,
        point: [f64; 2],
        spread: [[f64; 2]; 2],
    ) -> [f32; 4] {
        let [width, height] = self.pyramid.size(0).map(|side| side as f64);
        let scale = self.texels_per_mm;
        let finite = |value: f64| if value.abs() < FARTHEST { value } else { 0.0 };
        let x = finite((point[0] - self.origin[0]) * scale[0]);
        // Rows run down, v up.
        let y = finite(height - (point[1] - self.origin[1]) * scale[1]);
        let [across, along] = spread.map(|spread| spread.map(finite));
        // The sides of the sample in pixels: from sample to sample of a row, and from row to row.
        let sides = [
            [across[0] * scale[0], -along[0] * scale[1]],
            [across[1] * scale[0], -along[1] * scale[1]],
        ]
        .map(|side| side.map(|part| part.clamp(-FARTHEST, FARTHEST)));
        if self.interpolation == Interpolation::Linear
            && let Some(near) = Near::of([x, y], sides)
        {
            return self.near_mean(&near);
        }
        match upright(sides) {
            Some(extent) => self.upright_mean(scratch, [x, y], extent),
            None => self.turned_mean(scratch, [x, y], sides, [width, height]),
        }
    }

    #[inline]
    fn near_mean(&self, near: &Near) -> [f32; 4] {
        let size = self.pyramid.size(0);
        let (mut columns, mut rows) = ([None; 3], [None; 3]);
        for index in 0..3 {
            let step = index as i64;
            columns[index] = self.wrap.index(near.first[0] + step, size[0]);
            rows[index] = self.wrap.index(near.first[1] + step, size[1]);
        }
        let window = Window {
            columns: &columns,
            rows: &rows,
            weights: &near.weights,
        };
        self.pyramid.sum(0, window)
    }

    /// The copy of which a sample with sides of these lengths covers few pixels.
    fn level(&self, sides: [f64; 2]) -> usize {
        let (short, long) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
        let mut level = 0;
        let mut factor = 1.0;
        let last = self.pyramid.levels() - 1;
        while level < last && (short >= 2.0 * COVERED * factor || long > LONGEST * factor) {
            level += 1;
            factor *= 2.0;
        }
        level
    }

    /// Pixels of a copy for each pixel of the picture, along both axes.
    fn density(&self, level: usize) -> [f64; 2] {
        let (whole, part) = (self.pyramid.size(0), self.pyramid.size(level));
        match level {
            0 => [1.0, 1.0],
            _ => [0, 1].map(|axis| part[axis] as f64 / whole[axis] as f64),
        }
    }

    #[inline(never)]
    fn upright_mean(&self, scratch: &mut Scratch, centre: [f64; 2], extent: [f64; 2]) -> [f32; 4] {
        let level = self.level(extent);
        let density = self.density(level);
        let interpolation = match level {
            0 => self.interpolation,
            // Pixels of a copy are means over areas: nothing lies between them.
            _ => Interpolation::Nearest,
        };
        let size = self.pyramid.size(level);
        for (axis, weights) in [&mut scratch.columns, &mut scratch.rows]
            .into_iter()
            .enumerate()
        {
            // No more than the smallest copy can be counted.
            let width = (extent[axis] * density[axis]).min(4096.0);
            let span = [centre[axis] * density[axis], width];
            weights::write(weights, span, interpolation, self.wrap, size[axis]);
        }
        scratch
            .buffers
            .set_products(&scratch.columns, &scratch.rows);
        self.pyramid.sum(level, scratch.buffers.window())
    }

    #[inline(never)]
    fn turned_mean(
        &self,
        scratch: &mut Scratch,
        centre: [f64; 2],
        sides: [[f64; 2]; 2],
        sizes: [f64; 2],
    ) -> [f32; 4] {
        let lengths = sides.map(|[x, y]| (x * x + y * y).sqrt().min(4.0 * (sizes[0] + sizes[1])));
        let level = self.level(lengths);
        let size = self.pyramid.size(level);
        let points = self.points(level, centre, sides, lengths);
        let interpolation = match level {
            0 => self.interpolation,
            _ => Interpolation::Linear,
        };
        let [wide, tall] = [0, 1].map(|axis| {
            let [start, end] = points.range(axis);
            end - start + 1.0
        });
        let buffers = &mut scratch.buffers;
        let mut sum = [0.0f32; 4];
        if wide * tall <= WINDOW {
            buffers.set_points(&points, interpolation, self.wrap, size);
            sum = self.pyramid.sum(level, buffers.window());
        } else {
            for point in points.each() {
                buffers.set_points(&point, interpolation, self.wrap, size);
                let found = self.pyramid.sum(level, buffers.window());
                sum = std::array::from_fn(|part| sum[part] + found[part]);
            }
        }
        let share = 1.0 / (points.counts[0] * points.counts[1]) as f32;
        sum.map(|part| part * share)
    }

    /// Enough points of a turned sample that no pixel of the copy is passed over.
    fn points(
        &self,
        level: usize,
        centre: [f64; 2],
        sides: [[f64; 2]; 2],
        lengths: [f64; 2],
    ) -> Points {
        let density = self.density(level);
        let densest = density[0].max(density[1]);
        let between = if level == 0 { 1.0 } else { 0.0 };
        let counts = lengths.map(|length| {
            let enough = -floor(-(length * densest + between));
            enough.clamp(1, LONGEST as i64) as usize
        });
        let steps = [0, 1]
            .map(|side| [0, 1].map(|axis| sides[side][axis] * density[axis] / counts[side] as f64));
        let back = [0, 1].map(|side| 0.5 * (counts[side] - 1) as f64);
        let first = [0, 1].map(|axis| {
            centre[axis] * density[axis] - back[0] * steps[0][axis] - back[1] * steps[1][axis]
        });
        Points {
            first,
            steps,
            counts,
        }
    }
}

/// Width and height of a sample whose sides run along rows and columns, either way round.
fn upright([first, second]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let is_small = |part: f64, whole: f64| part.abs() <= (UPRIGHT * whole.abs()).max(UPRIGHT);
    if is_small(first[1], second[1]) && is_small(second[0], first[0]) {
        Some([first[0].abs(), second[1].abs()])
    } else if is_small(first[0], second[0]) && is_small(second[1], first[1]) {
        Some([second[0].abs(), first[1].abs()])
    } else {
        None
    }
}
