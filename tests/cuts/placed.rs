//! Cuts that are moved, turned and scaled as a whole.

use super::*;
use yosegi::nodes::cut::{rotary_cut, slice_cut};

fn placement(parts: &[(&'static str, [f64; 3])]) -> Value {
    let part = |(name, vector): &(&'static str, [f64; 3])| {
        (*name, Value::Vector(DVec3::from_array(*vector)))
    };
    Value::Record(parts.iter().map(part).collect())
}

fn slice(parts: &[(&'static str, [f64; 3])]) -> Arc<Material> {
    let given = [
        ("cut", Value::Choice("plane")),
        ("origin", Value::Vector(DVec3::new(10.0, 20.0, 30.0))),
        ("across", Value::Vector(DVec3::X)),
        ("along", Value::Vector(DVec3::Z)),
        ("turn", Value::Number(0.0)),
        ("offset", Value::Number(0.0)),
        ("size", Value::Pair([4.0, 8.0])),
        ("placed", placement(parts)),
    ];
    cut(&slice_cut::KIND, &given).unwrap()
}

fn near(piece: &Material, at: [f64; 2], expected: [f64; 3]) {
    let found = places(piece, &[[at[0], at[1], 0.0]])[0];
    assert!(
        found.distance(expected.into()) < 1e-5,
        "{found}, not {expected:?}"
    );
}

#[test]
fn a_slice_moves_turns_and_grows_about_its_pivot() {
    near(&slice(&[]), [0.0, 0.0], [8.0, 20.0, 26.0]);
    near(
        &slice(&[("move", [1.0, 2.0, 3.0])]),
        [0.0, 0.0],
        [9.0, 22.0, 29.0],
    );
    let turned = slice(&[("turn", [0.0, 0.0, 90.0]), ("pivot", [10.0, 20.0, 30.0])]);
    near(&turned, [0.0, 0.0], [10.0, 18.0, 26.0]);
    near(&turned, [4.0, 8.0], [10.0, 22.0, 34.0]);
    let grown = slice(&[("scale", [2.0, 1.0, 3.0]), ("pivot", [10.0, 20.0, 30.0])]);
    assert_eq!(grown.size, Some([8.0, 24.0]));
    near(&grown, [0.0, 0.0], [6.0, 20.0, 18.0]);
    near(&grown, [8.0, 24.0], [14.0, 20.0, 42.0]);
}

#[test]
fn a_strip_of_a_log_twice_as_large_is_twice_as_long() {
    let strip = |parts: &[(&'static str, [f64; 3])]| {
        let given = [
            ("origin", Value::Vector(DVec3::new(0.0, 0.0, 5.0))),
            ("offset", Value::Pair([0.0; 2])),
            ("radius", Value::Number(20.0)),
            ("core", Value::Number(0.0)),
            ("pitch", Value::Number(0.6)),
            ("height", Value::Number(10.0)),
            ("start", Value::Number(0.0)),
            ("direction", Value::Choice("against_the_clock")),
            ("from", Value::Number(0.0)),
            ("placed", placement(parts)),
        ];
        cut(&rotary_cut::KIND, &given).unwrap()
    };
    let (plain, grown) = (strip(&[]), strip(&[("scale", [2.0; 3])]));
    assert_eq!(
        grown.size.unwrap(),
        plain.size.unwrap().map(|length| 2.0 * length)
    );
    let small = places(&plain, &[[100.0, 3.0, 0.0]])[0];
    near(&grown, [200.0, 6.0], (2.0 * small).to_array());
    let lying = strip(&[("turn", [90.0, 0.0, 0.0]), ("move", [7.0, 0.0, 0.0])]);
    near(&lying, [100.0, 3.0], [small.x + 7.0, -small.z, small.y]);
}
