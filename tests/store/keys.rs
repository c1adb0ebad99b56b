//! What makes an entry another one and what does not, and what is never stored.

use super::*;
use std::fs::{self, File};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;
use yosegi::engine::RunError;
use yosegi::graph::{Settings, load_text_with};
use yosegi::node::{Build, Failure, Input, Inputs, Kind, Output};
use yosegi::nodes::KINDS;
use yosegi::value::{AfterEnd, ColourPattern, Type, Unit, Value};
use yosegi::world::Disk;

/// Whether a run after that of the board finds everything in place.
fn is_known(recipe: &str) -> bool {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let log = workshop.another(options()).run(recipe);
    assert!(
        log.contains("written") != log.contains("up to date"),
        "{log}"
    );
    log.contains("up to date")
}

fn edit(from: &str, to: &str) -> String {
    assert!(BOARD.contains(from), "{from}");
    BOARD.replace(from, to)
}

#[test]
fn the_last_bit_of_a_number_makes_another_map_and_the_sign_of_zero_does_not() {
    let next = f64::from_bits(300f64.to_bits() + 1);
    assert!(!is_known(&edit(
        "elongation: 300,",
        &format!("elongation: {next:?},")
    )));
    assert!(is_known(&edit("elongation: 300,", "elongation: 300.0,")));
    assert!(is_known(&edit(
        "trunk: [(0, 0, 0)",
        "trunk: [(-0.0, -0, 0)"
    )));
    assert!(is_known(&edit(
        "origin: (0, 0, 600)",
        "origin: (-0.0, 0, 600)"
    )));
    let tiny = f64::from_bits(1);
    assert!(!is_known(&edit(
        "trunk: [(0, 0, 0)",
        &format!("trunk: [({tiny:e}, 0, 0)")
    )));
}

#[test]
fn names_of_nodes_their_order_and_that_of_inputs_do_not_count() {
    assert!(is_known(&edit("\"tree\"", "\"bole\"")));
    let line = BOARD
        .lines()
        .find(|line| line.contains("\"year\""))
        .unwrap();
    let moved = BOARD
        .replace(line, "")
        .replacen("nodes: {", &format!("nodes: {{{line}"), 1);
    assert!(is_known(&moved));
    let reordered = edit(
        "time: \"time\", pattern: \"year\"",
        "pattern: \"year\", time: \"time\"",
    );
    assert!(is_known(&reordered));
    assert!(is_known(&edit("nodes: {", "// a comment\n    nodes: {")));
}

#[test]
fn an_asset_with_the_same_size_and_time_and_other_bytes_is_another() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = r##"(
        nodes: {
            "tree": skeleton_from_file(pith: "pith.json"),
            "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3),
            "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
            "look": pattern_lookup(time: "time", pattern: "year"),
            "wood": material(base_color: "look"),
            "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 500), size: (12, 10)),
        },
        outputs: { "board": maps(of: "plank", pixels: (8, 6), channels: [base_color]) },
    )"##;
    let options = Options {
        store: Some(folder.path().join("store")),
        ..options()
    };
    let mut workshop = workshop(options.clone()).another_on(Arc::new(Disk), options);
    workshop.folder = folder.path().to_owned();
    let path = folder.path().join("pith.json");
    let long_ago = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    let write = |pith: &str| {
        fs::write(&path, pith).unwrap();
        let file = File::options().write(true).open(&path).unwrap();
        file.set_modified(long_ago).unwrap();
    };
    write("[[0, 0, 0], [1, 0, 1000]]");
    assert!(workshop.run(recipe).contains("written"));
    assert!(workshop.run(recipe).contains("up to date"));
    write("[[0, 0, 0], [2, 0, 1000]]");
    assert!(workshop.run(recipe).contains("written"));
    write("[[0, 0, 0], [1, 0, 1000]]");
    assert!(workshop.run(recipe).contains("restored"));
}

static CALLS: AtomicUsize = AtomicUsize::new(0);
static NO_INPUTS: [Input; 1] = [Input::number("years", Unit::Year, "Not used.").default("1")];
static PATTERN: [Output; 1] = [Output::new("pattern", Type::ColourPattern, "Never.")];

/// Fails, or panics every other time.
static FAILS: Kind = Kind {
    name: "fails",
    version: 1,
    about: "Not for pictures.",
    source: "own construction",
    inputs: &NO_INPUTS,
    outputs: &PATTERN,
    example: "",
    build: |_, _| {
        let number = CALLS.fetch_add(1, Ordering::Relaxed);
        assert!(number.is_multiple_of(2), "a fault");
        Err(Failure::new("it fails"))
    },
};

#[test]
fn a_failure_is_never_stored() {
    let kinds: Vec<&'static Kind> = KINDS.iter().copied().chain([&FAILS]).collect();
    let recipe = edit(
        r##"colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")])"##,
        "fails()",
    );
    let graph = load_text_with(&kinds, "own.ron", &recipe, &Settings::default());
    let graph = graph.unwrap_or_else(|wrong| panic!("{wrong:?}")).graph;
    let workshop = workshop(options());
    for number in 1..5 {
        let run = workshop.render_graph(&graph, &[], Cancel::new(), &|_| {});
        assert!(matches!(run.result, Err(RunError::Nodes(_))));
        assert_eq!(CALLS.load(Ordering::Relaxed), number);
        // The skeleton alone: neither the failure, nor what reads it, nor a record of the run.
        assert_eq!(entries(&workshop), entries_of(&workshop, "structure"));
        assert_eq!(entries(&workshop).len(), 1);
    }
}

/// Cancels the run in which `half` is built next.
static SWITCH: Mutex<Option<Cancel>> = Mutex::new(None);

/// Gives what it has if the run is cancelled meanwhile, which kinds should not do.
static HALF: Kind = Kind {
    name: "half",
    build: build_half,
    ..FAILS
};

fn build_half(_: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    if let Some(switch) = SWITCH.lock().unwrap().take() {
        switch.cancel();
    }
    let steps = (0..10).take_while(|_| build.go_on().is_ok()).count();
    let pattern = ColourPattern {
        colours: vec![[steps as f32 * 0.05; 3]; 2],
        years: 1.0,
        ring_starts: vec![0.0],
        after_end: AfterEnd::Repeat,
        smooth: true,
    };
    Ok(vec![Value::ColourPattern(Arc::new(pattern))])
}

#[test]
fn what_a_cancelled_build_gives_is_remembered_neither_in_memory_nor_in_the_store() {
    let kinds: Vec<&'static Kind> = KINDS.iter().copied().chain([&HALF]).collect();
    let recipe = edit(
        r##"colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")])"##,
        "half()",
    );
    let graph = load_text_with(&kinds, "own.ron", &recipe, &Settings::default());
    let graph = graph.unwrap_or_else(|wrong| panic!("{wrong:?}")).graph;
    let render =
        |workshop: &Workshop, cancel: Cancel| workshop.render_graph(&graph, &[], cancel, &|_| {});
    let undisturbed = workshop(options());
    assert!(render(&undisturbed, Cancel::new()).result.is_ok());
    for has_memory in [true, false] {
        let workshop = workshop(options());
        let cancel = Cancel::new();
        *SWITCH.lock().unwrap() = Some(cancel.clone());
        assert_eq!(render(&workshop, cancel).result, Err(RunError::Cancelled));
        let next = match has_memory {
            true => workshop,
            false => workshop.another(options()),
        };
        let log = render(&next, Cancel::new()).log();
        assert!(log.contains("built year"), "{log}");
        assert!(MAPS.map(|name| next.map(name)) == MAPS.map(|name| undisturbed.map(name)));
    }
}

#[test]
fn a_cancelled_run_stores_nothing_of_what_it_did_not_finish() {
    for step in 0..4 {
        let workshop = workshop(options());
        let (cancel, heard) = (Cancel::new(), AtomicUsize::new(0));
        let run = workshop.render(BOARD, &[], cancel.clone(), &|_| {
            if heard.fetch_add(1, Ordering::Relaxed) == step {
                cancel.cancel();
            }
        });
        // The last steps may come after everything is done.
        assert!(run.result.is_err() || step > 1);
        if run.result.is_ok() {
            continue;
        }
        for family in ["plan", "run"] {
            assert_eq!(entries_of(&workshop, family), [] as [PathBuf; 0], "{step}");
        }
        for path in entries(&workshop) {
            let entry = workshop.files.read(&path).unwrap();
            assert_eq!(sealed(&path, &payload(&entry)), entry);
        }
        workshop.another(options()).run(BOARD);
        assert_eq!(MAPS.map(|name| workshop.map(name)), right_maps());
    }
}
