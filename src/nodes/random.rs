//! Random numbers that depend on nothing but seeds: splitmix64 (Steele, Lea & Flood 2014).

use crate::key::KeyHasher;

/// A stream of random numbers.
pub(in crate::nodes) struct Random(u64);

impl Random {
    /// The stream of one node: of the recipe's seed, the kind, and the node's own seed.
    pub(in crate::nodes) fn new(recipe_seed: u64, kind: &str, node_seed: i64) -> Random {
        let key = KeyHasher::new("random", 1)
            .bytes(&recipe_seed.to_le_bytes())
            .text(kind)
            .whole(node_seed)
            .finish();
        Random(key.short())
    }

    /// 32 random bits.
    pub(in crate::nodes) fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 32) as u32
    }

    /// A number from 0 to less than 1, in steps of 2^-24.
    pub(in crate::nodes) fn share(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / 16_777_216.0
    }

    /// Another stream, for one of the items that the node draws for.
    pub(in crate::nodes) fn of_item(&self, item: u32) -> Random {
        let mut own = Random(self.0 ^ u64::from(item).wrapping_mul(0xd6e8_feb8_6659_fd93));
        own.bits();
        own
    }

    /// A number of the normal distribution with mean 0 and deviation 1 (Box & Muller 1958).
    pub(in crate::nodes) fn normal(&mut self) -> f64 {
        let (share, turn) = (1.0 - f64::from(self.share()), f64::from(self.share()));
        libm::sqrt(-2.0 * libm::log(share)) * libm::cos(std::f64::consts::TAU * turn)
    }

    /// A number from `low` to `high`.
    pub(in crate::nodes) fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * f64::from(self.share())
    }
}
