//! Powers and roots of positive vectors: the same bits at every vector width.

use crate::lanes::{exp2, log2};
use fearless_simd::prelude::*;

/// The exponent k of the blend between trunk and branches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Power {
    /// k = 2.
    Square,
    /// k = 2^n.
    Doublings(u32),
    /// Any other k.
    Any(f32),
}

impl Power {
    pub(super) fn new(exponent: f64) -> Power {
        let doublings = (0..8).find(|n| f64::from(1 << n) == exponent);
        match doublings {
            Some(1) => Power::Square,
            Some(doublings) => Power::Doublings(doublings),
            None => Power::Any(exponent as f32),
        }
    }
}

/// `x^k` for x from 0 to 1.
#[inline(always)]
pub(super) fn raise<S: Simd>(simd: S, mut x: S::f32s, power: Power) -> S::f32s {
    match power {
        Power::Square => x * x,
        Power::Doublings(doublings) => {
            for _ in 0..doublings {
                x *= x;
            }
            x
        }
        Power::Any(exponent) => {
            let raised = exp2(simd, log2(simd, x.max(f32::MIN_POSITIVE)) * exponent);
            x.simd_gt(0.0).select(raised, S::f32s::splat(simd, 0.0))
        }
    }
}

/// `x^(-1/k)` for positive x.
#[inline(always)]
pub(super) fn inverse_root<S: Simd>(simd: S, x: S::f32s, power: Power) -> S::f32s {
    let mut root = S::f32s::splat(simd, 1.0) / x;
    match power {
        Power::Square => root.sqrt(),
        Power::Doublings(doublings) => {
            for _ in 0..doublings {
                root = root.sqrt();
            }
            root
        }
        Power::Any(exponent) => exp2(simd, -log2(simd, x) * (1.0 / exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};
    use fearless_simd_macros::simd;

    #[simd]
    fn both<S: Simd>(simd: S, x: f32, power: Power) -> [f32; 2] {
        let x = S::f32s::splat(simd, x);
        [raise(simd, x, power)[0], inverse_root(simd, x, power)[0]]
    }

    #[test]
    fn powers_and_roots_agree_with_double_precision() {
        for exponent in [1.0, 1.37, 2.0, 3.3, 4.0, 8.0, 11.5, 16.0] {
            let power = Power::new(exponent);
            for x in (1..400).map(|i| 0.0025 * i as f32).chain([1e-3, 1e-4]) {
                let [raised, root] = dispatch!(Level::new(), simd => both(simd, x, power));
                let expected = libm::pow(f64::from(x), exponent);
                let tolerance = 3e-7 * exponent * (1.0 - libm::log2(f64::from(x)));
                if expected > 1e-30 {
                    assert!(
                        (f64::from(raised) / expected - 1.0).abs() < tolerance,
                        "{x}^{exponent}"
                    );
                }
                let expected = libm::pow(f64::from(x), -1.0 / exponent);
                assert!(
                    (f64::from(root) / expected - 1.0).abs() < 2e-6,
                    "{x}^(-1/{exponent})"
                );
            }
            let [zero, _] = dispatch!(Level::new(), simd => both(simd, 0.0, power));
            assert_eq!(zero, 0.0);
        }
    }
}
