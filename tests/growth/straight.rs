//! The straight skeleton: known numbers, its published defects, and the kernel against double precision.

use super::{field, grow_at, levels::levels, scattered, tree};
use fearless_simd::Level;
use glam::DVec3;
use serde_json::Value;
use yosegi::field::{Program, RunContext, Samples, Scratch};
use yosegi::nodes::wood::growth::{GrowthModel, GrowthSettings, Region, Seen, StraightTrunk};
use yosegi::value::{Skeleton, Tangents};

fn vectors() -> Value {
    let text = include_str!("../data/spec-vectors.json");
    serde_json::from_str::<Value>(text).unwrap()["wood_straight"].clone()
}

fn points(value: &Value) -> Vec<DVec3> {
    let number = |value: &Value| value.as_f64().unwrap();
    let point = |value: &Value| DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]));
    value.as_array().unwrap().iter().map(point).collect()
}

/// The bent trunk of the paper's figure 3.
fn bent() -> GrowthModel {
    let skeleton = Skeleton {
        trunk: points(&vectors()["nodes"]),
        tangents: Tangents::Natural,
        branches: vec![],
    };
    let settings = GrowthSettings {
        elongation: 1.0,
        thickening: 0.05,
        sharpness: 2.0,
        reach: None,
    };
    GrowthModel::straight(&skeleton, settings, None).unwrap()
}

fn see(model: &GrowthModel, point: DVec3) -> Seen {
    model.trunk.straight().unwrap().see(point)
}

#[test]
fn times_and_regions_are_the_known_ones() {
    let (vectors, model) = (vectors(), bent());
    let points = points(&vectors["points"]);
    let found = grow_at(&model, &points);
    for (index, point) in points.iter().enumerate() {
        let expected = vectors["T_smooth"][index].as_f64().unwrap();
        assert!(
            (model.trunk_time(*point) - expected).abs() < 1e-12,
            "{point}"
        );
        assert!(
            (f64::from(found.time[index]) - expected).abs() < 1e-5 * 20.0,
            "{point}"
        );
        let member = vectors["kind"][index][1].as_u64().unwrap() as usize;
        let region = match vectors["kind"][index][0].as_str().unwrap() {
            "seg" => Region::Segment(member),
            "blend" => Region::Blend(member),
            _ => Region::Node(member),
        };
        assert_eq!(see(&model, *point).region, region, "{point}");
    }
}

#[test]
fn it_jumps_where_the_paper_shows_it() {
    let model = bent();
    let nodes = model.trunk.straight().unwrap().nodes();
    let (middle, along) = (
        nodes[1].midpoint(nodes[2]),
        (nodes[2] - nodes[1]).normalize(),
    );
    let across = DVec3::new(along.z, 0.0, -along.x);
    let known = [
        (-3.0, 0.0),
        (-1.5, 1.417),
        (-1.0, 1.307),
        (-0.5, 0.0),
        (0.0, 0.0),
        (0.5, 0.0),
        (1.0, -0.867),
        (3.0, 0.0),
    ];
    for (distance, expected) in known {
        let place = middle + across * distance;
        let jump = model.trunk_time(place + along * 1e-9) - model.trunk_time(place - along * 1e-9);
        assert!((jump - expected).abs() < 6e-4, "{distance}: {jump}");
    }
}

#[test]
fn blends_meet_both_neighbours() {
    let model = bent();
    let node = model.trunk.straight().unwrap().nodes()[1];
    let [before, after] = model
        .trunk
        .straight()
        .unwrap()
        .directions(1)
        .map(Option::unwrap);
    // On the plane across the first segment only the second counts, and the other way round.
    let sides = [
        (before, DVec3::new(0.4, 0.0, 0.0)),
        (after, DVec3::new(after.z, 0.0, -after.x) * 0.4),
    ];
    for (direction, offset) in sides {
        let at = |step: f64| model.trunk_time(node + offset + direction * step);
        assert!((at(1e-9) - at(-1e-9)).abs() < 1e-6, "{direction}");
    }
}

#[test]
fn the_kernel_is_within_a_hundred_thousandth_of_the_largest() {
    let settings = super::settings(2.0);
    for skeleton in [tree(), many_nodes()] {
        let model = GrowthModel::straight(&skeleton, settings, None).unwrap();
        let trunk = model.trunk.straight().unwrap();
        let points = scattered(
            4000,
            DVec3::new(-300.0, -300.0, -100.0),
            DVec3::new(300.0, 300.0, 2500.0),
        );
        let points: Vec<DVec3> = points
            .into_iter()
            .filter(|point| is_off_jumps(trunk, *point))
            .collect();
        assert!(points.len() > 3000);
        let found = grow_at(&model, &points);
        let expected: Vec<f64> = points
            .iter()
            .map(|point| model.terms(*point).time)
            .collect();
        let largest = expected
            .iter()
            .fold(0.0f64, |most, time| most.max(time.abs()));
        for (index, expected) in expected.iter().enumerate() {
            let off = (f64::from(found.time[index]) - expected).abs();
            assert!(
                off < 1e-5 * largest,
                "{}: {off} of {largest}",
                points[index]
            );
        }
    }
}

#[test]
fn every_level_gives_the_same_bits() {
    let model = GrowthModel::straight(&tree(), super::settings(2.0), None).unwrap();
    let points = scattered(999, DVec3::splat(-300.0), DVec3::new(300.0, 300.0, 2500.0));
    let points: Vec<[f64; 3]> = points.iter().map(DVec3::to_array).collect();
    let program = Program::compile(&[field(&model)]);
    let bits = |level: Level| -> Vec<u32> {
        let mut scratch = Scratch::default();
        let context = RunContext {
            level,
            cache: None,
            filtering: true,
            cancel: None,
        };
        program.run(&Samples::Points(&points), &mut scratch, &context);
        program
            .output(&scratch, 0, 0)
            .iter()
            .map(|value| value.to_bits())
            .collect()
    };
    let baseline = bits(Level::baseline());
    assert!(levels().into_iter().all(|level| bits(level) == baseline));
}

/// A trunk of 200 short segments.
fn many_nodes() -> Skeleton {
    let node = |index: i32| {
        let z = 12.0 * f64::from(index);
        DVec3::new(20.0 * libm::sin(0.004 * z), 15.0 * libm::cos(0.003 * z), z)
    };
    Skeleton {
        trunk: (0..200).map(node).collect(),
        ..tree()
    }
}

/// Whether no two nodes are about equally far: there rounding may choose the other one.
fn is_off_jumps(trunk: &StraightTrunk, point: DVec3) -> bool {
    let mut distances: Vec<f64> = trunk
        .nodes()
        .iter()
        .map(|node| node.distance(point))
        .collect();
    distances.sort_by(f64::total_cmp);
    distances[1] - distances[0] > 1e-3
}
