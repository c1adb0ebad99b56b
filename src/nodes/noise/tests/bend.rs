//! Laws of `distort`.

use super::pixels::{Plane, errors, painted};
use super::*;
use crate::nodes::noise::distort;
use crate::value::{Domain, Material};
use std::collections::BTreeMap;

/// The heights of a solid with a `height`, bent.
fn bent(height: Field, by: Field, amount: DVec3) -> Field {
    let solid = Material {
        domain: Domain::Solid,
        channels: BTreeMap::from([("height".into(), height)]),
        size: None,
        surface: None,
    };
    let values = [
        Value::Material(Arc::new(solid)),
        Value::Field(by),
        Value::Vector(amount),
    ]
    .map(Some);
    let built = build(&distort::KIND, &values, 0).expect("the inputs are right");
    match &built[..] {
        [Value::Material(bent)] => bent.channels["height"].clone(),
        _ => panic!("distort gives a material"),
    }
}

#[test]
fn pixels_grow_with_the_distortion() {
    // Points moved away by as much as they have from 0 show noise of half the size.
    let of = |size| {
        Noise {
            size: [size; 3],
            octaves: 4,
            ..PLAIN
        }
        .value()
    };
    let moved = bent(of(3.0), Field::position(Domain::Solid), DVec3::ONE);
    for side in [0.2, 1.0, 4.0] {
        let plane = Plane::oblique([side; 2]);
        assert_eq!(
            bits(&painted(&moved, &plane, 24)),
            bits(&painted(&of(1.5), &plane, 24))
        );
    }
}

#[test]
fn coarse_pixels_of_what_is_bent_are_means_of_fine_ones() {
    let height = Noise {
        size: [2.0; 3],
        ..PLAIN
    }
    .value();
    let [_, waves] = Noise {
        size: [12.0; 3],
        octaves: 2,
        seed: 4,
        ..PLAIN
    }
    .fields();
    let field = bent(height, waves, DVec3::splat(4.0));
    for side in [0.2, 0.5, 1.0, 2.0, 4.0] {
        let [mean, root] = errors(&field, [side; 2]);
        println!("{side} {mean:.4} {root:.4}");
        assert!(mean.abs() < 0.003 && root < 0.05, "{side}: {mean} {root}");
    }
}

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
        surface: None,
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
