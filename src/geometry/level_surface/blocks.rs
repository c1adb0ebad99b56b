//! Finds the blocks of cubes through which a surface runs.

use super::tetrahedra::Crossings;
use super::{Corner, Evaluate, Grid, MOST_POINTS, NoSurface};
use glam::DVec3;
use std::collections::BTreeSet;

/// Cubes along each side of a block.
const SIDE: i32 = 8;

/// Corners along each side of a block.
const CORNERS: usize = SIDE as usize + 1;

/// Steps of the coarse grid, in cubes, at least.
const COARSE: i32 = 4;

/// Points of the coarse grid, at most.
const MOST_COARSE: u64 = 4_000_000;

/// Blocks that are evaluated in one go.
const AT_ONCE: usize = 512;

/// The number of a block along each axis.
type Number = [i32; 3];

/// Some cubes, and which of their corners are inside.
pub(super) struct Block {
    number: Number,
    inside: Vec<bool>,
}

impl Grid {
    /// The blocks through which the surface runs, in order.
    pub(super) fn blocks(&self, evaluate: &Evaluate<'_>) -> Result<Vec<Block>, NoSurface> {
        let mut pending = self.seeds(evaluate)?;
        let mut known = pending.clone();
        let mut blocks: Vec<Block> = vec![];
        while !pending.is_empty() {
            let points = (known.len() * CORNERS * CORNERS * CORNERS) as u64;
            if points > MOST_POINTS {
                return Err(NoSurface::TooFine { points });
            }
            let numbers: Vec<Number> = std::mem::take(&mut pending).into_iter().collect();
            for numbers in numbers.chunks(AT_ONCE) {
                for block in self.evaluated(numbers, evaluate)? {
                    let next = block.neighbours(self).into_iter();
                    pending.extend(next.filter(|number| known.insert(*number)));
                    blocks.push(block);
                }
            }
        }
        blocks.sort_by_key(|block| block.number);
        Ok(blocks)
    }

    /// Blocks in which a coarse grid sees the surface.
    fn seeds(&self, evaluate: &Evaluate<'_>) -> Result<BTreeSet<Number>, NoSurface> {
        let steps = |step: i32| self.cubes.map(|cubes| (cubes + step - 1) / step + 1);
        let points = |step: i32| {
            let counts = steps(step).map(|count| count as u64);
            counts.iter().product::<u64>()
        };
        let step = std::iter::successors(Some(COARSE), |step| Some(step * 2))
            .find(|step| points(*step) <= MOST_COARSE)
            .expect("a step as long as the grid leaves eight points");
        let counts = steps(step);
        let corner = |index: usize| {
            let index = index as i32;
            let (x, rest) = (index % counts[0], index / counts[0]);
            let numbers = [x, rest % counts[1], rest / counts[1]];
            [0, 1, 2].map(|axis| (numbers[axis] * step).min(self.cubes[axis]))
        };
        let total = points(step) as usize;
        let places: Vec<DVec3> = (0..total).map(|index| self.place(corner(index))).collect();
        let values = evaluate(&places).ok_or(NoSurface::Cancelled)?;
        let mut seeds = BTreeSet::new();
        let strides = [1, counts[0] as usize, (counts[0] * counts[1]) as usize];
        for index in 0..total {
            let here = corner(index);
            let is_inside = values[index] > 0.0;
            for axis in 0..3 {
                if here[axis] < self.cubes[axis] {
                    let there = index + strides[axis];
                    if is_inside != (values[there] > 0.0) {
                        between(here, corner(there), axis, &mut seeds);
                    }
                }
                if is_inside && (here[axis] == 0 || here[axis] == self.cubes[axis]) {
                    seeds.insert(here.map(block_of));
                    // The flat layer beyond the last cube may be in the next block.
                    seeds.insert(here.map(|part| block_of(part + 1)));
                }
            }
        }
        match seeds.is_empty() {
            true => Err(NoSurface::Empty),
            false => Ok(seeds),
        }
    }

    fn evaluated(
        &self,
        numbers: &[Number],
        evaluate: &Evaluate<'_>,
    ) -> Result<Vec<Block>, NoSurface> {
        let mut places = vec![];
        for number in numbers {
            let corners = corners(*number).filter(|corner| !self.is_outside(*corner));
            places.extend(corners.map(|corner| self.place(corner)));
        }
        let values = evaluate(&places).ok_or(NoSurface::Cancelled)?;
        let mut values = values.into_iter();
        let block = |number: &Number| {
            let is_inside = |corner: Corner| {
                !self.is_outside(corner) && values.next().is_some_and(|value| value > 0.0)
            };
            Block {
                number: *number,
                inside: corners(*number).map(is_inside).collect(),
            }
        };
        Ok(numbers.iter().map(block).collect())
    }
}

/// The block that a corner or cube belongs to; the first cube of all is the flat layer at -1.
fn block_of(part: i32) -> i32 {
    (part + 1).div_euclid(SIDE)
}

/// The blocks along an axis from one corner to another.
fn between(from: Corner, to: Corner, axis: usize, seeds: &mut BTreeSet<Number>) {
    let mut number = from.map(block_of);
    for part in block_of(from[axis])..=block_of(to[axis]) {
        number[axis] = part;
        seeds.insert(number);
    }
}

/// The corners of a block, x fastest.
fn corners(number: Number) -> impl Iterator<Item = Corner> {
    let first = number.map(|part| part * SIDE - 1);
    (0..CORNERS * CORNERS * CORNERS).map(move |index| {
        let parts = [
            index % CORNERS,
            index / CORNERS % CORNERS,
            index / CORNERS / CORNERS,
        ];
        [0, 1, 2].map(|axis| first[axis] + parts[axis] as i32)
    })
}

impl Block {
    fn is_inside(&self, parts: [usize; 3]) -> bool {
        self.inside[(parts[2] * CORNERS + parts[1]) * CORNERS + parts[0]]
    }

    /// The blocks beyond the faces through which the surface runs.
    fn neighbours(&self, grid: &Grid) -> Vec<Number> {
        let mut found = vec![];
        for axis in 0..3 {
            for (end, step) in [(0, -1), (CORNERS - 1, 1)] {
                let is_inside = |index: usize| {
                    let mut parts = [end; 3];
                    parts[(axis + 1) % 3] = index % CORNERS;
                    parts[(axis + 2) % 3] = index / CORNERS;
                    self.is_inside(parts)
                };
                let count = (0..CORNERS * CORNERS)
                    .filter(|index| is_inside(*index))
                    .count();
                let mut number = self.number;
                number[axis] += step;
                let is_there = (0..=block_of(grid.cubes[axis])).contains(&number[axis]);
                if is_there && (1..CORNERS * CORNERS).contains(&count) {
                    found.push(number);
                }
            }
        }
        found
    }

    /// Adds the triangles in this block's cubes.
    pub(super) fn divide(&self, grid: &Grid, crossings: &mut Crossings) {
        let side = SIDE as usize;
        for index in 0..side * side * side {
            let parts = [index % side, index / side % side, index / side / side];
            let cube = [0, 1, 2].map(|axis| self.number[axis] * SIDE - 1 + parts[axis] as i32);
            if (0..3).any(|axis| cube[axis] > grid.cubes[axis]) {
                continue;
            }
            let inside = std::array::from_fn(|corner| {
                self.is_inside([0, 1, 2].map(|axis| parts[axis] + (corner >> axis & 1)))
            });
            crossings.add_cube(grid, cube, inside);
        }
    }
}
