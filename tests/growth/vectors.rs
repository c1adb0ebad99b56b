//! The numbers of an independent implementation in double precision.

use super::{grow_at, rounded};
use glam::DVec3;
use serde_json::Value;
use yosegi::geometry::spline::TrunkCurve;
use yosegi::nodes::wood::growth::{GrowthModel, GrowthSettings, growth_time};
use yosegi::value::{Branch, Skeleton, Tangents, Thickness};

const SETTINGS: GrowthSettings = GrowthSettings {
    elongation: 0.5,
    thickening: 0.01,
    sharpness: 2.0,
    reach: None,
};

fn vectors() -> Value {
    let text = include_str!("../data/spec-vectors.json");
    serde_json::from_str::<Value>(text).unwrap()["wood_curve"].clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn point(value: &Value) -> DVec3 {
    DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn points(value: &Value) -> Vec<DVec3> {
    value.as_array().unwrap().iter().map(point).collect()
}

fn skeleton(vectors: &Value, tangents: Tangents) -> Skeleton {
    let branch = |value: &Value| Branch {
        height: number(&value[0]),
        direction: point(&value[1]).normalize(),
        thickness: Thickness::Speed(number(&value[2])),
        length: None,
    };
    let branches = vectors["branches_zb_dir_vb"]
        .as_array()
        .unwrap()
        .iter()
        .map(branch)
        .collect();
    Skeleton {
        trunk: points(&vectors["nodes"]),
        tangents,
        branches,
    }
}

fn cases() -> [(&'static str, Tangents); 2] {
    [("natural", Tangents::Natural), ("local", Tangents::Local)]
}

fn assert_near(found: f64, expected: f64, what: &str) {
    let tolerance = 1e-12 * expected.abs().max(1.0);
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: expected {expected}, found {found}"
    );
}

#[test]
fn control_points_and_the_curve_are_the_known_ones() {
    let vectors = vectors();
    for (name, tangents) in cases() {
        let known = &vectors[name];
        let curve = TrunkCurve::through(&points(&vectors["nodes"]), tangents).unwrap();
        let pairs = [
            (curve.raw_control_points(), &known["control_raw"]),
            (curve.optimised_control_points(), &known["control_opt"]),
        ];
        for (found, expected) in pairs {
            assert_eq!(found.len(), expected.as_array().unwrap().len());
            for (found, expected) in found.into_iter().zip(points(expected)) {
                assert!(
                    found.distance(expected) < 1e-12,
                    "{name}: {found} is not {expected}"
                );
            }
        }
        for (at, expected) in points(&vectors["points"]).iter().zip(points(&known["Q"])) {
            assert!(curve.at(at.z).distance(expected) < 1e-12);
        }
    }
}

#[test]
fn every_term_of_the_growth_time_is_the_known_one() {
    let vectors = vectors();
    for (name, tangents) in cases() {
        let skeleton = skeleton(&vectors, tangents);
        for (index, at) in points(&vectors["points"]).into_iter().enumerate() {
            let terms = growth_time(&skeleton, SETTINGS, at).unwrap();
            assert_near(terms.trunk, number(&vectors[name]["T1"][index]), "T1");
            assert_near(terms.time, number(&vectors[name]["T"][index]), "T");
            for (branch, found) in terms.branches.iter().enumerate() {
                let expected = &vectors[name]["terms"][index][branch];
                assert_eq!(found.is_none(), expected.is_null(), "{name}, point {index}");
                if let Some(found) = found {
                    assert_near(found.alpha, number(&expected[0]), "T_alpha");
                    assert_near(found.beta, number(&expected[1]), "T_beta");
                    assert_near(found.gamma, number(&expected[2]), "T_gamma");
                }
            }
        }
    }
}

#[test]
fn the_kernel_gives_the_known_times() {
    let vectors = vectors();
    for (name, tangents) in cases() {
        let model = GrowthModel::new(&skeleton(&vectors, tangents), SETTINGS).unwrap();
        let points = points(&vectors["points"]);
        let expected: Vec<f64> = (0..points.len())
            .map(|i| number(&vectors[name]["T"][i]))
            .collect();
        let largest = expected.iter().fold(0.0, |a: f64, b| a.max(*b));
        let found = grow_at(&model, &points);
        for ((found, expected), at) in found.time.iter().zip(expected).zip(points) {
            // The kernel's points are rounded to single precision.
            let moved = model.terms(rounded(at)).time - model.terms(at).time;
            assert!((f64::from(*found) - expected - moved).abs() < 1e-5 * largest);
        }
    }
}

/// Value at `z` of the cubic with these values and slopes at the ends, by the Hermite basis.
fn hermite(z: f64, [z0, z1]: [f64; 2], values: [f64; 2], slopes: [f64; 2]) -> f64 {
    let (dz, t) = (z1 - z0, (z - z0) / (z1 - z0));
    let (h00, h01) = (
        (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t),
        t * t * (3.0 - 2.0 * t),
    );
    let (h10, h11) = (t * (1.0 - t) * (1.0 - t), t * t * (t - 1.0));
    h00 * values[0] + h01 * values[1] + dz * (h10 * slopes[0] + h11 * slopes[1])
}

/// Solves the dense system in place by elimination with pivots.
fn solve(matrix: &mut [Vec<f64>], right: &mut [f64]) {
    for column in 0..right.len() {
        let best = (column..right.len()).max_by(|a, b| {
            matrix[*a][column]
                .abs()
                .total_cmp(&matrix[*b][column].abs())
        });
        let best = best.unwrap();
        matrix.swap(column, best);
        right.swap(column, best);
        for row in 0..right.len() {
            if row != column {
                let factor = matrix[row][column] / matrix[column][column];
                let pivot = matrix[column].clone();
                matrix[row]
                    .iter_mut()
                    .zip(&pivot)
                    .for_each(|(a, b)| *a -= factor * b);
                right[row] -= factor * right[column];
            }
        }
    }
    right
        .iter_mut()
        .enumerate()
        .for_each(|(row, value)| *value /= matrix[row][row]);
}

#[test]
fn the_curve_is_the_hermite_cubic_of_an_independent_solution() {
    let nodes = points(&vectors()["nodes"]);
    let count = nodes.len();
    let tangents = [0, 1, 2].map(|axis| {
        let at = |index: usize| nodes[index][axis];
        let mut matrix = vec![vec![0.0; count]; count];
        let mut right = vec![0.0; count];
        for row in 0..count {
            let (before, after) = (row.max(1) - 1, (row + 1).min(count - 1));
            right[row] = 3.0 * (at(after) - at(before));
            matrix[row][row] = if row == 0 || row == count - 1 {
                2.0
            } else {
                4.0
            };
            if row > 0 {
                matrix[row][before] = 1.0;
            }
            if row < count - 1 {
                matrix[row][after] = 1.0;
            }
        }
        solve(&mut matrix, &mut right);
        right
    });
    let curve = TrunkCurve::through(&nodes, Tangents::Natural).unwrap();
    for segment in 0..count - 1 {
        let ends = [segment, segment + 1];
        let heights = ends.map(|end| nodes[end].z);
        for step in 0..=10 {
            let z = heights[0] + 0.1 * f64::from(step) * (heights[1] - heights[0]);
            for axis in 0..2 {
                let values = ends.map(|end| nodes[end][axis]);
                let slopes = ends.map(|end| tangents[axis][end] / tangents[2][end]);
                let expected = hermite(z, heights, values, slopes);
                assert!((curve.at(z)[axis] - expected).abs() < 1e-12);
            }
        }
    }
}
