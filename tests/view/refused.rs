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
            "camera: (up: (0, 0, 0))",
            "the direction `up` of the camera has no length",
        ),
        (
            "camera: (height: 40)",
            "`height` is set, but the camera is a perspective",
        ),
        (
            "camera: (projection: orthographic, angle: 24)",
            "`angle` is set, but the camera is orthographic",
        ),
        (
            "cuts: [(point: (0, 31, 0), normal: (0, -1, 0))]",
            "the cuts leave nothing to see",
        ),
        (
            "cuts: [(point: (0, 5, 0), normal: (0, -1, 0)), (point: (0, 5, 0), normal: (0, 1, 0))]",
            "the cuts leave nothing to see",
        ),
        (
            "cuts: [(point: (1, 31, 0), normal: (0, -1, 0)), (point: (-21, 0, 0), normal: (1, 0, 0))], remove: common",
            "the cuts leave nothing to see",
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
fn what_cannot_lie_on_the_ground_is_refused() {
    let wood = r#""grain": solid_noise(size: (4, 4, 4)), "wood": material(base_color: (0.5, 0.5, 0.5), height: "= 2 * grain.value")"#;
    let flat = r#""plain": plane_noise(size: (4, 4, 4)), "flat": material(base_color: (0.5, 0.5, 0.5), height: "= 2 * plain.value")"#;
    let none = r#""zero": plane_noise(size: (4, 4, 4)), "none": math(operation: power, a: "= 1 + 1e4 * zero * zero + 1e4", b: 60),
                  "flat": material(base_color: (0.5, 0.5, 0.5), height: "= 1e9 * none")"#;
    for (nodes, view, expected) in [
        (
            wood,
            r#"of: "wood", size: (40, 30)"#,
            "an uncut material has no shape, and `on` gives none",
        ),
        (
            flat,
            r#"of: "flat""#,
            "the material is not a cut piece, so it has no size",
        ),
        (
            flat,
            r#"of: "flat", size: (40, 30), cuts: [(point: (0, 0, 0), normal: (1, 0, 0))]"#,
            "a flat piece has no inside that cuts could show",
        ),
        (
            &format!("{wood}, {flat}"),
            r#"of: "flat", size: (40, 30), bark: "wood""#,
            "`bark` is set, but a flat piece is of one material",
        ),
        (
            &format!(r#"{wood}, "shape": block(size: (40, 30), thickness: 20)"#),
            r#"of: "wood", on: "shape", relief: 2"#,
            "`relief` is set, but `on` gives a shape of its own",
        ),
        (
            none,
            r#"of: "flat", size: (40, 30)"#,
            "the height at (0.000, 0.000) is not a number",
        ),
    ] {
        let text =
            format!("(nodes: {{ {nodes} }}, outputs: {{ \"a\": view(pixels: (8, 8), {view}) }})");
        let run = workshop().render(&text, &[], Cancel::new(), &|_| {});
        let error = run.result.expect_err("the recipe is wrong");
        assert_eq!(error.diagnostics()[0].message, expected);
    }
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

/// A tetrahedron in a file, with the triangles given by their corners.
fn tetrahedron(faces: &str) -> String {
    let points = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\n";
    let text = format!("{points}{faces}");
    let nodes = r#""thing": material(base_color: (0.5, 0.5, 0.5)), "shape": mesh_from_file(file: "shape.obj", unit: mm)"#;
    let cut = "pixels: (8, 8), cuts: [(point: (1, 1, 1), normal: (1, 0, 0))]";
    let workshop = workshop();
    workshop
        .files
        .insert(workshop.folder.join("shape.obj"), text);
    let run = workshop.render(&recipe(nodes, cut), &[], Cancel::new(), &|_| {});
    match run.result {
        Ok(_) => String::new(),
        Err(error) => error.diagnostics()[0].message.clone(),
    }
}

#[test]
fn only_closed_meshes_are_cut() {
    let outwards = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    assert_eq!(tetrahedron(outwards), "");
    assert_eq!(
        tetrahedron("f 1 3 2\nf 1 2 4\nf 1 4 3\n"),
        "the mesh is not closed, so it has no inside that cuts could show: 3 of its edges lie open, \
         one at (4.500, 4.500, 0.000)"
    );
    // A seam that is off by rounding is none.
    assert_eq!(
        tetrahedron("v 9 -5e-15 0\nf 1 3 2\nf 1 5 4\nf 1 4 3\nf 2 3 4\n"),
        ""
    );
    // One triangle is turned.
    assert_eq!(
        tetrahedron("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n"),
        "the mesh is not closed, so it has no inside that cuts could show: 3 of its edges lie open, \
         one at (4.500, 4.500, 0.000)"
    );
    assert_eq!(
        tetrahedron("f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n"),
        "the mesh is inside out: its triangles run clockwise seen from outside"
    );
}
