//! Laws of Voronoi cells, and known values of power cells and lattices.

use super::{anywhere, assert_tiles, given, outline_of, points, split};
use glam::DVec2;
use std::sync::Arc;
use yosegi::field::Field;
use yosegi::value::{Domain, Partition, Polygon, Region, Value};

#[test]
fn cells_tile_and_hold_what_is_nearest_to_their_seeds() {
    let size = (30.0, 20.0);
    let seeds = anywhere(400, size);
    let cells = split(given(points(&seeds), size)).unwrap();
    assert_eq!(cells.len(), 400);
    assert_tiles(&cells, 600.0);
    for (cell, own) in seeds.iter().enumerate() {
        let distance = |seed: &(f64, f64), at: DVec2| at.distance(DVec2::new(seed.0, seed.1));
        for corner in outline_of(&cells, cell) {
            let nearest = seeds
                .iter()
                .map(|seed| distance(seed, *corner))
                .fold(f64::INFINITY, f64::min);
            assert!(distance(own, *corner) - nearest < 1e-12, "cell {cell}");
        }
    }
}

#[test]
fn the_order_of_the_seeds_is_of_no_importance() {
    let size = (30.0, 20.0);
    for seeds in [anywhere(300, size), lattice()] {
        let forward = split(given(points(&seeds), size)).unwrap();
        let reversed: Vec<_> = seeds.iter().rev().copied().collect();
        let backward = split(given(points(&reversed), size)).unwrap();
        for cell in 0..seeds.len() {
            let other = seeds.len() - 1 - cell;
            let turned = |cells: &Partition, cell: usize| {
                let mut corners: Vec<[u64; 2]> = cells
                    .outline(cell)
                    .iter()
                    .map(|at| [at.x.to_bits(), at.y.to_bits()])
                    .collect();
                corners.sort_unstable();
                corners
            };
            assert_eq!(turned(&forward, cell), turned(&backward, other));
            assert_eq!(forward.areas[cell], backward.areas[other]);
        }
    }
}

/// A square lattice: four seeds on each circle.
fn lattice() -> Vec<(f64, f64)> {
    let seed = |index: i32| (f64::from(index % 30) + 0.5, f64::from(index / 30) + 0.5);
    (0..600).map(seed).collect()
}

#[test]
fn a_lattice_has_squares_as_cells() {
    let cells = split(given(points(&lattice()), (30.0, 20.0))).unwrap();
    assert_tiles(&cells, 600.0);
    for cell in 0..600 {
        assert_eq!(cells.outline(cell).len(), 4);
        assert!((cells.areas[cell] - 1.0).abs() < 1e-12);
    }
}

#[test]
fn scale_changes_no_bit() {
    let size = (30.0, 20.0);
    let seeds = anywhere(200, size);
    let cells = split(given(points(&seeds), size)).unwrap();
    for scale in [2.0_f64.powi(-30), 2.0_f64.powi(20)] {
        let larger: Vec<_> = seeds.iter().map(|(x, y)| (x * scale, y * scale)).collect();
        let other = split(given(points(&larger), (30.0 * scale, 20.0 * scale))).unwrap();
        let back: Vec<DVec2> = other.corners.iter().map(|at| *at / scale).collect();
        assert_eq!(cells.corners, back);
        assert_eq!(cells.neighbours, other.neighbours);
    }
}

#[test]
fn a_plane_that_repeats_closes() {
    for count in [1, 2, 3, 7, 300] {
        let mut inputs = given(points(&anywhere(count, (30.0, 20.0))), (0.0, 0.0));
        inputs.pop();
        inputs.push(("period", Value::Pair([30.0, 20.0])));
        let cells = split(inputs).unwrap();
        assert_eq!(cells.len(), count);
        let sum: f64 = cells.areas.iter().sum();
        assert!((sum - 600.0).abs() < 1e-9, "{count}: {sum}");
        if count > 3 {
            assert_tiles(&cells, 600.0);
        }
        let is_within = |at: &DVec2| at.cmpge(DVec2::ZERO).all() && at.x < 30.0 && at.y < 20.0;
        assert!(cells.centres.iter().all(is_within));
    }
}

#[test]
fn jittered_hexagons_are_like_the_scales_of_a_lizard() {
    let cells = split(vec![
        ("seeds", Value::Choice("hexagonal")),
        ("period", Value::Pair([2000.0, 2000.0])),
        ("count", Value::Whole(6000)),
        ("jitter", Value::Number(0.26)),
    ])
    .unwrap();
    let six = (0..cells.len())
        .filter(|cell| cells.outline(*cell).len() == 6)
        .count();
    let share = six as f64 / cells.len() as f64;
    let mean = cells.areas.iter().sum::<f64>() / cells.len() as f64;
    let square = |area: &f64| (area / mean - 1.0) * (area / mean - 1.0);
    let deviation = (cells.areas.iter().map(square).sum::<f64>() / cells.len() as f64).sqrt();
    assert!((share - 0.88).abs() < 0.03, "{share}");
    // To first order the area of a cell with sides s changes by s/2 times what its six neighbours move towards or away from it, so
    // seeds moved by j s give a deviation of sqrt(6)/2 j s² over 3 sqrt(3)/2 s² = 0.471 j: 0.123 here, and what is
    // of second order adds some hundredths of that. Lattices jittered by 0.25 and 0.3, computed apart, have 0.123 and
    // 0.15, which is 0.128 between them. The lizard's 0.117 would need 0.24, with which 94 % are hexagons: no jitter has both of its
    // numbers.
    let first_order = 6.0_f64.sqrt() / 2.0 * 0.26 / (1.5 * 3.0_f64.sqrt());
    assert!(
        (first_order..1.1 * first_order).contains(&deviation),
        "{deviation}"
    );
}

#[test]
fn relaxation_evens_areas_out() {
    let deviation = |relax: i64| {
        let cells = split(vec![
            ("period", Value::Pair([300.0, 300.0])),
            ("count", Value::Whole(900)),
            ("relax", Value::Whole(relax)),
        ])
        .unwrap();
        let square = |area: &f64| (area / 100.0 - 1.0) * (area / 100.0 - 1.0);
        (cells.areas.iter().map(square).sum::<f64>() / cells.len() as f64).sqrt()
    };
    assert!((deviation(0) - 0.53).abs() < 0.05);
    assert!((deviation(5) - 0.23).abs() < 0.05);
}

/// The share of cells whose middle is in the right half of 400 mm.
fn right(cells: &Partition) -> f64 {
    let right = cells.centres.iter().filter(|at| at.x > 200.0).count();
    right as f64 / cells.len() as f64
}

#[test]
fn seeds_are_as_dense_as_a_field_says_before_and_after_relaxation() {
    // As dense as x is large: three quarters are in the right half.
    let density = || Value::Field(Field::position(Domain::Plane).part(0, 1));
    for (relax, ground) in [(0, "size"), (12, "size"), (12, "period")] {
        let cells = split(vec![
            (ground, Value::Pair([400.0, 200.0])),
            ("count", Value::Whole(3000)),
            ("relax", Value::Whole(relax)),
            ("density", density()),
        ])
        .unwrap();
        assert_tiles(&cells, 80_000.0);
        assert!(
            (right(&cells) - 0.75).abs() < 0.025,
            "{relax}: {}",
            right(&cells)
        );
    }
    // Relaxation alone draws seeds there too.
    let drawn = split(vec![
        ("size", Value::Pair([400.0, 200.0])),
        ("seeds", Value::Choice("jittered")),
        ("count", Value::Whole(60)),
        ("relax", Value::Whole(150)),
        ("density", density()),
    ])
    .unwrap();
    assert!(right(&drawn) > 0.6, "{}", right(&drawn));
    let wrong = split(vec![
        ("size", Value::Pair([400.0, 200.0])),
        ("seeds", Value::Choice("square")),
        ("count", Value::Whole(60)),
        ("density", density()),
    ]);
    assert_eq!(
        wrong.unwrap_err().message,
        "the density says where random seeds are, and where relaxation moves others"
    );
    let none = split(vec![
        ("size", Value::Pair([400.0, 200.0])),
        ("count", Value::Whole(60)),
        ("density", Value::Number(0.0)),
    ]);
    assert_eq!(none.unwrap_err().message, "the density is nowhere above 0");
}

#[test]
fn cells_have_the_areas_that_are_stated() {
    let outline = [
        (0.0, 0.0),
        (90.0, 0.0),
        (90.0, 40.0),
        (40.0, 40.0),
        (40.0, 80.0),
        (0.0, 80.0),
    ];
    let angle = Value::Region(Arc::new(Region {
        polygons: vec![Polygon {
            outline: outline.map(|(x, y)| DVec2::new(x, y)).to_vec(),
            holes: vec![],
        }],
    }));
    let grounds = [
        (("size", Value::Pair([90.0, 60.0])), 5400.0),
        (("period", Value::Pair([90.0, 60.0])), 5400.0),
        (("region", angle), 5200.0),
    ];
    for (ground, whole) in grounds {
        for (relax, areas) in [(0, [1.0, 1.0]), (3, [0.5, 2.0])] {
            let cells = split(vec![
                ground.clone(),
                ("count", Value::Whole(200)),
                ("relax", Value::Whole(relax)),
                ("areas", Value::Pair(areas)),
            ])
            .unwrap();
            assert_tiles(&cells, whole);
            assert_eq!(cells.len(), 200);
            let mean = whole / 200.0;
            let mut found: Vec<f64> = cells.areas.iter().map(|area| area / mean).collect();
            found.sort_by(f64::total_cmp);
            if relax == 0 {
                assert!(
                    found[0] > 1.0 - 1e-6 && found[199] < 1.0 + 1e-6,
                    "{}",
                    found[0]
                );
                continue;
            }
            // Evenly drawn between 0.5 and 2, in means of 1.25.
            assert!(found[0] > 0.37 && found[199] < 1.7);
            let quarters = [found[50], found[100], found[150]];
            for (quarter, expected) in quarters.iter().zip([0.7, 1.0, 1.3]) {
                assert!((quarter - expected).abs() < 0.15, "{quarters:?}");
            }
        }
    }
    let both = split(vec![
        ("size", Value::Pair([9.0, 9.0])),
        ("count", Value::Whole(20)),
        ("areas", Value::Pair([0.5, 2.0])),
        ("weights", Value::Pair([0.5, 2.0])),
    ]);
    assert_eq!(
        both.unwrap_err().message,
        "`weights` and `areas` both say how heavy the seeds are"
    );
}

#[test]
fn densities_and_areas_are_alike_at_any_thread_count() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            split(vec![
                ("size", Value::Pair([400.0, 200.0])),
                ("count", Value::Whole(150)),
                ("relax", Value::Whole(2)),
                ("areas", Value::Pair([0.5, 2.0])),
                (
                    "density",
                    Value::Field(Field::position(Domain::Plane).part(0, 1)),
                ),
            ])
        })
    };
    assert_eq!(with(1).unwrap(), with(3).unwrap());
}

#[test]
fn borders_of_power_cells_have_equal_tangents() {
    let mut inputs = given(points(&[(20.0, 10.0), (60.0, 10.0)]), (100.0, 20.0));
    inputs.push((
        "radii",
        Value::List(vec![Value::Number(20.0), Value::Number(10.0)]),
    ));
    let cells = split(inputs).unwrap();
    // (d^2 + r^2 - s^2) / 2d from the first seed.
    let border = 20.0 + (1600.0 + 400.0 - 100.0) / 80.0;
    assert!((cells.areas[0] - 20.0 * border).abs() < 1e-4);
    assert_tiles(&cells, 2000.0);
}

#[test]
fn large_weights_leave_the_borders_where_they_are() {
    let seeds = [(1.0, 1.0), (5.0, 5.0), (8.0, 2.0)];
    let plain = split(given(points(&seeds), (10.0, 10.0))).unwrap();
    let mut inputs = given(points(&seeds), (10.0, 10.0));
    inputs.push(("radii", Value::List(vec![Value::Number(1e9); 3])));
    let heavy = split(inputs).unwrap();
    assert_tiles(&heavy, 100.0);
    for (a, b) in plain.areas.iter().zip(&heavy.areas) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn equal_weights_change_nothing_and_hidden_seeds_have_no_cell() {
    let size = (30.0, 20.0);
    let seeds = anywhere(300, size);
    let plain = split(given(points(&seeds), size)).unwrap();
    let radii = |of: &dyn Fn(usize) -> f64| {
        Value::List((0..300).map(|seed| Value::Number(of(seed))).collect())
    };
    let mut inputs = given(points(&seeds), size);
    inputs.push(("radii", radii(&|_| 3.0)));
    let equal = split(inputs.clone()).unwrap();
    assert_tiles(&equal, 600.0);
    for (a, b) in plain.areas.iter().zip(&equal.areas) {
        assert!((a - b).abs() < 1e-6);
    }
    inputs.pop();
    inputs.push(("radii", radii(&|seed| if seed == 7 { 5.0 } else { 0.0 })));
    let heavy = split(inputs).unwrap();
    assert!(heavy.len() < 300);
    assert_tiles(&heavy, 600.0);
}

#[test]
fn cells_within_cells_keep_the_borders() {
    let outer = split(given(points(&anywhere(12, (300.0, 200.0))), (300.0, 200.0))).unwrap();
    let inner = split(vec![
        ("within", Value::Partition(outer.clone())),
        ("cell_size", Value::Number(15.0)),
    ])
    .unwrap();
    assert_tiles(&inner, 60_000.0);
    let parents = &inner.attributes["parent"];
    for (cell, area) in outer.areas.iter().enumerate() {
        let of_cell = parents
            .iter()
            .zip(&inner.areas)
            .filter(|(parent, _)| **parent == f64::from(outer.ids[cell]));
        let sum: f64 = of_cell.map(|(_, area)| area).sum();
        assert!((sum / area - 1.0).abs() < 1e-6);
        for corner in outer.outline(cell) {
            assert!(inner.corners.iter().any(|at| at.distance(*corner) < 1e-5));
        }
    }
}
