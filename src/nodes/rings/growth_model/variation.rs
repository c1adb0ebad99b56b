//! What makes one tree differ from the mean of its stand: a random factor for each year.
//!
//! The factor's logarithm is a first-order autoregressive series of normal numbers: with e normal, amplitude s and
//! persistence p, `x = p x' + sqrt(1 - p^2) e` and the factor is `exp(s x)` (own construction). A weather station
//! says nothing of crowns, neighbours, seed years and soil, so rings of the weather alone are too even. How uneven
//! single trees are is known, as mean sensitivity and autocorrelation: amplitude and persistence are those with which
//! the rings of this weather and this draw have the measured ones, by bisection. So a tree on a dry site, where the
//! weather does more, is left less to chance. Trees of a site differ in these as well, see [`Band::of_one_tree`].

use super::statistics::{autocorrelation, detrended, mean_sensitivity};
use crate::nodes::random::Random;
use libm::{cos, exp, log, sqrt};
use std::f64::consts::TAU;

/// How even the rings of single trees of a species are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Mean sensitivity of the widths.
    pub sensitivity: f64,
    /// Correlation of widths that follow each other, after division by the mean of the 33 around each.
    pub autocorrelation: f64,
}

impl Band {
    /// That of one tree of the species: within half of a standard deviation of those of single oaks on one site, which
    /// is 13 % of the mean sensitivity and 0.11 of the autocorrelation (24 series, ZAL).
    pub(super) fn of_one_tree(self, random: &mut Random) -> Band {
        let mut around = || f64::from(random.share()) - 0.5;
        Band {
            sensitivity: self.sensitivity * (1.0 + 0.13 * around()),
            autocorrelation: self.autocorrelation + 0.11 * around(),
        }
    }
}

/// The strength of the random factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Standard deviation of its logarithm.
    pub amplitude: f64,
    /// Correlation from one year to the next.
    pub persistence: f64,
}

/// Largest amplitude, and the range of persistence that is searched.
const MOST: f64 = 1.5;
const PERSISTENCE: [f64; 2] = [-0.6, 0.9];

/// Halvings of a range: each finds the amplitude to a millionth.
const HALVINGS: usize = 20;

/// Normal numbers, one for each year.
#[derive(Clone, Debug)]
pub(super) struct Draw(Vec<f64>);

impl Draw {
    /// One number for each of `years` years (Box & Muller 1958).
    pub(super) fn new(random: &mut Random, years: usize) -> Draw {
        let mut normal = || {
            // The share begins at 0, whose logarithm is not finite.
            let radius = sqrt(-2.0 * log(1.0 - f64::from(random.share())));
            radius * cos(TAU * f64::from(random.share()))
        };
        Draw((0..years).map(|_| normal()).collect())
    }

    /// The factor of each year.
    pub(super) fn factors(&self, variation: Variation) -> Vec<f64> {
        let Variation {
            amplitude,
            persistence,
        } = variation;
        let fresh = sqrt(1.0 - persistence * persistence);
        let mut state = self.0.first().copied().unwrap_or_default();
        let mut next = |normal: &f64| {
            state = persistence * state + fresh * normal;
            exp(amplitude * state)
        };
        self.0.iter().map(&mut next).collect()
    }

    /// The variation with which the widths that `widths` makes of the factors are as even as the band says, or as near
    /// to that as can be.
    pub(super) fn fitted(&self, band: Band, widths: impl Fn(&[f64]) -> Vec<f64>) -> Variation {
        let grown = |variation| widths(&self.factors(variation));
        let with = |persistence| {
            let amplitude = rising([0.0, MOST], band.sensitivity, |amplitude| {
                mean_sensitivity(&grown(Variation {
                    amplitude,
                    persistence,
                }))
            });
            Variation {
                amplitude,
                persistence,
            }
        };
        let persistence = rising(PERSISTENCE, band.autocorrelation, |persistence| {
            autocorrelation(&detrended(&grown(with(persistence))))
        });
        with(persistence)
    }
}

/// Where a function that rises takes a value, or the end that comes nearest.
fn rising([mut low, mut high]: [f64; 2], value: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        if function(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}
