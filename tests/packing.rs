//! Packings: order, gaps and outlines of real plazas, both methods, and what a recipe can ask for.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "packing/faults.rs"]
mod faults;
#[path = "support/node.rs"]
mod node;

use std::collections::BTreeMap;
use std::sync::Arc;
use yosegi::engine::Cancel;
use yosegi::node::{Failure, Kind};
use yosegi::nodes::kind;
use yosegi::value::{FileContents, Partition, Value};

/// What a node gives; inputs that are left out have their defaults only if these are listed.
fn built(kind: &'static Kind, given: &[(&str, Value)]) -> Result<Value, Failure> {
    Ok(node::built(kind, &node::inputs(kind, given), 1, None)?.remove(0))
}

/// The outline of a plaza from the assets.
fn plaza(name: &str, part: &str) -> Value {
    let path = format!("assets/outlines/{name}.geojson");
    let file = FileContents {
        bytes: std::fs::read(&path).unwrap().into(),
        path: path.into(),
    };
    let given = [
        ("file", Value::File(file)),
        ("parts", Value::List(vec![Value::Text(part.to_owned())])),
        ("turn", Value::Number(0.0)),
        ("scale", Value::Number(1.0)),
        ("origin", Value::Choice("corner")),
        ("at", Value::Pair([0.0, 0.0])),
        ("tolerance", Value::Number(0.01)),
    ];
    built(kind("region_from_file").unwrap(), &given).unwrap()
}

fn packed(given: &[(&str, Value)]) -> Result<Arc<Partition>, Failure> {
    let defaults = [
        ("aspect", Value::Number(1.0)),
        ("corners", Value::Whole(4)),
        ("spread", Value::Pair([0.8, 1.2])),
        ("scale", Value::Number(1.0)),
        ("method", Value::Choice("position_field")),
        ("bond", Value::Number(0.0)),
        ("force", Value::Choice("radial")),
        ("start", Value::Choice("lattice")),
        ("steps", Value::Whole(600)),
        ("seed", Value::Whole(0)),
    ];
    let mut all = defaults.to_vec();
    all.extend(given.iter().cloned());
    match built(kind("square_packing").unwrap(), &all)? {
        Value::Partition(partition) => Ok(partition),
        other => panic!("found a {}", other.type_name()),
    }
}

/// The columns of `packing_table`.
fn measured(partition: &Arc<Partition>, region: &Value) -> BTreeMap<String, f64> {
    let given = [
        ("of", Value::Partition(Arc::clone(partition))),
        ("region", region.clone()),
    ];
    let Value::Table(table) = built(kind("packing_table").unwrap(), &given).unwrap() else {
        panic!("expected a table");
    };
    let mut lines = table.text.lines();
    let (names, numbers) = (lines.next().unwrap(), lines.next().unwrap());
    let pairs = names.split(',').zip(numbers.split(','));
    let there = pairs.filter(|(_, number)| !number.is_empty());
    there
        .map(|(name, number)| (name.to_owned(), number.parse().unwrap()))
        .collect()
}

fn region_area(region: &Value) -> f64 {
    let Value::Region(region) = region else {
        panic!("expected a region");
    };
    let doubled = |ring: &[glam::DVec2]| -> f64 {
        let next = ring.iter().cycle().skip(1);
        let pairs = ring.iter().zip(next);
        pairs
            .map(|(a, b)| (*a - ring[0]).perp_dot(*b - ring[0]))
            .sum()
    };
    0.5 * region.rings().map(doubled).sum::<f64>()
}

#[test]
fn ten_thousand_stones_follow_the_plaza_and_leave_nothing_out() {
    let region = plaza("fischmarktplatz", "Fischmarktplatz");
    let side = (region_area(&region) / 10_000.0).sqrt();
    let given = [("region", region.clone()), ("stone", Value::Number(side))];
    let partition = packed(&given).unwrap();
    assert!(partition.is_sound());
    let covered: f64 = partition.areas.iter().sum();
    assert!(
        (covered / region_area(&region) - 1.0).abs() < 1e-9,
        "{covered}"
    );
    let found = measured(&partition, &region);
    assert!(found["angle_median_degrees"] < 2.0, "{found:?}");
    assert!(found["angle_90_percent_degrees"] < 5.0, "{found:?}");
    assert!(found["occupancy"] > 0.999, "{found:?}");
    assert!(found["largest_overlap"] < 1e-6, "{found:?}");
    assert_eq!(found["across_outline"], 0.0, "{found:?}");
    assert!(found["four_corners"] > 0.85, "{found:?}");
    // No sliver at the outline: every cell is a good part of a stone.
    let least = partition
        .areas
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    assert!(least > 0.2 * side * side, "{least}");
}

#[test]
fn joints_of_natural_stones_vary_and_leave_no_places_empty() {
    let region = plaza("fischmarktplatz", "Fischmarktplatz");
    let side = (region_area(&region) / 10_000.0).sqrt();
    let given = [("region", region.clone()), ("stone", Value::Number(side))];
    let cells = packed(&given).unwrap();
    let joints = |vary: [f64; 2], each: &'static str| {
        let given = [
            ("of", Value::Partition(Arc::clone(&cells))),
            ("joint", Value::Number(12.0)),
            ("vary", Value::Pair(vary)),
            ("each", Value::Choice(each)),
            ("round", Value::Number(0.0)),
            ("round_vary", Value::Pair([1.0, 1.0])),
            ("least", Value::Number(0.0)),
            ("seed", Value::Whole(0)),
        ];
        let Value::Partition(stones) = built(kind("inset_cells").unwrap(), &given).unwrap() else {
            panic!("expected a partition");
        };
        measured(&stones, &region)
    };
    for each in ["edge", "cell"] {
        let found = joints([0.6, 1.4], each);
        assert!((found["joint_mm"] - 12.0).abs() < 0.3, "{each}: {found:?}");
        let variation = found["joint_variation"];
        assert!(variation > 0.1 && variation < 0.3, "{each}: {found:?}");
        assert!(found["occupancy"] > 0.999, "{each}: {found:?}");
        assert!(found["largest_overlap"] < 1e-6, "{each}: {found:?}");
        assert_eq!(found["across_outline"], 0.0, "{each}: {found:?}");
    }
    // What varies is what was asked for, not the packing.
    let even = joints([1.0, 1.0], "edge");
    assert!(even["joint_variation"] < 0.01, "{even:?}");
}

#[test]
fn the_position_field_beats_particles_in_order_and_gaps_on_both_plazas() {
    for (name, part) in [
        ("fischmarktplatz", "Fischmarktplatz"),
        ("sechselaeutenplatz", "Sechseläutenplatz"),
    ] {
        let region = plaza(name, part);
        let side = (region_area(&region) / 1500.0).sqrt();
        let with = |method: &'static str| {
            let given = [
                ("region", region.clone()),
                ("stone", Value::Number(side)),
                ("method", Value::Choice(method)),
            ];
            measured(&packed(&given).unwrap(), &region)
        };
        let (field, particles) = (with("position_field"), with("particles"));
        assert!(
            field["order"] > particles["order"] + 0.03,
            "{name}: {field:?} {particles:?}"
        );
        assert!(
            field["occupancy"] > particles["occupancy"],
            "{name}: {field:?} {particles:?}"
        );
        assert!(field["area_variation"] < 0.9 * particles["area_variation"]);
        for column in ["angle_median_degrees", "angle_90_percent_degrees"] {
            assert!(
                field[column] < 0.7 * particles[column],
                "{name}: {field:?} {particles:?}"
            );
        }
        // The paper's own packing keeps to the field well enough, too, and within the outline.
        assert!(particles["angle_median_degrees"] < 10.0 && particles["occupancy"] > 0.98);
        assert_eq!(particles["across_outline"], 0.0);
        assert!(particles["largest_overlap"] < 0.01);
    }
}

#[test]
fn half_the_size_gives_four_times_the_stones() {
    let count = |stone: f64, method: &'static str| {
        let given = [
            ("size", Value::Pair([3000.0, 2300.0])),
            ("stone", Value::Number(stone)),
            ("method", Value::Choice(method)),
        ];
        packed(&given).unwrap().len() as f64
    };
    for method in ["position_field", "particles"] {
        let times = count(100.0, method) / count(200.0, method);
        assert!((times / 4.0 - 1.0).abs() < 0.15, "{method}: {times}");
    }
}

#[test]
fn more_spread_gives_more_unlike_stones() {
    let variation = |spread: [f64; 2]| {
        let given = [
            ("size", Value::Pair([2000.0, 2000.0])),
            ("stone", Value::Number(100.0)),
            ("spread", Value::Pair(spread)),
        ];
        let areas = &packed(&given).unwrap().areas;
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        let square = areas
            .iter()
            .map(|area| (area - mean) * (area - mean))
            .sum::<f64>();
        (square / areas.len() as f64).sqrt() / mean
    };
    let (none, some, much) = (
        variation([1.0, 1.0]),
        variation([0.8, 1.2]),
        variation([0.6, 1.4]),
    );
    assert!(
        none < 0.02 && some > 0.05 && much > 1.4 * some,
        "{none} {some} {much}"
    );
}

#[test]
fn equal_squares_in_a_rectangle_that_fits_are_a_lattice() {
    let given = [
        ("size", Value::Pair([1200.0, 800.0])),
        ("stone", Value::Number(100.0)),
        ("spread", Value::Pair([1.0, 1.0])),
    ];
    let partition = packed(&given).unwrap();
    assert_eq!(partition.len(), 96);
    for cell in 0..96 {
        assert_eq!(partition.outline(cell).len(), 4);
        assert!(
            (partition.areas[cell] - 1e4).abs() < 1.0,
            "{}",
            partition.areas[cell]
        );
    }
}

#[test]
fn cells_that_repeat_cover_the_period() {
    for (method, corners) in [
        ("position_field", 4),
        ("particles", 4),
        ("position_field", 6),
        ("position_field", 5),
    ] {
        let given = [
            ("period", Value::Pair([2000.0, 1500.0])),
            ("stone", Value::Number(100.0)),
            ("method", Value::Choice(method)),
            ("corners", Value::Whole(corners)),
        ];
        let partition = packed(&given).unwrap();
        assert!(partition.is_sound());
        let covered: f64 = partition.areas.iter().sum();
        assert!(
            (covered / 3e6 - 1.0).abs() < 1e-9,
            "{method} {corners}: {covered}"
        );
        assert!(
            partition
                .neighbours
                .iter()
                .all(|cell| *cell != Partition::NONE)
        );
    }
}

#[test]
fn hexagons_and_oblong_stones_have_their_shapes() {
    let ground = ("size", Value::Pair([3000.0, 3000.0]));
    let stone = ("stone", Value::Number(100.0));
    let with_corners = |partition: &Partition, corners: usize| {
        let cells = 0..partition.len();
        let of = cells.filter(|cell| partition.outline(*cell).len() == corners);
        of.count() as f64 / partition.len() as f64
    };
    let hexagons = packed(&[ground.clone(), stone.clone(), ("corners", Value::Whole(6))]).unwrap();
    // One in nine lies at the border, where it has four or five: no more than 0.89 of all could have six.
    assert!(with_corners(&hexagons, 6) > 0.8);
    let is_inside = |cell: &usize| {
        let mut edges = hexagons.rings_of(*cell).flatten();
        edges.all(|edge| hexagons.neighbours[edge] != Partition::NONE)
    };
    let inside: Vec<usize> = (0..hexagons.len()).filter(is_inside).collect();
    let six = inside
        .iter()
        .filter(|cell| hexagons.outline(**cell).len() == 6);
    assert!(six.count() as f64 > 0.9 * inside.len() as f64);
    let aspect = ("aspect", Value::Number(2.0));
    let bricks = packed(&[
        ground.clone(),
        stone.clone(),
        aspect,
        ("bond", Value::Number(0.5)),
    ])
    .unwrap();
    // In a running bond two stones are above and two below.
    let share = with_corners(&bricks, 6);
    assert!(share > 0.65, "{share}");
    let mean = bricks.areas.iter().sum::<f64>() / bricks.len() as f64;
    assert!((mean / 2e4 - 1.0).abs() < 0.1, "{mean}");
    let pentagons = packed(&[
        ground,
        stone,
        ("corners", Value::Whole(5)),
        ("method", Value::Choice("particles")),
    ]);
    assert!(pentagons.unwrap().is_sound());
}

#[test]
fn the_result_is_the_same_at_any_thread_count_and_differs_with_the_seed() {
    let with = |threads: usize, method: &'static str, seed: i64| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let given = [
            ("size", Value::Pair([3000.0, 2000.0])),
            ("stone", Value::Number(100.0)),
            ("method", Value::Choice(method)),
            ("seed", Value::Whole(seed)),
        ];
        pool.install(|| packed(&given).unwrap())
    };
    for method in ["position_field", "particles"] {
        let one = with(1, method, 0);
        assert_eq!(one, with(3, method, 0), "{method}");
        assert_ne!(one, with(1, method, 1), "{method}");
    }
}

#[test]
fn a_cancelled_run_ends_soon() {
    let cancel = Cancel::new();
    cancel.cancel();
    let kind = kind("square_packing").unwrap();
    let given = [
        ("size", Value::Pair([20_000.0, 20_000.0])),
        ("stone", Value::Number(100.0)),
        ("aspect", Value::Number(1.0)),
        ("corners", Value::Whole(4)),
        ("spread", Value::Pair([0.8, 1.2])),
        ("scale", Value::Number(1.0)),
        ("method", Value::Choice("particles")),
        ("bond", Value::Number(0.0)),
        ("force", Value::Choice("radial")),
        ("start", Value::Choice("lattice")),
        ("steps", Value::Whole(100_000)),
        ("seed", Value::Whole(0)),
    ];
    let values = node::inputs(kind, &given);
    assert!(node::built(kind, &values, 1, Some(&cancel)).is_err());
}

#[test]
fn what_cannot_be_packed_is_refused_in_words() {
    let message = |given: &[(&str, Value)]| packed(given).unwrap_err().message;
    let stone = ("stone", Value::Number(100.0));
    assert_eq!(
        message(std::slice::from_ref(&stone)),
        "nothing says what is divided"
    );
    let ground = ("size", Value::Pair([1000.0, 1000.0]));
    let spread = ("spread", Value::Pair([1.2, 0.8]));
    assert_eq!(
        message(&[ground.clone(), stone.clone(), spread]),
        "expected the smaller number first, found (1.2, 0.8)"
    );
    let oblong = [("aspect", Value::Number(2.0)), ("corners", Value::Whole(6))];
    assert_eq!(
        message(&[&[ground.clone(), stone][..], &oblong[..]].concat()),
        "only stones with 4 corners can be oblong"
    );
    let tiny = ("stone", Value::Number(0.1));
    assert_eq!(
        message(&[ground, tiny]),
        "expected at most 4000000 stones, found about 100000000"
    );
}
