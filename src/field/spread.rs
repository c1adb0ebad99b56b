//! Spread: how much a column changes from one sample to the next, and how much it bends.

/// Writes the change per sample along rows and columns of every grid: central differences inside,
/// one-sided ones at the rim, 0 where a grid has no neighbours.
pub(super) fn write_spread(values: &[f32], [width, height]: [usize; 2], along: &mut [Vec<f32>; 2]) {
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
                differences_in_row(&grid[row.clone()], &mut rows[start..start + area][row]);
            }
        }
        if height > 2 {
            differences_between_rows(grid, width, &mut columns[start..start + area]);
        }
    }
}

fn differences_in_row(row: &[f32], out: &mut [f32]) {
    let last = row.len() - 1;
    for ((out, before), after) in out[1..last].iter_mut().zip(row).zip(&row[2..]) {
        *out = 0.5 * (after - before);
    }
    out[0] = row[1] - row[0];
    out[last] = row[last] - row[last - 1];
}

fn differences_between_rows(grid: &[f32], width: usize, out: &mut [f32]) {
    let inner = grid.len() - width;
    for ((out, before), after) in out[width..inner]
        .iter_mut()
        .zip(grid)
        .zip(&grid[2 * width..])
    {
        *out = 0.5 * (after - before);
    }
    for x in 0..width {
        out[x] = grid[x + width] - grid[x];
        out[inner + x] = grid[inner + x] - grid[inner + x - width];
    }
}

/// How far the column departs from a plane within one sample, at the inner sample `index`:
/// the second-order terms of its Taylor series at the corner of the sample.
pub(super) fn bend(values: &[f32], width: usize, index: usize) -> f32 {
    let at = |offset: isize| values[index.wrapping_add_signed(offset)];
    let (row, here) = (width as isize, at(0));
    let along_row = at(1) - 2.0 * here + at(-1);
    let along_column = at(row) - 2.0 * here + at(-row);
    let mixed = 0.25 * ((at(row + 1) - at(row - 1)) - (at(1 - row) - at(-row - 1)));
    0.125 * (along_row.abs() + along_column.abs()) + 0.25 * mixed.abs()
}

/// How much the column changes across one sample, at the inner sample `index`.
pub(super) fn size(values: &[f32], width: usize, index: usize) -> f32 {
    let along_row = 0.5 * (values[index + 1] - values[index - 1]);
    let along_column = 0.5 * (values[index + width] - values[index - width]);
    (along_row * along_row + along_column * along_column).sqrt()
}

/// Whether any neighbour of the inner sample `index` differs from it.
pub(super) fn varies(values: &[f32], width: usize, index: usize) -> bool {
    let neighbours = [index - 1, index + 1, index - width, index + width];
    neighbours
        .iter()
        .any(|neighbour| values[*neighbour] != values[index])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_of_a_plane_is_its_gradient_and_it_does_not_bend() {
        let values: Vec<f32> = (0..35)
            .map(|i| 2.0 * (i % 7) as f32 - 3.0 * (i / 7) as f32)
            .collect();
        let mut along = [vec![], vec![]];
        write_spread(&values, [7, 5], &mut along);
        assert!(along[0].iter().all(|d| *d == 2.0));
        assert!(along[1].iter().all(|d| *d == -3.0));
        assert_eq!(bend(&values, 7, 8), 0.0);
    }

    #[test]
    fn single_points_have_no_spread() {
        let mut along = [vec![], vec![]];
        write_spread(&[1.0, 5.0, 9.0], [1, 1], &mut along);
        assert_eq!(along, [vec![0.0; 3], vec![0.0; 3]]);
    }
}
