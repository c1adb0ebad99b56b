//! The measured spruce log: 400 sections of pith, 108 knots.

use super::{grow_at, nodes, rounded, settings};
use glam::DVec3;
use std::sync::Arc;
use yosegi::nodes::wood::growth::{GrowthModel, GrowthSettings, Reach};
use yosegi::value::{Skeleton, Thickness, Value};

const PITH: &[u8] = include_bytes!("../../assets/spruce_log/Gran_1_pith.json");
const KNOTS: &[u8] = include_bytes!("../../assets/spruce_log/Gran_1_knots.json");

fn log(every: i64) -> Arc<Skeleton> {
    nodes::skeleton_from_file(PITH, Some(KNOTS), every).unwrap()
}

#[test]
fn the_log_has_all_its_sections_and_knots() {
    let whole = log(1);
    assert_eq!((whole.trunk.len(), whole.branches.len()), (400, 108));
    assert_eq!(
        whole.trunk[0],
        DVec3::new(184.201146323, 169.696890477, 0.0)
    );
    let coarse = log(25);
    assert_eq!((coarse.trunk.len(), coarse.branches.len()), (17, 108));
    assert_eq!(coarse.trunk[16], whole.trunk[399]);
    assert_eq!(coarse.trunk[1], whole.trunk[25]);
}

#[test]
fn the_first_knot_is_the_chord_to_its_end() {
    // A..H of the first row; radians and mm.
    let (a, b, c, f, g, h) = (0.128486, -0.0411172, 70.0002, 3.04019, 0.0354012, 65.3057);
    let skeleton = log(1);
    let branch = &skeleton.branches[0];
    assert_eq!(branch.height, c);
    let azimuth: f64 = f + g * libm::log(h);
    let expected = DVec3::new(libm::cos(azimuth), libm::sin(azimuth), 0.0);
    // D and E of this knot are millionths: it is horizontal.
    assert!(branch.direction.distance(expected) < 1e-4);
    let Thickness::HalfWidth {
        distance,
        half_width,
    } = branch.thickness
    else {
        panic!("expected a half width")
    };
    assert!((distance - h).abs() < 1e-2);
    assert!((half_width - h * libm::tan(0.5 * (a + b * libm::pow(h, 0.25)))).abs() < 1e-9);
}

#[test]
fn every_knot_has_its_measured_thickness_at_the_bark() {
    let skeleton = log(1);
    let model = GrowthModel::new(&skeleton, settings(2.0)).unwrap();
    for (branch, growing) in skeleton.branches.iter().zip(&model.branches) {
        let Thickness::HalfWidth {
            distance,
            half_width,
        } = branch.thickness
        else {
            panic!("expected a half width")
        };
        let end = growing.start + growing.direction * distance;
        let border = end + growing.direction.any_orthonormal_vector() * half_width;
        let alone = GrowthModel {
            branches: vec![*growing],
            ..model.clone()
        };
        let by_branch = alone.terms(border).branches[0].unwrap().time();
        assert!((by_branch - model.trunk_time(end)).abs() < 1e-9);
    }
}

#[test]
fn inside_a_knot_the_branch_rules_and_between_knots_the_trunk() {
    let reach = Some(Reach {
        along: 250.0,
        across: 40.0,
    });
    let model = GrowthModel::new(
        &log(1),
        GrowthSettings {
            reach,
            ..settings(4.0)
        },
    )
    .unwrap();
    let thick = model
        .branches
        .iter()
        .filter(|branch| branch.thickening > 0.02);
    let inside: Vec<DVec3> = thick
        .map(|branch| branch.start + branch.direction * 60.0)
        .collect();
    assert!(inside.len() > 20, "{}", inside.len());
    assert!(
        grow_at(&model, &inside)
            .branch
            .iter()
            .all(|share| *share > 0.9)
    );
    let clear: Vec<DVec3> = (0..400)
        .map(|i| rounded(model.trunk.at(10.0 * f64::from(i)) + DVec3::new(0.0, 100.0, 0.0)))
        .filter(|point| model.terms(*point).branches.iter().all(Option::is_none))
        .collect();
    assert!(clear.len() > 20);
    assert!(
        grow_at(&model, &clear)
            .branch
            .iter()
            .all(|share| *share == 0.0)
    );
}

#[test]
fn the_kernel_follows_the_log_within_its_precision() {
    let reach = Some(Reach {
        along: 250.0,
        across: 60.0,
    });
    let model = GrowthModel::new(
        &log(1),
        GrowthSettings {
            reach,
            ..settings(2.0)
        },
    )
    .unwrap();
    let outside = |point: &DVec3| {
        model
            .branches
            .iter()
            .all(|b| b.start.distance(*point) > 4.0)
    };
    let points = super::scattered(
        3000,
        DVec3::new(40.0, 40.0, 0.0),
        DVec3::new(320.0, 320.0, 3990.0),
    );
    let points: Vec<DVec3> = points.into_iter().filter(outside).collect();
    let times = grow_at(&model, &points).time;
    let expected: Vec<f64> = points
        .iter()
        .map(|point| model.terms(*point).time)
        .collect();
    let largest = expected.iter().copied().fold(0.0, f64::max);
    let worst = times
        .iter()
        .zip(&expected)
        .map(|(a, b)| (f64::from(*a) - b).abs())
        .fold(0.0, f64::max);
    assert!(worst < 1e-5 * largest, "{worst} of {largest}");
}

#[test]
fn files_that_are_no_log_are_refused_with_the_row() {
    let refused = |pith: &[u8], knots: Option<&[u8]>| {
        let failure = nodes::skeleton_from_file(pith, knots, 1).unwrap_err();
        (failure.input.unwrap(), failure.message)
    };
    let (input, message) = refused(b"[[0, 0, 0], [0, 1, 5], [0, 1, 5]]", None);
    assert_eq!(input, "pith");
    assert_eq!(
        message,
        "expected z to rise from node to node, found z = 5 at node 3 after z = 5"
    );
    let (input, message) = refused(b"[[0, 0, 0], [0, 1]]", None);
    assert_eq!(
        (input, message.as_str()),
        ("pith", "row 2: expected 3 numbers, found 2")
    );
    let (input, message) = refused(PITH, Some(b"[[1, 2, 3, 4, 5, 6, 7, 8, \"x\"]]"));
    assert_eq!(
        (input, message.as_str()),
        ("knots", "row 1: expected a number, found \"x\"")
    );
    let (input, message) = refused(b"[]", None);
    assert_eq!(
        (input, message.as_str()),
        ("pith", "expected at least 2 nodes, found 0")
    );
    assert!(Value::Skeleton(log(1)).type_name() == "skeleton");
}
