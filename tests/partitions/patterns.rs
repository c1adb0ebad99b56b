//! Patterns: that they tile, close, keep what is asked for, and lie the way boards lie.

use super::{Given, anywhere, assert_tiles, given, laid, points, split};
use glam::DVec2;
use yosegi::value::{Partition, Value};

/// Each pattern with a board that it takes.
const BOARDS: [(&str, f64, f64); 9] = [
    ("rows", 60.0, 12.0),
    ("grid", 20.0, 12.0),
    ("herringbone", 40.0, 10.0),
    ("double_herringbone", 60.0, 10.0),
    ("basket", 30.0, 10.0),
    ("chevron", 40.0, 8.0),
    ("fan", 9.0, 9.0),
    ("hexagons", 20.0, 20.0),
    ("recursive", 20.0, 20.0),
];

fn board(length: f64, width: f64, more: Given) -> Given {
    let mut inputs = vec![
        ("length", Value::Number(length)),
        ("width", Value::Number(width)),
    ];
    inputs.extend(more);
    inputs
}

fn size(name: &'static str, width: f64, height: f64) -> Given {
    vec![(name, Value::Pair([width, height]))]
}

#[test]
fn all_patterns_tile_what_is_divided() {
    for (pattern, length, width) in BOARDS {
        for angle in [0.0, 30.0] {
            let mut inputs = board(length, width, size("size", 300.0, 200.0));
            inputs.push(("angle", Value::Number(angle)));
            assert_tiles(&laid(pattern, inputs).unwrap(), 60_000.0);
        }
    }
}

#[test]
fn all_patterns_close_where_the_plane_repeats() {
    for (pattern, length, width) in BOARDS {
        for angle in [0.0, 90.0] {
            let mut inputs = board(length, width, size("period", 310.0, 190.0));
            inputs.push(("angle", Value::Number(angle)));
            assert_tiles(&laid(pattern, inputs).unwrap(), 58_900.0);
        }
        let mut turned = board(length, width, size("period", 310.0, 190.0));
        turned.push(("angle", Value::Number(30.0)));
        let failure = laid(pattern, turned).unwrap_err();
        assert_eq!(
            failure.message,
            "a pattern turned by 30 degrees does not repeat"
        );
    }
}

#[test]
fn cells_of_a_partition_are_divided_along_their_frames() {
    let outer = split(given(points(&anywhere(7, (300.0, 200.0))), (300.0, 200.0))).unwrap();
    let mut turned = Partition::clone(&outer);
    turned.frames.fill(DVec2::new(0.6, 0.8));
    for (pattern, length, width) in BOARDS {
        let within = vec![(
            "within",
            Value::Partition(std::sync::Arc::new(turned.clone())),
        )];
        let cells = laid(pattern, board(length, width, within)).unwrap();
        assert_tiles(&cells, 60_000.0);
        if pattern == "rows" {
            assert!(
                cells
                    .frames
                    .iter()
                    .all(|frame| frame.distance(DVec2::new(0.6, 0.8)) < 1e-9)
            );
        }
    }
}

#[test]
fn whole_boards_have_the_size_that_is_asked_for() {
    for (pattern, area) in [
        ("rows", 720.0),
        ("herringbone", 720.0),
        ("double_herringbone", 720.0),
        ("basket", 720.0),
        ("chevron", 720.0),
    ] {
        let cells = laid(pattern, board(60.0, 12.0, size("size", 600.0, 600.0)));
        let Ok(cells) = cells else {
            assert_eq!(pattern, "double_herringbone");
            continue;
        };
        let whole = cells
            .areas
            .iter()
            .filter(|own| (*own / area - 1.0).abs() < 1e-6)
            .count();
        assert!(
            2 * whole > cells.len(),
            "{pattern}: {whole} of {}",
            cells.len()
        );
    }
}

#[test]
fn half_of_the_boards_of_a_herringbone_lie_across() {
    let cells = laid(
        "herringbone",
        board(40.0, 10.0, size("period", 320.0, 160.0)),
    )
    .unwrap();
    assert_eq!(cells.len(), 128);
    let across = cells
        .frames
        .iter()
        .filter(|frame| **frame == DVec2::Y)
        .count();
    assert_eq!(across, 64);
    assert!(cells.areas.iter().all(|area| (area - 400.0).abs() < 1e-9));
}

#[test]
fn bonds_move_rows_by_their_share() {
    for (bond, cycle) in [("running", 2.0), ("third", 3.0), ("stack", 1.0)] {
        let mut inputs = board(30.0, 10.0, size("period", 120.0, 60.0));
        inputs.push(("bond", Value::Choice(bond)));
        let cells = laid("rows", inputs).unwrap();
        assert_eq!(cells.len(), 24);
        for (cell, row) in cells.attributes["row"].iter().enumerate() {
            let moved = cells.centres[cell].x - 15.0 - 30.0 * (row % cycle) / cycle;
            let off = (moved / 30.0).round() * 30.0 - moved;
            assert!(off.abs() < 1e-9, "{bond}: row {row} at {moved}");
        }
    }
}

#[test]
fn lengths_are_in_their_range_and_a_ratio_that_is_none_is_refused() {
    let mut inputs = board(30.0, 10.0, size("size", 600.0, 100.0));
    inputs.push(("lengths", Value::Pair([0.5, 1.5])));
    let cells = laid("rows", inputs).unwrap();
    let lengths = &cells.attributes["length"];
    assert!(lengths.iter().all(|length| (15.0..=45.0).contains(length)));
    let failure = laid("herringbone", board(35.0, 10.0, size("size", 600.0, 100.0))).unwrap_err();
    assert_eq!(
        failure.message,
        "expected a length that is a whole number of times the width, found 3.500 times"
    );
}

#[test]
fn rows_have_widths_of_their_own() {
    for ground in ["size", "period"] {
        let mut inputs = board(30.0, 10.0, size(ground, 600.0, 400.0));
        inputs.push(("widths", Value::Pair([0.6, 1.4])));
        inputs.push(("lengths", Value::Pair([0.5, 1.5])));
        let cells = laid("rows", inputs.clone()).unwrap();
        assert_tiles(&cells, 240_000.0);
        let mut widths = std::collections::BTreeMap::new();
        for cell in 0..cells.len() {
            let corners = cells.outline(cell).iter().map(|at| at.y);
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let [low, high] = corners.fold(ends, |[low, high], y| [low.min(y), high.max(y)]);
            let row = cells.attributes["row"][cell] as i64;
            let width = *widths.entry(row).or_insert(high - low);
            assert!((width - (high - low)).abs() < 1e-6, "row {row}");
        }
        // The first and the last row of a size are cut off.
        let whole: Vec<f64> = widths.values().copied().collect();
        let whole = &whole[1..whole.len() - 1];
        let sum: f64 = whole.iter().sum();
        let mean = sum / whole.len() as f64;
        let spread = whole
            .iter()
            .map(|width| (width - mean).abs())
            .fold(0.0, f64::max);
        assert!(
            (9.0..11.0).contains(&mean) && spread > 2.0,
            "{mean}, {spread}"
        );
        assert!(whole.iter().all(|width| (5.5..15.0).contains(width)));
        inputs.push(("widths", Value::Pair([1.4, 0.6])));
        let failure = laid("rows", inputs).unwrap_err();
        assert_eq!(
            failure.message,
            "expected a range from low to high, found from 1.4 to 0.6"
        );
    }
}

#[test]
fn hexagons_have_six_neighbours_and_fans_have_arcs() {
    let hexagons = laid("hexagons", board(20.0, 20.0, size("period", 200.0, 173.0))).unwrap();
    assert!((0..hexagons.len()).all(|cell| hexagons.neighbours_of(cell).len() == 6));
    let fan = laid("fan", board(9.0, 9.0, size("period", 300.0, 200.0))).unwrap();
    assert!(fan.bulges.iter().any(|bulge| *bulge != 0.0));
}

#[test]
fn recursive_splits_make_as_many_cells_as_fit() {
    let cells = laid("recursive", board(10.0, 20.0, size("size", 400.0, 200.0))).unwrap();
    assert_eq!(cells.len(), 200);
    let largest = cells.areas.iter().copied().fold(0.0, f64::max);
    assert!(largest < 2.0 * 400.0);
    let tees = (0..cells.len())
        .filter(|cell| cells.outline(*cell).len() > 4)
        .count();
    assert!(tees > 50, "{tees}");
}
