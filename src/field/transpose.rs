//! Columns from rows of four numbers, for kernels that look up one row for each sample.

use fearless_simd::f32x4;
use fearless_simd::prelude::*;

/// The four columns of four rows.
#[inline(always)]
pub(crate) fn transposed<S: Simd>(simd: S, [a, b, c, d]: [&[f32; 4]; 4]) -> [f32x4<S>; 4] {
    let (a, b) = (
        f32x4::load_array_ref(simd, a),
        f32x4::load_array_ref(simd, b),
    );
    let (c, d) = (
        f32x4::load_array_ref(simd, c),
        f32x4::load_array_ref(simd, d),
    );
    let (low_ac, high_ac) = (a.zip_low(c), a.zip_high(c));
    let (low_bd, high_bd) = (b.zip_low(d), b.zip_high(d));
    [
        low_ac.zip_low(low_bd),
        low_ac.zip_high(low_bd),
        high_ac.zip_low(high_bd),
        high_ac.zip_high(high_bd),
    ]
}
