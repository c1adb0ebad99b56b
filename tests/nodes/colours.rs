//! Colours: modes of `mix`, and adjustments.

use super::*;

fn colour(nodes: &str) -> [f32; 3] {
    let columns = at(&field(nodes, "colour"), &[[0.0; 3]]);
    [columns[0][0], columns[1][0], columns[2][0]]
}

#[test]
fn modes_have_their_values() {
    let mixed = |mode: &str| {
        let nodes = format!(
            "\"example\": mix(a: (0.25, 0.5, 1), b: (0.5, 0.25, 0), amount: 1, mode: {mode})"
        );
        colour(&nodes)
    };
    assert_eq!(mixed("normal"), [0.5, 0.25, 0.0]);
    assert_eq!(mixed("multiply"), [0.125, 0.125, 0.0]);
    assert_eq!(mixed("screen"), [0.625, 0.625, 1.0]);
    assert_eq!(mixed("overlay"), [0.25, 0.25, 1.0]);
    assert_eq!(mixed("soft_light"), [0.25, 0.375, 1.0]);
    assert_eq!(mixed("add"), [0.75, 0.75, 1.0]);
    assert_eq!(mixed("subtract"), [0.0, 0.25, 1.0]);
    assert_eq!(mixed("difference"), [0.25, 0.25, 1.0]);
    assert_eq!(mixed("divide"), [0.5, 1.0, 1.0]);
    assert_eq!(mixed("darken"), [0.25, 0.25, 0.0]);
    assert_eq!(mixed("lighten"), [0.5, 0.5, 1.0]);
    let half = "\"example\": mix(a: (0.5, 0.5, 0.5), b: (0, 0, 1), amount: 0.5, mode: multiply)";
    assert_eq!(colour(half), [0.25, 0.25, 0.5]);
}

fn adjusted(colour_of: &str, rest: &str) -> [f32; 3] {
    colour(&format!(
        "\"example\": adjust_colour(colour: {colour_of}{rest})"
    ))
}

fn near(found: [f32; 3], expected: [f32; 3], within: f32) {
    let close = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (a - b).abs() <= within);
    assert!(close, "{found:?}, not {expected:?}");
}

#[test]
fn adjustments_change_what_they_say_and_nothing_else() {
    let wood = "(0.5, 0.3, 0.125)";
    assert_eq!(adjusted(wood, ""), [0.5, 0.3, 0.125]);
    assert_eq!(adjusted(wood, ", brightness: 2"), [1.0, 0.6, 0.25]);
    near(adjusted(wood, ", hue: 360"), [0.5, 0.3, 0.125], 1e-5);
    let [r, g, b] = adjusted(wood, ", saturation: 0");
    assert!((r - g).abs() < 1e-4 && (g - b).abs() < 1e-4, "{r} {g} {b}");
    // Without contrast all is middle grey; greys stay grey under hue and saturation.
    near(
        adjusted("(0.7, 0.7, 0.7)", ", contrast: 0"),
        [0.18; 3],
        1e-4,
    );
    near(
        adjusted("(0.4, 0.4, 0.4)", ", hue: 77, saturation: 3"),
        [0.4; 3],
        1e-4,
    );
    // Ottosson's page: linear sRGB red is L 0.628, a 0.225, b 0.126; half a turn is its complement.
    near(
        adjusted("(1, 0, 0)", ", hue: 180"),
        adjusted("(1, 0, 0)", ", hue: -180"),
        1e-6,
    );
}

#[test]
fn adjustments_and_modes_of_what_varies_keep_the_contract() {
    let edges = "\"place\": position(),
        \"stripes\": ramp(value: \"= (place.x + 0.2 * place.y) / 9.7 mm\", ends: repeat, curve: step, stops: [
            (at: 0, colour: \"#ff3333\"), (at: 0.35, colour: \"#111111\"), (at: 0.6, colour: \"#22dd88\")])";
    let strong = field(
        &format!(
            "{edges}, \"example\": adjust_colour(colour: \"stripes\", hue: 40, saturation: 0.7, contrast: 1.2)"
        ),
        "colour",
    );
    keeps_the_contract("adjust_colour", &strong, 64.0, 1.0);
    let product = field(
        &format!(
            "{edges}, \"other\": ramp(value: \"= (place.x - place.y) / 13 mm\", ends: repeat, curve: step, stops: [
                (at: 0, colour: \"#ffffff\"), (at: 0.5, colour: \"#002244\")]),
            \"example\": mix(a: \"stripes\", b: \"other\", amount: 0.8, mode: multiply)"
        ),
        "colour",
    );
    keeps_the_contract("mix multiply", &product, 64.0, 1.0);
}
