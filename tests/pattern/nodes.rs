//! `colour_pattern` and `mix`: known tables and known colours.

use super::{build, columns};
use std::sync::Arc;
use yosegi::field::{Field, Samples};
use yosegi::node::Failure;
use yosegi::value::{AfterEnd, ColourPattern, Domain, Value};

fn pattern(stops: &[(f64, f64)], texels: i64) -> Result<Arc<ColourPattern>, Failure> {
    let stop = |(at, red): &(f64, f64)| {
        let colour = Value::Colour([*red, 1.0 - red, 0.5]);
        Value::Record(vec![("at", Value::Number(*at)), ("colour", colour)])
    };
    let stops = Value::List(stops.iter().map(stop).collect());
    let inputs = [
        ("stops", stops),
        ("texels", Value::Whole(texels)),
        ("smooth", Value::Toggle(true)),
    ];
    match build("colour_pattern", &inputs)?.remove(0) {
        Value::ColourPattern(pattern) => Ok(pattern),
        other => panic!("found a {}", other.type_name()),
    }
}

fn reds(stops: &[(f64, f64)], texels: i64) -> Vec<f32> {
    pattern(stops, texels)
        .unwrap()
        .colours
        .iter()
        .map(|colour| colour[0])
        .collect()
}

#[test]
fn a_ramp_has_the_colours_of_its_texel_centres() {
    let pattern = pattern(&[(0.0, 0.0), (1.0, 1.0)], 4).unwrap();
    let expected = [0.125, 0.375, 0.625, 0.875].map(|red: f32| [red, 1.0 - red, 0.5]);
    assert_eq!(pattern.colours, expected);
    assert_eq!(
        (pattern.years, pattern.after_end, pattern.smooth),
        (1.0, AfterEnd::Repeat, true)
    );
    assert_eq!(pattern.ring_starts, [0.0]);
}

#[test]
fn the_outermost_stops_go_on_to_the_ends() {
    assert_eq!(
        reds(&[(0.25, 0.5), (0.75, 1.0)], 4),
        [0.5, 0.625, 0.875, 1.0]
    );
    assert_eq!(reds(&[(0.5, 0.75)], 3), [0.75; 3]);
}

#[test]
fn stops_at_one_place_make_a_hard_edge() {
    assert_eq!(
        reds(&[(0.0, 0.25), (0.5, 0.25), (0.5, 1.0), (1.0, 1.0)], 4),
        [0.25, 0.25, 1.0, 1.0]
    );
    // Of more than two only the first and the last are seen; an edge inside a texel is averaged.
    assert_eq!(
        reds(&[(0.25, 0.0), (0.25, 0.3), (0.25, 1.0)], 2),
        [0.5, 1.0]
    );
    assert_eq!(
        reds(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)], 2),
        [1.0, 1.0]
    );
}

#[test]
fn unsorted_and_missing_stops_are_refused() {
    let failure = pattern(&[(0.0, 0.0), (0.75, 0.5), (0.5, 1.0)], 4).unwrap_err();
    assert_eq!(failure.input, Some("stops"));
    assert_eq!(
        failure.message,
        "stop 3 at 0.5 stands before the stop at 0.75"
    );
    let failure = pattern(&[], 4).unwrap_err();
    assert_eq!(failure.message, "expected at least one stop, found none");
}

#[test]
fn mixing_is_exact_at_both_ends_and_clamps() {
    let (a, b) = ([0.1, 0.5, 1.0], [0.7, 0.5, 0.0]);
    let amount = Value::Field(Field::position(Domain::Solid).part(0, 1));
    let inputs = [
        ("a", Value::Colour(a)),
        ("b", Value::Colour(b)),
        ("amount", amount),
        ("mode", Value::Choice("normal")),
        ("pixels", Value::Choice("divided")),
    ];
    let Value::Field(mixed) = build("mix", &inputs).unwrap().remove(0) else {
        panic!("no field")
    };
    let amounts = [0.0, 1.0, 0.25, -3.0, 9.0].map(|amount| [amount, 0.0, 0.0]);
    let found = columns(&[mixed], &Samples::Points(&amounts));
    let expected = [
        [0.1, 0.7, 0.25, 0.1, 0.7],
        [0.5; 5],
        [1.0, 0.0, 0.75, 1.0, 0.0],
    ];
    for (found, expected) in found.iter().zip(expected) {
        for (found, expected) in found.iter().zip(expected.map(|part| part as f32)) {
            assert!(
                (found - expected).abs() < 1e-7,
                "{found} instead of {expected}"
            );
        }
    }
}
