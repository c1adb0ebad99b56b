//! Rings of single trees: as uneven as those of measured trees of their species, whatever the seed.

use super::*;
use yosegi::nodes::rings::growth_model::species::{SPECIES, Species};
use yosegi::nodes::rings::growth_model::statistics::{
    autocorrelation, detrended, mean_sensitivity,
};

/// Mean sensitivity, and autocorrelation after the 33-year mean is taken away.
fn measured(series: &RingSeries) -> [f64; 2] {
    let widths = widths(series);
    [
        mean_sensitivity(&widths),
        autocorrelation(&detrended(&widths)),
    ]
}

/// Whether a tree is within a standard deviation of single trees of the species: 13 % of the mean sensitivity, 0.11 of
/// the autocorrelation, as for the 24 oaks of the measured series.
fn is_within(species: &Species, [sensitivity, autocorrelation]: [f64; 2]) -> bool {
    let band = species.band;
    (sensitivity / band.sensitivity - 1.0).abs() < 0.13
        && (autocorrelation - band.autocorrelation).abs() < 0.11
}

#[test]
fn ten_trees_of_each_species_have_the_rings_of_their_species() {
    for (place, climate) in [("Oxford", oxford()), ("Tokyo", tokyo()), ("site 3", site())] {
        for species in &SPECIES {
            let mut all = vec![];
            for seed in 0..10 {
                let given = [
                    ("species", Value::Choice(species.name)),
                    ("seed", Value::Whole(seed)),
                ];
                all.push(measured(&grown(&climate, 7, &given).unwrap()));
            }
            let range = |part: usize| {
                let values = all.iter().map(|it| it[part]);
                [
                    values.clone().fold(f64::INFINITY, f64::min),
                    values.fold(f64::NEG_INFINITY, f64::max),
                ]
            };
            println!(
                "{place}, {}: {:.3?} {:.3?} for {:?}",
                species.name,
                range(0),
                range(1),
                species.band
            );
            assert!(
                all.iter().all(|it| is_within(species, *it)),
                "{place}, {}: {all:?}",
                species.name
            );
        }
    }
}

#[test]
fn the_same_seed_is_the_same_tree() {
    let tree = |recipe, seed| {
        let given = [
            ("species", Value::Choice("oak")),
            ("seed", Value::Whole(seed)),
        ];
        grown(&oxford(), recipe, &given).unwrap()
    };
    assert_eq!(tree(1, 2), tree(1, 2));
    assert_ne!(tree(1, 2), tree(1, 3));
    assert_ne!(tree(1, 2), tree(2, 2));
    // Without a species nothing is drawn.
    assert_eq!(
        grown(&oxford(), 1, &[]).unwrap(),
        grown(&oxford(), 2, &[]).unwrap()
    );
}

#[test]
fn a_stated_variation_is_taken_as_it_is() {
    let uneven = |variation: f64| {
        let given = [
            ("variation", Value::Number(variation)),
            ("reserve", Value::Number(0.0)),
        ];
        measured(&grown(&oxford(), 3, &given).unwrap())[0]
    };
    let alone = measured(&grown(&oxford(), 3, &[("reserve", Value::Number(0.0))]).unwrap())[0];
    assert!((uneven(0.0) - alone).abs() < 1e-12);
    let found: Vec<f64> = [0.1, 0.2, 0.4, 0.8].map(uneven).to_vec();
    assert!(
        found.is_sorted() && found[0] > alone && found[3] > 0.5,
        "{found:?}"
    );
}
