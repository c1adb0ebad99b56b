//! Tangents on the nodes of a cubic spline; see [`super::spline`].

use crate::value::Tangents;
use glam::DVec3;

/// A tangent rises if its z is more than this share of its length: slopes stay finite.
const LEAST_RISE: f64 = 1e-6;

/// The tangents on at least two nodes; chords where they would not rise.
pub(super) fn rising_tangents(nodes: &[DVec3], tangents: Tangents) -> Vec<DVec3> {
    let wanted = match tangents {
        Tangents::Natural => natural_tangents(nodes),
        Tangents::Local => local_tangents(nodes),
    };
    let replaced = |(index, tangent)| {
        if rises(tangent) {
            tangent
        } else {
            chord(nodes, index)
        }
    };
    wanted.into_iter().enumerate().map(replaced).collect()
}

fn rises(tangent: DVec3) -> bool {
    tangent.z > LEAST_RISE * tangent.length()
}

/// What replaces a tangent that does not rise.
fn chord(nodes: &[DVec3], index: usize) -> DVec3 {
    let last = nodes.len() - 1;
    match index {
        0 => nodes[1] - nodes[0],
        index if index == last => nodes[last] - nodes[last - 1],
        index => (nodes[index + 1] - nodes[index - 1]) / 2.0,
    }
}

/// Tangents of the natural cubic spline with uniform parameter: `2 D_0 + D_1 = 3 (N_1 - N_0)`,
/// `D_(i-1) + 4 D_i + D_(i+1) = 3 (N_(i+1) - N_(i-1))`, `D_(m-1) + 2 D_m = 3 (N_m - N_(m-1))`.
fn natural_tangents(nodes: &[DVec3]) -> Vec<DVec3> {
    let last = nodes.len() - 1;
    // Elimination from the bottom up: D_i = value_i - factor_i D_(i+1).
    let mut factors = vec![0.5];
    let mut values = vec![(nodes[1] - nodes[0]) * 1.5];
    for index in 1..=last {
        let (diagonal, right) = if index == last {
            (2.0, (nodes[last] - nodes[last - 1]) * 3.0)
        } else {
            (4.0, (nodes[index + 1] - nodes[index - 1]) * 3.0)
        };
        let pivot = diagonal - factors[index - 1];
        let value = (right - values[index - 1]) / pivot;
        factors.push(1.0 / pivot);
        values.push(value);
    }
    for index in (0..last).rev() {
        let next = values[index + 1];
        values[index] -= next * factors[index];
    }
    values
}

/// Tangents by eq. (4) on sliding triples of nodes; two nodes are joined by a straight line.
fn local_tangents(nodes: &[DVec3]) -> Vec<DVec3> {
    let last = nodes.len() - 1;
    if last == 1 {
        return vec![nodes[1] - nodes[0]; 2];
    }
    let tangent = |index: usize| match index {
        0 => (nodes[1] * 6.0 - nodes[0] * 5.0 - nodes[2]) / 4.0,
        index if index == last => {
            (nodes[last - 2] - nodes[last - 1] * 6.0 + nodes[last] * 5.0) / 4.0
        }
        index => (nodes[index + 1] - nodes[index - 1]) / 2.0,
    };
    (0..=last).map(tangent).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes(heights: &[f64]) -> Vec<DVec3> {
        let x = |index: usize| [0.0, 3.0, -1.0, 2.0, 2.5][index % 5];
        heights
            .iter()
            .enumerate()
            .map(|(i, z)| DVec3::new(x(i), -0.5 * x(i + 2), *z))
            .collect()
    }

    #[test]
    fn natural_tangents_make_second_derivatives_meet_and_vanish_at_the_ends() {
        let nodes = nodes(&[0.0, 1.0, 2.5, 3.0, 5.0, 6.0]);
        let d = natural_tangents(&nodes);
        let chord = |i: usize| nodes[i + 1] - nodes[i];
        let start = |i: usize| chord(i) * 6.0 - d[i] * 4.0 - d[i + 1] * 2.0;
        let end = |i: usize| d[i] * 2.0 + d[i + 1] * 4.0 - chord(i) * 6.0;
        assert!(start(0).length() < 1e-12 && end(4).length() < 1e-12);
        (1..5).for_each(|i| assert!((start(i) - end(i - 1)).length() < 1e-12));
    }

    #[test]
    fn tangents_that_do_not_rise_become_chords() {
        // The limit for three nodes: the lower end tangent rises if dz_2 < 5 dz_1.
        let points = nodes(&[0.0, 1.0, 5.99]);
        assert_eq!(
            rising_tangents(&points, Tangents::Natural),
            natural_tangents(&points)
        );
        let points = nodes(&[0.0, 1.0, 6.01]);
        let natural = natural_tangents(&points);
        assert!(natural[0].z < 0.0);
        let found = rising_tangents(&points, Tangents::Natural);
        assert_eq!(found, [points[1] - points[0], natural[1], natural[2]]);
        // Two high steps round a low one press an inner tangent down.
        let points = nodes(&[0.0, 9.0, 10.0, 10.5, 20.0]);
        let natural = natural_tangents(&points);
        let fallen: Vec<usize> = (0..5).filter(|i| natural[*i].z <= 0.0).collect();
        assert_eq!(fallen, [2]);
        let found = rising_tangents(&points, Tangents::Natural);
        assert_eq!(found[2], (points[3] - points[1]) / 2.0);
    }
}
