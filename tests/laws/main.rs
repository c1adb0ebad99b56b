//! Laws that hold for every kind of node, enumerated from the table of kinds.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod filtering;
mod repeats;
mod table;

#[path = "../support/levels.rs"]
mod levels;
#[path = "../support/workshop.rs"]
#[allow(dead_code, reason = "laws need no log of events")]
mod workshop;

use petgraph::graph::NodeIndex;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use workshop::Workshop;
use yosegi::engine::{Cancel, Event, Options, RunError, SampledField};
use yosegi::graph::{Graph, Settings, Source, load, load_text};
use yosegi::node::{Input, Kind, Presence, common_domain};
use yosegi::nodes::{KINDS, kind};
use yosegi::value::{Domain, Type, Value};
use yosegi::world::Disk;

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

/// The number of channels that the outputs of a recipe name; a view is one.
fn channels(graph: &Graph) -> usize {
    let of_output = |index: &NodeIndex| {
        let node = &graph.nodes[*index];
        let Some((position, _)) = node.kind.input("channels") else {
            return 1;
        };
        match &node.inputs[position].source {
            Source::Literal(Value::Names(names)) => names.len(),
            other => panic!("{other:?}"),
        }
    };
    graph.outputs.iter().map(of_output).sum()
}

#[test]
fn every_recipe_of_the_project_renders() {
    let mut recipes = 0;
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "ron") {
            continue;
        }
        let recipe = fs::read_to_string(&path).unwrap();
        let loaded = load(&Disk, &path, &Settings::default()).unwrap();
        assert_eq!(loaded.warnings, [], "{}", path.display());
        let mut workshop = workshop();
        workshop.size = Some([24, 40]);
        let run = workshop.render(&recipe, &[], Cancel::new(), &|event| {
            if let Event::MapWritten { not_finite, .. } = event {
                assert_eq!(*not_finite, 0, "{}: {event:?}", path.display());
            }
        });
        let maps = run
            .result
            .unwrap_or_else(|error| panic!("{}: {error:?}", path.display()));
        assert_eq!(maps.len(), channels(&loaded.graph), "{}", path.display());
        recipes += 1;
    }
    assert!(recipes >= 9);
}
