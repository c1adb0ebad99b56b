//! Flat pieces on the ground with their relief: shapes, shadows, and how much of the sky is seen.

use super::{EVEN, Picture, picture, rendered};

/// A view of the material `thing` on the ground.
fn recipe(nodes: &str, view: &str) -> String {
    format!(
        r##"(nodes: {{ "place": position(), {nodes} }}, outputs: {{ "a": view(of: "thing", format: png16, {view}) }})"##
    )
}

fn relief(nodes: &str, view: &str) -> Picture {
    picture(&recipe(nodes, view))
}

/// From above, 1 pixel a mm, a piece of 100 x 60 mm in a picture of 140 x 100.
const ABOVE: &str = "size: (100, 60), pixels: (140, 100), \
                     camera: (projection: orthographic, side: (0, 0, 1), up: (0, 1, 0), height: 100)";

/// The left side of the piece is 20 mm higher.
const STEP: &str = r#""right": threshold(value: "= place.u / 1 mm", edge: 40),
    "thing": material(base_color: (0.4, 0.4, 0.4), height: "= 20 - 20 * right", roughness: 1)"#;

#[test]
fn what_is_flat_looks_the_same_however_it_is_said() {
    let flat = |height: &str, view: &str| {
        let nodes =
            format!(r#""thing": material(base_color: (0.3, 0.4, 0.5), roughness: 0.6 {height})"#);
        relief(
            &nodes,
            &format!("size: (100, 60), pixels: (90, 60), {view}"),
        )
    };
    let plain = flat("", "");
    for (height, view) in [
        (r#", height: "= 0 * place.u""#, ""),
        (r#", height: "= place.u""#, "relief: 0"),
    ] {
        let other = flat(height, view);
        for (a, b) in plain.pixels.iter().zip(&other.pixels) {
            let is_same = (0..3).all(|part| (a[part] - b[part]).abs() < 2e-3);
            assert!(is_same, "{height} {view}: {a:?} {b:?}");
        }
    }
    // And as a mesh of the same shape in the same light.
    let view = "lights: [(direction: (-1, 0.5, 0.6), angle: 1)], camera: (side: (0, -0.5, 1)), pixels: (90, 60)";
    let mesh = picture(&format!(
        r##"(nodes: {{ "thing": material(base_color: (0.3, 0.4, 0.5), roughness: 0.6),
                "shape": block(across: (1, 0, 0), along: (0, 1, 0), size: (100, 60), thickness: 3, rounding: 0) }},
            outputs: {{ "a": view(of: "thing", on: "shape", format: png16, {view}) }})"##
    ));
    let slab = relief(
        r#""thing": material(base_color: (0.3, 0.4, 0.5), roughness: 0.6)"#,
        &format!("size: (100, 60), thickness: 3, {view}"),
    );
    let (a, b) = (mesh.mean(30..60, 20..40), slab.mean(30..60, 20..40));
    assert!((a / b - 1.0).abs() < 0.01, "{a} {b}");
}

#[test]
fn the_shadow_of_a_step_is_as_long_as_the_light_is_low() {
    for (rise, length) in [(1.0, 20.0), (0.5, 40.0)] {
        let light = format!("lights: [(direction: (-1, 0, {rise}), angle: 0.53)]");
        let seen = relief(STEP, &format!("{ABOVE}, {light}, sky: (strength: 0.2)"));
        // The piece begins at pixel 20, the step is at 60.
        let lit = seen.mean(125..135, 30..70).max(seen.mean(110..118, 40..60));
        let at = |x: u32| seen.mean(x..x + 1, 40..60);
        let dark = at(60 + (0.5 * length) as u32);
        let half = 0.5 * (at(60 + length as u32 + 4) + dark);
        let end = (62..118).find(|x| at(*x) > half).unwrap();
        assert!((f64::from(end) - 60.0 - length).abs() <= 1.0, "{end}");
        assert!(dark < 0.5 * lit, "{dark} {lit}");
    }
}

#[test]
fn no_light_comes_through_a_thin_wall() {
    let wall = r#""beside": remap(value: "= place.u / 1 mm", from: (28, 30)),
        "beyond": remap(value: "= place.u / 1 mm", from: (30, 32)),
        "thing": material(base_color: (0.4, 0.4, 0.4), height: "= 20 * beside - 20 * beyond", roughness: 1)"#;
    let light = "lights: [(direction: (-1, 0.3, 0.4), angle: 0.53)], sky: (strength: 0)";
    let seen = relief(wall, &format!("{ABOVE}, {light}, background: (0, 0, 0)"));
    // Its shadow is 47 mm long and shifted by 15 mm.
    for y in 45..75 {
        for x in 54..92 {
            assert!(seen.at(x, y)[0] < 1e-4, "({x}, {y}): {:?}", seen.at(x, y));
        }
    }
    assert!(seen.mean(104..116, 45..75) > 0.1);
}

#[test]
fn a_wide_light_makes_a_soft_shadow() {
    let steps = |angle: f64| {
        let light = format!("lights: [(direction: (-1, 0, 1), angle: {angle})]");
        let seen = relief(STEP, &format!("{ABOVE}, {light}, sky: (strength: 0)"));
        let row: Vec<f64> = (62..116).map(|x| seen.mean(x..x + 1, 40..60)).collect();
        let steps = row.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max)
    };
    let (sharp, soft) = (steps(0.2), steps(30.0));
    assert!(sharp > 0.1, "{sharp}");
    assert!(soft < 0.4 * sharp, "{soft} {sharp}");
}

#[test]
fn a_groove_sees_the_sky_between_its_sides() {
    let bottom = |depth: f64| {
        let groove = format!(
            r#""left": threshold(value: "= place.u / 1 mm", edge: 40), "right": threshold(value: "= place.u / 1 mm", edge: 60),
               "thing": material(base_color: (0.2, 0.2, 0.2), height: "= {depth} * (right - left)", roughness: 1)"#
        );
        let seen = relief(&groove, &format!("{ABOVE}, {EVEN}, samples: 1024"));
        seen.mean(69..71, 48..52) / seen.mean(35..37, 48..52)
    };
    // Half of the groove's width over its depth is the tangent of the sky's half angle, and its sine is what reaches the
    // bottom of a groove without ends; some comes back from the sides.
    for (depth, expected) in [(5.0, 0.894), (10.0, 0.707), (20.0, 0.447)] {
        let found = bottom(depth);
        assert!(
            (-0.03..0.12).contains(&(found - expected)),
            "{depth}: {found}, {expected}"
        );
    }
}

#[test]
fn a_post_keeps_its_area_from_above_and_its_height_from_the_side() {
    let post = r#""left": threshold(value: "= place.u / 1 mm", edge: 30), "right": threshold(value: "= place.u / 1 mm", edge: 50),
        "low": threshold(value: "= place.v / 1 mm", edge: 20), "high": threshold(value: "= place.v / 1 mm", edge: 40),
        "colour": mix(a: (0, 0, 0.5), b: (0.5, 0, 0), amount: "= (left - right) * (low - high)"),
        "thing": material(base_color: "colour", height: "= 26 * (left - right) * (low - high)", roughness: 1)"#;
    let red = |seen: &Picture| -> f64 {
        let sum: f64 = seen
            .pixels
            .iter()
            .map(|pixel| pixel[0] - pixel[2])
            .filter(|red| *red > 0.0)
            .sum();
        sum / seen.at(60, 50)[0].max(1e-9)
    };
    let view =
        format!("{ABOVE}, {EVEN}").replace("background: (0.5, 0.5, 0.5)", "background: (0, 0, 0)");
    let seen = relief(post, &view);
    let area = red(&seen);
    assert!((area / 400.0 - 1.0).abs() < 0.08, "{area}");
    let side = view.replace("side: (0, 0, 1), up: (0, 1, 0)", "side: (0, -1, 0)");
    let seen = relief(post, &format!("{side}, thickness: 10"));
    let is_seen = |pixel: &&[f64; 3]| pixel.iter().sum::<f64>() > 0.12;
    let count = seen.pixels.iter().filter(is_seen).count() as f64;
    // 20 mm x 26 mm of the post over 100 mm x 10 mm of the slab.
    assert!((count / 1520.0 - 1.0).abs() < 0.06, "{count}");
    // Twice as high.
    let seen = relief(post, &format!("{side}, thickness: 10, relief: 2"));
    let count = seen.pixels.iter().filter(is_seen).count() as f64;
    assert!((count / 2040.0 - 1.0).abs() < 0.06, "{count}");
}

#[test]
fn the_bytes_of_relief_depend_on_nothing_but_the_recipe() {
    use super::workshop::Workshop;
    use yosegi::engine::Options;
    let text = recipe(
        r#""bumps": plane_noise(size: (9, 9, 9), octaves: 4), "tone": mix(a: (0.1, 0.1, 0.05), b: (0.4, 0.4, 0.3), amount: "= 0.5 + bumps"),
           "thing": material(base_color: "tone", height: "= 8 * bumps")"#,
        "size: (90, 70), pixels: (70, 50), samples: 48,
         lights: [(direction: (-1, -1, 1)), (position: (20, 30, 40), radius: 10, strength: 0.4)]",
    );
    let options = || Options {
        threads: Some(2),
        tile: 64,
        memory: 0,
        ..Options::default()
    };
    let bytes = |options| rendered(&Workshop::new("recipes", options), &text, "a_view.png");
    let expected = bytes(options());
    for (threads, tile) in [(1, 64), (5, 7), (2, 33)] {
        let found = bytes(Options {
            threads: Some(threads),
            tile,
            ..options()
        });
        assert!(found == expected, "{threads} threads, tiles of {tile}");
    }
}
