//! The kernel against the model in double precision, and what its results do not depend on.

use super::levels::levels;
use super::{columns, scattered, skeleton, tree};
use fearless_simd::Level;
use glam::DVec3;
use yosegi::nodes::wood::energy::{Axis, EnergyModel, Reference};

const REFERENCES: [Reference; 3] = [Reference::Endless, Reference::Middle, Reference::Local];

fn points() -> Vec<DVec3> {
    scattered(
        3000,
        DVec3::new(-400.0, -400.0, -100.0),
        DVec3::new(400.0, 400.0, 2500.0),
    )
}

#[test]
fn columns_are_within_a_hundred_thousandth_of_the_largest() {
    for reference in REFERENCES {
        for is_straight in [false, true] {
            let (model, points) = (tree(reference, is_straight), points());
            let found = columns(&model, &points, Level::new());
            let expected: Vec<[f64; 7]> = points
                .iter()
                .map(|point| {
                    let terms = model.terms(*point);
                    let offset = model.axis.offset(*point).truncate();
                    let place = offset.normalize_or_zero() * (terms.radius - terms.wave).max(0.0);
                    let share = |energy: f64| 1.0 - libm::exp(-0.5 * energy);
                    [
                        terms.radius,
                        terms.energy(),
                        share(terms.branches),
                        share(terms.burls),
                        terms.wave,
                        place.x,
                        place.y,
                    ]
                })
                .collect();
            for column in 0..7 {
                let largest = expected
                    .iter()
                    .map(|row| row[column].abs())
                    .fold(0.0, f64::max);
                for (index, row) in expected.iter().enumerate() {
                    let off = (f64::from(found[column][index]) - row[column]).abs();
                    // Waves hang on the height's last digit: 2e-4 mm of 11 mm.
                    let allowed = if column == 4 { 1e-4 } else { 2e-5 };
                    assert!(
                        off <= allowed * largest,
                        "{reference:?}, straight: {is_straight}, column {column} at {}: {off} of {largest}",
                        points[index]
                    );
                }
            }
        }
    }
}

#[test]
fn every_level_gives_the_same_bits() {
    for reference in REFERENCES {
        let (model, points) = (tree(reference, reference == Reference::Middle), points());
        let bits = |level| -> Vec<u32> {
            columns(&model, &points, level)
                .concat()
                .iter()
                .map(|value| value.to_bits())
                .collect()
        };
        let baseline = bits(Level::baseline());
        assert!(levels().into_iter().all(|level| bits(level) == baseline));
    }
}

#[test]
fn on_charges_and_far_away_numbers_stay_finite() {
    for reference in REFERENCES {
        let model = tree(reference, false);
        let mut points = vec![
            model.axis.at(1000.0),
            DVec3::splat(1e6),
            DVec3::new(0.0, 0.0, -1e6),
        ];
        points.extend(model.burls.iter().map(|burl| burl.centre));
        points.extend(
            model
                .branches
                .iter()
                .map(|rod| rod.start + rod.direction * 100.0),
        );
        points.extend(model.trunk.iter().map(|rod| rod.start));
        for column in columns(&model, &points, Level::new()) {
            assert!(
                column.iter().all(|value| value.is_finite()),
                "{reference:?}: {column:?}"
            );
        }
    }
}

#[test]
fn on_the_axis_beyond_the_ends_of_a_trunk_numbers_stay_finite() {
    let axis = Axis::new(&skeleton(&[[0.0; 3], [0.0, 0.0, 9000.0]]), false).unwrap();
    let points = [-1e5, 0.0, 50.0, 9000.0, 20_000.0, 1e9].map(|height| DVec3::Z * height);
    for reference in REFERENCES {
        let model = EnergyModel::bare(axis.clone(), reference);
        for column in columns(&model, &points, Level::new()) {
            assert!(
                column.iter().all(|value| value.is_finite()),
                "{reference:?}: {column:?}"
            );
        }
    }
}
