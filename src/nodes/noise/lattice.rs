//! Gradient noise on a lattice of unit cells: the same bits at every vector width.
//!
//! Perlin 2002: every lattice point has one of twelve gradients, and the planes they span are blended
//! with the fade 6 t^5 - 15 t^4 + 10 t^3, whose slope and bend are continuous from cell to cell. The
//! gradients come from a hash of the cell's whole coordinates, so there is no table, and no period unless
//! one is asked for. The hash is a sum of products for each axis, exclusively or'ed, times an odd number
//! (as in FastNoise Lite, Peck 2020), of which the upper bits are used.

use fearless_simd::prelude::*;

/// Cells in each direction; whole coordinates beyond do not fit.
pub(super) const BORDER: f32 = 1_073_741_824.0;

/// Odd multipliers with well mixed bits: one for each axis and one to finish.
const MULTIPLIERS: [u32; 4] = [0x9e37_79b1, 0x85eb_ca6b, 0xc2b2_ae35, 0x27d4_eb2d];

/// A third of the whole numbers are larger, and a third are smaller than its negative.
const THIRD: i32 = i32::MAX / 3;

/// N noises at points in cells: 0 at whole coordinates, within -1.04 to 1.04, with the mean 0.
///
/// They share a lattice and its hashes, but every one takes its gradients from other bits. Along an axis
/// with a number of cells other than 0 they repeat after so many; points lie in -2^30 to 2^30 cells.
#[inline(always)]
pub(super) fn gradient_noise<S: Simd, const N: usize>(
    simd: S,
    at: [S::f32s; 3],
    seed: S::u32s,
    repeat: [f32; 3],
) -> [S::f32s; N] {
    let (cells_x, x) = cell::<S>(simd, at[0], MULTIPLIERS[0], repeat[0]);
    let (cells_y, y) = cell::<S>(simd, at[1], MULTIPLIERS[1], repeat[1]);
    let (cells_z, z) = cell::<S>(simd, at[2], MULTIPLIERS[2], repeat[2]);
    let others = [cells_y, cells_z];
    let fades = [fade::<S>(y), fade::<S>(z)];
    let near = face::<S, N>(cells_x[0] ^ seed, others, [x, y, z], fades);
    let far = face::<S, N>(cells_x[1] ^ seed, others, [x - 1.0, y, z], fades);
    blend::<S, N>(near, far, fade::<S>(x))
}

/// The blend of the gradients on a face of the cell with constant x.
#[inline(always)]
fn face<S: Simd, const N: usize>(
    of_x: S::u32s,
    [cells_y, cells_z]: [[S::u32s; 2]; 2],
    [x, y, z]: [S::f32s; 3],
    [fade_y, fade_z]: [S::f32s; 2],
) -> [S::f32s; N] {
    let near = edge::<S, N>(of_x ^ cells_y[0], cells_z, [x, y, z], fade_z);
    let far = edge::<S, N>(of_x ^ cells_y[1], cells_z, [x, y - 1.0, z], fade_z);
    blend::<S, N>(near, far, fade_y)
}

/// The blend of the gradients on an edge of the cell along z.
#[inline(always)]
fn edge<S: Simd, const N: usize>(
    of_xy: S::u32s,
    cells_z: [S::u32s; 2],
    [x, y, z]: [S::f32s; 3],
    fade_z: S::f32s,
) -> [S::f32s; N] {
    let near = (of_xy ^ cells_z[0]) * MULTIPLIERS[3];
    let far = (of_xy ^ cells_z[1]) * MULTIPLIERS[3];
    let near = along_gradients::<S, N>(near, [x, y, z]);
    let far = along_gradients::<S, N>(far, [x, y, z - 1.0]);
    blend::<S, N>(near, far, fade_z)
}

/// What a number adds to a seed: nothing if it is 0.
#[inline(always)]
pub(super) fn variant<S: Simd>(number: S::f32s) -> S::u32s {
    // -0 is 0.
    let bits = (number + 0.0).bitcast::<S::u32s>() * MULTIPLIERS[0];
    (bits ^ (bits >> 15)) * MULTIPLIERS[3]
}

/// What the cell and the next one add to a hash, and the position within the cell from 0 to 1.
#[inline(always)]
fn cell<S: Simd>(simd: S, at: S::f32s, multiplier: u32, repeat: f32) -> ([S::u32s; 2], S::f32s) {
    let floor = at.floor();
    if repeat == 0.0 {
        let near = hash::<S>(floor, multiplier);
        return ([near, near + multiplier], at - floor);
    }
    // Exact for whole numbers of less than 24 bits.
    let near = floor - (floor / repeat).floor() * repeat;
    let far = near + 1.0;
    let far = far.simd_lt(repeat).select(far, S::f32s::splat(simd, 0.0));
    (
        [hash::<S>(near, multiplier), hash::<S>(far, multiplier)],
        at - floor,
    )
}

#[inline(always)]
fn hash<S: Simd>(cell: S::f32s, multiplier: u32) -> S::u32s {
    cell.to_int::<S::i32s>().bitcast::<S::u32s>() * multiplier
}

/// The products of a position with gradients: the first from the bits, others from bits mixed anew.
#[inline(always)]
fn along_gradients<S: Simd, const N: usize>(
    mut bits: S::u32s,
    [x, y, z]: [S::f32s; 3],
) -> [S::f32s; N] {
    let mut products = [x; N];
    for (index, product) in products.iter_mut().enumerate() {
        if index > 0 {
            bits = (bits ^ (bits >> 15)) * MULTIPLIERS[3];
        }
        // A third of the numbers each for the planes of (x, y), (x, z) and (y, z).
        let number = bits.bitcast::<S::i32s>();
        let u = number.simd_gt(THIRD).select(y, x);
        let v = number.simd_lt(-THIRD).select(y, z);
        *product = with_sign::<S>(u, bits << 8) + with_sign::<S>(v, bits << 9);
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
