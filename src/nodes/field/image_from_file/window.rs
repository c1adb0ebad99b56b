//! A window on a copy of a picture: a few of its rows and columns, and the weight of each pixel there.

use super::weights::{Interpolation, Wrap, floor};

/// Points spread evenly over a sample, in pixels of a copy.
#[derive(Clone, Copy)]
pub(super) struct Points {
    /// The first of them.
    pub(super) first: [f64; 2],
    /// From point to point along both sides of the sample.
    pub(super) steps: [[f64; 2]; 2],
    /// How many there are along both sides.
    pub(super) counts: [usize; 2],
}

impl Points {
    /// Least and largest coordinate along an axis.
    pub(super) fn range(&self, axis: usize) -> [f64; 2] {
        let reach = [0, 1].map(|side| self.steps[side][axis] * (self.counts[side] - 1) as f64);
        let first = self.first[axis];
        [
            first + reach[0].min(0.0) + reach[1].min(0.0),
            first + reach[0].max(0.0) + reach[1].max(0.0),
        ]
    }

    /// Each of them alone.
    pub(super) fn each(self) -> impl Iterator<Item = Points> {
        (0..self.counts[0] * self.counts[1]).map(move |index| {
            let at = [index % self.counts[0], index / self.counts[0]].map(|at| at as f64);
            let [across, along] = self.steps;
            let first =
                [0, 1].map(|axis| self.first[axis] + at[0] * across[axis] + at[1] * along[axis]);
            Points {
                first,
                counts: [1, 1],
                ..self
            }
        })
    }
}

/// Some rows and columns of a copy, and a weight for each pixel where they cross, row by row.
#[derive(Clone, Copy)]
pub(super) struct Window<'a> {
    /// Those where nothing is are `None`.
    pub(super) columns: &'a [Option<usize>],
    /// Those where nothing is are `None`.
    pub(super) rows: &'a [Option<usize>],
    /// Weights row by row.
    pub(super) weights: &'a [f32],
}

impl Window<'_> {
    /// The sum of the pixels, of which `texel` gives that with a column and a row, by their weights.
    #[inline(always)]
    pub(super) fn sum(&self, texel: impl Fn(usize, usize) -> [f32; 4]) -> [f32; 4] {
        let mut sum = [0.0f32; 4];
        let width = self.columns.len().max(1);
        for (y, weights) in self.rows.iter().zip(self.weights.chunks_exact(width)) {
            let Some(y) = *y else { continue };
            for (x, weight) in self.columns.iter().zip(weights) {
                let (Some(x), true) = (*x, *weight != 0.0) else {
                    continue;
                };
                for (sum, part) in sum.iter_mut().zip(texel(x, y)) {
                    *sum += part * weight;
                }
            }
        }
        sum
    }
}

/// Buffers for a window.
#[derive(Default)]
pub(super) struct Buffers {
    columns: Vec<Option<usize>>,
    rows: Vec<Option<usize>>,
    weights: Vec<f32>,
}

impl Buffers {
    /// The window that was set.
    pub(super) fn window(&self) -> Window<'_> {
        Window {
            columns: &self.columns,
            rows: &self.rows,
            weights: &self.weights,
        }
    }

    /// The products of the weights of columns and rows.
    pub(super) fn set_products(
        &mut self,
        columns: &[(Option<usize>, f32)],
        rows: &[(Option<usize>, f32)],
    ) {
        self.weights.clear();
        for (list, from) in [(&mut self.columns, columns), (&mut self.rows, rows)] {
            list.clear();
            list.extend(from.iter().map(|(index, _)| *index));
        }
        for (_, tall) in rows {
            self.weights
                .extend(columns.iter().map(|(_, wide)| wide * tall));
        }
    }

    /// The sums of the weights that each of some points gives to the pixels around it.
    pub(super) fn set_points(
        &mut self,
        points: &Points,
        interpolation: Interpolation,
        wrap: Wrap,
        size: [usize; 2],
    ) {
        let taps = interpolation.taps();
        let shift = 0.5 * (taps - 1) as f64;
        let ranges = [0, 1].map(|axis| points.range(axis).map(|end| end - shift));
        let first = ranges.map(|[start, _]| floor(start));
        let counts = [0, 1].map(|axis| (floor(ranges[axis][1]) - first[axis]) as usize + taps);
        self.place(first, counts, wrap, size);
        let from = [0, 1].map(|axis| (points.first[axis] - shift - first[axis] as f64) as f32);
        match interpolation {
            Interpolation::Nearest => self.add_points(points, from, |_| [1.0]),
            Interpolation::Linear => self.add_points(points, from, |share| [1.0 - share, share]),
            Interpolation::Cubic => self.add_points(points, from, |share| {
                let back = 1.0 - share;
                let outer = |near: f32, far: f32| -0.5 * near * far * far;
                let inner = |far: f32| 1.0 + far * far * (1.5 * far - 2.5);
                [
                    outer(share, back),
                    inner(share),
                    inner(back),
                    outer(back, share),
                ]
            }),
        }
    }

    /// Takes the rows and columns from `first` on, without weights.
    fn place(&mut self, first: [i64; 2], counts: [usize; 2], wrap: Wrap, size: [usize; 2]) {
        for (axis, list) in [&mut self.columns, &mut self.rows].into_iter().enumerate() {
            let indices = first[axis]..first[axis] + counts[axis] as i64;
            list.clear();
            list.extend(indices.map(|index| wrap.index(index, size[axis])));
        }
        self.weights.clear();
        self.weights.resize(counts[0] * counts[1], 0.0);
    }

    /// Adds the weights that each point gives to `TAPS` pixels a side, by its place behind the first of them.
    fn add_points<const TAPS: usize>(
        &mut self,
        points: &Points,
        from: [f32; 2],
        weigh: impl Fn(f32) -> [f32; TAPS],
    ) {
        let [across, along] = points.steps.map(|step| step.map(|part| part as f32));
        let width = self.columns.len();
        // Rounding must not lead out of the window.
        let last = [width - TAPS, self.rows.len() - TAPS];
        for index in 0..points.counts[1] {
            let start = [0, 1].map(|axis| from[axis] + index as f32 * along[axis]);
            for index in 0..points.counts[0] {
                let at = [0, 1].map(|axis| start[axis] + index as f32 * across[axis]);
                let pixel = [0, 1].map(|axis| (at[axis] as u32 as usize).min(last[axis]));
                let [wide, tall] = [0, 1].map(|axis| weigh(at[axis] - pixel[axis] as f32));
                for (row, tall) in tall.iter().enumerate() {
                    let start = (pixel[1] + row) * width + pixel[0];
                    let weights = &mut self.weights[start..start + TAPS];
                    for (weight, wide) in weights.iter_mut().zip(wide) {
                        *weight += wide * tall;
                    }
                }
            }
        }
    }
}
