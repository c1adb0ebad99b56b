//! What cannot be drawn is said, with what to do.

use super::{recipe, workshop};
use yosegi::engine::Cancel;

const BLOCK: &str = r#""thing": material(base_color: (0.5, 0.5, 0.5)), "shape": block(size: (40, 30), thickness: 20)"#;

/// The message of a recipe that fails.
fn message(nodes: &str, view: &str) -> String {
    let text = recipe(nodes, &format!("pixels: (8, 8), {view}"));
    let run = workshop().render(&text, &[], Cancel::new(), &|_| {});
    let error = run.result.expect_err("the recipe is wrong");
    error.diagnostics()[0].message.clone()
}

#[test]
fn views_that_show_nothing_are_refused() {
    for (view, expected) in [
        (
            "camera: (position: (0, 0, 5), target: (0, 0, 5))",
            "the camera stands at its target",
        ),
        (
            "camera: (side: (0, 0, 1))",
            "the camera looks along its `up`, so nothing says what is up in the picture",
        ),
        (
            "camera: (side: (0, 0, 0))",
            "the direction `side` of the camera has no length",
        ),
        (
            "camera: (side: (0, 1, 0), position: (0, 9, 0))",
            "both `position` and `side` of the camera are set",
        ),
        (
            "cuts: [(point: (0, 0, 0), normal: (0, 0, 0))]",
            "the `normal` of cut 1 has no length",
        ),
        (
            "lights: [(strength: 2)]",
            "light 1: expected either `direction` or `position`",
        ),
        (
            "lights: [(direction: (0, 0, 0))]",
            "light 1: `direction` has no length",
        ),
    ] {
        assert_eq!(message(BLOCK, view), expected);
    }
}

#[test]
fn flat_pieces_need_a_place_on_the_mesh() {
    let flat = r#""grain": plane_noise(size: (4, 4, 4)), "thing": material(base_color: (0.5, 0.5, 0.5), height: "= 2 * grain.value"),"#;
    let block = format!(r#"{flat} "shape": block(size: (40, 30), thickness: 20)"#);
    assert_eq!(
        message(&block, ""),
        "the material is not a cut piece, so it has no size"
    );
    let cut = "size: (40, 30), cuts: [(point: (0, 0, 0), normal: (1, 0, 0))]";
    assert_eq!(
        message(&block, cut),
        "a flat piece has no inside that cuts could show"
    );
    let log = format!(
        r#"{flat} "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 100)]),
           "time": growth_field(skeleton: "tree", elongation: 100, thickening: 4),
           "shape": log(time: "time.time", age: 5, low: (-30, -30, 10), high: (30, 30, 60), detail: 10)"#
    );
    assert_eq!(
        message(&log, ""),
        "the mesh has no coordinates, so nothing says where a flat piece lies on it"
    );
}

#[test]
fn logs_that_are_nowhere_are_refused() {
    let log = |log: &str| {
        format!(
            r#""thing": material(base_color: (0.5, 0.5, 0.5)), "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 100)]),
               "time": growth_field(skeleton: "tree", elongation: 100, thickening: 4), "shape": log({log})"#
        )
    };
    for (inputs, expected) in [
        (
            r#"time: "time.time", age: 5, low: (300, 300, 10), high: (330, 330, 60)"#,
            "the field never crosses 5 years in the box, so there is no surface",
        ),
        (
            r#"inside: "time.branch", low: (-30, -30, 10), high: (30, 30, 60)"#,
            "the field is nowhere above 0.5 in the box, so there is no surface",
        ),
        (
            r#"time: "time.time", age: 5, low: (-30, -30, 10), high: (30, 30, 10)"#,
            "expected `high` above `low` in x, y and z, found a box without an inside",
        ),
        (
            r#"time: "time.time", low: (-30, -30, 10), high: (30, 30, 60)"#,
            "`time` is set, but no `age`",
        ),
        (
            "low: (-30, -30, 10), high: (30, 30, 60)",
            "expected either `time` with `age`, or `inside`",
        ),
    ] {
        assert_eq!(message(&log(inputs), ""), expected);
    }
    let fine = log(
        r#"time: "time.time", age: 5, low: (-300, -300, 10), high: (300, 300, 600), detail: 0.1"#,
    );
    let refused = message(&fine, "");
    assert!(
        refused.starts_with("the surface with details of 0.1 mm takes "),
        "{refused}"
    );
}
