//! `yosegi render`: its files, its options and its events.

use super::*;
use serde_json::json;
use yosegi::key::{Key, KeyHasher};

const MAPS: [&str; 3] = [
    "board_base_color.png",
    "board_normal.png",
    "plain_roughness.png",
];

#[test]
fn a_render_prints_its_files_and_nothing_else() {
    let place = Place::new(BOARD);
    let output = place.render(&[]);
    assert_eq!((code(&output), stderr(&output)), (0, String::new()));
    let expected: Vec<PathBuf> = MAPS
        .iter()
        .map(|name| Path::new("out").join(name))
        .collect();
    let printed = stdout(&output);
    assert_eq!(
        printed.lines().map(PathBuf::from).collect::<Vec<_>>(),
        expected
    );
    assert_eq!(place.names("out"), MAPS);
}

#[test]
fn a_second_render_says_that_all_is_up_to_date() {
    let place = Place::new(BOARD);
    let first = place.render(&["--json"]);
    assert_eq!(code(&first), 0);
    assert_eq!(
        events(&first, "map_written"),
        ["board/base_color", "board/normal", "plain/roughness"]
    );
    assert!(events(&first, "map_up_to_date").is_empty());
    let second = place.render(&["--json"]);
    assert_eq!(
        events(&second, "map_up_to_date"),
        ["board/base_color", "board/normal", "plain/roughness"]
    );
    assert_eq!(lines(&second).len(), 3);
    let told = place.render(&[]);
    assert_eq!(stderr(&told), "recipe.ron is up to date\n");
    assert_eq!(stdout(&told).lines().count(), 3);
    // One map of three has to be put back.
    fs::remove_file(place.path("out/board_normal.png")).unwrap();
    let told = place.render(&[]);
    assert_eq!((code(&told), stderr(&told)), (0, String::new()));
}

#[test]
fn without_a_cache_everything_is_written_again_and_no_store_is_made() {
    let place = Place::new(BOARD);
    for _ in 0..2 {
        let output = place.call(&["render", "recipe.ron", "--no-cache", "--json"]);
        assert_eq!(
            (code(&output), events(&output, "map_written").len()),
            (0, 3)
        );
    }
    let mut entries: Vec<_> = fs::read_dir(place.folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    entries.sort();
    assert_eq!(entries, ["out", "recipe.ron"]);
}

#[test]
fn vector_instructions_tiles_and_threads_give_the_same_files() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    let plain = place.files("out");
    for (index, arguments) in [
        ["--simd", "baseline"],
        ["--tile", "37"],
        ["--tile", "16"],
        ["--threads", "3"],
    ]
    .iter()
    .enumerate()
    {
        let folder = format!("out{index}");
        let rest = ["render", "recipe.ron", "--no-cache", "-o", &folder];
        assert_eq!(code(&place.call(&[&rest, &arguments[..]].concat())), 0);
        assert!(place.files(&folder) == plain, "{arguments:?}");
    }
}

#[test]
fn only_some_outputs_another_size_and_another_speed() {
    let place = Place::new(BOARD);
    assert_eq!(
        code(&place.render(&["--only", "plain", "--size", "8x6"])),
        0
    );
    assert_eq!(place.names("out"), ["plain_roughness.png"]);
    // Width and height stand in a PNG behind its signature and the head of its first chunk.
    let png = fs::read(place.path("out/plain_roughness.png")).unwrap();
    assert_eq!(png[16..24], [0, 0, 0, 8, 0, 0, 0, 6]);
    assert_eq!(code(&place.render(&["-o", "slow"])), 0);
    assert_eq!(code(&place.render(&["-o", "fast", "--set", "speed=4"])), 0);
    assert_ne!(place.files("slow")[0], place.files("fast")[0]);
    // Neither the height nor the roughness has to do with the growth.
    assert_eq!(place.files("slow")[1..], place.files("fast")[1..]);
}

#[test]
fn one_wrong_recipe_does_not_keep_the_others_from_rendering() {
    let place = Place::new(BOARD);
    place.write("wrong.ron", "(nodes: {})");
    let output = place.call(&["render", "wrong.ron", "recipe.ron", "--cache", "store"]);
    assert_eq!(code(&output), 2);
    assert_eq!(place.names("out/recipe"), MAPS);
}

#[test]
fn a_recipe_without_outputs_is_not_rendered() {
    let (nodes, _) = BOARD.split_once("    outputs").unwrap();
    let place = Place::new(&format!("{nodes})"));
    let output = place.render(&["--json"]);
    assert_eq!(code(&output), 2);
    assert_eq!(lines(&output).last().unwrap()["code"], "no-output");
    assert!(stderr(&place.render(&[])).contains("no output"));
}

#[test]
fn a_broken_store_is_said_and_does_no_harm() {
    let place = Place::new(BOARD);
    place.write("store", "not a folder");
    let output = place.render(&[]);
    assert_eq!(code(&output), 0);
    assert!(
        stderr(&output).contains("store of earlier results"),
        "{}",
        stderr(&output)
    );
    assert_eq!(place.names("out"), MAPS);
}

#[test]
fn programs_at_the_same_time_share_a_store_and_a_folder() {
    let place = Place::new(BOARD);
    assert_eq!(
        code(&place.call(&["render", "recipe.ron", "--no-cache", "-o", "right"])),
        0
    );
    let call = ["render", "recipe.ron", "--cache", "store", "--threads", "2"];
    for count in [2, 8] {
        let _ = fs::remove_dir_all(place.path("store"));
        let children: Vec<_> = (0..count).map(|_| start(&place, &call)).collect();
        for child in children {
            let output = child.wait_with_output().unwrap();
            // The last ones may have found nothing to do.
            let told = stderr(&output).replace("recipe.ron is up to date\n", "");
            assert_eq!((code(&output), told), (0, String::new()));
        }
        let verified = place.render(&["--verify-cache"]);
        let told = "7 results were computed again and compared\n".to_owned();
        assert_eq!((code(&verified), stderr(&verified)), (0, told));
    }
    assert!(place.files("out") == place.files("right"));
    assert_eq!(
        events(&place.render(&["--json"]), "map_up_to_date").len(),
        3
    );
}

#[test]
fn outputs_come_once_and_in_the_order_of_the_recipe() {
    let place = Place::new(BOARD);
    let asked = ["--only", "plain", "--only", "board", "--only", "plain"];
    let printed = stdout(&place.render(&asked));
    let expected: Vec<PathBuf> = MAPS
        .iter()
        .map(|name| Path::new("out").join(name))
        .collect();
    assert_eq!(
        printed.lines().map(PathBuf::from).collect::<Vec<_>>(),
        expected
    );
}

#[test]
fn a_map_that_is_there_already_is_warned_of_again() {
    warned_of_again(
        r##"(
            nodes: {
                "wood": material(base_color: "#c8a06e", height: 3),
                "board": slice_cut(of: "wood", cut: end_grain, origin: (0, 0, 0), size: (4, 3)),
            },
            outputs: { "board": maps(
                of: "board", pixels_per_mm: 1, channels: [height],
                ranges: [(channel: "height", low: 0, high: 1)],
            ) },
        )"##,
        "board_height.png: 12 samples were clamped; widen the range of `height`, or write EXR",
    );
    warned_of_again(
        r##"(
            nodes: {
                "at": position(),
                "wood": material(base_color: "#c8a06e", height: "= 1 mm * 1 mm / max(2.2 mm - at.u, 0 mm)"),
            },
            outputs: { "board": maps(of: "wood", size: (4, 3), pixels: (4, 3), channels: [height], format: exr_float) },
        )"##,
        "board_height.exr: 6 samples are not finite in the channel `height`, the first at pixel (2, 0) from the upper left, \
         (2.500, 2.500) mm from the lower left; look for a division by 0 in what is linked to it",
    );
}

/// A map is written, found, and put back from the store, each time with the same warning.
fn warned_of_again(recipe: &str, expected: &str) {
    let place = Place::new(recipe);
    let first = stderr(&place.render(&[]));
    assert!(first.contains(expected), "{first}");
    let second = format!("{first}recipe.ron is up to date\n");
    assert_eq!(stderr(&place.render(&[])), second);
    fs::remove_dir_all(place.folder.path().join("out")).unwrap();
    assert_eq!(stderr(&place.render(&[])), first);
}

#[test]
fn maps_that_cannot_show_what_they_ask_for_say_so() {
    let said = |maps: &str| {
        let place = Place::new(&format!(
            r##"(
            nodes: {{
                "tile": split_cells(period: (40, 40), pattern: rows, length: 20, width: 10),
                "found": cell_fields(cells: "tile"),
                "wood": material(base_color: "#c8a06e", height: "= 1 mm * found.random", extras: {{"id": "found.id"}}),
            }},
            outputs: {{ "it": maps(of: "wood", pixels: (4, 4), {maps}) }},
        )"##
        ));
        stderr(&place.render(&[]))
    };
    let cases = [
        (
            "size: (40, 40), channels: [base_color, base_colour, heigth]",
            "the material has no channels `base_colour` and `heigth`",
        ),
        (
            "size: (40, 40), channels: [base_color, base_colour, heigth]",
            "did you mean `base_color`, `height`?",
        ),
        (
            "size: (40, 40), channels: [id]",
            "ids are whole numbers: write `format: exr_float`",
        ),
        (
            "size: (40, 40), channels: [id], ranges: [(channel: \"id\", low: 0, high: 1000)]",
            "`id` from 0 to 1000 does not fit into the 256 values of png8, so different ids look the same",
        ),
        (
            "size: (100, 40), channels: [normal]",
            "the picture shows 100 x 40 mm of cells that repeat every 40 x 40 mm, so it has a seam where it is tiled; \
             80 x 40 mm would have none",
        ),
    ];
    for (maps, expected) in cases {
        assert!(said(maps).contains(expected), "{maps}: {}", said(maps));
    }
    let ids = "channels: [id], ranges: [(channel: \"id\", low: 0, high: 255)]";
    for size in ["80, 40", "20, 20"] {
        let told = said(&format!("size: ({size}), {ids}"));
        assert_eq!(told, "");
    }
}

/// The entry with another payload, as one writes it who knows how entries are made.
fn sealed(entry: &[u8], payload: &[u8]) -> Vec<u8> {
    let text = |range| std::str::from_utf8(&entry[range]).unwrap();
    let (key, family) = (text(72..136), text(136..152));
    let checksum = KeyHasher::new(family.trim_end(), 2)
        .key(Key::from_hexadecimal(key).unwrap())
        .bytes(payload)
        .finish();
    let header = format!("yosegi02{checksum}{key}{family}{:016x}", payload.len());
    [header.as_bytes(), payload].concat()
}

#[test]
fn a_verified_render_names_what_differs_with_1_and_replaces_it() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    let right = place.files("out");
    let verified = || place.render(&["--verify-cache"]);
    let output = verified();
    // Two structures, three maps, two plans.
    assert_eq!(
        (code(&output), stderr(&output)),
        (0, "7 results were computed again and compared\n".to_owned())
    );
    let records = place.path("store/map");
    let folder = fs::read_dir(records).unwrap().next().unwrap().unwrap();
    let record = fs::read_dir(folder.path())
        .unwrap()
        .next()
        .unwrap()
        .unwrap();
    let mut entry = fs::read(record.path()).unwrap();
    let mut payload = entry.split_off(168);
    // The number of samples that were not finite.
    payload[0] += 1;
    fs::write(record.path(), sealed(&entry, &payload)).unwrap();
    let output = verified();
    assert_eq!(code(&output), 1);
    let text = stderr(&output);
    assert!(text.contains("error[cache-mismatch]: the map `"), "{text}");
    assert!(
        text.contains(&record.file_name().into_string().unwrap()),
        "{text}"
    );
    assert_eq!(code(&verified()), 0);
    assert!(place.files("out") == right);
    let wrong = place.render(&["--verify-cache", "--no-cache"]);
    assert_eq!(code(&wrong), 2);
}

#[test]
fn a_small_store_stays_small_and_the_status_tells_its_limit() {
    let place = Place::new(BOARD);
    for speed in ["2", "3", "4", "5"] {
        let speed = format!("speed={speed}");
        let output = place.render(&["--set", &speed, "--cache-size", "80KiB"]);
        assert_eq!((code(&output), stderr(&output)), (0, String::new()));
    }
    let status = [
        "cache",
        "status",
        "--cache",
        "store",
        "--cache-size",
        "80KiB",
    ];
    let json = lines(&place.call(&[&status[..], &["--json"]].concat()));
    assert_eq!(json[0]["limit"], 80 << 10);
    assert!(json[0]["bytes"].as_u64().unwrap() <= 80 << 10);
    assert!(
        (10..=20).contains(&json[0]["entries"].as_u64().unwrap()),
        "{}",
        json[0]
    );
    let text = stdout(&place.call(&status));
    assert!(
        text.contains(" of at most 80.0 KiB, the oldest last used "),
        "{text}"
    );
    let none = place.render(&["--cache-size", "0"]);
    assert_eq!((code(&none), stderr(&none)), (0, String::new()));
    let json = lines(&place.call(&[&status[..], &["--json"]].concat()));
    assert_eq!(
        (&json[0]["entries"], &json[0]["oldest_seconds"]),
        (&json!(0), &json!(null))
    );
    assert_eq!(code(&place.render(&["--cache-size", "much"])), 2);
}
