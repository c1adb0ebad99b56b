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

/// N noises at points in cells: 0 at whole coordinates, within -1.04 to 1.04, with the mean 0.
///
/// They share a lattice and its hashes, but every one takes its gradients from other bits.
#[inline(always)]
pub(super) fn gradient_noise<S: Simd, const N: usize>(
    simd: S,
    at: [S::f32s; 3],
    seed: u32,
) -> [S::f32s; N] {
    let (cell_x, x) = cell::<S>(at[0]);
    let (cell_y, y) = cell::<S>(at[1]);
    let (cell_z, z) = cell::<S>(at[2]);
    let seed = S::u32s::splat(simd, seed);
    let fades = [fade::<S>(y), fade::<S>(z)];
    let near = hash::<S>(seed, cell_x, MULTIPLIERS[0]);
    let far = hash::<S>(seed, cell_x + 1, MULTIPLIERS[0]);
    let near = face::<S, N>(near, [cell_y, cell_z], [x, y, z], fades);
    let far = face::<S, N>(far, [cell_y, cell_z], [x - 1.0, y, z], fades);
    blend::<S, N>(near, far, fade::<S>(x))
}

/// The blend of the gradients on a face of the cell with constant x.
#[inline(always)]
fn face<S: Simd, const N: usize>(
    of_x: S::u32s,
    [cell_y, cell_z]: [S::u32s; 2],
    [x, y, z]: [S::f32s; 3],
    [fade_y, fade_z]: [S::f32s; 2],
) -> [S::f32s; N] {
    let near = hash::<S>(of_x, cell_y, MULTIPLIERS[1]);
    let far = hash::<S>(of_x, cell_y + 1, MULTIPLIERS[1]);
    let near = edge::<S, N>(near, cell_z, [x, y, z], fade_z);
    let far = edge::<S, N>(far, cell_z, [x, y - 1.0, z], fade_z);
    blend::<S, N>(near, far, fade_y)
}

/// The blend of the gradients on an edge of the cell along z.
#[inline(always)]
fn edge<S: Simd, const N: usize>(
    of_xy: S::u32s,
    cell_z: S::u32s,
    [x, y, z]: [S::f32s; 3],
    fade_z: S::f32s,
) -> [S::f32s; N] {
    let near = hash::<S>(of_xy, cell_z, MULTIPLIERS[2]) * MULTIPLIERS[3];
    let far = hash::<S>(of_xy, cell_z + 1, MULTIPLIERS[2]) * MULTIPLIERS[3];
    let near = along_gradients::<S, N>(near, [x, y, z]);
    let far = along_gradients::<S, N>(far, [x, y, z - 1.0]);
    blend::<S, N>(near, far, fade_z)
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

/// The products of a position with the gradients that the upper bits choose, four for each.
#[inline(always)]
fn along_gradients<S: Simd, const N: usize>(
    mut bits: S::u32s,
    [x, y, z]: [S::f32s; 3],
) -> [S::f32s; N] {
    let mut products = [x; N];
    for product in &mut products {
        let choice = bits >> 28;
        let u = choice.simd_lt(8).select(x, y);
        // Perlin's twelve gradients with four of them twice, so that four bits choose.
        let v = choice
            .simd_lt(4)
            .select(y, (choice & 13).simd_eq(12).select(x, z));
        *product = with_sign::<S>(u, bits << 3) + with_sign::<S>(v, bits << 2);
        bits <<= 4u32;
    }
    products
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
fn blend<S: Simd, const N: usize>(
    mut a: [S::f32s; N],
    b: [S::f32s; N],
    share: S::f32s,
) -> [S::f32s; N] {
    for (a, b) in a.iter_mut().zip(b) {
        *a += (b - *a) * share;
    }
    a
}
