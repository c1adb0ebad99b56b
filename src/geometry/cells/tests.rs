//! Finding cells, against a search through all and against shapes that are known.

use super::*;
use std::f64::consts::PI;

const NONE: u32 = Partition::NONE;

/// A grid of `count` x `count` squares of 10 mm whose inner corners are moved by up to 3 mm.
fn quads(count: usize, period: bool) -> Arc<Partition> {
    let moved = |i: usize, j: usize| {
        let (at_x, at_y) = (i % count, j % count);
        let is_free = period || (at_x * at_y != 0);
        let noise =
            |seed: usize| ((at_x * 37 + at_y * 101 + seed) * 7919 % 1000) as f64 / 1000.0 - 0.5;
        let by = DVec2::new(noise(1), noise(5)) * if is_free { 6.0 } else { 0.0 };
        DVec2::new(i as f64, j as f64) * 10.0 + by
    };
    let mut partition = Partition::default();
    (partition.rings, partition.cells) = (vec![0], vec![0]);
    for (j, i) in (0..count * count).map(|cell| (cell / count, cell % count)) {
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| moved(i + x, j + y));
        let beside = |x: isize, y: isize| {
            let [x, y] = [(i, x), (j, y)].map(|(at, step)| at as isize + step);
            let is_inside = [x, y].iter().all(|it| (0..count as isize).contains(it));
            match is_inside || period {
                true => {
                    let [x, y] = [x, y].map(|it| it.rem_euclid(count as isize) as usize);
                    (y * count + x) as u32
                }
                false => NONE,
            }
        };
        partition.corners.extend(corners);
        partition
            .neighbours
            .extend([beside(0, -1), beside(1, 0), beside(0, 1), beside(-1, 0)]);
        partition.rings.push(partition.corners.len() as u32);
        partition.cells.push(partition.rings.len() as u32 - 1);
        partition.ids.push((j * count + i) as u32);
        partition.centres.push(corners.iter().sum::<DVec2>() / 4.0);
        partition.frames.push(DVec2::X);
        partition.areas.push(100.0);
    }
    partition.period = period.then(|| DVec2::splat(10.0 * count as f64));
    assert!(partition.is_sound());
    Arc::new(partition)
}

fn points(count: usize, scale: f64) -> impl Iterator<Item = DVec2> {
    let share = |index: usize, stride: usize| (index * stride % 10_007) as f64 / 10_007.0;
    (0..count).map(move |index| DVec2::new(share(index, 617), share(index, 331)) * scale)
}

#[test]
fn a_point_is_in_one_cell_wherever_the_search_began() {
    for period in [false, true] {
        let partition = quads(9, period);
        let index = CellIndex::new(&partition);
        let mut last = None;
        for point in points(10_000, 90.0).chain((0..90).map(|i| DVec2::splat(f64::from(i)))) {
            let alone = index.find(point, None);
            let walked = index.find(point, last.as_ref());
            assert_eq!(alone.cell, walked.cell, "{point}");
            assert_eq!(alone.border, walked.border);
            assert!(alone.border >= 0.0);
            let all = (0..partition.len() as u32).flat_map(|cell| {
                let shifts = [-90.0, 0.0, 90.0];
                let shifts = shifts.map(|y| shifts.map(|x| DVec2::new(x, y)));
                let shifts = if period {
                    shifts.concat()
                } else {
                    vec![DVec2::ZERO]
                };
                shifts.into_iter().map(move |shift| (cell, shift))
            });
            let around = all.filter(|(cell, shift)| index.spot(*cell, *shift, point).border > 0.0);
            assert!(around.clone().count() <= 1);
            assert!(around.clone().all(|(cell, _)| cell == alone.cell));
            last = Some(walked);
        }
    }
}

#[test]
fn corners_and_edges_belong_to_one_cell() {
    let partition = quads(9, false);
    let index = CellIndex::new(&partition);
    for (corner, next) in partition
        .corners
        .iter()
        .zip(partition.corners.iter().skip(1))
    {
        for point in [*corner, (*corner + *next) * 0.5] {
            let around = (0..81).filter(|cell| index.spot(*cell, DVec2::ZERO, point).border >= 0.0);
            let is_within = point.cmpgt(DVec2::ZERO).all() && point.cmplt(DVec2::splat(90.0)).all();
            // What lies on a border has a border of 0 and may so seem to be in more than one.
            assert!(!is_within || around.count() >= 1, "{point}");
        }
    }
}

#[test]
fn outside_all_cells_the_nearest_is_found() {
    let partition = quads(3, false);
    let index = CellIndex::new(&partition);
    let spot = index.find(DVec2::new(5.0, -7.0), None);
    assert_eq!((spot.cell, spot.border), (0, -7.0));
    let spot = index.find(DVec2::new(33.0, 34.0), None);
    assert_eq!((spot.cell, spot.border), (8, -5.0));
}

#[test]
fn what_was_near_before_changes_nothing_outside() {
    let partition = quads(6, false);
    let index = CellIndex::new(&partition);
    let mut last = index.find(DVec2::splat(-40.0), None);
    for point in points(5000, 300.0).map(|point| point - 100.0) {
        let spot = index.find(point, Some(&last));
        let alone = index.find(point, None);
        assert_eq!(
            (spot.cell, spot.border),
            (alone.cell, alone.border),
            "{point}"
        );
        last = spot;
    }
    // What is no point is in no cell.
    let nowhere = index.find(DVec2::splat(f64::NAN), Some(&last));
    assert!(nowhere.border < 0.0);
}

#[test]
fn periods_repeat() {
    let partition = quads(5, true);
    let index = CellIndex::new(&partition);
    for point in points(500, 50.0) {
        let here = index.find(point, None);
        for shift in [DVec2::new(50.0, 0.0), DVec2::new(-100.0, 150.0)] {
            let there = index.find(point + shift, None);
            assert_eq!(here.cell, there.cell);
            assert!((here.border - there.border).abs() < 1e-9);
            assert!((here.offset - there.offset).length() < 1e-9);
        }
    }
}

#[test]
fn arcs_are_exact() {
    // A disc of two half circles, and beside its right half a cell that it bites into.
    let circle = Partition {
        corners: [
            (0.0, -1.0),
            (0.0, 1.0),
            (0.0, -1.0),
            (2.0, -1.0),
            (2.0, 1.0),
            (0.0, 1.0),
        ]
        .map(|(x, y)| DVec2::new(x, y))
        .to_vec(),
        bulges: vec![1.0, 1.0, 0.0, 0.0, 0.0, -1.0],
        neighbours: vec![1, NONE, NONE, NONE, NONE, 0],
        rings: vec![0, 2, 6],
        cells: vec![0, 1, 2],
        ids: vec![0, 1],
        centres: vec![DVec2::ZERO, DVec2::X],
        frames: vec![DVec2::X; 2],
        areas: vec![PI, 4.0 - PI / 2.0],
        ..Partition::default()
    };
    let index = CellIndex::new(&Arc::new(circle));
    for point in points(5000, 4.0).map(|point| point - 2.0) {
        let length = point.length();
        let spot = index.find(point, None);
        if length < 1.0 {
            assert_eq!(spot.cell, 0, "{point}");
            assert!((spot.border - (1.0 - length)).abs() < 1e-12, "{point}");
        } else if point.x > 0.0 && point.x < 2.0 && point.y.abs() < 1.0 {
            assert_eq!(spot.cell, 1, "{point}");
            let straight = (2.0 - point.x).min(1.0 - point.y.abs());
            assert!(
                (spot.border - straight.min(length - 1.0)).abs() < 1e-9,
                "{point}"
            );
        } else {
            assert!(spot.border <= 0.0, "{point}");
        }
    }
}

#[test]
fn cells_with_many_edges_are_found_alike() {
    // A wheel with a hole, and the same with its edges in a list.
    let point = |index: usize, radius: f64| {
        let angle = index as f64 * PI / 100.0;
        let radius = if index.is_multiple_of(2) {
            radius
        } else {
            0.8 * radius
        };
        DVec2::new(libm::cos(angle), libm::sin(angle)) * radius
    };
    let outline = (0..200).map(|index| point(index, 10.0));
    let hole = (0..60).map(|index| point(200 - index * 3, 4.0));
    let corners: Vec<DVec2> = outline.chain(hole).collect();
    let wheel = Arc::new(Partition {
        neighbours: vec![NONE; corners.len()],
        bulges: corners
            .iter()
            .map(|corner| 0.1 * corner.x.signum())
            .collect(),
        corners,
        rings: vec![0, 200, 260],
        cells: vec![0, 2],
        ids: vec![0],
        centres: vec![DVec2::ZERO],
        frames: vec![DVec2::X],
        areas: vec![200.0],
        ..Partition::default()
    });
    let index = CellIndex::new(&wheel);
    assert_eq!(index.large.len(), 1);
    for point in points(3000, 24.0).map(|point| point - 12.0) {
        let (inside, distance, _) = meet(&wheel, 0, point);
        let spot = index.find(point, None);
        assert_eq!(spot.border >= 0.0, inside, "{point}");
        assert_eq!(spot.border.abs(), distance.sqrt(), "{point}");
    }
}
