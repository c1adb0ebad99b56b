//! Verification: everything that the caches would give is made again and compared.

use super::*;
use insta::assert_snapshot;
use std::sync::Arc;
use workshop::Run;
use yosegi::diagnostics::{Code, render_all};
use yosegi::engine::{Event, RunError};
use yosegi::field::{Block, Field, Kernel};
use yosegi::graph::{Graph, Settings, load_text_with};
use yosegi::node::{Build, Failure, Input, Inputs, Kind, Output};
use yosegi::nodes::KINDS;
use yosegi::value::{AfterEnd, ColourPattern, Domain, Type, Unit, Value};

fn verifying() -> Options {
    Options {
        verify: true,
        ..options()
    }
}

fn run_graph(workshop: &Workshop, graph: &Graph) -> Run {
    workshop.render_graph(graph, &[], Cancel::new(), &|_| {})
}

/// What a run says is wrong.
fn told(run: &Run) -> String {
    match &run.result {
        Err(error @ RunError::Nodes(all)) => {
            assert!(all.iter().all(|it| it.code == Code::CacheMismatch));
            let text = render_all(error.diagnostics());
            // The keys change with every version of the program.
            let words = text.split_inclusive([' ', '\n']);
            let word = |word: &str| match Key::from_hexadecimal(word.trim()) {
                Some(_) => word.replace(word.trim(), "KEY"),
                None => word.to_owned(),
            };
            words.map(word).collect()
        }
        other => panic!("{other:?}"),
    }
}

fn compared(run: &Run) -> usize {
    let compared = run.events.iter().find_map(|event| match event {
        Event::CacheVerified { compared } => Some(*compared),
        _ => None,
    });
    compared.unwrap()
}

#[test]
fn what_is_right_is_compared_and_stays() {
    let first = workshop(options());
    first.run(BOARD);
    let before = entries(&first);
    let bytes = |path: &PathBuf| first.files.read(path).unwrap();
    let contents: Vec<_> = before.iter().map(bytes).collect();
    let second = first.another(verifying());
    let run = second.render(BOARD, &[], Cancel::new(), &|_| {});
    // Two structures, two maps, and what the plan led to.
    assert_eq!(compared(&run), 5);
    assert!(run.log().contains("built tree"), "{}", run.log());
    assert!(run.log().contains("written board_height.png"));
    assert_eq!(entries(&first), before);
    assert_eq!(before.iter().map(bytes).collect::<Vec<_>>(), contents);
    // The engine has them in memory now as well, and the columns of growth time: four tiles at least.
    let run = second.render(BOARD, &[], Cancel::new(), &|_| {});
    assert!(compared(&run) >= 5 + 2 + 4, "{}", compared(&run));
    assert!(run.result.is_ok());
}

#[test]
fn without_anything_to_compare_a_verified_run_is_an_ordinary_one() {
    let workshop = workshop(verifying());
    let run = workshop.render(BOARD, &[], Cancel::new(), &|_| {});
    assert_eq!((compared(&run), run.result.is_ok()), (0, true));
    assert_eq!(MAPS.map(|name| workshop.map(name)), right_maps());
}

/// A map whose copy in the store was replaced by whoever knows how entries are made.
#[test]
fn a_map_that_is_another_in_the_store_is_named_and_replaced() {
    let first = workshop(options());
    first.run(BOARD);
    let right = right_maps();
    let mut wrong = right[1].clone();
    let middle = wrong.len() / 2;
    wrong[middle] ^= 1;
    let (old, new) = [&right[1], &wrong].map(|it| Key::of_bytes(it)).into();
    let copy = path_of("file", &new);
    first.files.insert(&copy, sealed(&copy, &wrong));
    replace_in_records(&first, old, new);
    // Believed as it is, since it is a whole entry.
    first.files.insert(place(&first, MAPS[1]), "");
    first.another(options()).run(BOARD);
    assert_eq!(first.map(MAPS[1]), wrong);
    let run = first.another(verifying());
    let run = run.render(BOARD, &[], Cancel::new(), &|_| {});
    assert_snapshot!(told(&run), @r#"
    error[cache-mismatch]: the map `height` of `board` (maps) is not what the store has under the key KEY
      --> recipes/recipe.ron:14:9
       |
    14 |         "board": maps(of: "plank", pixels: (24, 20), channels: [base_color, height],
       |         ^^^^^^^ made again, this differs
       |
       = help: the map `height` was replaced; a kind whose results change needs a new version
    "#);
    assert_eq!(MAPS.map(|name| first.map(name)), right);
    let again = first.another(verifying());
    let again = again.render(BOARD, &[], Cancel::new(), &|_| {});
    assert_eq!((compared(&again), again.result.is_ok()), (5, true));
}

/// In the records of maps one file takes the place of another of the same size.
fn replace_in_records(workshop: &Workshop, old: Key, new: Key) {
    for path in entries(workshop) {
        let old = old.hexadecimal();
        let bytes = |digits: &str| -> Vec<u8> {
            let pair = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).unwrap();
            (0..32).map(|index| pair(2 * index)).collect()
        };
        let (from, to) = (bytes(&old), bytes(&new.hexadecimal()));
        let mut payload = payload(&workshop.files.read(&path).unwrap());
        let found = payload.windows(32).position(|window| window == from);
        if let Some(at) = found.filter(|_| path.starts_with("store/map")) {
            payload[at..at + 32].copy_from_slice(&to);
            workshop.files.insert(&path, sealed(&path, &payload));
        }
    }
}

/// A kind that makes a structure; `light` in all its colours.
fn pattern(light: f32) -> Result<Vec<Value>, Failure> {
    Ok(vec![Value::ColourPattern(Arc::new(ColourPattern {
        colours: vec![[light; 3]; 4],
        years: 1.0,
        ring_starts: vec![0.0],
        after_end: AfterEnd::Repeat,
        smooth: false,
    }))])
}

#[derive(Debug)]
struct Plain {
    light: f32,
}

impl Kernel for Plain {
    fn add_to_key(&self, key: &mut yosegi::key::KeyHasher) {
        // Whoever has written it has forgotten the light.
        key.text("own_light").whole(1);
    }

    fn width(&self) -> usize {
        1
    }

    fn nanoseconds(&self) -> f32 {
        100.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        block.outputs[0].fill(self.light);
    }
}

fn light(build: &Build<'_>, light: f32) -> Result<Vec<Value>, Failure> {
    let position = Field::position(Domain::Solid);
    Ok(vec![Value::Field(
        build.kernel(Plain { light }, vec![position]),
    )])
}

type Make = fn(&Inputs<'_>, &Build<'_>) -> Result<Vec<Value>, Failure>;

static NOT_USED: [Input; 1] = [Input::number("years", Unit::Year, "Not used.").default("1")];
static PATTERN: [Output; 1] = [Output::new("pattern", Type::ColourPattern, "The pattern.")];
static LIGHT: [Output; 1] =
    [Output::field("light", Type::Number(Unit::One), "The number.").on(Domain::Solid)];

const fn own(name: &'static str, outputs: &'static [Output], build: Make) -> Kind {
    Kind {
        name,
        version: 1,
        about: "Not for pictures.",
        source: "own construction",
        inputs: &NOT_USED,
        outputs,
        example: "",
        build,
    }
}

static DARK_PATTERN: Kind = own("own_pattern", &PATTERN, |_, _| pattern(0.2));
static BRIGHT_PATTERN: Kind = own("own_pattern", &PATTERN, |_, _| pattern(0.8));
static DARK_LIGHT: Kind = own("own_light", &LIGHT, |_, build| light(build, 0.2));
static BRIGHT_LIGHT: Kind = own("own_light", &LIGHT, |_, build| light(build, 0.8));

const OWN: &str = r##"(
    nodes: {
        "year": own_pattern(),
        "light": own_light(),
        "look": pattern_lookup(time: 0.5, pattern: "year"),
        "wood": material(base_color: "look.colour", roughness: "light"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 0), size: (12, 10)),
    },
    outputs: {
        "colours": maps(of: "plank", pixels: (8, 6), channels: [base_color]),
        "lights": maps(of: "plank", pixels: (8, 6), channels: [roughness]),
    },
)"##;

fn own_graph(own: [&'static Kind; 2]) -> Graph {
    let kinds: Vec<&'static Kind> = KINDS.iter().copied().chain(own).collect();
    let loaded = load_text_with(&kinds, "own.ron", OWN, &Settings::default());
    loaded
        .unwrap_or_else(|wrong| panic!("{}", render_all(&wrong)))
        .graph
}

#[test]
fn a_kind_whose_results_change_without_a_new_version_is_caught() {
    let first = workshop(options());
    let dark = own_graph([&DARK_PATTERN, &DARK_LIGHT]);
    assert!(run_graph(&first, &dark).result.is_ok());
    let bright = own_graph([&BRIGHT_PATTERN, &BRIGHT_LIGHT]);
    // The store believes it.
    let believed = run_graph(&first.another(options()), &bright);
    assert!(believed.log().contains("up to date colours_base_color.png"));
    let run = run_graph(&first.another(verifying()), &bright);
    assert_snapshot!(told(&run), @r#"
    error[cache-mismatch]: the structure of `year` (own_pattern) is not what the store has under the key KEY
     --> own.ron:3:9
      |
    3 |         "year": own_pattern(),
      |         ^^^^^^ made again, this differs
      |
      = help: the structure was replaced; a kind whose results change needs a new version

    error[cache-mismatch]: what is known of `colours` (maps) is not what the store has under the key KEY
      --> own.ron:10:9
       |
    10 |         "colours": maps(of: "plank", pixels: (8, 6), channels: [base_color]),
       |         ^^^^^^^^^ made again, this differs
       |
       = help: what is known was replaced; a kind whose results change needs a new version

    error[cache-mismatch]: the map `roughness` of `lights` (maps) is not what the store has under the key KEY
      --> own.ron:11:9
       |
    11 |         "lights": maps(of: "plank", pixels: (8, 6), channels: [roughness]),
       |         ^^^^^^^^ made again, this differs
       |
       = help: the map `roughness` was replaced; a kind whose results change needs a new version

    3 errors
    "#);
    // What was wrong is replaced: the next one finds nothing to say.
    let again = run_graph(&first.another(verifying()), &bright);
    assert!(again.result.is_ok());
    let plain = workshop(Options {
        store: None,
        ..options()
    });
    assert!(run_graph(&plain, &bright).result.is_ok());
    for name in ["colours_base_color.png", "lights_roughness.png"] {
        assert_eq!(first.map(name), plain.map(name), "{name}");
    }
}

#[test]
fn columns_and_structures_in_memory_are_compared() {
    let workshop = workshop(Options {
        store: None,
        ..verifying()
    });
    let dark = own_graph([&DARK_PATTERN, &DARK_LIGHT]);
    assert!(run_graph(&workshop, &dark).result.is_ok());
    let bright = own_graph([&BRIGHT_PATTERN, &BRIGHT_LIGHT]);
    let run = run_graph(&workshop, &bright);
    assert_snapshot!(told(&run), @r#"
    error[cache-mismatch]: the structure of `year` (own_pattern) is not what the memory has under the key KEY
     --> own.ron:3:9
      |
    3 |         "year": own_pattern(),
      |         ^^^^^^ made again, this differs
      |
      = help: the structure was replaced; a kind whose results change needs a new version

    error[cache-mismatch]: a column of `light` (own_light) is not what the memory has under the key KEY
     --> own.ron:4:9
      |
    4 |         "light": own_light(),
      |         ^^^^^^^ made again, this differs
      |
      = help: a column was replaced; a kind whose results change needs a new version

    2 errors
    "#);
    assert!(run_graph(&workshop, &bright).result.is_ok());
}
