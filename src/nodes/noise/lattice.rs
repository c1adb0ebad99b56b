//! Gradient noise on a lattice of unit cells: the same bits at every vector width.
//!
//! Perlin 2002: every lattice point has one of twelve gradients, and the planes they span are blended
//! with the fade 6 t^5 - 15 t^4 + 10 t^3, whose slope and bend are continuous from cell to cell. The
//! gradients come from a hash of the cell's whole coordinates, so there is neither a table nor a period.

use fearless_simd::prelude::*;

/// Cells in each direction; beyond, the noise is that of the border.
const BORDER: f32 = 1_073_741_824.0;

/// Odd multipliers with well mixed bits: one for each axis and one to finish.
const MULTIPLIERS: [u32; 4] = [0x9e37_79b1, 0x85eb_ca6b, 0xc2b2_ae35, 0x7feb_352d];

/// Noise at points in cells: 0 at whole coordinates, within -1.04 to 1.04, with the mean 0.
#[inline(always)]
pub(super) fn gradient_noise<S: Simd>(simd: S, at: [S::f32s; 3], seed: u32) -> S::f32s {
    let (cell_x, x) = cell::<S>(at[0]);
    let (cell_y, y) = cell::<S>(at[1]);
    let (cell_z, z) = cell::<S>(at[2]);
    let seed = S::u32s::splat(simd, seed);
    let fades = [fade::<S>(y), fade::<S>(z)];
    let near = hash::<S>(seed, cell_x, MULTIPLIERS[0]);
    let far = hash::<S>(seed, cell_x + 1, MULTIPLIERS[0]);
    let near = face::<S>(near, [cell_y, cell_z], [x, y, z], fades);
    let far = face::<S>(far, [cell_y, cell_z], [x - 1.0, y, z], fades);
    blend::<S>(near, far, fade::<S>(x))
}

/// The blend of the gradients on a face of the cell with constant x.
#[inline(always)]
fn face<S: Simd>(
    of_x: S::u32s,
    [cell_y, cell_z]: [S::u32s; 2],
    [x, y, z]: [S::f32s; 3],
    [fade_y, fade_z]: [S::f32s; 2],
) -> S::f32s {
    let near = hash::<S>(of_x, cell_y, MULTIPLIERS[1]);
    let far = hash::<S>(of_x, cell_y + 1, MULTIPLIERS[1]);
    let near = edge::<S>(near, cell_z, [x, y, z], fade_z);
    let far = edge::<S>(far, cell_z, [x, y - 1.0, z], fade_z);
    blend::<S>(near, far, fade_y)
}

/// The blend of the gradients on an edge of the cell along z.
#[inline(always)]
fn edge<S: Simd>(
    of_xy: S::u32s,
    cell_z: S::u32s,
    [x, y, z]: [S::f32s; 3],
    fade_z: S::f32s,
) -> S::f32s {
    let near = hash::<S>(of_xy, cell_z, MULTIPLIERS[2]);
    let far = hash::<S>(of_xy, cell_z + 1, MULTIPLIERS[2]);
    blend::<S>(
        along_gradient::<S>(near * MULTIPLIERS[3], [x, y, z]),
        along_gradient::<S>(far * MULTIPLIERS[3], [x, y, z - 1.0]),
        fade_z,
    )
}

/// The cell's coordinate as wrapping bits, and the position within the cell from 0 to 1.
#[inline(always)]
fn cell<S: Simd>(at: S::f32s) -> (S::u32s, S::f32s) {
    let at = at.max_precise(-BORDER).min_precise(BORDER);
    let floor = at.floor();
    (floor.to_int::<S::i32s>().bitcast(), at - floor)
}

#[inline(always)]
fn hash<S: Simd>(before: S::u32s, coordinate: S::u32s, multiplier: u32) -> S::u32s {
    let product = (before ^ coordinate) * multiplier;
    product ^ (product >> 15)
}

/// The product of a position with the gradient that the upper four bits choose.
#[inline(always)]
fn along_gradient<S: Simd>(bits: S::u32s, [x, y, z]: [S::f32s; 3]) -> S::f32s {
    let choice = bits >> 28;
    let u = choice.simd_lt(8).select(x, y);
    // Perlin's twelve gradients with four of them twice, so that four bits choose.
    let v = choice
        .simd_lt(4)
        .select(y, (choice & 13).simd_eq(12).select(x, z));
    with_sign::<S>(u, bits << 3) + with_sign::<S>(v, bits << 2)
}

/// The number with its sign turned where the highest bit is set.
#[inline(always)]
fn with_sign<S: Simd>(number: S::f32s, bits: S::u32s) -> S::f32s {
    (number.bitcast::<S::u32s>() ^ (bits & 0x8000_0000)).bitcast()
}

#[inline(always)]
fn fade<S: Simd>(t: S::f32s) -> S::f32s {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline(always)]
fn blend<S: Simd>(a: S::f32s, b: S::f32s, share: S::f32s) -> S::f32s {
    a + (b - a) * share
}
