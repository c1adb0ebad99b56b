//! Pictures: margins, supersampling, tiles and cached columns.

use super::*;

#[test]
fn margins_add_up_where_spreads_are_read_of_spreads() {
    let u = axis(Domain::Plane, 0);
    let square = product().of(&[&u, &u]);
    let [once, twice] = [rise().of(&[&square]), rise().of(&[&rise().of(&[&square])])];
    let margins = [&square, &once, &twice]
        .map(|field| Program::compile(std::slice::from_ref(field)).margin());
    assert_eq!(margins, [0, 1, 2]);
    let pictures = painted(&[once, twice], [9, 4], 3, &context());
    // u^2 at the pixel centres 0.5, 1.5 ..: slope 2u, and 2 everywhere, without an error at any border.
    for (index, (slope, bend)) in pictures[0].iter().zip(&pictures[1]).enumerate() {
        assert_eq!(
            (*slope, *bend),
            (2.0 * ((index % 9) as f32 + 0.5), 2.0),
            "pixel {index}"
        );
    }
}

/// The share of the pixel at (x, y) of a picture `height` pixels high where `below` holds.
fn coverage(x: u32, y: u32, height: u32, below: &dyn Fn(f64, f64) -> bool) -> f64 {
    const SIDE: u32 = 64;
    let at = |pixel: u32, part: u32| f64::from(pixel) + (f64::from(part) + 0.5) / f64::from(SIDE);
    let inside = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row)));
    let count = inside
        .filter(|(column, row)| below(at(x, *column), f64::from(height) - at(y, *row)))
        .count();
    count as f64 / f64::from(SIDE * SIDE)
}

#[test]
fn an_edge_is_supersampled_to_its_coverage() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let (mut total, mut crossed) = (0.0, 0);
    for offset in [9.05, 9.4, 9.65, 9.9] {
        // u - 0.3 v < offset / 2, a slanted edge.
        let slant = mean().of(&[&u, &product().of(&[&v, &Field::constant(-0.3)])]);
        let distance = mean().of(&[&slant, &Field::constant(-0.5 * offset)]);
        let picture = &painted(&[below_zero().of(&[&distance])], [20, 12], 7, &context())[0];
        for (index, value) in (0u32..).zip(picture) {
            let wanted = coverage(index % 20, index / 20, 12, &|u, v| u - 0.3 * v < offset);
            let error = f64::from(*value) - wanted;
            assert!(
                error.abs() <= 0.13,
                "pixel {index}: {value}, expected {wanted}"
            );
            assert!(
                (wanted > 0.0 && wanted < 1.0) || error == 0.0,
                "pixel {index}: {value}"
            );
            total += error;
            crossed += u32::from(wanted > 0.0 && wanted < 1.0);
        }
    }
    assert!(
        crossed >= 60 && (total / f64::from(crossed)).abs() < 0.01,
        "{total} over {crossed}"
    );
}

#[test]
fn without_filtering_and_at_points_nothing_is_averaged() {
    let u = axis(Domain::Plane, 0);
    let edge = below_zero().of(&[&mean().of(&[&u, &Field::constant(-3.3)])]);
    let plain = RunContext {
        filtering: false,
        ..context()
    };
    assert_eq!(
        painted(std::slice::from_ref(&edge), [6, 1], 4, &plain)[0],
        [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    );
    assert_eq!(
        at_points(&[edge], &[[3.2, 0.0, 0.0], [3.4, 0.0, 0.0]])[0],
        [1.0, 0.0]
    );
}

/// Fields that read spreads and edges of each other, each in several ways.
fn relatives() -> Vec<Field> {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let wave = mean().of(&[
        &product().of(&[&u, &u]),
        &product().of(&[&v, &Field::constant(-7.3)]),
    ]);
    let edge = below_zero().of(&[&mean().of(&[&wave, &Field::constant(-20.0)])]);
    let slope = rise().of(&[&edge]);
    let turned = join().of(&[&v, &u, &v]);
    let steep = below_zero().of(&[&mean().of(&[&slope, &Field::constant(0.4)])]);
    vec![
        rise().of(&[&rise().of(&[&wave])]),
        wave,
        edge.clone(),
        slope.clone(),
        rise().of(&[&slope]),
        steep,
        edge.at(&turned),
    ]
}

#[test]
fn tiles_give_the_same_bits_as_the_whole() {
    let fields = relatives();
    let whole = bits(&painted(&fields, [23, 17], 64, &context()));
    for side in [1, 2, 5, 16, 22] {
        assert!(
            bits(&painted(&fields, [23, 17], side, &context())) == whole,
            "tiles of {side}"
        );
    }
}

/// Keeps every column that it is given.
#[derive(Default)]
struct Everything(Mutex<HashMap<Key, Columns>>);

impl ColumnCache for Everything {
    fn get(&self, key: &Key) -> Option<Columns> {
        self.0.lock().unwrap().get(key).cloned()
    }

    fn put(&self, _: &str, key: Key, columns: Columns, _: f64) {
        self.0.lock().unwrap().insert(key, columns);
    }
}

/// A column may be needed farther beyond the tile by one program than by another.
#[test]
fn a_cache_filled_by_one_program_does_not_change_another() {
    let fields = relatives();
    let cache = Everything::default();
    let warm = RunContext {
        cache: Some(&cache),
        ..context()
    };
    for _ in 0..2 {
        for first in 0..fields.len() {
            for second in 0..fields.len() {
                let pair = [fields[first].clone(), fields[second].clone()];
                let cold = bits(&painted(&pair, [23, 17], 8, &context()));
                assert!(
                    bits(&painted(&pair, [23, 17], 8, &warm)) == cold,
                    "fields {first} and {second}"
                );
            }
        }
    }
}

#[test]
fn a_cached_kernel_does_not_run_again() {
    let counted = Test {
        nanoseconds: 9.0,
        ..mean()
    };
    let field = counted.of(&[&axis(Domain::Plane, 0), &axis(Domain::Plane, 1)]);
    let cache = Everything::default();
    let warm = RunContext {
        cache: Some(&cache),
        ..context()
    };
    let first = painted(std::slice::from_ref(&field), [8, 8], 4, &warm);
    assert_eq!(counted.calls(), 4);
    assert_eq!(painted(&[field], [8, 8], 4, &warm), first);
    assert_eq!(counted.calls(), 4);
}

#[test]
fn points_do_not_depend_on_their_neighbours() {
    let points: Vec<[f64; 3]> = (0..50)
        .map(|index| [f64::from(index) * 0.37, f64::from(index % 7), 0.0])
        .collect();
    let fields = relatives();
    let whole = at_points(&fields, &points);
    for length in [1, 7, 16, 33] {
        let mut parts = vec![vec![]; fields.len()];
        for points in points.chunks(length) {
            for (part, values) in parts.iter_mut().zip(at_points(&fields, points)) {
                part.extend(values);
            }
        }
        assert_eq!(bits(&parts), bits(&whole), "blocks of {length}");
    }
}
