//! Transcendental functions of vectors: the same bits at every vector width.

use fearless_simd::prelude::*;

/// Binary logarithm of positive normal numbers, within 2e-7 of the larger of 1 and its size.
#[inline(always)]
pub(crate) fn log2<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
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
pub(crate) fn exp2<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
    let x = x.max(-126.0).min(126.0);
    let whole = nearest_whole::<S>(x);
    let scale: S::f32s = ((whole.to_int::<S::i32s>() + 127) << 23).bitcast();
    polynomial(simd, x - whole, &EXP2_SERIES) * scale
}

/// The sine of `turns` whole turns, within 2e-7 for a few turns.
#[inline(always)]
pub(crate) fn sine_of_turns<S: Simd>(simd: S, turns: S::f32s) -> S::f32s {
    // Counted from the nearest whole turn, then from the nearer zero of the sine.
    let x = turns - nearest_whole::<S>(turns);
    let folded = S::f32s::splat(simd, 0.5).copysign(x) - x;
    let x = x.abs().simd_gt(0.25).select(folded, x);
    x * polynomial(simd, x * x, &SINE_SERIES)
}

/// The cosine of `turns` whole turns, within 2e-7 for a few turns.
#[inline(always)]
pub(crate) fn cosine_of_turns<S: Simd>(simd: S, turns: S::f32s) -> S::f32s {
    sine_of_turns(simd, turns - nearest_whole::<S>(turns) + 0.25)
}

/// The whole number next to x, for x up to some million.
#[inline(always)]
fn nearest_whole<S: Simd>(x: S::f32s) -> S::f32s {
    // Adding it rounds to a whole number, since it leaves no room for a fraction.
    const ROUND: f32 = 12_582_912.0;
    (x + ROUND) - ROUND
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

/// (-1)^n (2 pi)^(2n + 1) / (2n + 1)! from n = 6 down to 0.
const SINE_SERIES: [f32; 7] = {
    let turn = 2.0 * std::f64::consts::PI;
    let mut series = [0.0; 7];
    let (mut term, mut n) = (turn, 0);
    while n < 7 {
        series[6 - n] = term as f32;
        n += 1;
        term *= -turn * turn / ((2 * n) as f64 * (2 * n + 1) as f64);
    }
    series
};

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};
    use fearless_simd_macros::simd;

    #[simd]
    fn both<S: Simd>(simd: S, turns: f32) -> [f32; 2] {
        let turns = S::f32s::splat(simd, turns);
        [
            sine_of_turns(simd, turns)[0],
            cosine_of_turns(simd, turns)[0],
        ]
    }

    #[test]
    fn sine_and_cosine_agree_with_double_precision() {
        for step in -4000..4000i16 {
            let turns = f32::from(step) * 7.3e-4;
            let found = dispatch!(Level::new(), simd => both(simd, turns));
            let angle = 2.0 * std::f64::consts::PI * f64::from(turns);
            let expected = [libm::sin(angle), libm::cos(angle)];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((f64::from(found) - expected).abs() < 3e-7, "{turns}");
            }
        }
    }
}
