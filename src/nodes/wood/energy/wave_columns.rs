//! Waves in the rings, for columns of offsets and heights.

use super::wave::Wave;
use crate::lanes::{cosine_of_turns, sine_of_turns};
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// Adds a wave, from the offset across the axis and the height.
#[simd]
pub(super) fn add_wave<S: Simd>(simd: S, wave: &Wave, [dx, dy, z]: [&[f32]; 3], sum: &mut [f32]) {
    let lanes = S::f32s::LEN;
    let (amplitude, per_millimetre) = (wave.amplitude as f32, wave.per_millimetre as f32);
    let phase = (wave.phase - wave.phase.floor()) as f32;
    let offsets = dx
        .chunks_exact(lanes)
        .zip(dy.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    for (((dx, dy), z), sum) in offsets.zip(sum.chunks_exact_mut(lanes)) {
        let (dx, dy) = (S::f32s::from_slice(simd, dx), S::f32s::from_slice(simd, dy));
        let turns = S::f32s::from_slice(simd, z) * per_millimetre + phase;
        let [cosine, sine] = turned(simd, [dx, dy], wave.turns);
        let value = sine_of_turns(simd, turns) * cosine + cosine_of_turns(simd, turns) * sine;
        (S::f32s::from_slice(simd, sum) + value * amplitude).store_slice(sum);
    }
}

/// `[cos(m phi), sin(m phi)]` of the angle of an offset: the m-th power of a number on the complex unit circle.
#[inline(always)]
fn turned<S: Simd>(simd: S, [dx, dy]: [S::f32s; 2], turns: i64) -> [S::f32s; 2] {
    let length = (dx * dx + dy * dy).sqrt();
    let is_off = length.simd_gt(f32::MIN_POSITIVE);
    let [zero, one] = [0.0, 1.0].map(|value| S::f32s::splat(simd, value));
    let mut square = [
        is_off.select(dx / length, one),
        is_off.select(dy / length, zero),
    ];
    if turns < 0 {
        square[1] = -square[1];
    }
    let mut power = [one, zero];
    let mut left = turns.unsigned_abs();
    while left > 0 {
        if left & 1 == 1 {
            power = product::<S>(power, square);
        }
        square = product::<S>(square, square);
        left >>= 1;
    }
    power
}

/// The product of two complex numbers.
#[inline(always)]
fn product<S: Simd>([a, b]: [S::f32s; 2], [c, d]: [S::f32s; 2]) -> [S::f32s; 2] {
    [a * c - b * d, a * d + b * c]
}

/// Leaves of the waves what rings near the pith can carry, as `wave::share` says.
#[simd]
pub(super) fn fade_waves<S: Simd>(simd: S, most: f32, radius: &[f32], wave: &mut [f32]) {
    let lanes = S::f32s::LEN;
    let scale = 0.5 / most.max(f32::MIN_POSITIVE);
    for (radius, wave) in radius.chunks_exact(lanes).zip(wave.chunks_exact_mut(lanes)) {
        let t = (S::f32s::from_slice(simd, radius) * scale).min(1.0);
        (S::f32s::from_slice(simd, wave) * t * (-t + 2.0)).store_slice(wave);
    }
}
