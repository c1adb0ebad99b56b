//! Numbers: remap, threshold, ramp, math, parts and vectors.

use super::*;

const FIVE: [[f64; 3]; 5] = [
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.25, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [2.25, 0.0, 0.0],
];

/// A node over x, where the points of [`FIVE`] differ.
fn over_x(node: &str) -> String {
    format!("\"place\": position(), \"example\": {node}")
}

fn values(node: &str, output: &str) -> Vec<f32> {
    number(&field(&over_x(node), output), &FIVE)
}

fn nearly(found: &[f32], expected: &[f32]) {
    let close = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (a - b).abs() <= 2e-6 * b.abs().max(1.0));
    assert!(
        found.len() == expected.len() && close,
        "{found:?}, not {expected:?}"
    );
}

#[test]
fn remap_has_its_values_at_and_beyond_its_ends() {
    let remap = |rest: &str| {
        values(
            &format!("remap(value: \"= place.x / 1 mm\", to: (10, 20){rest})"),
            "value",
        )
    };
    nearly(&remap(""), &[10.0, 10.0, 12.5, 20.0, 20.0]);
    nearly(&remap(", beyond: extend"), &[0.0, 10.0, 12.5, 20.0, 32.5]);
    nearly(&remap(", beyond: repeat"), &[10.0, 10.0, 12.5, 10.0, 12.5]);
    nearly(&remap(", beyond: mirror"), &[20.0, 10.0, 12.5, 20.0, 12.5]);
    // 3/16 - 2/64 = 5/32.
    nearly(
        &remap(", curve: smooth"),
        &[10.0, 10.0, 11.5625, 20.0, 20.0],
    );
    nearly(&remap(", from: (1, 0)"), &[20.0, 20.0, 17.5, 10.0, 10.0]);
}

#[test]
fn a_threshold_is_half_at_its_edge() {
    let threshold = |rest: &str| {
        values(
            &format!("threshold(value: \"= place.x / 1 mm\", edge: 0.25{rest})"),
            "mask",
        )
    };
    assert_eq!(threshold(""), [0.0, 0.0, 1.0, 1.0, 1.0]);
    nearly(
        &threshold(", width: 1, curve: linear"),
        &[0.0, 0.25, 0.5, 1.0, 1.0],
    );
    nearly(&threshold(", width: 1"), &[0.0, 0.15625, 0.5, 1.0, 1.0]);
}

#[test]
fn a_hard_edge_covers_pixels_by_their_area() {
    // x + y / 2 over pixels of 1 mm: an edge at 8.3 crosses them askew.
    let mask = field(
        &over_x("threshold(value: \"= (place.u + place.v / 2) / 1 mm\", edge: 8.3)"),
        "mask",
    );
    let square = |pixels| Square { side: 64.0, pixels };
    let exact = painted(&mask, &square(64), 1, true);
    // Coverage by 64 x 64 points of each pixel.
    for (pixel, found) in exact[0]
        .iter()
        .enumerate()
        .filter(|(_, mask)| (0.01..0.99).contains(*mask))
    {
        let (left, below) = ((pixel % 64) as f64, 63.0 - (pixel / 64) as f64);
        let inside = (0..4096).filter(|index| {
            let [x, y] = [index % 64, index / 64].map(|part| (f64::from(part) + 0.5) / 64.0);
            left + x + (below + y) / 2.0 >= 8.3
        });
        let covered = inside.count() as f64 / 4096.0;
        assert!(
            (found - covered).abs() < 4e-3,
            "{found}, not {covered} at {left}, {below}"
        );
    }
}

#[test]
fn stops_of_a_ramp_are_met_and_its_ends_hold_or_repeat() {
    let ramp = |rest: &str| {
        let stops = "[(at: 0, value: 2), (at: 0.5, value: 4), (at: 1, value: 1)]";
        values(
            &format!("ramp(value: \"= place.x / 1 mm\", stops: {stops}{rest})"),
            "value",
        )
    };
    nearly(&ramp(""), &[2.0, 2.0, 3.0, 1.0, 1.0]);
    nearly(&ramp(", curve: step"), &[2.0, 2.0, 2.0, 1.0, 1.0]);
    nearly(&ramp(", curve: smooth"), &[2.0, 2.0, 3.0, 1.0, 1.0]);
    // Flat at all three stops, since the middle one is a peak: as smooth as the S.
    nearly(&ramp(", curve: monotone"), &[2.0, 2.0, 3.0, 1.0, 1.0]);
    nearly(&ramp(", ends: repeat"), &[2.0, 2.0, 3.0, 2.0, 3.0]);
    // From 1 back to 2 between 1 and 3: -1 is as 2, 2.25 lies 1.25 of 2 on the way.
    nearly(
        &ramp(", ends: repeat, period: 3"),
        &[1.5, 2.0, 3.0, 1.0, 1.625],
    );
}

#[test]
fn a_monotone_ramp_does_not_overshoot_and_is_exact_on_lines() {
    let points: Vec<[f64; 3]> = (0..=400)
        .map(|i| [f64::from(i) / 400.0, 0.0, 0.0])
        .collect();
    let at_points = |stops: &str| {
        let node = format!("ramp(value: \"= place.x / 1 mm\", curve: monotone, stops: {stops})");
        number(&field(&over_x(&node), "value"), &points)
    };
    let steps = at_points(
        "[(at: 0, value: 0), (at: 0.4, value: 0.05), (at: 0.5, value: 3), (at: 1, value: 3.1)]",
    );
    assert!(
        steps.is_sorted() && steps[0] == 0.0 && steps[400] == 3.1,
        "{steps:?}"
    );
    let line = at_points(
        "[(at: -1, value: -1), (at: 0, value: 0), (at: 0.3, value: 0.3), (at: 1, value: 1), (at: 2, value: 2)]",
    );
    let wrong = points
        .iter()
        .zip(&line)
        .find(|(point, value)| (point[0] as f32 - **value).abs() > 1e-6);
    assert_eq!(wrong, None);
}

#[test]
fn two_stops_at_one_place_are_an_edge_also_at_the_ends() {
    let ramp = |stops: &str| {
        values(
            &format!("ramp(value: \"= place.x / 1 mm\", stops: {stops})"),
            "value",
        )
    };
    let edge = ramp("[(at: 0.25, value: 1), (at: 0.25, value: 5)]");
    assert_eq!(edge, [1.0, 1.0, 5.0, 5.0, 5.0]);
    let ends = ramp("[(at: 0, value: 9), (at: 0, value: 0), (at: 1, value: 1), (at: 1, value: 7)]");
    nearly(&ends, &[9.0, 0.0, 0.25, 7.0, 7.0]);
    assert_eq!(ramp("[(at: 3, value: 4)]"), [4.0; 5]);
}

#[test]
fn functions_have_their_values() {
    let math = |operation: &str, b: f64| {
        values(
            &format!("math(operation: {operation}, a: \"= place.x / 1 mm\", b: {b})"),
            "value",
        )
    };
    nearly(&math("power", 2.0), &[0.0, 0.0, 0.0625, 1.0, 5.0625]);
    nearly(&math("exponential", 0.0)[1..2], &[1.0]);
    nearly(&math("logarithm", 0.0)[3..4], &[0.0]);
    nearly(&math("sine", 0.0), &[0.0, 0.0, 1.0, 0.0, 1.0]);
    nearly(&math("cosine", 0.0), &[1.0, 1.0, 0.0, 1.0, 0.0]);
    nearly(&math("arctangent", 0.25)[1..3], &[0.0, 0.125]);
    nearly(&math("floor", 0.0), &[-1.0, 0.0, 0.0, 1.0, 2.0]);
    nearly(&math("modulo", 0.75), &[0.5, 0.0, 0.25, 0.25, 0.0]);
}

#[test]
fn parts_combine_and_separate() {
    let nodes =
        "\"place\": position(), \"v\": combine(x: \"= place.x / 1 mm\", y: 4, z: \"= 3 * place.z / 1 mm\"),
        \"example\": separate(vector: \"v.vector\")";
    let points = [[2.0, 0.0, 1.0], [0.0, 9.0, -1.0]];
    let part = |name: &str| number(&field(nodes, name), &points);
    assert_eq!(
        [part("x"), part("y"), part("z")],
        [[2.0, 0.0], [4.0, 4.0], [3.0, -3.0]]
    );
    nearly(&part("length"), &[29f32.sqrt(), 5.0]);
}

#[test]
fn vectors_add_multiply_cross_and_have_directions() {
    let result = |operation: &str, output: &str| {
        let nodes = format!(
            "\"example\": vector_math(operation: {operation}, a: (1, 2, 2), b: (3, 0, -1))"
        );
        let columns = at(&field(&nodes, output), &[[0.0; 3]]);
        columns
            .into_iter()
            .map(|column| column[0])
            .collect::<Vec<_>>()
    };
    assert_eq!(result("add", "vector"), [4.0, 2.0, 1.0]);
    assert_eq!(result("subtract", "vector"), [-2.0, 2.0, 3.0]);
    assert_eq!(result("multiply", "vector"), [3.0, 0.0, -2.0]);
    assert_eq!(result("cross", "vector"), [-2.0, 7.0, -6.0]);
    nearly(
        &result("normalise", "vector"),
        &[1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0],
    );
    assert_eq!(result("add", "dot"), [1.0]);
    nearly(&result("add", "length"), &[21f32.sqrt()]);
}

#[test]
fn mistakes_are_told_with_what_to_do() {
    let told = |node: &str, words: &str| {
        let message = refused(&over_x(node));
        assert!(message.contains(words), "{message}");
    };
    told(
        "remap(value: 1, from: (2, 2))",
        "the range is empty: 2 to 2",
    );
    told(
        "remap(value: 1, curve: smooth, beyond: extend)",
        "no straight continuation",
    );
    told("math(operation: modulo, a: 1, b: 0)", "nothing is left");
    told("separate()", "neither `colour` nor `vector` is set");
    told(
        "separate(colour: \"#ffffff\", vector: (1, 2, 3))",
        "both `colour` and `vector`",
    );
    told("ramp(value: 1, stops: [])", "at least one stop");
    told(
        "ramp(value: 1, stops: [(at: 1)])",
        "neither `colour` nor `value`",
    );
    told(
        "ramp(value: 1, stops: [(at: 0, value: 1), (at: 1, colour: \"#ffffff\")])",
        "stop 2 is unlike",
    );
    told(
        "ramp(value: 1, stops: [(at: 1, value: 1), (at: 0, value: 1)])",
        "stands before the stop at 1",
    );
    told(
        "ramp(value: 1, period: 2, stops: [(at: 1, value: 1)])",
        "has no period",
    );
    told(
        "ramp(value: 1, ends: repeat, stops: [(at: 0, value: 1), (at: 3, value: 1)])",
        "lies behind the end of the period at 1",
    );
}

/// Noise with features of some ten pixels of 64, for what is not linear.
const NOISE: &str = "\"noise\": solid_noise(size: (30, 30, 30), octaves: 2)";

#[test]
fn profiles_of_noise_and_of_fine_waves_keep_the_contract() {
    let over_noise =
        |node: &str, output: &str| field(&format!("{NOISE}, \"example\": {node}"), output);
    let over_fine = |node: &str, output: &str| {
        field(
            &format!(
                "\"place\": position(), \"example\": {}",
                node.replace("noise", "= (place.x + 0.3 * place.y) / 2.3 mm")
            ),
            output,
        )
    };
    let threshold = "threshold(value: \"noise\", edge: 0.05)";
    let remap = "remap(value: \"noise\", from: (0, 0.4), beyond: mirror)";
    let ramp = "ramp(value: \"noise\", ends: repeat, period: 0.4, curve: step, stops: [
        (at: 0, colour: \"#ffffff\"), (at: 0.1, colour: \"#000000\"), (at: 0.3, colour: \"#0088ff\")])";
    keeps_the_contract("threshold", &over_noise(threshold, "mask"), 256.0, 1.0);
    keeps_the_contract("remap", &over_noise(remap, "value"), 256.0, 1.0);
    keeps_the_contract("ramp", &over_noise(ramp, "colour"), 256.0, 1.0);
    // Two periods a pixel.
    keeps_the_contract("fine ramp", &over_fine(ramp, "colour"), 64.0, 1.0);
    keeps_the_contract("fine remap", &over_fine(remap, "value"), 256.0, 1.0);
    keeps_the_contract(
        "sine",
        &over_fine("math(operation: sine, a: \"noise\")", "value"),
        256.0,
        2.0,
    );
}
