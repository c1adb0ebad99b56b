//! The same recipe gives the same bytes: whatever the threads, tiles, vector instructions and caches.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "support/levels.rs"]
mod levels;
#[path = "support/workshop.rs"]
mod workshop;

use std::path::PathBuf;
use workshop::Workshop;
use yosegi::engine::Options;
use yosegi::key::Key;

/// A bent trunk with three branches, in all formats.
const TRUNK: &str = r##"(
    nodes: {
        "tree": skeleton(
            trunk: [(0, 0, 0), (22, 6, 500), (-10, -8, 1100), (14, 4, 1700), (0, 0, 2400)],
            branches: [
                (at: 620, direction: (1, 0.1, 0.5), thickening: 0.5),
                (at: 900, direction: (-0.8, -0.7, 0.6), thickening: 0.7),
                (at: 1180, direction: (-0.6, 0.9, 0.4), thickening: 0.6),
            ],
        ),
        "time": growth_field(skeleton: "tree", elongation: 350, thickening: 3, sharpness: 3, reach: (400, 60)),
        "year": colour_pattern(stops: [
            (at: 0, colour: "#e8c99b"), (at: 0.55, colour: "#dcb785"), (at: 0.92, colour: "#b27b48"), (at: 1, colour: "#9a6438"),
        ]),
        "look": pattern_lookup(time: "time.time", pattern: "year"),
        "knots": mix(a: "look.colour", b: "#7a4524", amount: "= 0.45 * time.branch"),
        "wood": material(
            base_color: "knots",
            height: "= 0.05 * look.position + 0.2 * max(time.branch, 0.5) * time.branch",
            roughness: "= 0.6 - 0.1 * look.position",
            extras: { "growth_time": "time.time" },
        ),
        "piece": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 900), size: (200, 270)),
    },
    outputs: {
        "a": maps(of: "piece", pixels: (97, 131), channels: [base_color, normal, roughness]),
        "b": maps(of: "piece", pixels: (97, 131), format: png16, channels: [base_color, normal]),
        "c": maps(of: "piece", pixels: (97, 131), format: exr_half, channels: [base_color, height, normal]),
        "d": maps(of: "piece", pixels: (97, 131), format: exr_float, channels: [base_color, height, normal, growth_time]),
        "e": maps(of: "piece", pixels: (97, 131), format: tiff8, channels: [base_color]),
        "f": maps(of: "piece", pixels: (97, 131), format: tiff16, channels: [normal]),
        "g": maps(of: "piece", pixels: (97, 131), format: tiff_half, channels: [base_color]),
        "h": maps(of: "piece", pixels: (97, 131), format: tiff_float, channels: [height]),
        "i": maps(of: "piece", pixels: (97, 131), format: bmp, channels: [base_color, roughness]),
    },
)"##;

/// The scanned log with all its knots.
const LOG: &str = r##"(
    nodes: {
        "log": skeleton_from_file(pith: "spruce_log/Gran_1_pith.json", knots: "spruce_log/Gran_1_knots.json", every: 5),
        "time": growth_field(skeleton: "log", elongation: 1700, thickening: 2.4, sharpness: 4, reach: (260, 70)),
        "bar": sample_pattern(file: "spruce_bar/spruce_bar.png", spans: bar, rings: 47, even_years: false),
        "look": pattern_lookup(time: "time.time", pattern: "bar"),
        "colour": mix(a: "look.colour", b: "#6b3d1f", amount: "= 0.5 * time.branch"),
        "spruce": material(base_color: "colour", height: "= 0.06 * look.position", opacity: "look.inside"),
        "piece": slice_cut(of: "spruce", cut: plain_sawn, origin: (182, 170, 1150), offset: 34, size: (140, 190)),
    },
    outputs: {
        "a": maps(of: "piece", pixels: (97, 131), channels: [base_color, normal, opacity]),
        "b": maps(of: "piece", pixels: (97, 131), format: png16, channels: [base_color, normal]),
        "c": maps(of: "piece", pixels: (97, 131), format: exr_half, channels: [base_color, height]),
        "d": maps(of: "piece", pixels: (97, 131), format: exr_float, channels: [base_color, height, normal]),
    },
)"##;

/// The same number of threads, tiles and so on wherever a test does not say otherwise.
fn options() -> Options {
    Options {
        threads: Some(2),
        tile: 64,
        memory: 0,
        ..Options::default()
    }
}

/// Every map with the hash of its file.
fn hashes(workshop: &Workshop) -> Vec<(String, Key)> {
    let hash = |name: String| (name.clone(), Key::of_bytes(&workshop.map(&name)));
    workshop.maps().into_iter().map(hash).collect()
}

fn rendered(recipe: &str, options: Options) -> Vec<(String, Key)> {
    let workshop = Workshop::new("recipes", options);
    workshop.run(recipe);
    hashes(&workshop)
}

#[test]
fn every_map_is_there_and_shows_something() {
    for (recipe, count) in [(TRUNK, 18), (LOG, 10)] {
        let mut hashes: Vec<Key> = rendered(recipe, options())
            .into_iter()
            .map(|(_, key)| key)
            .collect();
        assert_eq!(hashes.len(), count);
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), count, "two maps are the same file");
    }
}

#[test]
fn any_number_of_threads() {
    for recipe in [TRUNK, LOG] {
        let one = rendered(
            recipe,
            Options {
                threads: Some(1),
                tile: 37,
                ..options()
            },
        );
        for threads in [2, 3, 7] {
            let many = rendered(
                recipe,
                Options {
                    threads: Some(threads),
                    tile: 37,
                    ..options()
                },
            );
            assert_eq!(many, one, "{threads} threads");
        }
    }
}

#[test]
fn any_tile() {
    for recipe in [TRUNK, LOG] {
        let whole = rendered(
            recipe,
            Options {
                tile: 256,
                ..options()
            },
        );
        for tile in [16, 37, 64] {
            assert_eq!(
                rendered(recipe, Options { tile, ..options() }),
                whole,
                "tiles of {tile}"
            );
        }
    }
}

#[test]
fn tiny_tiles() {
    let narrow = TRUNK.replace("(97, 131)", "(13, 9)");
    let whole = rendered(&narrow, options());
    for tile in [1, 2, 3] {
        assert_eq!(
            rendered(&narrow, Options { tile, ..options() }),
            whole,
            "tiles of {tile}"
        );
    }
}

#[test]
fn any_vector_instructions() {
    for recipe in [TRUNK, LOG] {
        let best = rendered(recipe, options());
        for level in levels::levels() {
            let other = rendered(
                recipe,
                Options {
                    level: Some(level),
                    ..options()
                },
            );
            assert_eq!(other, best, "{level:?}");
        }
    }
}

#[test]
fn cold_warm_and_from_the_store() {
    for recipe in [TRUNK, LOG] {
        let plain = rendered(recipe, options());
        let warm = Workshop::new(
            "recipes",
            Options {
                memory: 256 << 20,
                ..options()
            },
        );
        for _ in 0..2 {
            warm.run(recipe);
            assert_eq!(hashes(&warm), plain);
        }
        let stored = Options {
            store: Some(PathBuf::from("store")),
            ..options()
        };
        let mut first = Workshop::new("recipes", stored.clone());
        first.run(recipe);
        assert_eq!(hashes(&first), plain);
        // Structures from the store, maps painted anew.
        for path in first.files.paths() {
            if path.starts_with("store") && !path.starts_with("store/structure") {
                first.files.insert(path, "");
            }
        }
        let second = first.another(stored.clone());
        let log = second.run(recipe);
        assert!(log.contains("(disk)") && !log.contains("built"), "{log}");
        assert_eq!(hashes(&second), plain);
        // Maps from the store, in another folder.
        first.folder = PathBuf::from("elsewhere");
        for asset in [
            "spruce_log/Gran_1_pith.json",
            "spruce_log/Gran_1_knots.json",
            "spruce_bar/spruce_bar.png",
        ] {
            first
                .files
                .insert(first.folder.join(asset), workshop::asset_bytes(asset));
        }
        let log = first.run(recipe);
        assert!(
            log.lines().all(|line| line.starts_with("restored")),
            "{log}"
        );
        assert_eq!(hashes(&first), plain);
    }
}

/// A memory that holds the columns of one recipe must not change what the next one gives.
#[test]
fn a_memory_full_of_relatives() {
    let small_tiles = || Options {
        tile: 16,
        ..options()
    };
    let before = TRUNK
        .replace(
            "0.05 * look.position + 0.2 * max(time.branch, 0.5) * time.branch",
            "0.2 * max(time.branch, 0.5) * time.branch",
        )
        .replace("0.6 - 0.1 * look.position", "0.5 + 0.1 * look.inside");
    let after = TRUNK.replace("+ 0.2 * max(time.branch, 0.5) * time.branch", "");
    assert!(before != TRUNK && after != TRUNK);
    let plain = [TRUNK, &before, &after].map(|recipe| rendered(recipe, small_tiles()));
    let warm = Workshop::new(
        "recipes",
        Options {
            memory: 256 << 20,
            ..small_tiles()
        },
    );
    for turn in [1, 0, 2, 1, 2, 0] {
        warm.run([TRUNK, &before, &after][turn]);
        assert_eq!(hashes(&warm), plain[turn], "recipe {turn}");
    }
}

#[test]
fn another_folder_and_another_order() {
    let plain = rendered(TRUNK, options());
    let elsewhere = Workshop::new("some/where else", options());
    elsewhere.run(TRUNK);
    assert_eq!(hashes(&elsewhere), plain);
    // The nodes from the last to the first.
    let (head, rest) = TRUNK.split_once("nodes: {\n").unwrap();
    let (nodes, tail) = rest.split_once("\n    },\n    outputs").unwrap();
    let mut nodes: Vec<&str> = nodes.split("\n        \"").collect();
    assert_eq!(nodes.len(), 7);
    nodes.reverse();
    let last = nodes.len() - 1;
    nodes[last] = nodes[last].trim_start().trim_start_matches('"');
    let reversed = format!(
        "{head}nodes: {{\n        \"{}\n    }},\n    outputs{tail}",
        nodes.join("\n        \"")
    );
    assert_eq!(rendered(&reversed, options()), plain);
}

#[test]
fn one_output_alone() {
    let plain = rendered(TRUNK, options());
    let alone = Workshop::new("recipes", options());
    alone
        .render(TRUNK, &["d"], yosegi::engine::Cancel::new(), &|_| {})
        .result
        .unwrap();
    let wanted: Vec<_> = plain
        .into_iter()
        .filter(|(name, _)| name.starts_with("d_"))
        .collect();
    assert_eq!(hashes(&alone), wanted);
}
