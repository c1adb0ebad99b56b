//! Laws of `distort`.

use super::*;
use crate::nodes::noise::distort;
use crate::value::{Domain, Material};
use std::collections::BTreeMap;

#[test]
fn distortion_by_a_constant_is_a_shift() {
    let field = Noise {
        octaves: 2,
        ..PLAIN
    }
    .value();
    let constant = Field::constant(0.5);
    let solid = Material {
        domain: Domain::Solid,
        channels: BTreeMap::from([
            ("height".into(), field.clone()),
            ("roughness".into(), constant),
        ]),
        size: None,
    };
    let values = [
        Value::Material(Arc::new(solid)),
        Value::Vector(DVec3::new(1.0, -2.0, 0.5)),
        Value::Vector(DVec3::new(0.5, 0.25, 8.0)),
    ]
    .map(Some);
    let built = build(&distort::KIND, &values, 0).expect("the inputs are right");
    let [Value::Material(bent)] = &built[..] else {
        panic!("distort gives a material")
    };
    assert_eq!(bent.domain, Domain::Solid);
    assert_eq!(bent.channels["roughness"].as_constant(), Some(&[0.5][..]));
    // Sums without rounding, so that the bits agree.
    let points: Vec<_> = (0..200)
        .map(|i| [f64::from(i) * 0.125, 3.0 - f64::from(i) * 0.25, 7.75])
        .collect();
    let shifted: Vec<_> = points
        .iter()
        .map(|[x, y, z]| [x + 0.5, y - 0.5, z + 4.0])
        .collect();
    assert_eq!(
        bits(&at_points(&bent.channels["height"], &points)),
        bits(&at_points(&field, &shifted))
    );
}
