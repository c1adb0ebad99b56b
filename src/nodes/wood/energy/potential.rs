//! The energies of lines, rods and burls, for columns of positions.

use super::model::{Burl, LEAST_DISTANCE, Rod};
use crate::lanes::{exp2, log2};
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use std::f32::consts::{LN_2, LOG2_E};

/// A rod, as the kernel needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RodConstants {
    start: [f32; 3],
    direction: [f32; 3],
    length: f32,
    charge: f32,
}

impl RodConstants {
    pub(super) fn new(rod: &Rod) -> RodConstants {
        RodConstants {
            start: rod.start.as_vec3().to_array(),
            direction: rod.direction.as_vec3().to_array(),
            length: rod.length as f32,
            charge: rod.charge as f32,
        }
    }
}

/// A burl, as the kernel needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct BurlConstants {
    centre: [f32; 3],
    charge: f32,
}

impl BurlConstants {
    pub(super) fn new(burl: &Burl) -> BurlConstants {
        BurlConstants {
            centre: burl.centre.as_vec3().to_array(),
            charge: burl.charge as f32,
        }
    }
}

/// `e^(-E / 2)`.
#[inline(always)]
pub(super) fn half_exponential<S: Simd>(simd: S, energy: S::f32s) -> S::f32s {
    exp2(simd, energy * (-0.5 * LOG2_E))
}

/// `[1 / sinh(E / 2), tanh(E / 2)]`.
#[inline(always)]
pub(super) fn inverse_sinh<S: Simd>(simd: S, energy: S::f32s) -> [S::f32s; 2] {
    let t = half_exponential(simd, energy);
    let square = t * t;
    let less = (-square + 1.0).max(f32::MIN_POSITIVE);
    [t * 2.0 / less, less / (square + 1.0)]
}

/// The energy of a line without ends, `-2 ln r`.
#[simd]
pub(super) fn endless<S: Simd>(simd: S, distance: &[f32], energy: &mut [f32]) {
    let lanes = S::f32s::LEN;
    for (distance, energy) in distance
        .chunks_exact(lanes)
        .zip(energy.chunks_exact_mut(lanes))
    {
        let distance = S::f32s::from_slice(simd, distance).max(LEAST_DISTANCE as f32);
        (log2(simd, distance) * (-2.0 * LN_2)).store_slice(energy);
    }
}

/// Adds the energy of a rod.
#[simd]
pub(super) fn add_rod<S: Simd>(
    simd: S,
    rod: &RodConstants,
    [x, y, z]: [&[f32]; 3],
    sum: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let [ux, uy, uz] = rod.direction;
    let scale = rod.charge * LN_2;
    let positions = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    for (((x, y), z), sum) in positions.zip(sum.chunks_exact_mut(lanes)) {
        let x = S::f32s::from_slice(simd, x) - rod.start[0];
        let y = S::f32s::from_slice(simd, y) - rod.start[1];
        let z = S::f32s::from_slice(simd, z) - rod.start[2];
        let along = x * ux + y * uy + z * uz;
        let (fx, fy, fz) = (x - along * ux, y - along * uy, z - along * uz);
        let across = (fx * fx + fy * fy + fz * fz)
            .sqrt()
            .max(LEAST_DISTANCE as f32);
        let inverse = S::f32s::splat(simd, 1.0) / across;
        let ends = exponential_of_asinh(simd, (-along + rod.length) * inverse)
            * exponential_of_asinh(simd, along * inverse);
        (S::f32s::from_slice(simd, sum) + log2(simd, ends) * scale).store_slice(sum);
    }
}

/// `e^asinh(x) = x + sqrt(x^2 + 1)`, for negative x without cancellation.
#[inline(always)]
fn exponential_of_asinh<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
    let size = x.abs();
    let of_size = size + (size * size + 1.0).sqrt();
    let inverse = S::f32s::splat(simd, 1.0) / of_size;
    x.simd_lt(0.0).select(inverse, of_size)
}

/// Adds the energy of a burl.
#[simd]
pub(super) fn add_burl<S: Simd>(
    simd: S,
    burl: &BurlConstants,
    [x, y, z]: [&[f32]; 3],
    sum: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let least = (LEAST_DISTANCE * LEAST_DISTANCE) as f32;
    let positions = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    for (((x, y), z), sum) in positions.zip(sum.chunks_exact_mut(lanes)) {
        let x = S::f32s::from_slice(simd, x) - burl.centre[0];
        let y = S::f32s::from_slice(simd, y) - burl.centre[1];
        let z = S::f32s::from_slice(simd, z) - burl.centre[2];
        let distance = (x * x + y * y + z * z).max(least).sqrt();
        (S::f32s::from_slice(simd, sum) + S::f32s::splat(simd, burl.charge) / distance)
            .store_slice(sum);
    }
}
