//! Powers and roots of positive vectors: the same bits at every vector width.

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

/// Binary logarithm of positive normal numbers, within 2e-7 of the larger of 1 and its size.
#[inline(always)]
fn log2<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
    // x = 2^e m with m between sqrt(1/2) and sqrt(2).
    let bits: S::i32s = x.bitcast();
    let exponent = (bits - 0x3f35_04f3) >> 23;
    let m: S::f32s = (bits - (exponent << 23)).bitcast();
    // ln m = 2 artanh((m - 1) / (m + 1)), whose series is cut where terms are below 1e-8.
    let s = (m - 1.0) / (m + 1.0);
    let artanh = s * polynomial(simd, s * s, &ARTANH_SERIES);
    exponent.to_float::<S::f32s>() + artanh * (2.0 * std::f32::consts::LOG2_E)
}

/// 2^x; beyond +-126 the value there.
#[inline(always)]
fn exp2<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
    // Adding it rounds to a whole number, since it leaves no room for a fraction.
    const ROUND: f32 = 12_582_912.0;
    let x = x.max(-126.0).min(126.0);
    let whole = (x + ROUND) - ROUND;
    let scale: S::f32s = ((whole.to_int::<S::i32s>() + 127) << 23).bitcast();
    polynomial(simd, x - whole, &EXP2_SERIES) * scale
}

/// The polynomial with these coefficients, the highest first.
#[inline(always)]
fn polynomial<S: Simd>(simd: S, x: S::f32s, coefficients: &[f32]) -> S::f32s {
    let mut sum = S::f32s::splat(simd, 0.0);
    for coefficient in coefficients {
        sum = sum * x + *coefficient;
    }
    sum
}

/// The series of artanh(s) / s in s^2.
const ARTANH_SERIES: [f32; 5] = [1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0];

/// ln(2)^n / n! from n = 7 down to 0.
const EXP2_SERIES: [f32; 8] = {
    let mut series = [0.0; 8];
    let (mut term, mut n) = (1.0, 0);
    while n < 8 {
        series[7 - n] = term as f32;
        n += 1;
        term *= std::f64::consts::LN_2 / n as f64;
    }
    series
};

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
