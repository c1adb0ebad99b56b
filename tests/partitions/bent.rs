//! Cells with arcs: made smaller, and divided.

use super::{Given, assert_tiles, built, laid, split};
use glam::DVec2;
use std::sync::Arc;
use yosegi::nodes::partition::inset_cells;
use yosegi::value::{Partition, Value};

/// A square of 20 mm with a disk of 10 mm let in.
fn disk_in_square() -> Partition {
    let square = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)];
    let hole = [(15.0, 10.0), (5.0, 10.0)];
    let disk = [(5.0, 10.0), (15.0, 10.0)];
    let corners = square.iter().chain(&hole).chain(&disk);
    const NONE: u32 = Partition::NONE;
    let area = 25.0 * std::f64::consts::PI;
    Partition {
        corners: corners.map(|(x, y)| DVec2::new(*x, *y)).collect(),
        bulges: vec![0.0, 0.0, 0.0, 0.0, -1.0, -1.0, 1.0, 1.0],
        neighbours: vec![NONE, NONE, NONE, NONE, 1, 1, 0, 0],
        rings: vec![0, 4, 6, 8],
        cells: vec![0, 2, 3],
        ids: vec![3, 8],
        centres: vec![DVec2::splat(10.0); 2],
        frames: vec![DVec2::X; 2],
        areas: vec![400.0 - area, area],
        ..Partition::default()
    }
}

fn inset(cells: Arc<Partition>, joint: f64, round: f64) -> Arc<Partition> {
    let given = vec![
        ("of", Value::Partition(cells)),
        ("joint", Value::Number(joint)),
        ("vary", Value::Pair([1.0; 2])),
        ("each", Value::Choice("edge")),
        ("round", Value::Number(round)),
        ("round_vary", Value::Pair([1.0; 2])),
        ("least", Value::Number(0.0)),
        ("seed", Value::Whole(0)),
    ];
    built(&inset_cells::KIND, given).unwrap()
}

fn fan() -> Arc<Partition> {
    let given: Given = vec![
        ("length", Value::Number(9.0)),
        ("width", Value::Number(9.0)),
        ("period", Value::Pair([300.0, 200.0])),
    ];
    laid("fan", given).unwrap()
}

/// The centres and the radii of a cell's arcs.
fn circles(cells: &Partition, cell: usize) -> Vec<(DVec2, f64)> {
    let mut found = vec![];
    for ring in cells.rings_of(cell) {
        for corner in ring.clone() {
            let next = if corner + 1 == ring.end {
                ring.start
            } else {
                corner + 1
            };
            let (from, to) = (cells.corners[corner], cells.corners[next]);
            let bulge = cells.bulge(corner);
            if bulge != 0.0 {
                let aside = (to - from).perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
                let centre = 0.5 * (from + to) + aside;
                found.push((centre, centre.distance(from)));
            }
        }
    }
    found
}

#[test]
fn the_joint_around_a_disk_is_a_ring() {
    let left = inset(Arc::new(disk_in_square()), 2.0, 0.0);
    let pi = std::f64::consts::PI;
    assert!((left.areas[0] - (324.0 - 36.0 * pi)).abs() < 1e-6);
    assert!((left.areas[1] - 16.0 * pi).abs() < 1e-6);
    assert_eq!(
        (left.neighbours_of(0), left.neighbours_of(1)),
        (vec![1], vec![0])
    );
    for (cell, radius) in [(0, 6.0), (1, 4.0)] {
        let circles = circles(&left, cell);
        assert_eq!(circles.len(), 2);
        assert!(circles.iter().all(|(centre, own)| {
            centre.distance(DVec2::splat(10.0)) < 1e-9 && (own - radius).abs() < 1e-9
        }));
    }
}

#[test]
fn setts_of_a_fan_keep_the_centres_of_their_arcs() {
    let fan = fan();
    let left = inset(Arc::clone(&fan), 1.0, 0.0);
    let mut arcs = 0;
    for cell in 0..left.len() {
        let of_id = fan.ids.binary_search(&left.ids[cell]).unwrap();
        let before = circles(&fan, of_id);
        for (centre, radius) in circles(&left, cell) {
            let is_moved = |(other, of): &(DVec2, f64)| {
                other.distance(centre) < 1e-6 && ((of - radius).abs() - 0.5).abs() < 1e-6
            };
            assert!(before.iter().any(is_moved), "cell {cell}");
            arcs += 1;
        }
        assert!(left.areas[cell] < fan.areas[of_id]);
    }
    assert!(arcs > left.len(), "{arcs}");
    // What is rounded once can be made smaller again.
    let rounded = inset(fan, 1.0, 1.5);
    let again = inset(Arc::clone(&rounded), 1.0, 0.0);
    assert!(again.areas.iter().sum::<f64>() < rounded.areas.iter().sum());
}

#[test]
fn cells_with_arcs_are_divided_along_the_same_chords_from_both_sides() {
    let of = |cells: Partition| -> Given {
        vec![
            ("within", Value::Partition(Arc::new(cells))),
            ("cell_size", Value::Number(1.5)),
        ]
    };
    let cells = split(of(disk_in_square())).unwrap();
    assert_tiles(&cells, 400.0);
    let parents = &cells.attributes["parent"];
    let disk = parents.iter().zip(&cells.areas).filter(|it| *it.0 == 8.0);
    let disk: f64 = disk.map(|it| it.1).sum();
    // The chords leave out two thirds of a ring as wide as they are off.
    let exact = 25.0 * std::f64::consts::PI;
    assert!(disk < exact && disk > exact * (1.0 - 1e-3), "{disk}");
    let given: Given = vec![
        ("length", Value::Number(4.0)),
        ("width", Value::Number(2.0)),
        ("within", Value::Partition(Arc::new(disk_in_square()))),
    ];
    assert_tiles(&laid("rows", given).unwrap(), 400.0);
    let mut plain = Partition::clone(&fan());
    plain.period = None;
    let whole = plain.areas.iter().sum::<f64>();
    let divided = split(of(plain)).unwrap();
    assert!((divided.areas.iter().sum::<f64>() / whole - 1.0).abs() < 1e-6);
}
