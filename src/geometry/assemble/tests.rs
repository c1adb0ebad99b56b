//! Pieces put together, cut and joined.

use super::*;
use crate::value::{Polygon, Region};
use std::convert::Infallible;

const NONE: u32 = Partition::NONE;

fn assemble(pieces: Vec<Piece>, period: Option<DVec2>, tolerance: f64) -> Partition {
    let Ok(cells) = super::assemble(pieces, period, tolerance, &mut go_on);
    cells
}

fn clip(pieces: Vec<Piece>, region: &Region) -> Vec<Piece> {
    let Ok(parts) = super::clip(pieces, region, &mut go_on);
    parts
}

fn dissolve(cells: &Partition, owner: &[u32]) -> Partition {
    let Ok(joined) = dissolve::dissolve(cells, owner, &mut go_on);
    joined
}

fn merge_slivers(cells: &Partition, least: f64) -> (Partition, usize) {
    let Ok(merged) = super::merge_slivers(cells, |_| least, &mut go_on);
    merged
}

fn go_on() -> Result<(), Infallible> {
    Ok(())
}

fn ring(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

fn piece(id: u32, corners: &[(f64, f64)]) -> Piece {
    Piece {
        rings: vec![Ring::straight(ring(corners))],
        id,
        frame: DVec2::X,
        centre: None,
    }
}

fn block(id: u32, (left, bottom): (f64, f64), (right, top): (f64, f64)) -> Piece {
    piece(
        id,
        &[(left, bottom), (right, bottom), (right, top), (left, top)],
    )
}

fn region(outline: &[(f64, f64)], holes: &[&[(f64, f64)]]) -> Region {
    let holes = holes.iter().map(|hole| ring(hole)).collect();
    Region {
        polygons: vec![Polygon {
            outline: ring(outline),
            holes,
        }],
    }
}

/// What every partition of a region must be: each edge seen from both sides with equal ends.
fn check(partition: &Partition, area: f64) {
    assert!(partition.is_sound());
    let sum: f64 = partition.areas.iter().sum();
    assert!((sum / area - 1.0).abs() < 1e-9, "{sum} instead of {area}");
    let within = |point: DVec2| match partition.period {
        Some(period) => ((point / period - (point / period + 1e-9).floor()) * period * 1e6).round(),
        None => point,
    };
    let edges = |cell: usize| {
        let rings = partition.rings_of(cell);
        rings
            .flat_map(|ring| {
                let next = move |corner| {
                    if corner + 1 == ring.end {
                        ring.start
                    } else {
                        corner + 1
                    }
                };
                ring.clone().map(move |corner| {
                    let ends =
                        [corner, next(corner)].map(|corner| within(partition.corners[corner]));
                    (ends, partition.neighbours[corner])
                })
            })
            .collect::<Vec<_>>()
    };
    for cell in 0..partition.len() {
        for ([a, b], beyond) in edges(cell) {
            if beyond != NONE {
                let back = edges(beyond as usize);
                assert!(
                    back.contains(&([b, a], cell as u32)),
                    "{cell} {beyond} {a} {b}"
                );
            }
        }
    }
}

#[test]
fn a_wall_of_bricks_gets_its_joints() {
    let bricks = vec![
        block(7, (0.0, 0.0), (2.0, 1.0)),
        block(3, (2.0, 0.0), (4.0, 1.0)),
        block(5, (0.0, 1.0 + 1e-9), (1.0, 2.0)),
        block(4, (1.0, 1.0), (3.0, 2.0)),
        block(9, (3.0, 1.0), (4.0, 2.0)),
        block(8, (1.0, 1.0), (1.0, 2.0)),
    ];
    let wall = assemble(bricks, None, 1e-6);
    check(&wall, 8.0);
    assert_eq!(wall.ids, [7, 3, 5, 4, 9]);
    assert_eq!(wall.outline(0).len(), 5);
    assert_eq!(wall.neighbours_of(3), [0, 1, 2, 4]);
    let edges: Vec<u32> = wall.neighbours[wall.rings_of(0).next().unwrap()].to_vec();
    assert_eq!(edges, [NONE, 1, 3, 2, NONE]);
}

#[test]
fn a_wall_that_repeats_has_no_end() {
    let bricks = vec![
        block(0, (0.0, 0.0), (2.0, 1.0)),
        block(1, (2.0, 0.0), (4.0, 1.0)),
        block(2, (-1.0, 1.0), (1.0, 2.0)),
        block(3, (1.0, 1.0), (3.0, 2.0)),
    ];
    let wall = assemble(bricks, Some(DVec2::new(4.0, 2.0)), 1e-6);
    check(&wall, 8.0);
    assert!(wall.neighbours.iter().all(|cell| *cell != NONE));
    assert_eq!(wall.neighbours_of(0), [1, 2, 3]);
    assert_eq!(wall.outline(0).len(), 6);
    let one = assemble(
        vec![block(0, (0.5, 0.0), (4.5, 2.0))],
        Some(DVec2::new(4.0, 2.0)),
        1e-6,
    );
    assert_eq!(one.neighbours, [0; 4]);
}

#[test]
fn a_disk_fits_its_hole() {
    let disk = Ring {
        corners: ring(&[(3.0, 5.0), (7.0, 5.0)]),
        bulges: vec![1.0, 1.0],
    };
    let mut around = block(0, (0.0, 0.0), (10.0, 10.0));
    around.rings.push(disk.clone());
    let mut inner = block(1, (0.0, 0.0), (1.0, 1.0));
    inner.rings = vec![disk];
    let cells = assemble(vec![around, inner], None, 1e-6);
    assert!(cells.is_sound());
    assert_eq!(cells.neighbours, [NONE, NONE, NONE, NONE, 1, 1, 0, 0]);
    assert!((cells.areas[0] + cells.areas[1] - 100.0).abs() < 1e-12);
    assert!((cells.areas[1] - 4.0 * std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(dissolve(&cells, &[5, 5]).areas, [100.0]);
}

#[test]
fn cells_are_cut_at_a_region_with_a_hole() {
    let blocks = (0..100).map(|id| {
        let at = (f64::from(id % 10), f64::from(id / 10));
        block(id, at, (at.0 + 1.0, at.1 + 1.0))
    });
    let frame: &[(f64, f64)] = &[(0.5, 0.5), (9.5, 0.5), (9.5, 9.5), (0.5, 9.5)];
    let hole: &[(f64, f64)] = &[(5.25, 3.2), (3.25, 5.2), (5.25, 7.2), (7.25, 5.2)];
    let region = region(frame, &[hole]);
    let blocks: Vec<Piece> = blocks.collect();
    let cut = clip(blocks.clone(), &region);
    let inside = cut.iter().find(|piece| piece.id == 11).unwrap();
    assert_eq!(inside.rings, blocks[11].rings);
    let cells = assemble(cut, None, 1e-6);
    check(&cells, 73.0);
    let (merged, count) = merge_slivers(&cells, 0.2);
    check(&merged, 73.0);
    assert!(count > 0 && merged.areas.iter().all(|area| *area >= 0.2));
}

#[test]
fn a_piece_that_falls_apart_becomes_several() {
    let comb = [
        (0.0, 0.0),
        (9.0, 0.0),
        (9.0, 9.0),
        (6.0, 9.0),
        (6.0, 2.0),
        (3.0, 2.0),
        (3.0, 9.0),
        (0.0, 9.0),
    ];
    let mut bar = block(4, (-10.0, 5.0), (10.0, 6.0));
    bar.centre = Some(DVec2::new(7.0, 5.5));
    let cut = clip(
        vec![bar, block(9, (20.0, 0.0), (21.0, 1.0))],
        &region(&comb, &[]),
    );
    let ids: Vec<u32> = cut.iter().map(|piece| piece.id).collect();
    assert_eq!(ids, [4, 10]);
    let cells = assemble(cut, None, 1e-6);
    assert_eq!(cells.areas, [3.0, 3.0]);
}

#[test]
fn cells_of_one_owner_become_one() {
    let blocks = (0..9).map(|id| {
        let at = (f64::from(id % 3), f64::from(id / 3));
        block(id, at, (at.0 + 1.0, at.1 + 1.0))
    });
    let mut cells = assemble(blocks.collect(), None, 1e-6);
    cells
        .attributes
        .insert("number".to_owned(), (0..9).map(f64::from).collect());
    let around = dissolve(&cells, &[1, 1, 1, 1, 0, 1, 1, 1, 1]);
    check(&around, 9.0);
    assert_eq!(around.areas, [8.0, 1.0]);
    assert_eq!(around.rings_of(0).count(), 2);
    assert_eq!(around.attributes["number"], [0.0, 4.0]);
    let apart = dissolve(&cells, &[1, 0, 1, 0, 0, 0, 1, 0, 1]);
    check(&apart, 9.0);
    assert_eq!(apart.len(), 5);
}

#[test]
fn cells_that_repeat_are_joined_across_the_seam() {
    let blocks = (0..9).map(|id| {
        let at = (f64::from(id % 3), f64::from(id / 3));
        block(id, at, (at.0 + 1.0, at.1 + 1.0))
    });
    let cells = assemble(blocks.collect(), Some(DVec2::splat(3.0)), 1e-6);
    let joined = dissolve(&cells, &[0, 1, 0, 3, 4, 5, 6, 7, 8]);
    check(&joined, 9.0);
    assert_eq!(joined.areas[0], 2.0);
    assert_eq!(joined.neighbours_of(0), [1, 2, 4, 5, 7]);
}

#[test]
fn a_cancelled_run_ends_before_it_takes_long() {
    // So many squares that all stages together take some tenths of a second.
    let count = 250_u32;
    let square = |id: u32| {
        let low = (f64::from(id % count), f64::from(id / count));
        block(id, low, (low.0 + 1.0, low.1 + 1.0))
    };
    let squares: Vec<Piece> = (0..count * count).map(square).collect();
    let side = f64::from(count) - 0.5;
    let slanting = region(
        &[
            (0.5, 0.25),
            (side, 0.0),
            (side - 1.0, side),
            (0.0, side - 1.0),
        ],
        &[],
    );
    let work = |go_on: &mut dyn FnMut() -> Result<(), ()>| -> Result<usize, ()> {
        let pieces = super::clip(squares.clone(), &slanting, go_on)?;
        let cells = super::assemble(pieces, None, 1e-6, go_on)?;
        let (cells, _) = super::merge_slivers(&cells, |_| 0.4, go_on)?;
        Ok(cells.len())
    };
    let mut asked = 0;
    let mut count_asked = || {
        asked += 1;
        Ok(())
    };
    assert!(work(&mut count_asked).is_ok());
    assert!(asked > 60, "{asked}");
    // Whichever question is answered with an error is the last one.
    for last in [1, 5, asked / 2, asked] {
        let mut left = last;
        let mut stop = || {
            left -= 1;
            if left == 0 { Err(()) } else { Ok(()) }
        };
        assert_eq!(work(&mut stop), Err(()));
        assert_eq!(left, 0);
    }
}
