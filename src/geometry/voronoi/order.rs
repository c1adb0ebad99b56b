//! The order in which seeds are inserted: random rounds, each along a Hilbert curve.
//!
//! Biased randomised insertion (Amenta, Choi & Rote 2003): each round has about eight times the seeds of those before it,
//! so no arrangement of seeds makes the triangulation slow, and the next seed is near the last. Who is in which round
//! follows from the place of a seed alone.

use super::Site;
use rayon::prelude::*;

/// Bits of each coordinate along the curve.
const BITS: u32 = 28;
/// Rounds, at most.
const ROUNDS: u32 = 16;

/// Sorts sites for insertion; of those at one place the one with the lowest seed comes first.
pub(super) fn sort(sites: &[Site]) -> Vec<Site> {
    let mut keyed: Vec<(u64, u32)> = sites
        .par_iter()
        .enumerate()
        .map(|(index, site)| (key(site), index as u32))
        .collect();
    keyed.par_sort_unstable_by(|(a, first), (b, second)| {
        a.cmp(b).then_with(|| {
            let [first, second] = [first, second].map(|index| &sites[*index as usize]);
            let by_x = first.at.x.total_cmp(&second.at.x);
            let by_place = by_x.then_with(|| first.at.y.total_cmp(&second.at.y));
            by_place.then_with(|| first.seed.cmp(&second.seed))
        })
    });
    let sorted = keyed.par_iter().map(|(_, index)| sites[*index as usize]);
    sorted.collect()
}

/// The round, then the place along the curve.
fn key(site: &Site) -> u64 {
    let bits = site.at.x.to_bits().rotate_left(17) ^ site.at.y.to_bits();
    let round = ROUNDS - 1 - (mixed(bits).trailing_zeros() / 3).min(ROUNDS - 1);
    (u64::from(round) << (2 * BITS)) | hilbert(site)
}

/// The finaliser of splitmix64 (Steele, Lea & Flood 2014).
fn mixed(bits: u64) -> u64 {
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// The place along a Hilbert curve over coordinates from -1 to 3.
fn hilbert(site: &Site) -> u64 {
    let whole = f64::from(1_u32 << (BITS - 2));
    let [mut x, mut y] = (site.at + 1.0).to_array().map(|it| (it * whole) as u32);
    let mut place = 0;
    for bit in (0..BITS).rev() {
        let (right, up) = ((x >> bit) & 1, (y >> bit) & 1);
        place = (place << 2) | u64::from((3 * right) ^ up);
        if up == 0 {
            // Above this bit both are of no more use.
            if right == 1 {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
    }
    place
}
