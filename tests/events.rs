//! Edits in one process: what runs again after each, and what is left of runs that end early.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "support/workshop.rs"]
mod workshop;

use insta::assert_snapshot;
use std::path::{Path, PathBuf};
use workshop::Workshop;
use yosegi::diagnostics::Code;
use yosegi::engine::{Cancel, Event, Options, RunError};
use yosegi::world::World;

/// 48 x 40 pixels in tiles of 16: nine tiles.
const BOARD: &str = r##"(
    nodes: {
        "tree": skeleton(
            trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)],
            branches: [(at: 590, direction: (1, 0, 0.5), thickening: 0.8)],
        ),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3, sharpness: 3),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "knots": mix(a: "look.colour", b: "#7a4524", amount: "= 0.5 * time.branch"),
        "wood": material(base_color: "knots", height: "= 0.05 * look.position"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    },
    outputs: {
        "board": maps(of: "plank", pixels: (48, 40), channels: [base_color]),
    },
)"##;

/// Two outputs that share the tree and nothing else.
const PAIR: &str = r##"(
    nodes: {
        "tree": skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3),
        "light": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "dark": colour_pattern(stops: [(at: 0, colour: "#805030"), (at: 1, colour: "#402010")]),
        "light_look": pattern_lookup(time: "time", pattern: "light"),
        "dark_look": pattern_lookup(time: "time", pattern: "dark"),
        "light_wood": material(base_color: "light_look"),
        "dark_wood": material(base_color: "dark_look"),
        "left": slice_cut(of: "light_wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
        "right": slice_cut(of: "dark_wood", cut: plain_sawn, origin: (0, 0, 600), offset: 20, size: (120, 100)),
    },
    outputs: {
        "pale": maps(of: "left", pixels: (48, 40)),
        "deep": maps(of: "right", pixels: (48, 40)),
    },
)"##;

const LOG: &str = r##"(
    nodes: {
        "log": skeleton_from_file(pith: "spruce_log/Gran_1_pith.json", every: 20),
        "time": growth_field(skeleton: "log", elongation: 900, thickening: 2.4),
        "bar": sample_pattern(file: "spruce_bar/spruce_bar.png", spans: bar, rings: 47),
        "look": pattern_lookup(time: "time", pattern: "bar"),
        "wood": material(base_color: "look"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (182, 170, 1000), size: (120, 100)),
    },
    outputs: { "board": maps(of: "plank", pixels: (48, 40)) },
)"##;

fn options() -> Options {
    Options {
        threads: Some(2),
        tile: 16,
        memory: 64 << 20,
        ..Options::default()
    }
}

fn without_store() -> Workshop {
    Workshop::new("recipes", options())
}

fn with_store() -> Workshop {
    Workshop::new("recipes", stored())
}

fn stored() -> Options {
    Options {
        store: Some(PathBuf::from("store")),
        ..options()
    }
}

/// The recipe with one piece of its text replaced.
fn edit(recipe: &str, from: &str, to: &str) -> String {
    assert_eq!(
        recipe.matches(from).count(),
        1,
        "`{from}` is not there once"
    );
    recipe.replace(from, to)
}

#[test]
fn a_chain_is_computed_once_and_then_reused() {
    let workshop = without_store();
    assert_snapshot!(workshop.run(BOARD), @"
    built tree
    built year
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
    let cold = workshop.map("board_base_color.png");
    assert_snapshot!(workshop.run(BOARD), @"
    reused tree (memory)
    reused year (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 0, reused 9
    tiles of board: time computed 0, reused 9
    written board_base_color.png
    ");
    assert_eq!(workshop.map("board_base_color.png"), cold);
}

#[test]
fn a_changed_colour_does_not_grow_the_tree_again() {
    let workshop = without_store();
    workshop.run(BOARD);
    assert_snapshot!(workshop.run(&edit(BOARD, "#9a6438", "#a06438")), @"
    built year
    reused tree (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: time computed 0, reused 9
    written board_base_color.png
    ");
    // The colour behind the lookup: not even the pattern is looked up again.
    assert_snapshot!(workshop.run(&edit(BOARD, "#7a4524", "#000000")), @"
    reused tree (memory)
    reused year (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 0, reused 9
    tiles of board: time computed 0, reused 9
    written board_base_color.png
    ");
}

#[test]
fn a_changed_speed_grows_again_on_the_same_tree() {
    let workshop = without_store();
    workshop.run(BOARD);
    assert_snapshot!(workshop.run(&edit(BOARD, "thickening: 3,", "thickening: 4,")), @"
    reused tree (memory)
    reused year (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
}

#[test]
fn a_changed_trunk_leaves_the_pattern() {
    let workshop = without_store();
    workshop.run(BOARD);
    assert_snapshot!(workshop.run(&edit(BOARD, "(10, 4, 600)", "(11, 4, 600)")), @"
    built tree
    reused year (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
}

#[test]
fn a_diamond_computes_its_foot_once() {
    // `time` is read by the lookup and by the amount of the mix; `knots` joins both.
    let workshop = without_store();
    workshop.run(BOARD);
    assert_snapshot!(workshop.run(&edit(BOARD, "0.5 * time.branch", "0.6 * time.branch")), @"
    reused tree (memory)
    reused year (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 0, reused 9
    tiles of board: time computed 0, reused 9
    written board_base_color.png
    ");
}

#[test]
fn a_moved_cut_computes_everything_but_structures() {
    let workshop = without_store();
    workshop.run(BOARD);
    assert_snapshot!(workshop.run(&edit(BOARD, "origin: (0, 0, 600)", "origin: (0, 0, 610)")), @"
    reused tree (memory)
    reused year (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
}

#[test]
fn a_changed_size_computes_other_tiles_and_the_old_ones_are_still_known() {
    let workshop = without_store();
    workshop.run(BOARD);
    assert_snapshot!(workshop.run(&edit(BOARD, "(48, 40)", "(24, 20)")), @"
    reused tree (memory)
    reused year (memory)
    tiles of board: knots computed 4, reused 0
    tiles of board: look computed 4, reused 0
    tiles of board: plank computed 4, reused 0
    tiles of board: time computed 4, reused 0
    written board_base_color.png
    ");
    assert_snapshot!(workshop.run(BOARD), @"
    reused tree (memory)
    reused year (memory)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 0, reused 9
    tiles of board: time computed 0, reused 9
    written board_base_color.png
    ");
}

#[test]
fn only_the_changed_one_of_two_outputs_is_rendered() {
    let workshop = with_store();
    assert_snapshot!(workshop.run(PAIR), @"
    built dark
    built light
    built tree
    tiles of deep: dark_look computed 9, reused 0
    tiles of deep: right computed 9, reused 0
    tiles of deep: time computed 9, reused 0
    tiles of pale: left computed 9, reused 0
    tiles of pale: light_look computed 9, reused 0
    tiles of pale: time computed 9, reused 0
    written deep_base_color.png
    written pale_base_color.png
    ");
    assert_snapshot!(workshop.run(&edit(PAIR, "#805030", "#905030")), @"
    built dark
    reused tree (memory)
    tiles of deep: dark_look computed 9, reused 0
    tiles of deep: time computed 0, reused 9
    up to date pale_base_color.png
    written deep_base_color.png
    ");
}

#[test]
fn only_the_wanted_output_is_rendered() {
    let workshop = without_store();
    let run = workshop.render(PAIR, &["deep"], Cancel::new(), &|_| {});
    assert_snapshot!(run.log(), @"
    built dark
    built tree
    tiles of deep: dark_look computed 9, reused 0
    tiles of deep: right computed 9, reused 0
    tiles of deep: time computed 9, reused 0
    written deep_base_color.png
    ");
    assert_eq!(workshop.maps(), ["deep_base_color.png"]);
}

#[test]
fn comments_names_and_order_change_nothing() {
    let workshop = with_store();
    workshop.run(BOARD);
    let commented = edit(
        BOARD,
        "\"time\": growth",
        "// how old the wood is\n \"time\": growth",
    );
    let renamed = BOARD
        .replace("\"look", "\"appearance")
        .replace("look.position", "appearance.position");
    let described = edit(BOARD, "(\n    nodes", "(\n about: \"A board.\",\n nodes");
    for recipe in [&commented, &renamed, &described] {
        assert_eq!(workshop.run(recipe), "up to date board_base_color.png");
    }
}

#[test]
fn a_renamed_node_finds_what_it_was_under_its_new_name() {
    let workshop = without_store();
    workshop.run(BOARD);
    let renamed = BOARD
        .replace("\"tree\"", "\"trunk\"")
        .replace("\"time\"", "\"age\"")
        .replace("time.branch", "age.branch");
    assert_snapshot!(workshop.run(&renamed), @"
    reused trunk (memory)
    reused year (memory)
    tiles of board: age computed 0, reused 9
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 0, reused 9
    written board_base_color.png
    ");
}

#[test]
fn a_changed_file_rebuilds_what_reads_it() {
    let workshop = without_store();
    assert_snapshot!(workshop.run(LOG), @"
    built bar
    built log
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
    let pith = workshop.folder.join("spruce_log/Gran_1_pith.json");
    let text = String::from_utf8(workshop.files.read(&pith).unwrap()).unwrap();
    assert!(text.contains("184.201146323"));
    workshop
        .files
        .insert(&pith, text.replace("184.201146323", "185.201146323"));
    assert_snapshot!(workshop.run(LOG), @"
    built log
    reused bar (memory)
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
}

#[test]
fn nothing_runs_after_a_structure_that_is_rebuilt_to_the_same_content() {
    for options in [options(), stored()] {
        let workshop = Workshop::new("recipes", options.clone());
        workshop.run(LOG);
        let pith = workshop.folder.join("spruce_log/Gran_1_pith.json");
        let text = String::from_utf8(workshop.files.read(&pith).unwrap()).unwrap();
        workshop
            .files
            .insert(&pith, text.replace("], [", "],\n   ["));
        let log = workshop.run(LOG);
        if options.store.is_some() {
            assert_snapshot!(log, @"
            built log
            reused bar (memory)
            up to date board_base_color.png
            ");
        } else {
            assert_snapshot!(log, @"
            built log
            reused bar (memory)
            tiles of board: look computed 0, reused 9
            written board_base_color.png
            ");
        }
    }
}

#[test]
fn without_memory_everything_runs_again_to_the_same_bytes() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            memory: 0,
            ..options()
        },
    );
    let first = (workshop.run(BOARD), workshop.map("board_base_color.png"));
    assert_snapshot!(first.0, @"
    built tree
    built year
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
    assert_eq!(
        (workshop.run(BOARD), workshop.map("board_base_color.png")),
        first
    );
    assert_eq!(workshop.engine.remembered_bytes(), 0);
}

#[test]
fn a_small_memory_keeps_its_budget() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            memory: 20_000,
            ..options()
        },
    );
    workshop.run(BOARD);
    let wanted = workshop.map("board_base_color.png");
    workshop.run(BOARD);
    let bytes = workshop.engine.remembered_bytes();
    assert!(bytes > 0 && bytes <= 20_000, "{bytes}");
    assert_eq!(workshop.map("board_base_color.png"), wanted);
}

#[test]
fn equal_nodes_are_computed_once() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            threads: Some(1),
            ..options()
        },
    );
    let twins = edit(
        BOARD,
        "\"year\":",
        r#""tree_again": skeleton(
            trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)],
            branches: [(at: 590, direction: (1, 0, 0.5), thickening: 0.8)],
        ),
        "time_again": growth_field(skeleton: "tree_again", elongation: 300, thickening: 3, sharpness: 3),
        "year":"#,
    );
    let twins = edit(&twins, "time.branch", "time_again.branch");
    // Away from the pith and the branch, where nothing is supersampled: there every tile counts once.
    let twins = edit(&twins, "cut: quarter_sawn", "cut: plain_sawn, offset: 60");
    let log = workshop.run(&twins);
    let count = |what: &str| log.lines().filter(|line| line.contains(what)).count();
    assert_eq!((count("built tree"), count("reused tree")), (1, 1), "{log}");
    assert_eq!(count(": time"), 1, "{log}");
}

#[test]
fn a_cancelled_run_leaves_no_map_and_the_next_one_completes() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            threads: Some(1),
            tile: 8,
            ..stored()
        },
    );
    let cancel = Cancel::new();
    let run = workshop.render(BOARD, &[], cancel.clone(), &|event| {
        if matches!(event, Event::Progress { .. }) {
            cancel.cancel();
        }
    });
    assert_eq!(run.result, Err(RunError::Cancelled));
    assert_eq!(run.events.last(), Some(&Event::Cancelled));
    assert_eq!(workshop.maps(), [""; 0]);
    workshop.run(BOARD);
    let fresh = without_store();
    fresh.run(BOARD);
    assert_eq!(
        workshop.map("board_base_color.png"),
        fresh.map("board_base_color.png")
    );
}

#[test]
fn a_run_that_is_cancelled_before_it_starts_builds_nothing() {
    let workshop = without_store();
    let cancel = Cancel::new();
    cancel.cancel();
    let run = workshop.render(BOARD, &[], cancel, &|_| {});
    assert_eq!(run.result, Err(RunError::Cancelled));
    assert_snapshot!(run.log(), @"cancelled");
}

#[test]
fn outputs_that_were_done_before_a_cancel_stay() {
    let workshop = without_store();
    let cancel = Cancel::new();
    let run = workshop.render(PAIR, &[], cancel.clone(), &|event| {
        if matches!(event, Event::OutputDone { .. }) {
            cancel.cancel();
        }
    });
    assert_eq!(run.result, Err(RunError::Cancelled));
    assert_eq!(workshop.maps(), ["pale_base_color.png"]);
}

/// `PAIR` with a cut that spans no plane in the output `deep`.
fn half_broken() -> String {
    edit(
        PAIR,
        "cut: plain_sawn, origin: (0, 0, 600), offset: 20",
        "origin: (0, 0, 600), across: (1, 0, 0), along: (1, 0, 0)",
    )
}

#[test]
fn a_failing_node_is_named_and_what_is_there_stays() {
    let workshop = with_store();
    workshop.run(PAIR);
    let before = ["deep_base_color.png", "pale_base_color.png"].map(|name| workshop.map(name));
    let run = workshop.render(&half_broken(), &[], Cancel::new(), &|_| {});
    let Err(RunError::Nodes(wrong)) = run.result else {
        panic!("{:?}", run.result);
    };
    let named: Vec<_> = wrong
        .iter()
        .map(|it| (it.code, it.node.as_deref()))
        .collect();
    assert_eq!(named, [(Code::NodeFailed, Some("right"))]);
    assert_eq!(
        ["deep_base_color.png", "pale_base_color.png"].map(|name| workshop.map(name)),
        before
    );
    // A failure is not remembered: the corrected recipe renders at once.
    assert_snapshot!(workshop.run(PAIR), @"
    up to date deep_base_color.png
    up to date pale_base_color.png
    ");
}

#[test]
fn nothing_is_painted_while_a_node_fails() {
    let workshop = without_store();
    let run = workshop.render(&half_broken(), &[], Cancel::new(), &|_| {});
    assert!(matches!(run.result, Err(RunError::Nodes(_))));
    assert_eq!(workshop.maps(), [""; 0]);
}

#[test]
fn every_failing_node_is_named_in_the_order_of_the_file() {
    let workshop = without_store();
    let both = edit(
        &half_broken(),
        "quarter_sawn, origin: (0, 0, 600)",
        "quarter_sawn, across: (1, 0, 0), origin: (0, 0, 600)",
    );
    let run = workshop.render(&both, &[], Cancel::new(), &|_| {});
    let Err(RunError::Nodes(wrong)) = run.result else {
        panic!("{:?}", run.result);
    };
    let named: Vec<_> = wrong.iter().map(|it| it.node.as_deref().unwrap()).collect();
    assert_eq!(named, ["left", "right"]);
    assert_eq!(workshop.maps(), [""; 0]);
}

#[test]
fn a_missing_file_is_a_failure_of_files() {
    let workshop = without_store();
    let run = workshop.render(
        &edit(LOG, "Gran_1_pith", "Gran_7_pith"),
        &[],
        Cancel::new(),
        &|_| {},
    );
    let Err(RunError::Files(wrong)) = run.result else {
        panic!("{:?}", run.result);
    };
    assert_eq!(
        (wrong[0].code, wrong[0].node.as_deref()),
        (Code::FileNotRead, Some("log"))
    );
}

#[test]
fn more_pixels_than_allowed_are_refused_before_anything_is_painted() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            largest_output: 48 * 40 - 1,
            ..options()
        },
    );
    let run = workshop.render(BOARD, &[], Cancel::new(), &|_| {});
    let Err(RunError::Limit(wrong)) = &run.result else {
        panic!("{:?}", run.result);
    };
    assert_eq!(wrong[0].code, Code::TooMuch);
    assert!(!run.log().contains("tiles"), "{}", run.log());
}

#[test]
fn an_overwritten_map_is_restored_from_the_store() {
    let workshop = with_store();
    workshop.run(BOARD);
    let path = workshop.folder.join("out/board_base_color.png");
    let right = workshop.map("board_base_color.png");
    // One byte of the pixels, behind the key in the header: only the hash of the file tells.
    let mut painted_over = right.clone();
    let middle = right.len() / 2;
    painted_over[middle] ^= 1;
    for wrong in [painted_over, right[..middle].to_vec(), vec![]] {
        workshop.files.insert(&path, wrong);
        assert_eq!(workshop.run(BOARD), "restored board_base_color.png");
        assert_eq!(workshop.map("board_base_color.png"), right);
    }
    assert_eq!(workshop.run(BOARD), "up to date board_base_color.png");
}

#[test]
fn a_map_is_restored_where_it_is_not_there_yet() {
    let mut workshop = with_store();
    workshop.run(BOARD);
    let right = workshop.map("board_base_color.png");
    workshop.folder = "elsewhere".into();
    assert_eq!(workshop.run(BOARD), "restored board_base_color.png");
    assert_eq!(workshop.map("board_base_color.png"), right);
}

#[test]
fn another_process_finds_structures_and_maps_in_the_store() {
    let first = with_store();
    first.run(BOARD);
    let second = first.another(stored());
    assert_eq!(second.run(BOARD), "up to date board_base_color.png");
    assert_snapshot!(second.run(&edit(BOARD, "thickening: 3,", "thickening: 4,")), @"
    reused tree (disk)
    reused year (disk)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
}

/// What harms an entry of the store.
const DAMAGES: [fn(&mut Vec<u8>); 5] = [
    |bytes| *bytes.last_mut().unwrap() ^= 1,
    |bytes| bytes[0] ^= 1,
    |bytes| bytes[40] ^= 1,
    |bytes| bytes.truncate(100),
    |bytes| bytes.clear(),
];

#[test]
fn a_damaged_entry_of_the_store_is_a_miss() {
    let first = with_store();
    first.run(BOARD);
    let right = first.map("board_base_color.png");
    let entries: Vec<PathBuf> = first
        .files
        .paths()
        .into_iter()
        .filter(|path| path.starts_with("store"))
        .collect();
    // Two structures, the plan, the map's record and the file itself.
    assert_eq!(entries.len(), 5);
    for entry in &entries {
        for damage in DAMAGES {
            let mut bytes = first.files.read(entry).unwrap();
            let whole = bytes.clone();
            damage(&mut bytes);
            first.files.insert(entry, bytes);
            first.files.insert(
                first.folder.join("out/board_base_color.png"),
                "painted over",
            );
            first.another(stored()).run(BOARD);
            assert_eq!(
                first.map("board_base_color.png"),
                right,
                "{}",
                entry.display()
            );
            // The run has put the entry back, if it needed it.
            let needed = !entry.starts_with("store/structure");
            assert!(
                !needed || first.files.read(entry).unwrap() == whole,
                "{}",
                entry.display()
            );
            first.files.insert(entry, whole);
        }
    }
}

#[test]
fn exchanged_entries_of_the_store_are_misses() {
    let first = with_store();
    first.run(PAIR);
    let right = first.map("pale_base_color.png");
    let files: Vec<PathBuf> = first
        .files
        .paths()
        .into_iter()
        .filter(|path| path.starts_with("store/file"))
        .collect();
    let [a, b] = files.as_slice() else {
        panic!("{files:?}")
    };
    let bytes = [a, b].map(|path| first.files.read(Path::new(path)).unwrap());
    first.files.insert(a, bytes[1].clone());
    first.files.insert(b, bytes[0].clone());
    first
        .files
        .insert(first.folder.join("out/pale_base_color.png"), "");
    let second = first.another(stored());
    second.run(PAIR);
    assert_eq!(second.map("pale_base_color.png"), right);
}
