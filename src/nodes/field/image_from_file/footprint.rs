//! The mean of a picture over what a sample covers of it.
//!
//! Where the sample's sides run along the picture's rows and columns the mean is separable and exact, on the largest
//! copy of which it covers few pixels. Elsewhere it is the mean of points spread evenly over the sample.

use super::pyramid::Pyramid;
use super::weights::{self, Interpolation, Wrap};

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

/// Buffers for the weights of columns and rows.
#[derive(Default)]
pub(super) struct Scratch {
    columns: Vec<(Option<usize>, f32)>,
    rows: Vec<(Option<usize>, f32)>,
}

/// Least number of pixels of a reduced copy that a sample covers along its shorter side.
const COVERED: f64 = 4.0;

/// Most of them along its longer side.
const LONGEST: f64 = 64.0;

/// Skewness, as a share of a sample's own sides, below which it counts as upright.
const UPRIGHT: f64 = 0.01;

/// Farthest from the picture that is computed, in pixels.
const FARTHEST: f64 = 1e12;

impl Sampler {
    /// Buffers for [`Sampler::mean`].
    pub(super) fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    /// The mean around a point in mm whose coordinates change by `spread` from sample to sample; the colour is
    /// multiplied by the opacity, which is the last part.
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
        ];
        let sizes = [width, height];
        match upright(sides) {
            Some(extent) => self.upright_mean(scratch, [x, y], extent),
            None => self.turned_mean(scratch, [x, y], sides, sizes),
        }
    }

    /// The copy of which a sample with sides of these lengths covers few pixels.
    fn level(&self, sides: [f64; 2]) -> usize {
        let (short, long) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
        let mut level = 0;
        let mut factor = 1.0;
        let last = self.pyramid.levels() - 1;
        while level < last && (short / (2.0 * factor) >= COVERED || long / factor > LONGEST) {
            level += 1;
            factor *= 2.0;
        }
        level
    }

    /// Sides of a pixel of a copy, in pixels of the picture.
    fn texel(&self, level: usize) -> [f64; 2] {
        let (whole, part) = (self.pyramid.size(0), self.pyramid.size(level));
        [0, 1].map(|axis| whole[axis] as f64 / part[axis] as f64)
    }

    fn upright_mean(&self, scratch: &mut Scratch, centre: [f64; 2], extent: [f64; 2]) -> [f32; 4] {
        let level = self.level(extent);
        let texel = self.texel(level);
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
            let width = (extent[axis] / texel[axis]).min(4096.0);
            let span = [centre[axis] / texel[axis], width];
            weights::write(weights, span, interpolation, self.wrap, size[axis]);
        }
        self.sum(scratch, level)
    }

    /// The sum of the pixels of a copy by the weights of their columns and rows.
    fn sum(&self, scratch: &Scratch, level: usize) -> [f32; 4] {
        let mut sum = [0.0f32; 4];
        for (y, tall) in &scratch.rows {
            let Some(y) = y else { continue };
            let mut row = [0.0f32; 4];
            for (x, wide) in &scratch.columns {
                let Some(x) = x else { continue };
                let texel = self.pyramid.texel(level, *x, *y);
                for (row, part) in row.iter_mut().zip(texel) {
                    *row += part * wide;
                }
            }
            for (sum, row) in sum.iter_mut().zip(row) {
                *sum += row * tall;
            }
        }
        sum
    }

    fn turned_mean(
        &self,
        scratch: &mut Scratch,
        centre: [f64; 2],
        sides: [[f64; 2]; 2],
        sizes: [f64; 2],
    ) -> [f32; 4] {
        let lengths = sides.map(|[x, y]| (x * x + y * y).sqrt().min(4.0 * (sizes[0] + sizes[1])));
        let level = self.level(lengths);
        let texel = self.texel(level);
        let size = self.pyramid.size(level);
        let interpolation = match level {
            0 => self.interpolation,
            _ => Interpolation::Linear,
        };
        // Enough points that no pixel of the copy is passed over.
        let smallest = texel[0].min(texel[1]);
        let between = if level == 0 { 1.0 } else { 0.0 };
        let counts =
            lengths.map(|length| (length / smallest + between).ceil().clamp(1.0, LONGEST) as usize);
        let mut sum = [0.0f32; 4];
        for index in 0..counts[0] * counts[1] {
            let at = [index % counts[0], index / counts[0]];
            let share = [0, 1].map(|side| (at[side] as f64 + 0.5) / counts[side] as f64 - 0.5);
            let point = [0, 1]
                .map(|axis| centre[axis] + share[0] * sides[0][axis] + share[1] * sides[1][axis]);
            for (axis, weights) in [&mut scratch.columns, &mut scratch.rows]
                .into_iter()
                .enumerate()
            {
                let span = [point[axis] / texel[axis], 0.0];
                weights::write(weights, span, interpolation, self.wrap, size[axis]);
            }
            let found = self.sum(scratch, level);
            for (sum, found) in sum.iter_mut().zip(found) {
                *sum += found;
            }
        }
        sum.map(|part| part / (counts[0] * counts[1]) as f32)
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
