//! Rational B-spline surfaces: points and derivatives by the basis functions of Cox and de Boor.

use crate::value::{HIGHEST_DEGREE, Patch};
use glam::DVec3;

/// Room for the basis functions that differ from 0 at one parameter.
const ROOM: usize = HIGHEST_DEGREE as usize + 1;

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnPatch {
    /// Where it is, in mm.
    pub(crate) place: DVec3,
    /// Derivatives of the place by u and by v.
    pub(crate) along: [DVec3; 2],
}

/// Basis functions and their derivatives at a parameter.
struct Basis {
    /// The first control point whose function differs from 0.
    first: usize,
    values: [f64; ROOM],
    slopes: [f64; ROOM],
}

/// The point of a patch at (u, v), both from 0 to 1; beyond, its border.
pub(crate) fn evaluate(patch: &Patch, at: [f64; 2]) -> OnPatch {
    let [u, v] = [0, 1].map(|axis: usize| {
        let (degree, knots) = (patch.degrees[axis] as usize, &patch.knots[axis]);
        basis(degree, knots, at[axis].clamp(0.0, 1.0))
    });
    let [across, rows] = patch.degrees.map(|degree| degree as usize + 1);
    // Sums of points times weights, and of weights: of the values and of the derivatives by u and v.
    let (mut points, mut weights) = ([DVec3::ZERO; 3], [0.0; 3]);
    for row in 0..rows {
        let start = (v.first + row) * patch.counts[0] as usize + u.first;
        for column in 0..across {
            let index = start + column;
            let weight = patch.weights.get(index).copied().unwrap_or(1.0);
            let factors = [
                u.values[column] * v.values[row],
                u.slopes[column] * v.values[row],
                u.values[column] * v.slopes[row],
            ];
            for (part, factor) in factors.into_iter().enumerate() {
                points[part] += patch.points[index] * (factor * weight);
                weights[part] += factor * weight;
            }
        }
    }
    let place = points[0] / weights[0];
    let along = [1, 2].map(|part: usize| (points[part] - place * weights[part]) / weights[0]);
    OnPatch { place, along }
}

/// The basis functions of a degree at a parameter from 0 to 1 (Piegl & Tiller 1997, algorithms A2.1 and A2.2).
fn basis(degree: usize, knots: &[f64], at: f64) -> Basis {
    let last = knots.len() - degree - 1;
    let whole = knots[last] - knots[degree];
    let at = knots[degree] + at * whole;
    // The last span that begins at or before the parameter and is not empty; the end belongs to the last one.
    let behind = knots[degree..last].partition_point(|knot| *knot <= at);
    let mut span = (degree + behind).saturating_sub(1).max(degree);
    while span > degree && knots[span] >= knots[span + 1] {
        span -= 1;
    }
    let mut values = [0.0; ROOM];
    let mut lower = [0.0; ROOM];
    values[0] = 1.0;
    for order in 1..=degree {
        if order == degree {
            lower = values;
        }
        let mut carried = 0.0;
        for index in 0..order {
            let (right, left) = (knots[span + index + 1], knots[span + 1 + index - order]);
            let share = values[index] / (right - left);
            values[index] = carried + (right - at) * share;
            carried = (at - left) * share;
        }
        values[order] = carried;
    }
    let mut slopes = [0.0; ROOM];
    for index in 0..=degree {
        let quotient = |lower: f64, first: usize| {
            let width = knots[first + degree] - knots[first];
            if width > 0.0 { lower / width } else { 0.0 }
        };
        let before = match index {
            0 => 0.0,
            _ => quotient(lower[index - 1], span + index - degree),
        };
        let after = match index == degree {
            true => 0.0,
            false => quotient(lower[index], span + index + 1 - degree),
        };
        slopes[index] = degree as f64 * (before - after) * whole;
    }
    Basis {
        first: span - degree,
        values,
        slopes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// De Casteljau's construction of a cubic.
    fn casteljau(points: [DVec3; 4], at: f64) -> DVec3 {
        let mut points = points.to_vec();
        while points.len() > 1 {
            points = points
                .windows(2)
                .map(|pair| pair[0].lerp(pair[1], at))
                .collect();
        }
        points[0]
    }

    #[test]
    fn a_bezier_patch_is_what_de_casteljau_constructs() {
        let point = |i: usize| {
            let wave = |stride: usize| (i * stride % 17) as f64;
            DVec3::new(wave(3), wave(5), wave(7))
        };
        let points: [DVec3; 16] = std::array::from_fn(point);
        let patch = Patch::bezier(points);
        for (u, v) in (0..=10).flat_map(|u| (0..=10).map(move |v| (u, v))) {
            let [u, v] = [u, v].map(|part| f64::from(part) / 10.0);
            let row = |row: usize| casteljau(std::array::from_fn(|it| points[4 * row + it]), u);
            let expected = casteljau(std::array::from_fn(row), v);
            let found = evaluate(&patch, [u, v]);
            assert!(found.place.distance(expected) < 1e-12);
            let step = 1e-6;
            for (axis, along) in found.along.into_iter().enumerate() {
                let shifted = |by: f64| {
                    let mut at = [u, v].map(|part| part.clamp(step, 1.0 - step));
                    at[axis] += by;
                    evaluate(&patch, at).place
                };
                let slope = (shifted(step) - shifted(-step)) / (2.0 * step);
                assert!(along.distance(slope) < 1e-3, "{along}, not {slope}");
            }
        }
    }

    /// Piegl & Tiller 1997, example 7.1: a quarter of a circle with weights 1, 1, 2.
    #[test]
    fn a_rational_surface_is_a_cylinder_and_inner_knots_change_nothing_at_its_ends() {
        let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (0.0, 1.0, 2.0)];
        let both = [0.0, 5.0];
        let points = both
            .iter()
            .flat_map(|z| arc.map(|(x, y, _)| DVec3::new(x, y, *z)));
        let patch = Patch {
            degrees: [2, 1],
            counts: [3, 2],
            knots: [vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![2.0, 2.0, 4.0, 4.0]],
            points: points.collect(),
            weights: both
                .iter()
                .flat_map(|_| arc.map(|(_, _, weight)| weight))
                .collect(),
        };
        for step in 0..=20 {
            let part = f64::from(step) / 20.0;
            let found = evaluate(&patch, [part, part]);
            let radius = found.place.truncate().length();
            assert!((radius - 1.0).abs() < 1e-12 && (found.place.z - 5.0 * part).abs() < 1e-12);
            assert!(found.along[0].truncate().dot(found.place.truncate()).abs() < 1e-12);
            assert!((found.along[1] - DVec3::Z * 5.0).length() < 1e-12);
        }
    }

    #[test]
    fn a_spline_with_inner_knots_runs_through_what_its_basis_says() {
        // Degree 2 over knots 0 0 0 1 2 2 2: at the middle the weights are 0, 1/2, 1/2, 0.
        let knots = [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0];
        let middle = basis(2, &knots, 0.5);
        assert_eq!(
            (middle.first, &middle.values[..3]),
            (1, &[0.5, 0.5, 0.0][..])
        );
        for step in 0..=40 {
            let at = basis(2, &knots, f64::from(step) / 40.0);
            assert!((at.values.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(at.slopes.iter().sum::<f64>().abs() < 1e-12);
        }
        let end = basis(2, &knots, 1.0);
        assert_eq!((end.first, &end.values[..3]), (1, &[0.0, 0.0, 1.0][..]));
    }
}
