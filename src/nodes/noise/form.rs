//! The forms of noise: what becomes of an octave, and what is expected of it over a part of a pixel.
//!
//! Folding is not linear, so a fading octave must not fade to the fold of 0 but to the mean of folds. Given
//! the noise n in the centre and the weight w of its regression, the expected size of the noise around it is
//! close to sqrt(w² n² + b²), where b² = m² (1 - w²) (1 - 0.445 w²) keeps the mean over all n at the mean
//! size m for every w, within 0.002. So the brightness of a picture does not depend on its pixels.

use super::filter::{DIVISIONS, Steps, weight};
use fearless_simd::prelude::*;

/// Mean size of gradient noise, and its variance, measured over 200 000 points.
pub(super) const MEAN_SIZE: f32 = 0.22;
pub(super) const VARIANCE: f32 = 0.0727;

/// The shape that is given to every octave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Form {
    /// The noise n itself: fractional Brownian motion.
    Soft,
    /// (1 - |n|)², each octave as strong as twice the one before, at most 1, lets it (Musgrave 1998).
    Ridged,
    /// |n|: turbulence (Perlin 1985).
    Billow,
}

impl Form {
    /// The form that a recipe calls `name`.
    pub(super) fn named(name: &str) -> Form {
        match name {
            "ridged" => Form::Ridged,
            "billow" => Form::Billow,
            _ => Form::Soft,
        }
    }

    /// What an octave becomes where it is averaged away.
    pub(super) fn mean(self) -> f32 {
        match self {
            Form::Soft => 0.0,
            Form::Ridged => 1.0 - 2.0 * MEAN_SIZE + VARIANCE,
            Form::Billow => MEAN_SIZE,
        }
    }

    /// When pixels are divided for an octave with a share of the sum: if the error that it would leave is
    /// more than 0.5 % of the range, so that what is left of it does not show.
    pub(super) fn steps(self, strength: f64) -> Steps {
        // The error of one point per pixel, and the range.
        let (error, range) = match self {
            Form::Soft => (0.087, 2.0),
            Form::Ridged => (0.09, 1.0),
            Form::Billow => (0.053, 1.0),
        };
        match self {
            _ if strength * error <= 0.005 * range => Steps::NONE,
            Form::Soft => Steps([0.4f32.powi(2), 1.4f32.powi(2)]),
            // What is folded has features half as large.
            Form::Ridged | Form::Billow => Steps([0.25f32.powi(2), 0.7f32.powi(2)]),
        }
    }

    /// What is expected over a part of a pixel with `noise` in its centre, and a weight from 0 to 1.
    #[inline(always)]
    pub(super) fn expected<S: Simd>(self, noise: S::f32s, weight: S::f32s) -> S::f32s {
        if self == Form::Soft {
            return noise * weight;
        }
        let kept = weight * weight;
        let lost = kept * -1.0 + 1.0;
        let mean_square = MEAN_SIZE * MEAN_SIZE;
        let size =
            (noise * noise * kept + lost * (kept * (-0.445 * mean_square) + mean_square)).sqrt();
        if self == Form::Billow {
            return size;
        }
        // The variance of |n| within the part is what is lost of n² less what the size makes good.
        let variance = lost * (kept * (0.445 * mean_square) + (VARIANCE - mean_square));
        let ridge = size * -1.0 + 1.0;
        ridge * ridge + variance
    }
}

/// How strong the next octave of ridges is, min(1, 2 r s), given the expected ridge r of this one, its
/// strength s, and the squares of the pixel's sides.
///
/// Octaves do not know each other, so means of products are products of means; only the limit of 1 is not
/// linear. It is a fold, min(1, x) = (1 + x - |1 - x|) / 2, and is treated as one: as the octave fades, b²
/// grows until the mean over all noise is right within 0.004, whatever s is.
#[inline(always)]
pub(super) fn next_strength<S: Simd>(
    simd: S,
    ridge: S::f32s,
    strength: S::f32s,
    squares: [S::f32s; 2],
) -> S::f32s {
    let known = weight::<S>(simd, squares, [DIVISIONS[0]; 2]);
    let unlimited = ridge * strength * 2.0;
    // No ridge reaches the limit while s is less than a half.
    let above = (strength * 2.0 - 1.0).max_precise(0.0);
    let spread = above * (above * (above * -1.0 + 1.0) + 1.0) * 0.128;
    let short = unlimited * -1.0 + 1.0;
    let fold = (short * short + spread * (known * known * -1.0 + 1.0)).sqrt();
    (unlimited + 1.0 - fold) * 0.5
}
