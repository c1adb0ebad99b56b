//! Looking without rendering: checks, and samples at points.

use super::*;
use yosegi::engine::Render;

fn check(workshop: &Workshop, recipe: &str) -> (Result<(), RunError>, Vec<PathBuf>) {
    let graph = workshop.graph(recipe);
    let before = workshop.files.paths();
    let result = workshop.engine.check(&Render {
        graph: &graph,
        folder: workshop.folder.join("out"),
        only: vec![],
        pixels: workshop.size,
        listener: &|_: Event| {},
        cancel: Cancel::new(),
    });
    let mut new = workshop.files.paths();
    new.retain(|path| !before.contains(path));
    (result, new)
}

#[test]
fn a_check_builds_structures_into_the_store_and_writes_no_map() {
    let workshop = with_store();
    let (result, new) = check(&workshop, BOARD);
    assert_eq!(result, Ok(()));
    assert_eq!(new.len(), 2);
    assert!(new.iter().all(|path| path.starts_with("store/structure")));
    let log = workshop.another(stored()).run(BOARD);
    assert!(log.contains("reused tree (disk)"), "{log}");
}

#[test]
fn a_check_finds_at_once_what_only_building_shows() {
    let wrong = edit(
        PAIR,
        "pixels: (48, 40)),\n        \"deep\"",
        "channels: [hight]),\n        \"deep\"",
    );
    let wrong = edit(
        &wrong,
        "pixels: (48, 40)),\n    }",
        "pixels: (48, 40), pixels_per_mm: 1),\n    }",
    );
    let wrong = edit(
        &wrong,
        "\"left\":",
        "\"loose\": colour_pattern(stops: [(at: 1, colour: (0, 0, 0)), (at: 0.5, colour: (0, 0, 0))]),\n\"left\":",
    );
    let (result, new) = check(&without_store(), &wrong);
    let Err(RunError::Nodes(failures)) = result else {
        panic!("{result:?}");
    };
    let told: Vec<(&str, &str)> = failures
        .iter()
        .map(|it| (it.node.as_deref().unwrap(), it.message.as_str()))
        .collect();
    assert_eq!(
        told,
        [
            ("loose", "stop 2 at 0.5 stands before the stop at 1"),
            ("pale", "the material has no channel `hight`"),
            ("deep", "both `pixels_per_mm` and `pixels` are set"),
        ]
    );
    assert!(failures.iter().all(|it| it.label.is_some()));
    assert!(new.is_empty());
}

#[test]
fn a_check_names_every_output_over_the_limit() {
    let options = Options {
        largest_output: 48 * 40 - 1,
        ..options()
    };
    let (result, _) = check(&Workshop::new("recipes", options), PAIR);
    let Err(RunError::Limit(failures)) = result else {
        panic!("{result:?}");
    };
    let told: Vec<&str> = failures
        .iter()
        .filter_map(|it| it.node.as_deref())
        .collect();
    assert_eq!(told, ["pale", "deep"]);
}

#[test]
fn samples_are_the_same_on_any_number_of_threads() {
    // More than one block of points, and a rest.
    let points: Vec<[f64; 3]> = (0..9001)
        .map(|index| {
            let x = f64::from(index);
            [x % 97.0, x % 89.0, 600.0 + x / 90.0]
        })
        .collect();
    let values = [1, 2, 5].map(|threads| {
        let workshop = Workshop::new(
            "recipes",
            Options {
                threads: Some(threads),
                ..options()
            },
        );
        let graph = workshop.graph(BOARD);
        let fields = workshop
            .engine
            .fields(&graph, "look", &|_: Event| {})
            .unwrap();
        let values = workshop.engine.sample(&fields, &points);
        let bits = |column: &Vec<f32>| column.iter().map(|value| value.to_bits()).collect();
        values.iter().flatten().map(bits).collect::<Vec<Vec<u32>>>()
    });
    assert!(values[0].len() >= 4 && values[0].iter().all(|column| column.len() == 9001));
    assert!(values[0] == values[1] && values[0] == values[2]);
    let empty = without_store();
    let graph = empty.graph(BOARD);
    let fields = empty.engine.fields(&graph, "time", &|_: Event| {}).unwrap();
    assert_eq!(empty.engine.sample(&fields, &[])[0], [[0f32; 0]]);
}
