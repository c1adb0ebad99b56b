//! JSON: the names of its fields are the ones that `docs/json.md` promises.

use super::*;
use serde_json::json;
use std::collections::BTreeSet;
use yosegi::engine::{Event, ReusedFrom, Spot};

/// Every event with the JSON it becomes. An event that is missing here does not compile in `is_listed`.
fn all_events() -> Vec<(Event, Value)> {
    let text = str::to_owned;
    let (output, channel, path) = (text("board"), text("height"), PathBuf::from("out/a.png"));
    let map = |event: &str| {
        json!({
            "event": event, "output": "board", "channel": "height", "path": "out/a.png",
            "not_finite": 1, "first_not_finite": { "pixel": [5, 7], "place": [0.5, 2.25] }, "clamped": 2,
        })
    };
    let (not_finite, clamped) = (1, 2);
    let first_not_finite = Some(Spot {
        pixel: [5, 7],
        place: [0.5, 2.25],
    });
    vec![
        (
            Event::StructureBuilt {
                node: text("tree"),
                milliseconds: 1.5,
            },
            json!({ "event": "structure_built", "node": "tree", "milliseconds": 1.5 }),
        ),
        (
            Event::StructureProgress {
                node: text("stones"),
                fraction: 0.5,
            },
            json!({ "event": "structure_progress", "node": "stones", "fraction": 0.5 }),
        ),
        (
            Event::StructureReused {
                node: text("tree"),
                from: ReusedFrom::Memory,
            },
            json!({ "event": "structure_reused", "node": "tree", "from": "memory" }),
        ),
        (
            Event::StructureReused {
                node: text("tree"),
                from: ReusedFrom::Disk,
            },
            json!({ "event": "structure_reused", "node": "tree", "from": "disk" }),
        ),
        (
            Event::FieldTiles {
                output: output.clone(),
                node: text("time"),
                computed: 3,
                reused: 4,
            },
            json!({ "event": "field_tiles", "output": "board", "node": "time", "computed": 3, "reused": 4 }),
        ),
        (
            Event::Progress {
                output: output.clone(),
                done: 1,
                total: 4,
                maps_done: 2,
                maps_total: 3,
                fraction: 0.25,
                seconds_left: None,
            },
            json!({
                "event": "progress", "output": "board", "done": 1, "total": 4, "maps_done": 2,
                "maps_total": 3, "fraction": 0.25, "seconds_left": null,
            }),
        ),
        (
            Event::MapWritten {
                output: output.clone(),
                channel: channel.clone(),
                path: path.clone(),
                not_finite,
                first_not_finite,
                clamped,
            },
            map("map_written"),
        ),
        (
            Event::MapUpToDate {
                output: output.clone(),
                channel: channel.clone(),
                path: path.clone(),
                not_finite,
                first_not_finite,
                clamped,
            },
            map("map_up_to_date"),
        ),
        (
            Event::MapRestored {
                output: output.clone(),
                channel: channel.clone(),
                path: path.clone(),
                not_finite,
                first_not_finite,
                clamped,
            },
            map("map_restored"),
        ),
        (
            Event::MapStale {
                output: output.clone(),
                channel,
                path,
            },
            json!({ "event": "map_stale", "output": "board", "channel": "height", "path": "out/a.png" }),
        ),
        (
            Event::OutputDone {
                output,
                milliseconds: 2.0,
                computing: 1.5,
            },
            json!({ "event": "output_done", "output": "board", "milliseconds": 2.0, "computing": 1.5 }),
        ),
        (
            Event::Warning {
                node: text("tree"),
                file: "recipe.ron".into(),
                line: 3,
                column: 9,
                message: text("cut"),
            },
            json!({
                "event": "warning", "node": "tree", "file": "recipe.ron", "line": 3, "column": 9, "message": "cut",
            }),
        ),
        (
            Event::StoreFailed {
                reason: text("full"),
            },
            json!({ "event": "store_failed", "reason": "full" }),
        ),
        (
            Event::CacheVerified { compared: 3 },
            json!({ "event": "cache_verified", "compared": 3 }),
        ),
        (Event::Cancelled, json!({ "event": "cancelled" })),
    ]
}

fn is_listed(event: &Event) -> bool {
    match event {
        Event::StructureBuilt { .. }
        | Event::StructureReused { .. }
        | Event::StructureProgress { .. }
        | Event::FieldTiles { .. }
        | Event::Progress { .. }
        | Event::MapWritten { .. }
        | Event::MapUpToDate { .. }
        | Event::MapRestored { .. }
        | Event::MapStale { .. }
        | Event::OutputDone { .. }
        | Event::Warning { .. }
        | Event::StoreFailed { .. }
        | Event::CacheVerified { .. }
        | Event::Cancelled => true,
    }
}

/// The words that the document quotes.
fn documented() -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/json.md");
    let text = fs::read_to_string(path).unwrap();
    text.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

/// The names of all fields within a value.
fn fields(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) => {
            for (name, value) in object {
                names.insert(name.clone());
                fields(value, names);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| fields(item, names)),
        _ => {}
    }
}

fn assert_documented(values: &[Value]) {
    let mut names = BTreeSet::new();
    values.iter().for_each(|value| fields(value, &mut names));
    assert!(!names.is_empty());
    let missing: Vec<String> = names.difference(&documented()).cloned().collect();
    assert!(missing.is_empty(), "docs/json.md does not name {missing:?}");
}

#[test]
fn events_have_stable_names_that_are_documented() {
    let documented = documented();
    for (event, expected) in all_events() {
        assert!(is_listed(&event));
        let found = serde_json::to_value(&event).unwrap();
        assert_eq!(found, expected);
        let name = found["event"].as_str().unwrap();
        assert!(
            documented.contains(name),
            "docs/json.md does not name `{name}`"
        );
        assert_documented(&[found]);
    }
}

#[test]
fn a_render_prints_only_events_and_diagnostics_that_are_documented() {
    let place = Place::new(BOARD);
    let printed = lines(&place.render(&["--json"]));
    assert!(printed.iter().all(|line| line["event"].is_string()));
    assert_documented(&printed);
    let progress = |line: &&Value| line["event"] == "progress";
    let last = printed.iter().rfind(progress).unwrap();
    assert_eq!(
        (&last["fraction"], &last["seconds_left"]),
        (&json!(1.0), &json!(0.0))
    );
    let wrong = place.call(&["check", "recipe.ron", "--set", "speed=99", "--json"]);
    assert_documented(&lines(&wrong));
    place.write("wrong.ron", &edit("thickening", "thickning"));
    assert_documented(&lines(&place.call(&["check", "wrong.ron", "--json"])));
}

#[test]
fn stale_files_are_told_as_events_and_as_warnings() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    place.write("recipe.ron", &edit("[base_color, normal]", "[base_color]"));
    assert_eq!(
        events(&place.render(&["--json"]), "map_stale"),
        ["board/normal"]
    );
    let output = place.render(&[]);
    let path = Path::new("out").join("board_normal.png");
    let expected = format!(
        "warning: {} is from an earlier run: `board` no longer writes it\nrecipe.ron is up to date\n",
        path.display()
    );
    assert_eq!((code(&output), stderr(&output)), (0, expected));
    assert!(place.path("out/board_normal.png").exists());
}

#[test]
fn kinds_are_described_completely() {
    let place = Place::new(BOARD);
    let printed = lines(&place.call(&["nodes", "--json"]));
    assert_documented(&printed);
    let kinds = printed[0].as_array().unwrap();
    let is_compound = |kind: &&Value| !kind["file"].is_null();
    let native = yosegi::nodes::KINDS.len();
    assert_eq!(
        kinds.iter().position(|kind| is_compound(&kind)),
        Some(native)
    );
    assert!(
        kinds[native..]
            .iter()
            .any(|kind| kind["name"] == "tree_wood")
    );
    for (kind, found) in yosegi::nodes::KINDS.iter().zip(kinds) {
        assert_eq!(
            &lines(&place.call(&["nodes", kind.name, "--json"]))[0],
            found
        );
        assert_eq!(
            (&found["name"], &found["version"]),
            (&json!(kind.name), &json!(kind.version))
        );
        assert_eq!(
            (&found["about"], &found["source"]),
            (&json!(kind.about), &json!(kind.source))
        );
        assert_eq!(found["example"], kind.example);
        assert_eq!(found["inputs"].as_array().unwrap().len(), kind.inputs.len());
        assert_eq!(
            found["outputs"].as_array().unwrap().len(),
            kind.outputs.len()
        );
    }
    let input = |kind: &str, name: &str| {
        let kind = kinds.iter().find(|it| it["name"] == kind).unwrap();
        let mut inputs = kind["inputs"].as_array().unwrap().iter();
        inputs.find(|it| it["name"] == name).unwrap().clone()
    };
    assert_eq!(
        input("growth_field", "elongation"),
        json!({
            "name": "elongation", "type": "number", "unit": "mm/year", "choices": null, "item": null,
            "parts": null, "varies": "constant", "domain": null, "presence": "optional",
            "default": null, "range": [1.0, 100_000.0],
            "about": input("growth_field", "elongation")["about"],
        })
    );
    let cut = input("slice_cut", "cut");
    assert_eq!(
        (&cut["type"], &cut["presence"], &cut["default"]),
        (&json!("choice"), &json!("default"), &json!("plane"))
    );
    assert!(
        cut["choices"]
            .as_array()
            .unwrap()
            .contains(&json!("quarter_sawn"))
    );
    let of = input("maps", "of");
    assert_eq!(
        (&of["type"], &of["domain"], &of["presence"]),
        (&json!("material"), &json!("plane"), &json!("required"))
    );
    assert_eq!(input("maps", "pixels")["presence"], "optional");
    let stops = input("colour_pattern", "stops");
    assert_eq!(
        (&stops["type"], &stops["item"]["type"]),
        (&json!("list"), &json!("record"))
    );
    let part = |index: usize, field: &str| stops["item"]["parts"][index][field].clone();
    assert_eq!(
        (
            part(0, "name"),
            part(0, "type"),
            part(1, "name"),
            part(1, "type")
        ),
        (
            json!("at"),
            json!("number"),
            json!("colour"),
            json!("colour")
        )
    );
    assert_eq!(input("mix", "a")["varies"], "per_point");
}

#[test]
fn reasons_and_the_cache_are_documented() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    let why = lines(&place.call(&[
        "why",
        "recipe.ron",
        "board",
        "--cache",
        "store",
        "--set",
        "speed=4",
        "--json",
    ]));
    assert_documented(&why);
    let first = &why[0]["first_cause"];
    assert_eq!(
        (&first["name"], &first["cause"]),
        (
            &json!("time"),
            &json!({ "is": "input_changed", "input": "thickening", "from": "3", "to": "4" })
        )
    );
    assert_eq!(
        (&why[0]["of"]["fate"], &why[0]["earlier_run"]),
        (&json!("painted_unless_known"), &json!(true))
    );
    let cache = lines(&place.call(&["cache", "status", "--cache", "store", "--json"]));
    assert_documented(&cache);
    assert_eq!(cache[0]["families"].as_array().unwrap().len(), 5);
}
