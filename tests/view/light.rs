//! How things are lit.

use super::{EVEN, picture, recipe};

/// A ball of radius 40 as a level surface.
const BALL: &str = r#"
    "place": position(),
    "centred": combine(x: "= place.x / 1 mm", y: "= place.y / 1 mm", z: "= place.z / 1 mm"),
    "from_middle": separate(vector: "centred.vector"),
    "shape": log(inside: "= 40.5 - from_middle.length", low: (-50, -50, -50), high: (50, 50, 50), detail: 4),"#;

#[test]
fn a_white_ball_under_a_white_sky_cannot_be_seen() {
    for roughness in [0.1, 0.5, 1.0] {
        for metalness in [0, 1] {
            let ball = format!(
                "{BALL} \"thing\": material(base_color: (1, 1, 1), roughness: {roughness}, metalness: {metalness})"
            );
            let seen = picture(&recipe(
                &ball,
                &format!("pixels: (40, 40), samples: 512, {EVEN}"),
            ));
            for (index, pixel) in seen.pixels.iter().enumerate() {
                let is_white = pixel.iter().all(|part| (part - 0.5).abs() < 0.01);
                assert!(
                    is_white,
                    "roughness {roughness}, metalness {metalness}, pixel {index}: {pixel:?}"
                );
            }
        }
    }
}

#[test]
fn a_dark_ball_reflects_less_than_it_gets() {
    let ball = format!("{BALL} \"thing\": material(base_color: (0.2, 0.2, 0.2), roughness: 0.6)");
    let seen = picture(&recipe(
        &ball,
        &format!("pixels: (40, 40), samples: 256, {EVEN}"),
    ));
    let middle = seen.at(20, 20)[0];
    // A fifth of 0.5, and some four to six percent that are mirrored.
    assert!((0.1..0.14).contains(&middle), "{middle}");
}

/// A post seen from above, lit from one side.
fn post(light: &str) -> super::Picture {
    picture(&recipe(
        r#""thing": material(base_color: (0.5, 0.5, 0.5)), "shape": block(size: (20, 40), thickness: 20, rounding: 0)"#,
        &format!(
            "pixels: (80, 80), samples: 64, lights: [{light}], background: (0.5, 0.5, 0.5),
             camera: (projection: orthographic, side: (0, 0, 1), up: (0, 1, 0), target: (0, 10, 0), height: 160)"
        ),
    ))
}

#[test]
fn shadows_fall_to_the_side_away_from_the_light() {
    let seen = post("(direction: (1, 0, 1), angle: 0.5)");
    let (left, right) = (seen.mean(18..32, 38..42), seen.mean(48..62, 38..42));
    assert!(left < 0.75 * right, "{left} {right}");
    // The post is 40 high and the light stands at 45 degrees: the shadow ends 40 mm from its side.
    assert!(seen.mean(18..22, 38..42) < 0.8 * seen.mean(6..12, 38..42));
    assert!(seen.mean(6..12, 38..42) > 0.93 * right);
}

#[test]
fn wide_lights_make_soft_shadows() {
    let steps = |angle: f64| {
        let seen = post(&format!("(direction: (1, 0, 1), angle: {angle})"));
        let row: Vec<f64> = (4..34).map(|x| seen.mean(x..x + 1, 38..42)).collect();
        let steps = row.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max)
    };
    let (sharp, soft) = (steps(0.2), steps(30.0));
    assert!(sharp > 0.08, "{sharp}");
    assert!(soft < 0.4 * sharp, "{soft} {sharp}");
}

#[test]
fn a_lamp_grows_weaker_with_the_square_of_the_distance() {
    // White ground is not drawn, so a wide plate is lit from close by.
    let seen = picture(&recipe(
        r#""thing": material(base_color: (0.5, 0.5, 0.5), roughness: 1),
           "shape": block(size: (400, 400), thickness: 10, rounding: 0, along: (0, 1, 0))"#,
        "pixels: (80, 80), samples: 16, sky: (strength: 0), ground: false, background: (0, 0, 0),
         lights: [(position: (0, 0, 100), radius: 1, strength: 0.5)],
         camera: (projection: orthographic, side: (0, 0, 1), up: (0, 1, 0), height: 400)",
    ));
    let (below, beside) = (seen.mean(39..41, 39..41), seen.mean(59..61, 39..41));
    // At 100 mm aside twice the squared distance, and 45 degrees: 2^-1.5, or a little more for what is mirrored.
    let share = beside / below;
    assert!((0.33..0.39).contains(&share), "{share}");
}

#[test]
fn relief_turns_towards_the_light() {
    let lit = |height: &str| {
        let seen = picture(&recipe(
            &format!(
                r#""place": position(), "thing": material(base_color: (0.5, 0.5, 0.5), roughness: 1, height: "{height}"),
                   "shape": block(size: (40, 40), thickness: 10, rounding: 0)"#
            ),
            "pixels: (40, 40), samples: 16, sky: (strength: 0), ground: false, background: (0, 0, 0),
             lights: [(direction: (1, -1, 0), strength: 0.5)], camera: (projection: orthographic, side: (0, -1, 0), height: 40)",
        ));
        seen.mean(10..30, 10..30)
    };
    let (flat, rising, falling) = (
        lit("= 0 * place.x"),
        lit("= 0.5 * place.x"),
        lit("= 0 - 0.5 * place.x"),
    );
    // The face turns by 26.6 degrees away from the light, or towards it.
    assert!((rising / flat - 0.447).abs() < 0.02, "{}", rising / flat);
    assert!((falling / flat - 1.342).abs() < 0.03, "{}", falling / flat);
}
