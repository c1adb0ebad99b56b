//! Cuts of every kind as files: the same bytes whatever the tiles, threads and vector instructions.

use super::workshop::Workshop;
use yosegi::engine::Options;
use yosegi::key::Key;

const RECIPE: &str = r##"(
    nodes: {
        "log": skeleton(trunk: [(0, 0, 0), (6, 3, 250), (-5, -2, 500)], branches: [(at: 200, direction: (1, 0.3, 0.6), thickening: 1.1)]),
        "time": growth_field(skeleton: "log", elongation: 900, thickening: 6, sharpness: 3, reach: (300, 60)),
        "year": colour_pattern(stops: [(at: 0, colour: "#ecd0a4"), (at: 0.9, colour: "#b98552"), (at: 1, colour: "#a06c3c")]),
        "look": pattern_lookup(time: "time.time", pattern: "year"),
        "wood": material(base_color: "look.colour", height: "= 0.2 * look.position", opacity: "look.inside"),
        "cow": mesh_from_file(file: "spot/spot.obj", unit: cm, up: y),
        "boxed": mesh_from_file(file: "spot/spot.obj", unit: cm, up: y, places: box),
        "pot": patches_from_file(file: "teapot/teapot.txt", unit: inch),
        "worn": mesh_cut(of: "wood", mesh: "cow", placed: (scale: (16, 16, 16), move: (0, 0, 250))),
        "packed": mesh_cut(of: "wood", mesh: "boxed", placed: (scale: (16, 16, 16), move: (0, 0, 250))),
        "glazed": patch_cut(of: "wood", patches: "pot", placed: (move: (0, 0, 250), turn: (0, 90, 0))),
        "peeled": rotary_cut(of: "wood", radius: 60, pitch: 2, height: 60, origin: (0, 0, 180), length: 300),
    },
    outputs: {
        "worn": maps(of: "worn", pixels: (131, 97), channels: [base_color, normal, opacity]),
        "packed": maps(of: "packed", pixels: (131, 97), channels: [base_color, coverage], format: exr_half),
        "glazed": maps(of: "glazed", pixels: (131, 97), channels: [base_color, normal]),
        "peeled": maps(of: "peeled", pixels: (131, 97), channels: [base_color, normal]),
    },
)"##;

fn rendered(options: Options) -> Vec<(String, Key)> {
    let workshop = Workshop::new("recipes", options);
    workshop.run(RECIPE);
    let hash = |name: String| (name.clone(), Key::of_bytes(&workshop.map(&name)));
    workshop.maps().into_iter().map(hash).collect()
}

#[test]
fn bytes_depend_on_the_recipe_alone() {
    let options = |threads, tile| Options {
        threads: Some(threads),
        tile,
        ..Options::default()
    };
    let expected = rendered(options(2, 64));
    assert_eq!(expected.len(), 9);
    for (threads, tile) in [(1, 16), (3, 31), (2, 1024)] {
        assert_eq!(
            rendered(options(threads, tile)),
            expected,
            "{threads} threads, tiles of {tile}"
        );
    }
    for level in super::levels::levels() {
        let options = Options {
            level: Some(level),
            ..options(2, 64)
        };
        assert_eq!(rendered(options), expected, "{level:?}");
    }
}
