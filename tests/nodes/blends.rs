//! Whole materials blended.

use super::*;

const MATERIALS: &str = "\"place\": position(),
    \"a\": material(base_color: (0.8, 0.4, 0.2), height: \"= place.x\", roughness: 0.2, extras: {\"age\": 40, \"tint\": (1, 0, 0)}),
    \"b\": material(base_color: (0, 0.4, 1), height: 10, roughness: 0.6, extras: {\"wet\": 1})";

fn blended(rest: &str, channel: &str, points: &[[f64; 3]]) -> Vec<Vec<f32>> {
    let nodes = format!("{MATERIALS}, \"example\": blend(a: \"a\", b: \"b\"{rest})");
    at(&field(&nodes, channel), points)
}

#[test]
fn every_channel_of_both_is_there_and_mixed() {
    let origin = [[4.0, 0.0, 0.0]];
    let channel = |name: &str| {
        blended(", mask: 0.25", name, &origin)
            .into_iter()
            .map(|column| column[0])
            .collect::<Vec<_>>()
    };
    let close = |found: Vec<f32>, expected: &[f32]| {
        let apart = found
            .iter()
            .zip(expected)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max);
        assert!(
            found.len() == expected.len() && apart < 1e-6,
            "{found:?}, not {expected:?}"
        );
    };
    close(channel("base_color"), &[0.6, 0.4, 0.4]);
    close(channel("height"), &[5.5]);
    close(channel("roughness"), &[0.3]);
    close(channel("opacity"), &[1.0]);
    // What one lacks is 0 or black ..
    close(channel("age"), &[30.0]);
    close(channel("tint"), &[0.75, 0.0, 0.0]);
    close(channel("wet"), &[0.25]);
    // .. unless it is stated.
    let stated = blended(
        ", mask: 0.25, missing: {\"age\": 80, \"tint\": (1, 1, 1)}",
        "age",
        &origin,
    );
    close(stated[0].clone(), &[50.0]);
}

#[test]
fn the_higher_material_wins_by_height() {
    // `a` is as high as x, `b` is 10 mm high.
    let points = [4.0, 9.0, 10.0, 11.0, 16.0].map(|x| [x, 0.0, 0.0]);
    let roughness = |rest: &str| {
        blended(
            &format!(", by: height, transition: 4{rest}"),
            "roughness",
            &points,
        )
        .remove(0)
    };
    let even = roughness("");
    // A quarter into the S: 3/16 - 2/64 = 0.15625 of the way from 0.6 to 0.2.
    for (found, expected) in even.iter().zip([0.6, 0.5375, 0.4, 0.2625, 0.2]) {
        assert!((found - expected).abs() < 1e-6, "{even:?}");
    }
    // The mask of 0.75 raises `b` by half of the reach: its 10 mm count as 16.
    let raised = roughness(", mask: 0.75, reach: 12");
    assert!(
        raised[..4].iter().all(|it| (it - 0.6).abs() < 1e-6) && (raised[4] - 0.4).abs() < 1e-6,
        "{raised:?}"
    );
}

#[test]
fn what_cannot_be_blended_is_refused() {
    let told = |rest: &str, words: &str| {
        let message = refused(&format!(
            "{MATERIALS}, \"example\": blend(a: \"a\", b: \"b\"{rest})"
        ));
        assert!(message.contains(words), "{message}");
    };
    told(", by: height", "needs `transition`");
    told(", transition: 1", "not blended by height");
    told(
        ", missing: {\"ages\": 1}",
        "neither material has a channel `ages`",
    );
    told(", missing: {\"ages\": 1}", "did you mean `age`?");
    told(
        ", missing: {\"height\": 1}",
        "both materials have the channel `height`",
    );
    told(
        ", missing: {\"age\": (1, 0, 0)}",
        "the channel `age` is a number in `a` and a colour in `b`",
    );
    let pieces = "\"wood\": material(base_color: \"#c8a06e\", extras: {\"x\": \"= place.x / 1 mm\"}), \"place\": position(),
        \"a\": slice_cut(of: \"wood\", cut: end_grain, origin: (0, 0, 1), size: (10, 20)),
        \"b\": slice_cut(of: \"wood\", cut: end_grain, origin: (0, 0, 1), size: (10, 30)),
        \"example\": blend(a: \"a\", b: \"b\")";
    let message = refused(pieces);
    assert!(
        message.contains("`a` is a piece of 10 x 20 mm, `b` one of 10 x 30 mm"),
        "{message}"
    );
}

#[test]
fn blends_keep_the_contract() {
    let nodes = "\"place\": position(), \"noise\": solid_noise(size: (30, 30, 30), octaves: 2),
        \"low\": material(base_color: (0.05, 0.1, 0.4)),
        \"high\": material(base_color: (0.9, 0.7, 0.3), height: \"= 2 * noise\")";
    let masked = format!(
        "{nodes}, \"mask\": threshold(value: \"noise\", edge: 0.1),
        \"example\": blend(a: \"low\", b: \"high\", mask: \"mask\")"
    );
    keeps_the_contract("blend by mask", &field(&masked, "base_color"), 256.0, 1.0);
    let by_height = format!(
        "{nodes}, \"example\": blend(a: \"low\", b: \"high\", by: height, transition: 0.05)"
    );
    keeps_the_contract(
        "blend by height",
        &field(&by_height, "base_color"),
        256.0,
        1.0,
    );
}
