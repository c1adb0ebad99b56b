//! Laws that hold for every kind of node, enumerated from the table of kinds.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "support/levels.rs"]
mod levels;
#[path = "support/workshop.rs"]
mod workshop;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use workshop::Workshop;
use yosegi::engine::{Cancel, Options, RunError, SampledField};
use yosegi::graph::{Graph, Settings, Source, load_text};
use yosegi::node::{Input, Kind, Presence, common_domain};
use yosegi::nodes::{KINDS, kind};
use yosegi::value::{Domain, Type};

/// Loads the recipe of an example; neither errors nor warnings are allowed.
fn loaded(kind: &Kind, recipe: &str) -> Graph {
    match load_text("recipes/example.ron", recipe, &Settings::default()) {
        Ok(loaded) => {
            assert_eq!(loaded.warnings, [], "example of `{}`", kind.name);
            loaded.graph
        }
        Err(wrong) => panic!(
            "example of `{}`:\n{}",
            kind.name,
            yosegi::diagnostics::render_all(&wrong)
        ),
    }
}

fn workshop() -> Workshop {
    Workshop::new(
        "recipes",
        Options {
            threads: Some(2),
            ..Options::default()
        },
    )
}

/// The fields of the node `example`; none if it gives structures or maps.
fn fields(workshop: &Workshop, kind: &Kind, graph: &Graph) -> Vec<SampledField> {
    if graph.node("example").is_none() {
        return vec![];
    }
    match workshop.engine.fields(graph, "example", &|_| {}) {
        Ok(fields) => fields,
        Err(RunError::Request(_)) if kind.is_structure() => vec![],
        Err(error) => panic!("`{}`: {error:?}", kind.name),
    }
}

/// 2000 reproducible points of a solid 1 m wide and 2.4 m high, or of a plane (linear congruential, Knuth's MMIX).
fn points(fields: &[SampledField]) -> Vec<[f64; 3]> {
    let mut state = 1u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let domain = common_domain(fields.iter().map(|sampled| &sampled.field));
    let mut point = || match domain {
        Domain::Plane => [1000.0 * random(), 1000.0 * random(), 0.0],
        _ => [
            1000.0 * random() - 500.0,
            1000.0 * random() - 500.0,
            2400.0 * random(),
        ],
    };
    (0..2000).map(|_| point()).collect()
}

fn bits(values: &[Vec<Vec<f32>>]) -> Vec<Vec<Vec<u32>>> {
    let column = |column: &Vec<f32>| column.iter().map(|value| value.to_bits()).collect();
    values
        .iter()
        .map(|columns| columns.iter().map(column).collect())
        .collect()
}

#[test]
fn every_example_is_a_recipe_with_its_own_kind_in_it() {
    for kind in KINDS {
        let graph = loaded(kind, kind.example);
        let output = graph
            .outputs
            .iter()
            .map(|index| &graph.nodes[*index])
            .find(|node| &*node.name == "example");
        let node = graph.node("example").or(output);
        let node = node.unwrap_or_else(|| panic!("no `example` in the example of `{}`", kind.name));
        assert_eq!(node.kind.name, kind.name);
    }
}

#[test]
fn every_example_renders_or_gives_fields_or_structures() {
    for kind in KINDS {
        let workshop = workshop();
        let graph = loaded(kind, kind.example);
        let gives_maps = kind
            .outputs
            .iter()
            .any(|output| output.value_type == Type::Maps);
        if gives_maps {
            let run = workshop.render(kind.example, &[], Cancel::new(), &|_| {});
            assert!(!run.result.unwrap().is_empty(), "`{}`", kind.name);
        } else {
            let fields = fields(&workshop, kind, &graph);
            assert_eq!(fields.is_empty(), kind.is_structure(), "`{}`", kind.name);
        }
    }
}

#[test]
fn every_field_is_finite_and_the_same_for_every_way_to_ask() {
    let plain = workshop();
    for kind in KINDS {
        let graph = loaded(kind, kind.example);
        let fields = fields(&plain, kind, &graph);
        let points = points(&fields);
        let values = plain.engine.sample(&fields, &points);
        assert!(
            values
                .iter()
                .flatten()
                .flatten()
                .all(|value| value.is_finite()),
            "`{}`",
            kind.name
        );
        let expected = bits(&values);
        assert!(
            bits(&plain.engine.sample(&fields, &points)) == expected,
            "`{}` repeated",
            kind.name
        );
        for length in [1, 17, 1999] {
            assert!(
                bits(&in_parts(&plain, &fields, &points, length)) == expected,
                "`{}` in blocks of {length}",
                kind.name
            );
        }
        for level in levels::levels() {
            let other = Workshop::new(
                "recipes",
                Options {
                    threads: Some(1),
                    level: Some(level),
                    ..Options::default()
                },
            );
            let fields = self::fields(&other, kind, &graph);
            assert!(
                bits(&other.engine.sample(&fields, &points)) == expected,
                "`{}` at {level:?}",
                kind.name
            );
        }
    }
}

fn in_parts(
    workshop: &Workshop,
    fields: &[SampledField],
    points: &[[f64; 3]],
    length: usize,
) -> Vec<Vec<Vec<f32>>> {
    let empty = |sampled: &SampledField| vec![vec![]; sampled.field.width()];
    let mut whole: Vec<Vec<Vec<f32>>> = fields.iter().map(empty).collect();
    for points in points.chunks(length) {
        let part = workshop.engine.sample(fields, points);
        for (whole, part) in whole.iter_mut().flatten().zip(part.into_iter().flatten()) {
            whole.extend(part);
        }
    }
    whole
}

#[test]
fn equal_points_and_equal_fields_have_equal_values() {
    let workshop = workshop();
    for kind in KINDS {
        let graph = loaded(kind, kind.example);
        let fields = fields(&workshop, kind, &graph);
        let [first, second] = [points(&fields)[0], points(&fields)[1]];
        let twice: Vec<SampledField> = fields.iter().chain(&fields).cloned().collect();
        let values = bits(&workshop.engine.sample(&twice, &[first, second, first]));
        assert_eq!(
            values[..fields.len()],
            values[fields.len()..],
            "`{}`",
            kind.name
        );
        assert!(
            values.iter().flatten().all(|column| column[0] == column[2]),
            "`{}`",
            kind.name
        );
    }
}

#[test]
fn every_field_has_a_name_for_each_column() {
    let workshop = workshop();
    for kind in KINDS {
        for sampled in fields(&workshop, kind, &loaded(kind, kind.example)) {
            assert_eq!(
                sampled.columns.len(),
                sampled.field.width(),
                "`{}`: {:?}",
                kind.name,
                sampled.columns
            );
        }
    }
}

#[test]
fn a_default_that_is_written_out_changes_nothing() {
    for kind in KINDS {
        let head = format!("\"example\": {}(", kind.name);
        let (_, body) = kind
            .example
            .split_once(&head)
            .unwrap_or_else(|| panic!("no `{head}` in its example"));
        let plain = loaded(kind, kind.example);
        for (index, input) in kind.inputs.iter().enumerate() {
            let Presence::Default(literal) = input.presence else {
                continue;
            };
            if body.contains(&format!("{}:", input.name)) {
                continue;
            }
            let written = kind
                .example
                .replace(&head, &format!("{head}{}: {literal}, ", input.name));
            let written = loaded(kind, &written);
            let [default, literal] = [&plain, &written].map(|graph| source(graph, index));
            assert_eq!(literal, default, "`{}` of `{}`", input.name, kind.name);
        }
    }
}

/// The value of an input of the node or output `example`.
fn source(graph: &Graph, input: usize) -> String {
    let node = graph
        .nodes
        .node_weights()
        .find(|node| &*node.name == "example")
        .unwrap();
    match &node.inputs[input].source {
        Source::Literal(value) => format!("{value:?}"),
        other => panic!("a default is a literal, not {other:?}"),
    }
}

fn is_snake_case(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_lowercase())
        && name
            .chars()
            .all(|part| part.is_ascii_lowercase() || part.is_ascii_digit() || part == '_')
        && !name.ends_with('_')
        && !name.contains("__")
}

fn is_sentence(text: &str) -> bool {
    text.ends_with('.') && !text.contains("  ") && !text.contains('\n')
}

/// All inputs of a list, with the parts of records inside.
fn with_parts(inputs: &'static [Input]) -> Vec<&'static Input> {
    let parts = |value_type: Type| match value_type {
        Type::Record(parts) | Type::List(Type::Record(parts)) => with_parts(parts),
        _ => vec![],
    };
    inputs
        .iter()
        .flat_map(|input| [vec![input], parts(input.value_type)].concat())
        .collect()
}

#[test]
fn every_kind_says_what_it_is_and_where_it_comes_from() {
    for kind in KINDS {
        assert!(is_snake_case(kind.name), "{}", kind.name);
        assert!(
            kind.version > 0 && is_sentence(kind.about),
            "`{}`: {}",
            kind.name,
            kind.about
        );
        assert!(kind.source.len() > 10, "`{}`: {}", kind.name, kind.source);
        assert!(!kind.outputs.is_empty(), "`{}`", kind.name);
        for input in with_parts(kind.inputs) {
            assert!(
                is_snake_case(input.name),
                "`{}` of `{}`",
                input.name,
                kind.name
            );
            assert!(
                is_sentence(input.about),
                "`{}` of `{}`: {}",
                input.name,
                kind.name,
                input.about
            );
            assert!(
                input.range.is_none_or(|(low, high)| low < high),
                "`{}` of `{}`",
                input.name,
                kind.name
            );
        }
        for output in kind.outputs {
            assert!(
                is_snake_case(output.name) && is_sentence(output.about),
                "`{}` of `{}`",
                output.name,
                kind.name
            );
        }
    }
}

#[test]
fn names_are_different() {
    let kinds: BTreeSet<&str> = KINDS.iter().map(|kind| kind.name).collect();
    assert_eq!(kinds.len(), KINDS.len());
    for kind in KINDS {
        let inputs: BTreeSet<&str> = kind.inputs.iter().map(|input| input.name).collect();
        let outputs: BTreeSet<&str> = kind.outputs.iter().map(|output| output.name).collect();
        assert_eq!(
            (inputs.len(), outputs.len()),
            (kind.inputs.len(), kind.outputs.len()),
            "`{}`",
            kind.name
        );
    }
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let files = |path: PathBuf| {
        if path.is_dir() {
            rust_files(&path)
        } else {
            vec![path]
        }
    };
    entries
        .flat_map(files)
        .filter(|path| path.extension().is_some_and(|it| it == "rs"))
        .collect()
}

#[test]
fn one_node_is_one_file_and_one_line_in_the_table() {
    let declares = |path: &PathBuf| {
        fs::read_to_string(path)
            .unwrap()
            .contains("pub static KIND: Kind")
    };
    let files = rust_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/nodes"));
    let mut names: Vec<String> = files
        .iter()
        .filter(|path| declares(path))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    let mut table: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
    table.sort_unstable();
    assert_eq!(names, table);
    assert!(
        table
            .iter()
            .all(|name| kind(name).is_some_and(|kind| kind.name == *name))
    );
}
