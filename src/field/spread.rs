//! Spread: how much a column changes from one sample to the next, and how much it bends.

use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// The mean of the changes to both neighbours.
#[inline(always)]
pub(super) fn mean_change([before, _, after]: [f32; 3]) -> f32 {
    0.5 * (after - before)
}

/// The mean, or the larger of both changes where they have little in common. Within pixels that is a kink mostly, as that of a
/// distance in the middle between two edges, of which the mean would say that nothing changes.
#[inline(always)]
pub(super) fn change_at_kinks([before, here, after]: [f32; 3]) -> f32 {
    let [to, from] = [here - before, after - here];
    let (smaller, larger) = match to.abs() < from.abs() {
        true => (to, from),
        false => (from, to),
    };
    // The other way, or less than half of it.
    match smaller * larger < 0.5 * larger * larger {
        true => larger,
        false => 0.5 * (after - before),
    }
}

/// Writes the change per sample along rows and columns of every grid: as `change` says inside, one-sided at the rim, 0 where
/// a grid has no neighbours.
pub(super) fn write_spread(
    values: &[f32],
    [width, height]: [usize; 2],
    along: &mut [Vec<f32>; 2],
    change: impl Fn([f32; 3]) -> f32,
) {
    let [rows, columns] = along;
    rows.clear();
    rows.resize(values.len(), 0.0);
    columns.clear();
    columns.resize(values.len(), 0.0);
    let area = width * height;
    for start in (0..values.len() - values.len() % area).step_by(area) {
        let grid = &values[start..start + area];
        if width > 2 {
            for y in 0..height {
                let row = y * width..(y + 1) * width;
                let out = &mut rows[start..start + area][row.clone()];
                differences_in_row(&grid[row], out, &change);
            }
        }
        if height > 2 {
            differences_between_rows(grid, width, &mut columns[start..start + area], &change);
        }
    }
}

fn differences_in_row(row: &[f32], out: &mut [f32], change: &impl Fn([f32; 3]) -> f32) {
    let last = row.len() - 1;
    let neighbours = row.iter().zip(&row[1..]).zip(&row[2..]);
    for (out, ((before, here), after)) in out[1..last].iter_mut().zip(neighbours) {
        *out = change([*before, *here, *after]);
    }
    out[0] = row[1] - row[0];
    out[last] = row[last] - row[last - 1];
}

fn differences_between_rows(
    grid: &[f32],
    width: usize,
    out: &mut [f32],
    change: &impl Fn([f32; 3]) -> f32,
) {
    let inner = grid.len() - width;
    let neighbours = grid.iter().zip(&grid[width..]).zip(&grid[2 * width..]);
    for (out, ((before, here), after)) in out[width..inner].iter_mut().zip(neighbours) {
        *out = change([*before, *here, *after]);
    }
    for x in 0..width {
        out[x] = grid[x + width] - grid[x];
        out[inner + x] = grid[inner + x] - grid[inner + x - width];
    }
}

/// The samples of a grid that are asked about: all but those near its rim.
pub(super) struct Inside {
    /// Samples in a row of the grid.
    pub(super) width: usize,
    /// Rows of the grid.
    pub(super) height: usize,
    /// Samples left out at each side, at least one.
    pub(super) border: usize,
}

impl Inside {
    /// Where runs of up to `lanes` samples of one row start, in order.
    fn starts(&self, lanes: usize) -> impl Iterator<Item = usize> {
        let (width, border) = (self.width, self.border);
        let rows = border..self.height.saturating_sub(border);
        let columns = move || (border..width.saturating_sub(border)).step_by(lanes);
        rows.flat_map(move |y| columns().map(move |x| y * width + x))
    }

    /// Lists the samples of the run at `start` whose bit is set.
    #[inline(always)]
    fn list(&self, start: usize, mut bits: u64, list: &mut Vec<u32>) {
        if bits == 0 {
            return;
        }
        let left = self.width - self.border - start % self.width;
        while bits.trailing_zeros() < left.min(64) as u32 {
            list.push(start as u32 + bits.trailing_zeros());
            bits &= bits - 1;
        }
    }
}

/// Lists the samples that bend more than `absolute + relative * spread` within themselves.
///
/// How far a column departs from a plane within one sample are the second-order terms of its Taylor
/// series at the corner of the sample.
#[simd]
pub(super) fn list_bent<S: Simd>(
    simd: S,
    values: &[f32],
    inside: &Inside,
    [absolute, relative]: [f32; 2],
    list: &mut Vec<u32>,
) {
    let width = inside.width;
    for start in inside.starts(S::f32s::LEN) {
        let (above, below) = (start - width, start + width);
        let [north_west, north, north_east] = load_three(simd, values, above);
        let [west, here, east] = load_three(simd, values, start);
        let [south_west, south, south_east] = load_three(simd, values, below);
        let (row, column) = ((east - west) * 0.5, (south - north) * 0.5);
        let mixed = ((south_east - south_west) - (north_east - north_west)) * 0.25;
        let along_row = east - here * 2.0 + west;
        let along_column = south - here * 2.0 + north;
        let bend = (along_row.abs() + along_column.abs()) * 0.125 + mixed.abs() * 0.25;
        let spread = (row * row + column * column).sqrt();
        let bent = bend.simd_gt(spread * relative + absolute);
        inside.list(start, bent.to_bitmask(), list);
    }
}

/// Lists the samples from which to the next the values change by more than `allowed`.
#[simd]
pub(super) fn list_uneven<S: Simd>(
    simd: S,
    values: &[f32],
    inside: &Inside,
    allowed: f32,
    list: &mut Vec<u32>,
) {
    let width = inside.width;
    for start in inside.starts(S::f32s::LEN) {
        let row = (load(simd, values, start + 1) - load(simd, values, start - 1)) * 0.5;
        let (above, below) = (start - width, start + width);
        let column = (load(simd, values, below) - load(simd, values, above)) * 0.5;
        let spread = (row * row + column * column).sqrt();
        inside.list(start, spread.simd_gt(allowed).to_bitmask(), list);
    }
}

/// How much the values change from a sample of a grid to the next; the sample is not at the rim.
pub(super) fn change(values: &[f32], width: usize, sample: usize) -> f32 {
    let row = (values[sample + 1] - values[sample - 1]) * 0.5;
    let column = (values[sample + width] - values[sample - width]) * 0.5;
    (row * row + column * column).sqrt()
}

/// Lists the samples that differ from any of their neighbours in a row or column, in any of some columns.
#[simd]
pub(super) fn list_varying<S: Simd>(
    simd: S,
    columns: &[&[f32]],
    inside: &Inside,
    list: &mut Vec<u32>,
) {
    let width = inside.width;
    for start in inside.starts(S::f32s::LEN) {
        let mut bits = 0;
        for values in columns {
            let here = load(simd, values, start);
            for neighbour in [start - 1, start + 1, start - width, start + width] {
                bits |= load(simd, values, neighbour).simd_ne(here).to_bitmask();
            }
        }
        inside.list(start, bits, list);
    }
}

/// Vectors of the values before, at and after `start`.
#[inline(always)]
fn load_three<S: Simd>(simd: S, values: &[f32], start: usize) -> [S::f32s; 3] {
    [
        load(simd, values, start - 1),
        load(simd, values, start),
        load(simd, values, start + 1),
    ]
}

/// A vector of the values from `start` on; zeros behind their end.
#[inline(always)]
fn load<S: Simd>(simd: S, values: &[f32], start: usize) -> S::f32s {
    if let Some(values) = values.get(start..start + S::f32s::LEN) {
        return S::f32s::from_slice(simd, values);
    }
    let mut rest = [0.0; 16];
    for (to, value) in rest.iter_mut().zip(&values[start..]) {
        *to = *value;
    }
    S::f32s::from_slice(simd, &rest[..S::f32s::LEN])
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};

    fn bent(values: &[f32], width: usize, allowed: [f32; 2]) -> Vec<u32> {
        let (height, border) = (values.len() / width, 1);
        let inside = Inside {
            width,
            height,
            border,
        };
        let mut list = vec![];
        dispatch!(Level::new(), simd => list_bent(simd, values, &inside, allowed, &mut list));
        list
    }

    #[test]
    fn spread_of_a_plane_is_its_gradient_and_it_does_not_bend() {
        let values: Vec<f32> = (0..35)
            .map(|i| 2.0 * (i % 7) as f32 - 3.0 * (i / 7) as f32)
            .collect();
        let mut along = [vec![], vec![]];
        write_spread(&values, [7, 5], &mut along, mean_change);
        assert!(along[0].iter().all(|d| *d == 2.0));
        assert!(along[1].iter().all(|d| *d == -3.0));
        assert!(bent(&values, 7, [0.0; 2]).is_empty());
    }

    /// In a wide grid, so that rows are several vectors long.
    #[test]
    fn a_bump_bends_itself_and_its_neighbours() {
        let (width, at) = (41, 5 * 41 + 30);
        let mut values = vec![1.0; 41 * 9];
        values[at] = 2.0;
        let around = |row: usize| at + row * width - width - 1..at + row * width - width + 2;
        let neighbours: Vec<u32> = (0..3).flat_map(around).map(|index| index as u32).collect();
        assert_eq!(bent(&values, width, [0.0; 2]), neighbours);
        // 0.5 at the bump, 0.125 beside it, 0.0625 at the corners.
        assert_eq!(bent(&values, width, [0.2, 0.0]), [at as u32]);
        assert_eq!(bent(&values, width, [0.0625, 0.0]).len(), 5);
        let inside = Inside {
            width,
            height: 9,
            border: 1,
        };
        let mut uneven = vec![];
        dispatch!(Level::new(), simd => list_uneven(simd, &values, &inside, 0.5, &mut uneven));
        assert!(uneven.is_empty());
        dispatch!(Level::new(), simd => list_uneven(simd, &values, &inside, 0.49, &mut uneven));
        let beside = [at - width, at - 1, at + 1, at + width].map(|index| index as u32);
        assert_eq!(uneven, beside);
        let mut varying = vec![];
        let columns = [&values[..]];
        dispatch!(Level::new(), simd => list_varying(simd, &columns, &inside, &mut varying));
        let expected = [at - width, at - 1, at, at + 1, at + width].map(|index| index as u32);
        assert_eq!(varying, expected);
    }

    #[test]
    fn kinks_have_the_larger_change() {
        assert_eq!(change_at_kinks([3.0, 1.0, 2.0]), -2.0);
        assert_eq!(change_at_kinks([-1.0, 1.0, 0.0]), 2.0);
        assert_eq!(change_at_kinks([1.0, 1.0, 4.0]), 3.0);
        assert_eq!(change_at_kinks([0.0, 2.0, 5.0]), 2.5);
        assert_eq!(change_at_kinks([4.0, 4.0, 4.0]), 0.0);
        assert_eq!(mean_change([3.0, 1.0, 2.0]), -0.5);
    }

    #[test]
    fn single_points_have_no_spread() {
        let mut along = [vec![], vec![]];
        write_spread(&[1.0, 5.0, 9.0], [1, 1], &mut along, mean_change);
        assert_eq!(along, [vec![0.0; 3], vec![0.0; 3]]);
    }
}
