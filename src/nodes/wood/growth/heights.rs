//! Finds the piece of the trunk's curve that holds a height, in the same short time for any number of
//! nodes and any spacing.

use fearless_simd::prelude::*;
use std::ops::RangeInclusive;

/// Most buckets in a table.
const MOST_BUCKETS: usize = 1 << 16;

/// The heights of the nodes, sorted into buckets.
///
/// Piece i of the curve holds the heights from `bounds[i]` up to, not including, `bounds[i + 1]`.
#[derive(Debug)]
pub(in crate::nodes::wood) struct Heights {
    bounds: Vec<f32>,
    buckets: Vec<Bucket>,
    lowest: f32,
    buckets_per_millimetre: f32,
    /// Steps of the search inside a bucket.
    rounds: u32,
}

/// A range of heights. All buckets are equally high, and most hold one node at most.
#[derive(Clone, Copy, Debug)]
struct Bucket {
    /// The piece at its lower end.
    first: u32,
    /// Height of the next node, in this bucket or above.
    next: f32,
}

impl Heights {
    /// Sorts the heights of at least two nodes, none below the one before it.
    pub(in crate::nodes::wood) fn new(nodes: &[f32]) -> Heights {
        let count = (2 * nodes.len()).min(MOST_BUCKETS);
        let scale = (count - 1) as f32 / (nodes[nodes.len() - 1] - nodes[0]);
        let mut heights = Heights {
            bounds: vec![],
            buckets: vec![
                Bucket {
                    first: 0,
                    next: f32::INFINITY
                };
                count
            ],
            lowest: nodes[0],
            buckets_per_millimetre: if scale.is_finite() { scale } else { 0.0 },
            rounds: 0,
        };
        let fullest = heights.fill_buckets(nodes);
        heights.rounds = fullest.checked_ilog2().map_or(0, |log| log + 1);
        // The search may look this far beyond the last node.
        let beyond = std::iter::repeat_n(f32::INFINITY, 1 << heights.rounds);
        let nodes = nodes.iter().copied();
        heights.bounds = std::iter::once(f32::NEG_INFINITY)
            .chain(nodes)
            .chain(beyond)
            .collect();
        heights
    }

    /// Fills the buckets; gives the largest number of nodes in one.
    fn fill_buckets(&mut self, nodes: &[f32]) -> usize {
        let (mut first, mut fullest) = (0, 0);
        for bucket in 0..self.buckets.len() {
            let inside = |node: &&f32| self.bucket(**node) == bucket;
            let count = nodes[first..].iter().take_while(inside).count();
            let next = nodes.get(first).copied().unwrap_or(f32::INFINITY);
            self.buckets[bucket] = Bucket {
                first: first as u32,
                next,
            };
            fullest = fullest.max(count);
            first += count;
        }
        fullest
    }

    /// Never falls with z, whatever the rounding: that makes the search exact.
    fn bucket(&self, z: f32) -> usize {
        (((z - self.lowest) * self.buckets_per_millimetre) as usize).min(self.buckets.len() - 1)
    }

    /// The piece that holds height `z`.
    pub(in crate::nodes::wood) fn piece(&self, z: f32) -> usize {
        self.piece_in_bucket(z, self.bucket(z))
    }

    #[inline(always)]
    fn piece_in_bucket(&self, z: f32, bucket: usize) -> usize {
        let Bucket { first, next } = self.buckets[bucket];
        let mut piece = first as usize;
        if self.rounds <= 1 {
            return piece + usize::from(next <= z);
        }
        for round in (0..self.rounds).rev() {
            let step = 1 << round;
            piece += if self.bounds[piece + step] <= z {
                step
            } else {
                0
            };
        }
        piece
    }

    /// Height at which a piece begins.
    #[inline(always)]
    pub(super) fn start(&self, piece: usize) -> f32 {
        self.bounds[piece]
    }

    /// Whether all heights are in these pieces.
    #[inline(always)]
    pub(super) fn hold<S: Simd>(
        &self,
        simd: S,
        pieces: &RangeInclusive<usize>,
        height: S::f32s,
    ) -> bool {
        let _ = simd;
        let above = height.simd_ge(self.bounds[*pieces.start()]);
        let below = height.simd_lt(self.bounds[*pieces.end() + 1]);
        (above & below).all_true()
    }

    /// For every lane the bucket of its height, as [`Heights::piece_of_lane`] wants it.
    #[inline(always)]
    pub(super) fn buckets<S: Simd>(&self, simd: S, height: S::f32s) -> S::i32s {
        let _ = simd;
        let bucket = (height - self.lowest) * self.buckets_per_millimetre;
        bucket
            .max(0.0)
            .min((self.buckets.len() - 1) as f32)
            .to_int()
    }

    /// The piece that holds height `z`, whose bucket is known.
    #[inline(always)]
    pub(super) fn piece_of_lane(&self, z: f32, bucket: i32) -> usize {
        self.piece_in_bucket(z, (bucket as usize).min(self.buckets.len() - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_height_is_found_in_its_piece_whatever_the_spacing() {
        let even: Vec<f32> = (0..1000u16).map(f32::from).collect();
        let crowded: Vec<f32> = (0..500u16)
            .map(|i| 1e-4 * f32::from(i))
            .chain([1e3, 4e3])
            .collect();
        let growing: Vec<f32> = (0..60u8).map(|i| libm::exp2f(0.3 * f32::from(i))).collect();
        for nodes in [
            even,
            crowded,
            growing,
            vec![-5.0, 5.0],
            vec![0.0, 1e-44],
            vec![3.0, 3.0],
        ] {
            let heights = Heights::new(&nodes);
            for node in nodes.iter().copied() {
                for z in [
                    node.next_down(),
                    node,
                    node.next_up(),
                    node + 0.3,
                    node - 0.3,
                ] {
                    let expected = nodes.iter().filter(|node| **node <= z).count();
                    assert_eq!(heights.piece(z), expected, "z = {z}");
                }
            }
            assert_eq!(heights.piece(-1e30), 0);
            assert_eq!(heights.piece(1e30), nodes.len());
        }
    }

    #[test]
    fn even_spacing_needs_one_step_in_a_bucket() {
        let nodes: Vec<f32> = (0..10_000u16).map(|i| 0.4 * f32::from(i)).collect();
        assert_eq!(Heights::new(&nodes).rounds, 1);
    }
}
