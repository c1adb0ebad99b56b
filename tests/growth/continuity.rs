//! Growth time has no jumps: bounds on the difference between neighbouring samples.

use super::{grow_at, rounded, settings, tree};
use glam::DVec3;
use yosegi::nodes::wood::growth::{GrowingBranch, GrowthModel, GrowthSettings, Reach};
use yosegi::value::{Skeleton, Tangents};

/// Rows of points on a slice through the tree, from one corner along two directions.
fn slice(origin: DVec3, right: DVec3, down: DVec3, size: usize) -> Vec<Vec<DVec3>> {
    let row = |y: usize| {
        let point = |x: usize| rounded(origin + right * x as f64 + down * y as f64);
        (0..size).map(point).collect()
    };
    (0..size).map(row).collect()
}

/// Calls `check(a, b, difference in T, largest T)` for all neighbours in rows and columns.
fn for_neighbours(
    model: &GrowthModel,
    rows: &[Vec<DVec3>],
    check: impl Fn(DVec3, DVec3, f64, f64),
) {
    let points: Vec<DVec3> = rows.iter().flatten().copied().collect();
    let times = grow_at(model, &points).time;
    let largest = times
        .iter()
        .fold(0.0, |a: f64, b| a.max(f64::from(b.abs())));
    let width = rows[0].len();
    for index in 0..points.len() {
        let right = (index % width + 1 < width).then_some(index + 1);
        for next in right
            .into_iter()
            .chain((index + width < points.len()).then_some(index + width))
        {
            let difference = (f64::from(times[index]) - f64::from(times[next])).abs();
            check(points[index], points[next], difference, largest);
        }
    }
}

/// The bound on the trunk's gradient: 1 / v_e + (1 + max |dQ/dz|) / v_h.
fn trunk_gradient(model: &GrowthModel) -> f64 {
    let GrowthSettings {
        elongation,
        thickening,
        ..
    } = model.settings;
    1.0 / elongation + (1.0 + model.trunk.curve().unwrap().steepest()) / thickening
}

#[test]
fn without_branches_neighbours_differ_by_the_bound_on_any_slice() {
    // The paper's figures 12c and 12d: vertical sections through a bent axis.
    let bent = [
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 2.0),
        (1.5, 0.0, 3.0),
        (1.5, 0.0, 6.0),
    ];
    let settings = GrowthSettings {
        elongation: 1.0,
        thickening: 0.05,
        ..settings(2.0)
    };
    for tangents in [Tangents::Natural, Tangents::Local] {
        let trunk = bent.map(DVec3::from).to_vec();
        let skeleton = Skeleton {
            trunk,
            tangents,
            branches: vec![],
        };
        let model = GrowthModel::new(&skeleton, settings).unwrap();
        let bound = trunk_gradient(&model);
        for (y, turn) in [(0.0, 0.0), (0.7, 0.0), (0.0, 0.03), (-2.0, 0.05)] {
            let origin = DVec3::new(-6.0, y, -0.5);
            let rows = slice(
                origin,
                DVec3::new(0.075, turn, 0.0),
                DVec3::new(0.0, 0.0, 0.045),
                160,
            );
            for_neighbours(&model, &rows, |a, b, difference, largest| {
                assert!(
                    difference <= a.distance(b) * bound + 1e-6 * largest,
                    "{a} {b}"
                );
            });
        }
    }
}

/// A bound on |grad T| at the distances |P - b1| >= `distances`, where T_1 <= `trunk`.
///
/// With k = 2, `dT/dT_i = f^2 (T / T_i)^3`, and `f T <= T_i`: it is at most 1 for f = 1, and at most
/// `q = max(1, T_1 / T_alpha)` otherwise. From T_gamma = rho |w| / (v_b s), for s >= rho its slopes are at most
/// 3 / v_b and 1 / v_b. For s < rho they are at most 3 rho^2 / (v_b |w| s) and rho^3 / (v_b |w| s^2), and
/// T / T_i <= T_1 v_b s / (rho |w|) once or twice leaves 3 T_1 / |w| and T_1^2 v_b / |w|^2. dT/df is at most
/// T_1 q, and the slopes of f are 3 / reach.
fn gradient(model: &GrowthModel, trunk: f64, distances: &[f64]) -> f64 {
    let slope = |reach: Reach| 3.0 / reach.along + 3.0 / reach.across;
    let of_fade = model.settings.reach.map_or(0.0, slope);
    let of_branch = |(branch, w): (&GrowingBranch, &f64)| {
        let v = branch.thickening;
        let faded = |_| (trunk / branch.start_time).max(1.0);
        let q = model.settings.reach.map_or(1.0, faded);
        let across = 3.0 * q / v + 3.0 * trunk / w;
        let along = q / v + trunk * trunk * v / (w * w);
        q / model.settings.elongation + across + along + of_fade * trunk * q
    };
    trunk_gradient(model)
        + model
            .branches
            .iter()
            .zip(distances)
            .map(of_branch)
            .sum::<f64>()
}

#[test]
fn with_branches_neighbours_differ_by_the_gradient_outside_balls_round_the_starts() {
    // The balls are 3 mm in radius; within, T depends on the direction from the start.
    let ball = 3.0;
    for reach in [
        None,
        Some(Reach {
            along: 200.0,
            across: 60.0,
        }),
    ] {
        let model = GrowthModel::new(
            &tree(),
            GrowthSettings {
                reach,
                ..settings(2.0)
            },
        )
        .unwrap();
        for branch in &model.branches {
            let axis = branch.direction;
            let (right, down) = (axis * 0.25, DVec3::new(0.02, 0.1, 0.22));
            let rows = slice(branch.start - (right + down) * 80.0, right, down, 160);
            for_neighbours(&model, &rows, |a, b, difference, largest| {
                let step = a.distance(b);
                let distances: Vec<f64> = model
                    .branches
                    .iter()
                    .map(|branch| branch.start.distance(a) - step)
                    .collect();
                if distances.iter().all(|distance| *distance > ball) {
                    let trunk = model.trunk_time(a) + step * trunk_gradient(&model);
                    let bound = gradient(&model, trunk, &distances);
                    assert!(
                        difference <= step * bound + 1e-5 * largest,
                        "{a} {b}: {difference}"
                    );
                }
            });
        }
    }
}

/// One-sided slopes of T along `direction` at `point`.
fn slopes(model: &GrowthModel, point: DVec3, direction: DVec3) -> [f64; 2] {
    // Second order, so that curvature does not pass for a kink.
    let time = |distance: f64| model.terms(point + direction * distance).time;
    let one_sided = |h: f64| (4.0 * time(h) - time(2.0 * h) - 3.0 * time(0.0)) / (2.0 * h);
    [one_sided(-1e-3), one_sided(1e-3)]
}

#[test]
fn the_fade_has_no_kink_where_it_begins_and_ends() {
    let reach = Reach {
        along: 200.0,
        across: 60.0,
    };
    for sharpness in [2.0, 3.3, 8.0] {
        let settings = GrowthSettings {
            reach: Some(reach),
            ..settings(sharpness)
        };
        let mut skeleton = tree();
        skeleton.branches.truncate(1);
        let model = GrowthModel::new(&skeleton, settings).unwrap();
        let branch = model.branches[0];
        let aside = branch.direction.any_orthonormal_vector();
        let along = [100.0, 200.0].map(|s| (branch.direction * s + aside * 25.0, branch.direction));
        let across = [30.0, 60.0].map(|rho| (branch.direction * 60.0 + aside * rho, aside));
        for (offset, direction) in along.into_iter().chain(across) {
            let [before, after] = slopes(&model, branch.start + offset, direction);
            assert!(
                (before - after).abs() < 1e-5,
                "{offset}: {before} and {after}"
            );
        }
    }
}

#[test]
fn across_the_plane_of_a_start_there_is_no_kink() {
    let model = GrowthModel::new(&tree(), settings(2.0)).unwrap();
    for branch in &model.branches {
        let aside = branch.direction.any_orthonormal_vector();
        for rho in [20.0, 50.0, 150.0] {
            let [before, after] = slopes(&model, branch.start + aside * rho, branch.direction);
            assert!((before - after).abs() < 1e-5);
        }
    }
}

#[test]
fn where_trunk_and_branch_meet_the_time_is_shortened_by_the_root_of_two() {
    let model = GrowthModel::new(&tree(), settings(2.0)).unwrap();
    let branch = model.branches[0];
    let aside = branch.direction.any_orthonormal_vector();
    // Bisects for the border T_2 = T_1 between the axis and a point far from it.
    let [mut inside, mut outside] = [0.0, 100.0];
    let at = |rho: f64| model.terms(branch.start + branch.direction * 80.0 + aside * rho);
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        let terms = at(middle);
        let earlier = terms.branches[0].is_some_and(|branch| branch.time() < terms.trunk);
        *(if earlier { &mut inside } else { &mut outside }) = middle;
    }
    let terms = at(inside);
    let alone = GrowthModel {
        branches: vec![branch],
        ..model.clone()
    };
    let border = alone.terms(branch.start + branch.direction * 80.0 + aside * inside);
    assert!((border.time * 2f64.sqrt() - terms.trunk).abs() < 1e-9);
    assert!((border.branch - 0.5).abs() < 1e-9);
}
