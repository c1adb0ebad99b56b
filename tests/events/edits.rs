//! What runs again after an edit.

use super::*;

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
fn maps_come_in_the_order_of_the_recipe() {
    let workshop = with_store();
    workshop.run(PAIR);
    // The first output is painted, the second is there.
    let recipe = edit(PAIR, "#e8c99b", "#f8d9ab");
    let run = workshop.render(&recipe, &[], Cancel::new(), &|_| {});
    let maps = run.result.unwrap();
    let outputs: Vec<&str> = maps.iter().map(|map| &*map.output).collect();
    assert_eq!(outputs, ["pale", "deep"]);
}
