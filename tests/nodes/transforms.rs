//! Things that are moved, turned, scaled.

use super::*;
use std::collections::BTreeMap;
use yosegi::node::{Build, Inputs};
use yosegi::value::{Domain, Material, Value};

const SOURCE: &str = "\"place\": position(), \"height\": remap(value: \"= (place.x + 10 * place.y + 100 * place.z) / 1 mm\", beyond: extend)";

fn moved(rest: &str, point: [f64; 3]) -> f32 {
    let nodes = format!("{SOURCE}, \"example\": transform_field(value: \"height\"{rest})");
    number(&field(&nodes, "value"), &[point])[0]
}

#[test]
fn points_show_what_was_at_their_place_before() {
    let point = [3.0, 5.0, 7.0];
    assert_eq!(moved("", point), 753.0);
    assert_eq!(moved(", move: (1, 2, 4)", point), 332.0);
    // Against the clock about z: (3, 5) was at (5, -3).
    assert_eq!(moved(", turn: (0, 0, 90)", point), 675.0);
    // About x: (y, z) = (5, 7) was at (7, -5). About y: (z, x) = (7, 3) was at (3, -7).
    assert_eq!(moved(", turn: (90, 0, 0)", point), -427.0);
    assert_eq!(moved(", turn: (0, 90, 0)", point), -7.0 + 50.0 + 300.0);
    assert_eq!(moved(", scale: (3, 5, -7)", point), 1.0 + 10.0 - 100.0);
    assert_eq!(moved(", scale: (2, 2, 2), pivot: (3, 5, 7)", point), 753.0);
    // x first: z turns to -y, then by z to x.
    assert_eq!(moved(", turn: (90, 0, 90)", [7.0, 0.0, 0.0]), 700.0);
    // Scaled along its own axis, then turned: x becomes y.
    assert_eq!(
        moved(", turn: (0, 0, 90), scale: (2, 1, 1)", [0.0, 6.0, 0.0]),
        3.0
    );
}

#[test]
fn a_turn_and_its_reverse_change_nothing() {
    let nodes = format!(
        "{SOURCE}, \"there\": transform_field(value: \"height\", turn: (0, 0, 37), move: (4, 5, 0), pivot: (1, 1, 0)),
        \"example\": transform_field(value: \"there\", turn: (0, 0, -37), pivot: (5, 6, 0), move: (-4, -5, 0))"
    );
    let points: Vec<[f64; 3]> = (0..50)
        .map(|i| [f64::from(i), f64::from(i * 7 % 11), 2.0])
        .collect();
    let found = number(&field(&nodes, "value"), &points);
    for (point, found) in points.iter().zip(found) {
        let expected = point[0] + 10.0 * point[1] + 100.0 * point[2];
        assert!(
            (f64::from(found) - expected).abs() < 1e-3,
            "{found}, not {expected}"
        );
    }
}

#[test]
fn vectors_turn_as_what_they_are() {
    let vector = |rest: &str| {
        let nodes = format!("\"example\": transform_field(vector: (1, 1, 0){rest})");
        let columns = at(&field(&nodes, "vector"), &[[0.0; 3]]);
        columns
            .into_iter()
            .map(|column| column[0])
            .collect::<Vec<f32>>()
    };
    let close = |found: Vec<f32>, expected: [f64; 3]| {
        let apart = found
            .iter()
            .zip(expected)
            .map(|(a, b)| (f64::from(*a) - b).abs());
        assert!(
            apart.fold(0.0, f64::max) < 1e-6,
            "{found:?}, not {expected:?}"
        );
    };
    close(vector(", turn: (0, 0, 90)"), [-1.0, 1.0, 0.0]);
    close(
        vector(", turn: (0, 0, 90), vectors: values"),
        [1.0, 1.0, 0.0],
    );
    // A line along (1, 1) becomes one along (2, 1); the normal of a surface goes the other way: (1/2, 1).
    let long = (2.0f64 / 5.0).sqrt();
    close(vector(", scale: (2, 1, 1)"), [2.0 * long, long, 0.0]);
    close(
        vector(", scale: (2, 1, 1), vectors: normals"),
        [long, 2.0 * long, 0.0],
    );
}

/// A kind's output for these inputs; the others have their place left empty.
fn built(kind: &str, inputs: &[(&str, Value)]) -> Arc<Material> {
    let kind = yosegi::nodes::kind(kind).unwrap();
    let mut values = vec![None; kind.inputs.len()];
    for (name, value) in inputs {
        values[kind.input(name).unwrap().0] = Some(value.clone());
    }
    let build = Build {
        node: &Arc::from("test"),
        seed: 0,
        cancel: None,
    };
    match (kind.build)(&Inputs::new(kind, &values), &build)
        .unwrap()
        .remove(0)
    {
        Value::Material(material) => material,
        other => panic!("found a {}", other.type_name()),
    }
}

fn with_fibre(direction: [f64; 3]) -> Value {
    let channels = [
        ("base_color", Field::constants(&[0.2, 0.4, 0.6])),
        ("fibre", Field::constants(&direction)),
    ];
    let channels = channels.map(|(name, field)| (name.to_owned(), field));
    Value::Material(Arc::new(Material {
        domain: Domain::Everywhere,
        channels: BTreeMap::from(channels),
        size: None,
        surface: None,
    }))
}

fn fibre(material: &Material) -> Vec<f32> {
    let columns = at(&material.channels["fibre"], &[[1.0, 2.0, 3.0]]);
    columns.into_iter().map(|column| column[0]).collect()
}

#[test]
fn fibres_turn_with_their_material_and_blend_as_axes() {
    let vector = |x, y, z| Value::Vector(glam::DVec3::new(x, y, z));
    let turned = built(
        "transform",
        &[
            ("of", with_fibre([1.0, 0.0, 0.0])),
            ("move", vector(0.0, 0.0, 0.0)),
            ("turn", vector(0.0, 0.0, 90.0)),
            ("scale", vector(1.0, 3.0, 1.0)),
            ("pivot", vector(0.0, 0.0, 0.0)),
        ],
    );
    assert_eq!(fibre(&turned), [0.0, 1.0, 0.0]);
    let blended = built(
        "blend",
        &[
            ("a", with_fibre([1.0, 0.0, 0.0])),
            ("b", with_fibre([-0.6, -0.8, 0.0])),
            ("mask", Value::Number(0.5)),
            ("by", Value::Choice("mask")),
        ],
    );
    // Half-way between (1, 0) and (0.6, 0.8).
    let root = 5f32.sqrt();
    let apart = fibre(&blended)
        .iter()
        .zip([2.0 / root, 1.0 / root, 0.0])
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    assert!(apart < 1e-6, "{:?}", fibre(&blended));
}

#[test]
fn what_leaves_nothing_or_leads_out_of_the_plane_is_refused() {
    let told = |nodes: &str, words: &str| {
        let message = refused(nodes);
        assert!(message.contains(words), "{message}");
    };
    told(
        "\"example\": transform_field(value: 1, scale: (1, 0, 1))",
        "nothing would be left",
    );
    let flat = |rest: &str| {
        format!(
            "\"waves\": plane_noise(size: (9, 9, 9)), \"example\": transform_field(value: \"waves\"{rest})"
        )
    };
    told(
        &flat(", move: (0, 0, 1)"),
        "`move` leads out of the flat piece",
    );
    told(&flat(", turn: (10, 0, 0)"), "`turn` leads out");
    told(&flat(", scale: (1, 1, 2)"), "`scale` leads out");
    told(
        "\"waves\": plane_noise(size: (9, 9, 9)), \"more\": solid_noise(size: (9, 9, 9)),
        \"example\": transform_field(value: \"waves\", vector: \"more.vector\")",
        "mixes a plane field",
    );
}

#[test]
fn transformed_fields_keep_the_contract() {
    let nodes = "\"place\": position(),
        \"stripes\": ramp(value: \"= (place.x + 0.2 * place.y) / 9.7 mm\", ends: repeat, curve: step, stops: [
            (at: 0, colour: \"#ff3333\"), (at: 0.35, colour: \"#111111\"), (at: 0.6, colour: \"#22dd88\")]),
        \"example\": transform_field(colour: \"stripes\", turn: (10, 20, 55), scale: (0.4, 2, 1), move: (3, 4, 5))";
    keeps_the_contract("transform_field", &field(nodes, "colour"), 64.0, 1.0);
}
