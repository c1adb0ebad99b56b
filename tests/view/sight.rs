//! Where things are seen: scales, edges, cut faces.

use super::{EVEN, Picture, picture, picture_in, read, recipe, rendered, workshop};

/// A block before a black background, 2 pixels a mm.
fn block(size: &str, more: &str) -> Picture {
    picture(&recipe(
        &format!(
            r#""thing": material(base_color: (0.5, 0.5, 0.5)), "shape": block(size: {size}, thickness: 20, rounding: 0)"#
        ),
        &format!(
            "pixels: (120, 90), camera: (projection: orthographic, side: (0, -1, 0), height: 45), samples: 64, ground: false, background: (0, 0, 0), {more}"
        ),
    ))
}

#[test]
fn an_orthographic_picture_has_its_scale_to_the_pixel() {
    let seen = block("(40, 30)", "");
    for y in 0..90 {
        for x in 0..120 {
            let is_block = (20..100).contains(&x) && (15..75).contains(&y);
            assert_eq!(seen.at(x, y) != [0.0; 3], is_block, "({x}, {y})");
        }
    }
}

#[test]
fn an_edge_within_a_pixel_is_mixed_in_linear_light() {
    // A quarter of a pixel beyond the whole ones on each side, and half of one above and below.
    let seen = block("(40.25, 30.5)", "");
    let whole = seen.at(60, 45);
    for (x, y, share) in [
        (19, 45, 0.25),
        (100, 40, 0.25),
        (60, 14, 0.5),
        (70, 75, 0.5),
    ] {
        for (mixed, whole) in seen.at(x, y).into_iter().zip(whole) {
            assert!(
                (mixed - share * whole).abs() < 0.01 * whole,
                "({x}, {y}): {mixed} of {whole}"
            );
        }
        assert_eq!(seen.at(18, 45), [0.0; 3]);
    }
}

#[test]
fn a_camera_without_a_position_shows_everything_and_little_more() {
    for view in [
        "",
        "camera: (projection: orthographic),",
        "camera: (side: (3, 1, 2), angle: 60),",
    ] {
        let seen = picture(&recipe(
            r#""thing": material(base_color: (0.8, 0.2, 0.2)), "shape": block(size: (400, 30), thickness: 20)"#,
            &format!("{view} pixels: (100, 80), samples: 16, ground: false, background: (0, 0, 0)"),
        ));
        let is_seen = |x: u32, y: u32| seen.at(x, y) != [0.0; 3];
        let columns = (0..100).filter(|x| (0..80).any(|y| is_seen(*x, y)));
        let rows = (0..80).filter(|y| (0..100).any(|x| is_seen(x, *y)));
        let (columns, rows): (Vec<u32>, Vec<u32>) = (columns.collect(), rows.collect());
        let free = |seen: &[u32], side: u32| [seen[0], side - 1 - seen[seen.len() - 1]];
        let (beside, above) = (free(&columns, 100), free(&rows, 80));
        assert!(
            beside.iter().chain(&above).all(|free| *free >= 3),
            "{view}: {beside:?} {above:?}"
        );
        let is_full = beside.iter().all(|free| *free <= 8) || above.iter().all(|free| *free <= 7);
        assert!(is_full, "{view}: {beside:?} {above:?}");
    }
}

/// A cut through a wood with rings shows in even light what a cut piece has as its colour.
#[test]
fn cut_faces_have_the_colours_of_cut_pieces() {
    let wood = r##"
        "tree": skeleton(trunk: [(0, 0, 0), (6, 4, 300), (-6, 0, 600)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 4),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 0.7, colour: "#b27b48"), (at: 1, colour: "#7a4428")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "thing": material(base_color: "look.colour", roughness: 1),
        "plain": material(base_color: (0, 0, 0), roughness: 1),
        "shape": log(time: "time.time", age: 15, low: (-80, -80, 250), high: (80, 80, 350), detail: 12),
        "piece": slice_cut(of: "thing", cut: quarter_sawn, origin: (0, 10, 300), size: (90, 60)),"##;
    let view = |of: &str| {
        format!(
            r#"view(of: "{of}", on: "shape", format: png16, pixels: (90, 60), samples: 64, {EVEN},
                cuts: [(point: (0, 10, 0), normal: (0, -1, 0))],
                camera: (projection: orthographic, target: (0, 10, 300), side: (0, -1, 0), height: 60))"#
        )
    };
    let recipe = format!(
        r#"(nodes: {{ {wood} }}, outputs: {{ "a": {}, "b": {}, "c": maps(of: "piece", pixels_per_mm: 1, format: png16) }})"#,
        view("thing"),
        view("plain")
    );
    let workshop = workshop();
    let seen = picture_in(&workshop, &recipe);
    let black = read(&workshop.map("b_view.png"));
    let piece = read(&workshop.map("c_base_color.png"));
    for y in 2..58 {
        for x in 4..86 {
            for ((seen, black), piece) in seen
                .at(x, y)
                .into_iter()
                .zip(black.at(x, y))
                .zip(piece.at(x, y))
            {
                // What is not mirrored of the light of 0.5 is coloured.
                let mirrored = black / 0.5;
                let colour = (seen / 0.5 - mirrored) / (1.0 - mirrored);
                assert!(
                    (colour - piece).abs() < 0.004,
                    "({x}, {y}): {colour} {piece}"
                );
            }
        }
    }
}

#[test]
fn a_notch_takes_away_only_what_lies_before_all_cuts() {
    let view = |remove: &str| {
        picture(&recipe(
            r#""thing": material(base_color: (0.5, 0.5, 0.5)), "shape": block(size: (40, 40), thickness: 40, rounding: 0)"#,
            &format!(
                "remove: {remove}, cuts: [(point: (0, 20, 0), normal: (0, -1, 0)), (point: (5, 0, 0), normal: (1, 0, 0))],
                 pixels: (60, 60), camera: (projection: orthographic, side: (0, -1, 0), target: (0, 0, 0), height: 60),
                 samples: 64, ground: false, background: (0, 0, 0)"
            ),
        ))
    };
    let (each, notch) = (view("each"), view("common"));
    // The block reaches from 10 to 50; before all cuts lies what is right of 35.
    assert!(each.at(20, 30) != [0.0; 3] && each.at(40, 30) == [0.0; 3]);
    assert!(notch.at(20, 30) != [0.0; 3] && notch.at(45, 30) != [0.0; 3]);
    assert!(
        notch.at(40, 30) != notch.at(20, 30),
        "the floor of the notch lies deeper, in its shade"
    );
}

#[test]
fn a_picture_of_another_shape_shows_more_and_is_not_stretched() {
    let text = recipe(
        r#""thing": material(base_color: (0.8, 0.4, 0.2)), "shape": block(size: (40, 30), thickness: 20)"#,
        "pixels: (60, 40), samples: 32",
    );
    let mut workshop = workshop();
    let whole = picture_in(&workshop, &text);
    workshop.size = Some([80, 40]);
    let wide = picture_in(&workshop, &text);
    for y in 0..40 {
        for x in 0..60 {
            assert_eq!(wide.at(x + 10, y), whole.at(x, y), "({x}, {y})");
        }
    }
    workshop.size = Some([60, 60]);
    let high = picture_in(&workshop, &text);
    assert_eq!((high.width, high.height), (60, 60));
    assert_eq!(high.at(30, 30), whole.at(30, 20));
}

#[test]
fn a_flat_piece_lies_on_a_mesh_by_its_coordinates() {
    let seen = picture(&recipe(
        r#""place": position(),
           "colour": combine(x: "= place.u / 40 mm", y: "= place.v / 30 mm", z: 0),
           "mask": separate(vector: "colour.vector"),
           "red": mix(a: (0, 0, 0), b: (1, 0, 0), amount: "mask.x"),
           "both": mix(a: "red", b: (0, 1, 0), amount: "= 0.5 * mask.y"),
           "thing": material(base_color: "both", roughness: 1),
           "shape": block(size: (40, 30), thickness: 20, rounding: 0)"#,
        &format!(
            "size: (40, 30), pixels: (40, 30), samples: 16, {EVEN}, camera: (projection: orthographic, side: (0, -1, 0), height: 30)"
        ),
    ));
    let [right, left] = [seen.at(35, 15), seen.at(4, 15)];
    assert!(right[0] > 0.25 && left[0] < 0.1, "{right:?} {left:?}");
    let [top, bottom] = [seen.at(20, 2), seen.at(20, 27)];
    assert!(top[1] > 0.18 && bottom[1] < 0.05, "{top:?} {bottom:?}");
}

#[test]
fn the_bytes_depend_on_nothing_but_the_recipe() {
    use super::levels::levels;
    use super::workshop::Workshop;
    use yosegi::engine::Options;
    let text = r##"(nodes: {
        "tree": skeleton(trunk: [(0, 0, 0), (6, 4, 300), (-6, 0, 600)], branches: [(at: 300, direction: (1, 0.2, 0.5), thickening: 2)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 4),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#7a4428")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "wood": material(base_color: "look.colour", height: "= 0.2 * look.position"),
        "noise": solid_noise(size: (9, 9, 30), octaves: 3),
        "bark": material(base_color: "#5a4a3c", height: "= 3 * noise.value", roughness: 0.9),
        "log": log(time: "time.time", age: 15, low: (-80, -80, 250), high: (90, 80, 400), detail: 12),
    }, outputs: {
        "a": view(of: "wood", bark: "bark", on: "log", cuts: [(point: (0, 10, 0), normal: (0.3, -1, 0.2))],
            lights: [(direction: (-1, -1, 2)), (position: (200, -300, 600), radius: 40, strength: 0.4)],
            pixels: (70, 50), samples: 48),
    })"##;
    let options = || Options {
        threads: Some(2),
        tile: 64,
        memory: 0,
        ..Options::default()
    };
    let bytes = |options| rendered(&Workshop::new("recipes", options), text, "a_view.png");
    let expected = bytes(options());
    for threads in [1, 5] {
        let found = bytes(Options {
            threads: Some(threads),
            ..options()
        });
        assert!(found == expected, "{threads} threads");
    }
    for tile in [7, 16, 33] {
        let found = bytes(Options { tile, ..options() });
        assert!(found == expected, "tiles of {tile}");
    }
    for level in levels() {
        let found = bytes(Options {
            level: Some(level),
            ..options()
        });
        assert!(found == expected, "{level:?}");
    }
}

/// Columns and rows of a picture before black in which something is seen: the first and the last.
fn bounds(seen: &Picture) -> [u32; 4] {
    let is_seen = |x: u32, y: u32| seen.at(x, y) != [0.0; 3];
    let columns = (0..seen.width).filter(|x| (0..seen.height).any(|y| is_seen(*x, y)));
    let rows = (0..seen.height).filter(|y| (0..seen.width).any(|x| is_seen(x, *y)));
    let (columns, rows): (Vec<u32>, Vec<u32>) = (columns.collect(), rows.collect());
    let ends = |seen: &[u32]| (seen[0], seen[seen.len() - 1]);
    let ((left, right), (top, bottom)) = (ends(&columns), ends(&rows));
    [left, right, top, bottom]
}

#[test]
fn a_thing_of_few_triangles_is_framed_whole_where_it_is_cut() {
    for (cuts, camera) in [
        ("cuts: [(point: (0, 15, 0), normal: (0, -1, 0))]", ""),
        ("cuts: [(point: (0, 3, 0), normal: (0, -1, 0))]", ""),
        // A room in the middle that meets no triangle.
        (
            "cuts: [(point: (9, 9, 6), normal: (1, 0, 0)), (point: (9, 9, 6), normal: (0, 1, 0)), (point: (9, 9, 6), normal: (0, 0, 1)),
                    (point: (-9, 3, -7), normal: (-1, 0, 0)), (point: (-9, 3, -7), normal: (0, -1, 0)), (point: (-9, 3, -7), normal: (0, 0, -1))]",
            "",
        ),
        // What is left reaches furthest where three cuts meet.
        (
            "cuts: [(point: (0, 10, -4), normal: (-1, 0, 0)), (point: (0, 10, -4), normal: (0, -1, 0)), (point: (0, 10, -4), normal: (0, 0, 1))]",
            "camera: (side: (1, 1, 1)),",
        ),
        (
            "cuts: [(point: (0, 9, 0), normal: (0, -1, 0)), (point: (-1e3, 0, 0), normal: (1, 0, 0))], remove: common",
            "",
        ),
    ] {
        let seen = picture(&recipe(
            r#""thing": material(base_color: (0.8, 0.2, 0.2)), "shape": block(size: (40, 20), thickness: 30)"#,
            &format!("{camera} {cuts}, pixels: (100, 80), samples: 16, ground: false, background: (0, 0, 0)"),
        ));
        let [left, right, top, bottom] = bounds(&seen);
        let (beside, above) = ([left, 99 - right], [top, 79 - bottom]);
        assert!(
            beside.iter().chain(&above).all(|free| *free >= 3),
            "{cuts}: {beside:?} {above:?}"
        );
        let is_full = beside.iter().all(|free| *free <= 8) || above.iter().all(|free| *free <= 7);
        assert!(is_full, "{cuts}: {beside:?} {above:?}");
    }
}
