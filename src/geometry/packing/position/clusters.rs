//! Where stones lie: samples beside each other that agree on a lattice point are one stone.

use super::{Field, Level, Sample};
use glam::DVec2;

/// Where stones lie: lattice points that many samples agree on, and how many do.
pub(crate) fn stones(field: &Field<'_>, level: &Level) -> Vec<(DVec2, f64)> {
    let mut parents = agreeing(field, level);
    let mut sums = vec![(DVec2::ZERO, 0.0); level.samples.len()];
    let mut order = vec![];
    for index in 0..level.samples.len() {
        let Some(sample) = &level.samples[index] else {
            continue;
        };
        let first = root(&mut parents, index as u32) as usize;
        if first == index {
            order.push(index);
        }
        let base = level.samples[first].as_ref().expect("a root is a sample");
        let across = field.across(base.point, sample.point);
        sums[first].0 += sample.origin + across;
        sums[first].1 += 1.0;
    }
    order
        .into_iter()
        .map(|index| (sums[index].0 / sums[index].1, sums[index].1))
        .collect()
}

/// Of each sample one that it agrees with on the lattice point, or itself.
fn agreeing(field: &Field<'_>, level: &Level) -> Vec<u32> {
    let mut parents: Vec<u32> = (0..level.samples.len() as u32).collect();
    let (columns, rows) = (level.columns as i64, level.rows as i64);
    for index in 0..level.samples.len() {
        let Some(sample) = &level.samples[index] else {
            continue;
        };
        let (x, y) = (index as i64 % columns, index as i64 / columns);
        for (x, y) in [(1, 0), (0, 1), (1, 1), (-1, 1)].map(|(dx, dy)| (x + dx, y + dy)) {
            let other = level.at(x, y);
            if other.is_some_and(|other| agree(field, sample, other)) {
                let other = (y.rem_euclid(rows) * columns + x.rem_euclid(columns)) as u32;
                let (a, b) = (root(&mut parents, index as u32), root(&mut parents, other));
                parents[a.max(b) as usize] = a.min(b);
            }
        }
    }
    parents
}

/// Whether the lattice points of two samples are one.
fn agree(field: &Field<'_>, sample: &Sample, other: &Sample) -> bool {
    let across = field.across(sample.point, other.point);
    let near = 0.35 * sample.scale.min(other.scale) * field.lattice.step.min_element();
    (other.origin + across).distance_squared(sample.origin) < near * near
}

fn root(parents: &mut [u32], index: u32) -> u32 {
    let mut index = index;
    while parents[index as usize] != index {
        parents[index as usize] = parents[parents[index as usize] as usize];
        index = parents[index as usize];
    }
    index
}
