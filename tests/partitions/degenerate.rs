//! Seeds that other programs stumble over: none, few, equal, on one line, on one circle, far away, close together.

use super::{anywhere, assert_tiles, given, points, split};
use yosegi::value::Value;

const SIZE: (f64, f64) = (64.0, 32.0);
const AREA: f64 = 64.0 * 32.0;

#[test]
fn no_seed_is_refused_and_one_has_everything() {
    let none = split(given(points(&[]), SIZE)).unwrap_err();
    assert_eq!(none.message, "expected at least one seed, found none");
    let one = split(given(points(&[(5.0, 5.0)]), SIZE)).unwrap();
    assert_eq!((one.len(), one.areas[0]), (1, AREA));
    assert_eq!(one.outline(0).len(), 4);
    let two = split(given(points(&[(5.0, 5.0), (15.0, 5.0)]), SIZE)).unwrap();
    assert_eq!(two.areas, [320.0, AREA - 320.0]);
}

#[test]
fn seeds_on_one_line_have_strips() {
    let lines: [fn(f64) -> (f64, f64); 4] = [
        |share| (64.0 * share, 7.0),
        |share| (3.0, 32.0 * share),
        |share| (64.0 * share, 32.0 * share),
        |share| (64.0 * share, 9.0 + 1e-14 * libm::sin(share * 1e4)),
    ];
    for line in lines {
        let seeds: Vec<_> = (0..3000)
            .map(|seed| line((f64::from(seed) + 0.5) / 3000.0))
            .collect();
        let cells = split(given(points(&seeds), SIZE)).unwrap();
        assert_eq!(cells.len(), 3000);
        assert_tiles(&cells, AREA);
    }
}

#[test]
fn equal_seeds_are_one_and_the_first_has_the_cell() {
    let same = split(given(points(&[(5.0, 5.0); 1000]), SIZE)).unwrap();
    assert_eq!((&same.ids[..], same.areas[0]), (&[0][..], AREA));
    let mut seeds = anywhere(500, SIZE);
    seeds.extend_from_within(..250);
    let half = split(given(points(&seeds), SIZE)).unwrap();
    assert_eq!(half.ids, (0..500).collect::<Vec<u32>>());
    assert_tiles(&half, AREA);
}

#[test]
fn seeds_a_last_bit_apart_are_one() {
    let mut seeds = anywhere(300, SIZE);
    let next = |number: f64| f64::from_bits(number.to_bits() + 1);
    seeds.extend(seeds.clone().iter().map(|(x, y)| (next(*x), *y)));
    seeds.extend(seeds.clone().iter().take(300).map(|(x, y)| (*x, next(*y))));
    let cells = split(given(points(&seeds), SIZE)).unwrap();
    assert_eq!(cells.ids, (0..300).collect::<Vec<u32>>());
    assert_tiles(&cells, AREA);
}

#[test]
fn seeds_on_one_circle_share_its_middle() {
    for count in [8, 360, 3000] {
        let seed = |index: i32| {
            let angle = std::f64::consts::TAU * f64::from(index) / f64::from(count);
            (
                32.0 + 12.0 * libm::cos(angle),
                16.0 + 12.0 * libm::sin(angle),
            )
        };
        let seeds: Vec<_> = (0..count).map(seed).collect();
        let cells = split(given(points(&seeds), SIZE)).unwrap();
        assert_eq!(cells.len(), count as usize);
        assert_tiles(&cells, AREA);
    }
}

#[test]
fn mixed_scales_and_tiny_numbers_are_no_matter() {
    let mut seeds = anywhere(200, SIZE);
    seeds.extend(
        anywhere(200, (64e-9, 32e-9))
            .iter()
            .map(|(x, y)| (20.0 + x, 10.0 + y)),
    );
    seeds.extend([(1e-45, 1e-300), (5e-324, 31.0), (0.0, -0.0)]);
    let cells = split(given(points(&seeds), SIZE)).unwrap();
    assert_eq!(cells.len(), 402);
    assert_tiles(&cells, AREA);
}

#[test]
fn seeds_far_away_have_no_cell() {
    let mut seeds = anywhere(100, SIZE);
    seeds.extend([(1e38, 0.0), (-1e8, 5.0), (5.0, 1e5)]);
    let cells = split(given(points(&seeds), SIZE)).unwrap();
    assert_eq!(cells.ids, (0..100).collect::<Vec<u32>>());
    assert_tiles(&cells, AREA);
}

#[test]
fn what_contradicts_itself_is_refused() {
    let mut both = given(points(&[(1.0, 1.0)]), SIZE);
    both.push(("radii", Value::List(vec![])));
    assert_eq!(
        split(both).unwrap_err().message,
        "expected 1 radii, one for each of the `points`, found 0"
    );
    let size = ("size", Value::Pair([64.0, 32.0]));
    let none = split(vec![size.clone()]).unwrap_err();
    assert_eq!(none.message, "nothing says how large cells are");
    let many = split(vec![size, ("cell_size", Value::Number(1e-3))]).unwrap_err();
    assert_eq!(
        many.message,
        "expected at most 4000000 cells, found about 2048000000"
    );
}
