//! What `why` says before a run, and that the run does just that.

use super::*;
use yosegi::engine::{Cause, Explained, Fate, Render, Why};

fn ask(workshop: &Workshop, recipe: &str, name: &str) -> Why {
    let graph = workshop.graph(recipe);
    let before = workshop.files.paths();
    let why = workshop.engine.why(
        &Render {
            graph: &graph,
            folder: workshop.folder.join("out"),
            only: vec![],
            pixels: workshop.size,
            listener: &|event: Event| panic!("{event:?}"),
            cancel: Cancel::new(),
        },
        name,
    );
    assert_eq!(workshop.files.paths(), before, "something was written");
    why.unwrap_or_else(|error| panic!("{}", yosegi::diagnostics::render_all(error.diagnostics())))
}

/// One line for the node, its outputs and its inputs.
fn told(why: &Why) -> String {
    let line = |it: &Explained| match &it.cause {
        Some(cause) => format!("{} {}: {cause}", it.name, it.fate),
        None => format!("{} {}", it.name, it.fate),
    };
    let all = [&why.of].into_iter().chain(&why.outputs).chain(&why.inputs);
    all.map(line).collect::<Vec<_>>().join("\n")
}

fn first(why: &Why) -> Option<&str> {
    why.first_cause.as_ref().map(|it| it.name.as_str())
}

/// Memory off, so that everything that is reused comes from the store.
fn alone() -> Workshop {
    Workshop::new(
        "recipes",
        Options {
            memory: 0,
            ..stored()
        },
    )
}

#[test]
fn a_first_run_and_one_without_a_store_know_nothing() {
    let why = ask(&alone(), BOARD, "time");
    assert!(!why.earlier_run && why.first_cause.is_none());
    assert_snapshot!(told(&why), @"
    time is evaluated: `board` is painted
    board is painted: nothing is known of an earlier run
    tree is built: nothing is known of an earlier run
    ");
    let without = ask(&without_store(), BOARD, "tree");
    assert_eq!(
        (without.of.fate, without.of.cause),
        (Fate::Built, Some(Cause::NoStore))
    );
}

#[test]
fn what_is_up_to_date_does_not_run() {
    let workshop = alone();
    workshop.run(BOARD);
    assert_snapshot!(told(&ask(&workshop, BOARD, "tree")), @"
    tree does not run: no output that reads it is painted
    board is up to date
    ");
    let board = ask(&workshop, BOARD, "board");
    assert_eq!((board.of.fate, board.inputs.len()), (Fate::UpToDate, 7));
    assert!(board.inputs.iter().all(|it| it.fate == Fate::NotNeeded));
    // A node that no output reads.
    let loose = edit(
        BOARD,
        "\"time\":",
        "\"loose\": solid_noise(size: (6, 6, 6)), \"time\":",
    );
    let why = ask(&workshop, &loose, "loose");
    assert_eq!(
        (why.of.fate, why.of.cause),
        (Fate::NotNeeded, Some(Cause::NotRead))
    );
}

#[test]
fn the_first_changed_input_is_named_with_both_values() {
    let workshop = alone();
    workshop.run(BOARD);
    let edits = [
        ("elongation: 300", "elongation: 310", "time"),
        ("#9a6438", "#9a6439", "year"),
        ("a: \"look.colour\"", "a: (0.5, 0.25, 1)", "knots"),
        ("= 0.5 * time.branch", "= 0.5 * (1 - time.branch)", "knots"),
        (
            "skeleton: \"tree\", ",
            "skeleton: \"tree\", reach: (3, 4), ",
            "time",
        ),
        ("(at: 590, direction", "(at: 591, direction", "tree"),
        ("channels: [base_color]", "channels: [normal]", "board"),
        ("cut: quarter_sawn", "cut: plain_sawn", "plank"),
    ];
    let said = edits.map(|(from, to, name)| {
        let why = ask(&workshop, &edit(BOARD, from, to), name);
        assert_eq!(first(&why), Some(name));
        format!("{name}: {}", why.of.cause.unwrap())
    });
    assert_snapshot!(said.join("\n"), @r##"
    time: input `elongation` changed: 300 -> 310
    year: input `stops` changed: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")] -> [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6439")]
    knots: input `a` changed: `look` -> (0.5, 0.25, 1)
    knots: input `amount` changed: = 0.5 * time.branch -> = 0.5 * (1 - time.branch)
    time: input `reach` changed: nothing -> (3, 4)
    tree: input `branches` changed: [(at: 590, direction: (1, 0, 0.5), thickening: 0.8)] -> [(at: 591, direction: (1, 0, 0.5), thickening: 0.8)]
    board: input `channels` changed: [base_color] -> [normal]
    plank: input `cut` changed: quarter_sawn -> plain_sawn
    "##);
}

#[test]
fn a_change_is_followed_to_where_it_began() {
    let workshop = alone();
    workshop.run(BOARD);
    let why = ask(
        &workshop,
        &edit(BOARD, "(10, 4, 600)", "(11, 4, 600)"),
        "look",
    );
    assert!(why.earlier_run);
    assert_eq!(first(&why), Some("tree"));
    assert_snapshot!(told(&why), @"
    look is evaluated: `time` changed (input `time`)
    board is painted, unless its maps come out as before: `plank` changed (input `of`)
    time is evaluated: `tree` changed (input `skeleton`)
    tree is built: input `trunk` changed: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)] -> [(0, 0, 0), (11, 4, 600), (0, 0, 1200)]
    year is reused from the store
    ");
    // The run does what was said.
    let log = workshop.run(&edit(BOARD, "(10, 4, 600)", "(11, 4, 600)"));
    assert!(
        log.contains("built tree") && log.contains("reused year (disk)"),
        "{log}"
    );
}

#[test]
fn a_renamed_node_has_not_changed_and_a_new_one_is_new() {
    let workshop = alone();
    workshop.run(BOARD);
    let renamed = BOARD
        .replace("\"tree\"", "\"trunk\"")
        .replace("thickening: 3,", "thickening: 4,");
    let why = ask(&workshop, &renamed, "trunk");
    assert_eq!((why.of.fate, why.of.cause), (Fate::ReusedFromDisk, None));
    let other = edit(BOARD, "b: \"#7a4524\"", "b: \"blotch\"");
    let other = edit(
        &other,
        "\"knots\":",
        "\"blotch\": mix(a: \"look\", b: \"#000000\", amount: 0.1), \"knots\":",
    );
    assert_eq!(ask(&workshop, &other, "blotch").of.cause, Some(Cause::New));
    let kind = edit(
        BOARD,
        "colour_pattern(stops: [(at: 0, colour: \"#e8c99b\"), (at: 1, colour: \"#9a6438\")])",
        "sample_pattern(file: \"spruce_bar/spruce_bar.png\", spans: bar, rings: 47)",
    );
    let (from, to) = ("colour_pattern".to_owned(), "sample_pattern".to_owned());
    assert_eq!(
        ask(&workshop, &kind, "year").of.cause,
        Some(Cause::KindChanged { from, to })
    );
}

#[test]
fn files_sizes_and_seeds_are_causes() {
    let log = edit(
        BOARD,
        "colour_pattern(stops: [(at: 0, colour: \"#e8c99b\"), (at: 1, colour: \"#9a6438\")])",
        "sample_pattern(file: \"spruce_bar/spruce_bar.png\", spans: bar, rings: 47)",
    );
    let mut workshop = alone();
    workshop.run(&log);
    let bar = workshop.folder.join("spruce_bar/spruce_bar.png");
    let mut bytes = workshop.files.read(&bar).unwrap();
    bytes.push(0);
    workshop.files.insert(&bar, bytes);
    let why = ask(&workshop, &log, "look");
    assert_eq!(first(&why), Some("year"));
    let file = "\"spruce_bar/spruce_bar.png\"".to_owned();
    let input = "file".to_owned();
    assert_eq!(
        why.first_cause.unwrap().cause,
        Some(Cause::FileChanged { input, file })
    );
    workshop.run(&log);
    workshop.size = Some([24, 20]);
    let size = ask(&workshop, &log, "board").of.cause;
    let (from, to) = (None, Some([24, 20]));
    assert_eq!(size, Some(Cause::SizeChanged { from, to }));
    workshop.size = None;
    let grain = edit(BOARD, "b: \"#7a4524\"", "b: (0, 0, 0)");
    let grain = edit(&grain, "\"= 0.5 * time.branch\"", "\"speckle.value\"");
    let grain = edit(
        &grain,
        "\"knots\":",
        "\"speckle\": solid_noise(size: (6, 6, 6)), \"knots\":",
    );
    workshop.run(&grain);
    let seeded = edit(&grain, "(\n    nodes", "(\n    seed: 7,\n    nodes");
    let why = ask(&workshop, &seeded, "plank");
    assert_eq!(first(&why), Some("speckle"));
    let (from, to) = (0, 7);
    assert_eq!(
        why.first_cause.unwrap().cause,
        Some(Cause::SeedChanged { from, to })
    );
}

#[test]
fn lost_maps_are_causes_and_copies_are_told() {
    let workshop = alone();
    workshop.run(BOARD);
    let path = workshop.folder.join("out/board_base_color.png");
    workshop.files.insert(&path, "painted over");
    let why = ask(&workshop, BOARD, "board");
    assert_eq!(
        (why.of.fate, why.of.cause),
        (Fate::Restored, Some(Cause::FileNotThere))
    );
    assert_eq!(ask(&workshop, BOARD, "time").of.fate, Fate::NotNeeded);
    for entry in workshop.files.paths() {
        if entry.starts_with("store/file") {
            workshop.files.insert(entry, "");
        }
    }
    let why = ask(&workshop, BOARD, "board");
    assert_eq!(
        (why.of.fate, why.of.cause),
        (Fate::Painted, Some(Cause::MapLost { path }))
    );
    let output = "board".to_owned();
    let time = ask(&workshop, BOARD, "time").of;
    assert_eq!(
        (time.fate, time.cause),
        (Fate::Evaluated, Some(Cause::OutputPainted { output }))
    );
}

#[test]
fn an_output_that_comes_out_as_before_is_said_to_be_uncertain() {
    let plain = edit(BOARD, "[base_color]", "[roughness]");
    let workshop = alone();
    workshop.run(&plain);
    let changed = edit(&plain, "thickening: 3,", "thickening: 4,");
    assert_eq!(
        ask(&workshop, &changed, "board").of.fate,
        Fate::PaintedUnlessKnown
    );
    let log = workshop.run(&changed);
    assert!(log.contains("up to date board_roughness.png"), "{log}");
}

#[test]
fn a_damaged_record_is_no_record_and_harms_nothing() {
    let workshop = alone();
    workshop.run(BOARD);
    let record = workshop.files.paths();
    let record = record
        .iter()
        .find(|path| path.starts_with("store/run"))
        .unwrap();
    let mut bytes = workshop.files.read(record).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    workshop.files.insert(record, bytes);
    assert!(!ask(&workshop, BOARD, "time").earlier_run);
    assert_eq!(workshop.run(BOARD), "up to date board_base_color.png");
    assert!(ask(&workshop, BOARD, "time").earlier_run);
}

#[test]
fn a_run_of_some_outputs_keeps_what_is_known_of_the_others() {
    let workshop = alone();
    workshop.run(PAIR);
    let changed = edit(PAIR, "#805030", "#905030");
    let run = workshop.render(&changed, &["pale"], Cancel::new(), &|_| {});
    assert!(run.result.is_ok());
    let said = ask(&workshop, &changed, "dark")
        .of
        .cause
        .unwrap()
        .to_string();
    assert!(
        said.contains("#805030") && said.contains("#905030"),
        "{said}"
    );
    // A failed run is none: the comparison is with the last one that ended well.
    let broken = edit(
        &changed,
        "cut: plain_sawn, ",
        "across: (1, 0, 0), along: (1, 0, 0), ",
    );
    assert!(
        workshop
            .render(&broken, &[], Cancel::new(), &|_| {})
            .result
            .is_err()
    );
    assert_eq!(
        ask(&workshop, &changed, "dark")
            .of
            .cause
            .unwrap()
            .to_string(),
        said
    );
}

#[test]
fn unknown_names_are_refused_with_the_nearest() {
    let workshop = alone();
    let graph = workshop.graph(BOARD);
    let request = Render {
        graph: &graph,
        folder: "out".into(),
        only: vec![],
        pixels: None,
        listener: &|_: Event| {},
        cancel: Cancel::new(),
    };
    let Err(RunError::Request(wrong)) = workshop.engine.why(&request, "tre") else {
        panic!("there is no node `tre`");
    };
    assert_eq!(
        (wrong[0].code, wrong[0].nearest[0].as_str()),
        (Code::UnknownNode, "tree")
    );
}

#[test]
fn a_deep_chain_costs_no_stack() {
    let links: String = (1..2000)
        .map(|index| {
            let before = index - 1;
            format!("\"n{index}\": mix(a: \"n{before}\", b: \"n{before}\", amount: 0.5),\n")
        })
        .collect();
    let recipe = format!(
        r##"(nodes: {{
            "n0": mix(a: "#000000", b: "#ffffff", amount: 0.25),
            {links}
            "wood": material(base_color: "n1999"),
            "piece": slice_cut(of: "wood", cut: end_grain, origin: (0, 0, 0), size: (4, 4)),
        }}, outputs: {{ "board": maps(of: "piece", pixels: (4, 4), channels: [roughness]) }})"##
    );
    let workshop = alone();
    workshop.run(&recipe);
    let why = ask(
        &workshop,
        &edit(&recipe, "amount: 0.25", "amount: 0.75"),
        "board",
    );
    assert_eq!(first(&why), Some("n0"));
    assert_eq!(why.inputs.len(), 2002);
}
