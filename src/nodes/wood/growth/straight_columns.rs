//! The straight skeleton for columns of positions: all nodes are compared, as the older model does.

use super::RUN;
use super::clock::Clock;
use super::straight::StraightTrunk;
use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// A straight trunk, laid out for columns.
#[derive(Debug)]
pub(super) struct StraightTable {
    nodes: Vec<NodeConstants>,
}

/// A node with its two segments.
#[derive(Clone, Copy, Debug)]
struct NodeConstants {
    place: [f32; 3],
    /// Unit vectors along the segment that ends here and the one that starts here; 0 where there is none.
    directions: [[f32; 3]; 2],
    /// -1 where there is no such segment, so that no point has its foot on it, otherwise 0.
    missing: [f32; 2],
    path: f32,
}

/// Growth times along a straight trunk.
#[derive(Debug)]
pub(super) struct StraightTimes {
    table: StraightTable,
    clock: Clock,
}

impl StraightTimes {
    pub(super) fn new(trunk: &StraightTrunk, clock: Clock) -> StraightTimes {
        StraightTimes {
            table: StraightTable::new(trunk),
            clock,
        }
    }

    pub(super) fn nanoseconds(&self) -> f32 {
        8.0 + 0.2 * self.table.nodes.len() as f32 + 2.0 * self.clock.nanoseconds()
    }

    /// Writes T_1 in years, eqs. (1)-(3), blended where two segments count.
    #[simd]
    pub(super) fn write_times<S: Simd>(&self, simd: S, position: [&[f32]; 3], times: &mut [f32]) {
        let mut columns = [[0.0; RUN]; 7];
        let mut seen = SeenColumns::of(&mut columns, times.len());
        self.table.see(simd, position, &mut seen);
        let lanes = S::f32s::LEN;
        for way in 0..2 {
            self.clock
                .write_times(simd, seen.along[way], seen.across[way]);
        }
        for start in (0..times.len()).step_by(lanes) {
            let range = start..start + lanes;
            let load = |column: &[f32]| S::f32s::from_slice(simd, &column[range.clone()]);
            let [first, second] = [0, 1].map(|way| load(seen.across[way]));
            let share = load(seen.share);
            (first * share + second * (-share + 1.0)).store_slice(&mut times[range.clone()]);
        }
    }
}

/// From the position to the kind of region and the index of what counts there.
#[derive(Debug)]
pub(in crate::nodes::wood) struct RegionKernel {
    trunk: StraightTrunk,
    table: StraightTable,
}

impl RegionKernel {
    pub(in crate::nodes::wood) fn new(trunk: &StraightTrunk) -> RegionKernel {
        RegionKernel {
            trunk: trunk.clone(),
            table: StraightTable::new(trunk),
        }
    }
}

impl Kernel for RegionKernel {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("straight_region").whole(1);
        for part in self.trunk.nodes().iter().flat_map(|node| node.to_array()) {
            key.number(part);
        }
    }

    fn width(&self) -> usize {
        2
    }

    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [x, y, z] = [0, 1, 2].map(|column| block.inputs[column].values);
        let [region, member] = block.outputs else {
            return;
        };
        for start in (0..x.len()).step_by(RUN) {
            let range = start..(start + RUN).min(x.len());
            let mut columns = [[0.0; RUN]; 7];
            let mut seen = SeenColumns::of(&mut columns, range.len());
            let position = [&x[range.clone()], &y[range.clone()], &z[range.clone()]];
            dispatch!(block.level, simd => self.table.see(simd, position, &mut seen));
            region[range.clone()].copy_from_slice(seen.region);
            member[range].copy_from_slice(seen.member);
        }
    }
}

/// What counts for the samples of a run, each as long as it: see `straight::Seen`.
pub(super) struct SeenColumns<'a> {
    /// Lengths of the ways along the skeleton, by the segments below and above the nearest node.
    pub(super) along: [&'a mut [f32]; 2],
    /// Squares of the distances from there.
    pub(super) across: [&'a mut [f32]; 2],
    /// Share of the first way.
    pub(super) share: &'a mut [f32],
    /// 0 in an influence area, 1 in a blend area, 2 outside a bend.
    pub(super) region: &'a mut [f32],
    /// Index of the segment in an influence area, otherwise of the node.
    pub(super) member: &'a mut [f32],
}

impl<'a> SeenColumns<'a> {
    /// The first `length` samples of columns.
    fn of(columns: &'a mut [[f32; RUN]; 7], length: usize) -> SeenColumns<'a> {
        let [a, b, c, d, share, region, member] = columns.each_mut().map(|it| &mut it[..length]);
        SeenColumns {
            along: [a, b],
            across: [c, d],
            share,
            region,
            member,
        }
    }
}

impl StraightTable {
    pub(super) fn new(trunk: &StraightTrunk) -> StraightTable {
        let node = |index: usize| {
            let directions = trunk.directions(index);
            NodeConstants {
                place: trunk.nodes()[index].as_vec3().to_array(),
                directions: directions.map(|it| it.unwrap_or_default().as_vec3().to_array()),
                missing: directions.map(|it| if it.is_some() { 0.0 } else { -1.0 }),
                path: trunk.paths()[index] as f32,
            }
        };
        StraightTable {
            nodes: (0..trunk.nodes().len()).map(node).collect(),
        }
    }

    /// Writes what counts for each sample.
    #[simd]
    pub(super) fn see<S: Simd>(&self, simd: S, position: [&[f32]; 3], seen: &mut SeenColumns<'_>) {
        self.find_nearest(simd, position, seen.member);
        let lanes = S::f32s::LEN;
        for start in (0..seen.member.len()).step_by(lanes) {
            let place = position.map(|part| S::f32s::from_slice(simd, &part[start..start + lanes]));
            self.see_lanes(simd, place, start, seen);
        }
    }

    /// Writes the index of the node nearest to each sample, the lowest of equals.
    #[simd]
    fn find_nearest<S: Simd>(&self, simd: S, [x, y, z]: [&[f32]; 3], nearest: &mut [f32]) {
        let lanes = S::f32s::LEN;
        let positions = x
            .chunks_exact(lanes)
            .zip(y.chunks_exact(lanes))
            .zip(z.chunks_exact(lanes));
        for (((x, y), z), nearest) in positions.zip(nearest.chunks_exact_mut(lanes)) {
            let [x, y, z] = [x, y, z].map(|part| S::f32s::from_slice(simd, part));
            let mut least = S::f32s::splat(simd, f32::INFINITY);
            let mut found = S::f32s::splat(simd, 0.0);
            for (index, node) in self.nodes.iter().enumerate() {
                let [nx, ny, nz] = node.place;
                let (dx, dy, dz) = (x - nx, y - ny, z - nz);
                let square = dx * dx + dy * dy + dz * dz;
                found = square
                    .simd_lt(least)
                    .select(S::f32s::splat(simd, index as f32), found);
                least = square.min(least);
            }
            found.store_slice(nearest);
        }
    }

    /// The samples from `start` on, whose nearest nodes are known.
    #[inline(always)]
    fn see_lanes<S: Simd>(
        &self,
        simd: S,
        place: [S::f32s; 3],
        start: usize,
        seen: &mut SeenColumns<'_>,
    ) {
        let lanes = S::f32s::LEN;
        let range = start..start + lanes;
        let nodes = Gathered {
            nodes: &self.nodes,
            indices: &seen.member[range.clone()],
            is_one: is_one_node(&seen.member[range.clone()]),
        };
        let from_node: [S::f32s; 3] =
            std::array::from_fn(|axis| place[axis] - nodes.part(simd, |it| it.place[axis]));
        let directions: [[S::f32s; 3]; 2] = std::array::from_fn(|side| {
            std::array::from_fn(|axis| nodes.part(simd, |it| it.directions[side][axis]))
        });
        let missing: [S::f32s; 2] =
            std::array::from_fn(|side| nodes.part(simd, |it| it.missing[side]));
        let path = nodes.part(simd, |it| it.path);
        let index = S::f32s::from_slice(simd, &seen.member[range.clone()]);

        let below = -dot::<S>(from_node, directions[0]) + missing[0];
        let above = dot::<S>(from_node, directions[1]) + missing[1];
        let (is_below, is_above) = (below.simd_ge(0.0), above.simd_ge(0.0));
        let [zero, one] = [0.0, 1.0].map(|value| S::f32s::splat(simd, value));
        // Without a segment on that side its foot is the node itself.
        let [by_first, by_second] = [is_below.select(-below, zero), is_above.select(above, zero)];
        let first = [
            path + by_first,
            square::<S>(from_node, directions[0], by_first),
        ];
        let second = [
            path + by_second,
            square::<S>(from_node, directions[1], by_second),
        ];
        let is_blend = is_below & is_above;
        let sum = below + above;
        let w = sum.simd_gt(0.0).select(below / sum, one * 0.5);
        let share = w * w * (w * -2.0 + 3.0);
        let [first, second] = [
            std::array::from_fn::<_, 2, _>(|part| is_below.select(first[part], second[part])),
            std::array::from_fn::<_, 2, _>(|part| is_above.select(second[part], first[part])),
        ];
        first[0].store_slice(&mut seen.along[0][range.clone()]);
        second[0].store_slice(&mut seen.along[1][range.clone()]);
        first[1].store_slice(&mut seen.across[0][range.clone()]);
        second[1].store_slice(&mut seen.across[1][range.clone()]);
        is_blend
            .select(share, one)
            .store_slice(&mut seen.share[range.clone()]);
        let is_one = is_below.select(one, zero) + is_above.select(one, zero);
        // Two feet make a blend, one an influence area, none is outside.
        let region = is_blend.select(one, (one - is_one) * 2.0);
        region.store_slice(&mut seen.region[range.clone()]);
        let is_lower = is_below.select(one, zero) - is_blend.select(one, zero);
        (index - is_lower).store_slice(&mut seen.member[range]);
    }
}

/// The nodes nearest to the lanes of a vector.
struct Gathered<'a> {
    nodes: &'a [NodeConstants],
    indices: &'a [f32],
    /// Whether they are all the same, as they mostly are.
    is_one: bool,
}

impl Gathered<'_> {
    #[inline(always)]
    fn part<S: Simd>(&self, simd: S, part: impl Fn(&NodeConstants) -> f32) -> S::f32s {
        if self.is_one {
            return S::f32s::splat(simd, part(&self.nodes[self.indices[0] as usize]));
        }
        S::f32s::from_fn(simd, |lane| part(&self.nodes[self.indices[lane] as usize]))
    }
}

fn is_one_node(indices: &[f32]) -> bool {
    indices.iter().all(|index| *index == indices[0])
}

#[inline(always)]
fn dot<S: Simd>(a: [S::f32s; 3], b: [S::f32s; 3]) -> S::f32s {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Square of the distance from the point that lies `along` from the node in a direction.
#[inline(always)]
fn square<S: Simd>(from_node: [S::f32s; 3], direction: [S::f32s; 3], along: S::f32s) -> S::f32s {
    let off: [S::f32s; 3] = std::array::from_fn(|axis| from_node[axis] - direction[axis] * along);
    dot::<S>(off, off)
}
