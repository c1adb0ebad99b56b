//! Charts: parts of a piece that lie side by side without being neighbours, such as the islands of a mesh's map.
//!
//! Samples are neighbours only if they are of one chart, so differences are one-sided at the rim of a chart, and pixels
//! that are supersampled take the mean of the samples of their own chart.

use super::Field;
use super::spread;
use crate::key::KeyHasher;
use crate::value::Domain;

/// The charts of the samples that a program is compiled for.
pub(super) struct Charts {
    /// Fields that have the same values only within a chart.
    pub(super) fields: Vec<Field>,
    /// Their columns, once they are compiled.
    pub(super) columns: Vec<usize>,
    /// The columns that say which neighbours are of one chart.
    pub(super) joins: Option<[usize; 2]>,
}

impl Charts {
    /// What is the same everywhere divides nothing.
    pub(super) fn of(fields: &[Field]) -> Charts {
        let varies = |field: &&Field| field.domain() != Domain::Everywhere;
        Charts {
            fields: fields.iter().filter(varies).cloned().collect(),
            columns: vec![],
            joins: None,
        }
    }

    /// Adds what columns depend on besides their fields; nothing if there are no charts.
    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        self.fields.iter().for_each(|field| {
            key.text("charts").key(field.key());
        });
    }
}

/// Writes 1 where a sample is of one chart with the next in its row, or in its column, and else 0.
pub(super) fn write_joins(
    charts: &[&[f32]],
    [width, height]: [usize; 2],
    joins: &mut [Vec<f32>; 2],
) {
    let length = charts[0].len();
    let area = width * height;
    for (column, (step, is_row)) in joins.iter_mut().zip([(1, true), (width, false)]) {
        column.clear();
        column.resize(length, 0.0);
        for (index, join) in column.iter_mut().enumerate().take(length - length % area) {
            let has_next = match is_row {
                true => index % width + 1 < width,
                false => index % area + width < area,
            };
            let is_same = |chart: &&[f32]| chart[index] == chart[index + step];
            *join = f32::from(u8::from(has_next && charts.iter().all(is_same)));
        }
    }
}

/// Writes the change per sample along rows and columns: the mean of the steps to neighbours of the same chart, or what
/// `change` says of both, 0 where there are none.
pub(super) fn write_spread(
    values: &[f32],
    joins: [&[f32]; 2],
    [width, height]: [usize; 2],
    along: &mut [Vec<f32>; 2],
    change: impl Fn([f32; 3]) -> f32,
) {
    let area = width * height;
    for ((column, joins), step) in along.iter_mut().zip(joins).zip([1, width]) {
        column.clear();
        column.resize(values.len(), 0.0);
        for (index, spread) in column
            .iter_mut()
            .enumerate()
            .take(values.len() - values.len() % area)
        {
            let before = index >= step && joins[index - step] != 0.0;
            let after = joins[index] != 0.0;
            *spread = match (before, after) {
                (true, true) => change([values[index - step], values[index], values[index + step]]),
                (false, true) => values[index + step] - values[index],
                (true, false) => values[index] - values[index - step],
                (false, false) => 0.0,
            };
        }
    }
}

/// Writes the change per sample along rows and columns, between neighbours of the same chart if there are charts.
pub(super) fn write_spread_between(
    values: &[f32],
    joins: Option<[&[f32]; 2]>,
    shape: [usize; 2],
    along: &mut [Vec<f32>; 2],
    change: impl Fn([f32; 3]) -> f32,
) {
    match joins {
        None => spread::write_spread(values, shape, along, change),
        Some(joins) => write_spread(values, joins, shape, along, change),
    }
}

#[cfg(test)]
mod tests {
    use super::super::spread::mean_change;
    use super::*;

    #[test]
    fn differences_end_where_charts_do() {
        // Two grids of 4 x 3 samples; the left half of each is one chart, the right half another.
        let chart: Vec<f32> = (0..24).map(|i| if i % 4 < 2 { 0.0 } else { 7.0 }).collect();
        let value = |i: usize| (i % 4) as f32 * 2.0 + (i / 4) as f32 * 3.0 + chart[i] * 1000.0;
        let values: Vec<f32> = (0..24).map(value).collect();
        let mut joins = [vec![], vec![]];
        write_joins(&[&chart], [4, 3], &mut joins);
        assert_eq!(joins[0][..4], [1.0, 0.0, 1.0, 0.0]);
        assert_eq!(joins[1][4..12], [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        let mut along = [vec![], vec![]];
        write_spread(
            &values,
            [&joins[0], &joins[1]],
            [4, 3],
            &mut along,
            mean_change,
        );
        assert!(along[0].iter().all(|change| *change == 2.0), "{along:?}");
        assert!(along[1].iter().all(|change| *change == 3.0), "{along:?}");
    }

    #[test]
    fn samples_alone_in_their_chart_and_points_have_no_spread() {
        let mut joins = [vec![], vec![]];
        write_joins(&[&[1.0, 2.0, 3.0]], [3, 1], &mut joins);
        let mut along = [vec![], vec![]];
        write_spread(
            &[5.0, 9.0, 1.0],
            [&joins[0], &joins[1]],
            [3, 1],
            &mut along,
            mean_change,
        );
        assert_eq!(along, [vec![0.0; 3], vec![0.0; 3]]);
        write_joins(&[&[1.0, 1.0]], [1, 1], &mut joins);
        assert_eq!(joins, [vec![0.0; 2], vec![0.0; 2]]);
    }
}
