//! The numbers of an independent implementation in double precision.

use super::{columns, skeleton};
use fearless_simd::Level;
use glam::DVec3;
use serde_json::Value;
use yosegi::nodes::wood::energy::{Axis, Burl, EnergyModel, Reference, Rod};

fn vectors() -> Value {
    let text = include_str!("../data/spec-vectors.json");
    serde_json::from_str::<Value>(text).unwrap()["virtual_energy"].clone()
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|number| number.as_f64().unwrap())
        .collect()
}

fn point(value: &Value) -> DVec3 {
    DVec3::from_slice(&numbers(value))
}

fn model(vectors: &Value, reference: Reference) -> EnergyModel {
    let rod =
        |line: &Value| Rod::between(point(&line[0]), point(&line[1]), line[2].as_f64().unwrap());
    let lines: Vec<Rod> = vectors["lines_a_b_lam"]
        .as_array()
        .unwrap()
        .iter()
        .map(rod)
        .collect();
    let ends = [
        lines[0].start,
        lines[0].start + lines[0].direction * lines[0].length,
    ];
    let axis = Axis::new(&skeleton(&ends.map(|end| end.to_array())), true).unwrap();
    let burl = |burl: &Value| Burl {
        centre: point(&burl[0]),
        charge: burl[1].as_f64().unwrap(),
    };
    EnergyModel {
        branches: lines[1..].to_vec(),
        burls: vectors["points_c_q"]
            .as_array()
            .unwrap()
            .iter()
            .map(burl)
            .collect(),
        ..EnergyModel::bare(axis, reference)
    }
}

#[test]
fn energies_and_radii_are_the_known_ones() {
    let vectors = vectors();
    let points: Vec<DVec3> = vectors["p"].as_array().unwrap().iter().map(point).collect();
    let cases = [
        (Reference::Endless, "E_infinite", "r_eq_V1"),
        (Reference::Middle, "E_finite", "r_eq_V2"),
        (Reference::Local, "E_finite", "r_eq_V3"),
    ];
    for (reference, energy, radius) in cases {
        let model = model(&vectors, reference);
        let found = columns(&model, &points, Level::new());
        let (energies, radii) = (numbers(&vectors[energy]), numbers(&vectors[radius]));
        let largest = |numbers: &[f64]| numbers.iter().copied().fold(0.0, f64::max);
        for (index, point) in points.iter().enumerate() {
            let terms = model.terms(*point);
            let (energy, radius) = (energies[index], radii[index]);
            assert!(
                (terms.energy() - energy).abs() < 1e-12,
                "{reference:?} at {point}"
            );
            assert!(
                (terms.radius - radius).abs() < 1e-12,
                "{reference:?} at {point}"
            );
            let [of_radius, of_energy] = [0, 1].map(|column| f64::from(found[column][index]));
            assert!(
                (of_radius - radius).abs() < 1e-5 * largest(&radii),
                "{reference:?} at {point}"
            );
            assert!(
                (of_energy - energy).abs() < 1e-5 * largest(&energies),
                "{reference:?} at {point}"
            );
        }
    }
}
