//! Evens out stones that lie almost as they should: each next to its neighbours, at the distance that their sizes ask for.

use super::Stone;
use super::guide::{Guide, nearest_turn};
use super::neighbours::{CHUNK, Neighbours};
use super::walls::Walls;
use glam::{DMat2, DVec2};
use rayon::prelude::*;

/// Rounds.
const ROUNDS: usize = 20;

/// Farthest neighbour that counts, in stones.
const REACH: f64 = 1.45;

/// How much a stone moves of what would put it right with its neighbours as they are.
const MOVED: f64 = 0.7;

/// How much it counts that stones lie side by side rather than staggered, and that they lie along the border.
const ALIGNED: f64 = 0.12;
const BORDER: f64 = 3.0;

/// Stones lie side by side only if none is smaller than this share of their mean.
const ALIKE: f64 = 0.7;

/// What stones are evened out in.
pub(crate) struct Relaxation<'a> {
    pub(crate) guide: &'a Guide,
    pub(crate) walls: Option<&'a Walls>,
    pub(crate) symmetry: u32,
    pub(crate) period: Option<DVec2>,
    /// Length and width of a stone of size 1, in mm.
    pub(crate) stone: DVec2,
    /// Sides that neighbours lie beyond.
    pub(crate) sides: u32,
    /// Whether stones of neighbouring rows lie side by side.
    pub(crate) is_aligned: bool,
}

/// Squares that a stone would like to be small: of its distances from lines.
#[derive(Clone, Copy, Default)]
struct Pull {
    matrix: DMat2,
    vector: DVec2,
}

impl Pull {
    /// The stone should be `off` farther along `normal`.
    fn add(&mut self, normal: DVec2, off: f64, weight: f64) {
        self.matrix += weight * DMat2::from_cols(normal * normal.x, normal * normal.y);
        self.vector += weight * off * normal;
    }

    /// Where to, with a little weight on staying.
    fn step(&self) -> DVec2 {
        let kept = self.matrix + DMat2::from_diagonal(DVec2::splat(0.5));
        kept.inverse() * self.vector
    }
}

impl Relaxation<'_> {
    /// Moves the stones that are not fixed.
    ///
    /// # Errors
    /// What `go_on` says.
    pub(crate) fn relax<E>(
        &self,
        stones: &mut [Stone],
        go_on: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut neighbours = Neighbours::default();
        for round in 0..ROUNDS {
            go_on(round as f64 / ROUNDS as f64)?;
            if round % 8 == 0 {
                if let Some(period) = self.period {
                    stones
                        .iter_mut()
                        .for_each(|stone| stone.point = stone.point.rem_euclid(period));
                }
                neighbours = self.neighbours(stones);
            }
            let steps = self.steps(stones, &neighbours);
            for (stone, step) in stones.iter_mut().zip(steps) {
                stone.point += MOVED * step;
            }
            stones.par_iter_mut().for_each(|stone| {
                let wished = self.guide.at(stone.point).frame;
                stone.frame = nearest_turn(wished, stone.frame, self.symmetry);
            });
        }
        Ok(())
    }

    fn neighbours(&self, stones: &[Stone]) -> Neighbours {
        let points: Vec<DVec2> = stones.iter().map(|stone| stone.point).collect();
        let reach = REACH * self.stone.max_element();
        let reaches: Vec<f64> = stones.iter().map(|stone| reach * stone.scale).collect();
        Neighbours::new(&points, self.period, &reaches, |index, other, offset| {
            let (one, other) = (&stones[index], &stones[other]);
            let scale = 0.5 * (one.scale + other.scale);
            let within = one.within(offset) / (scale * self.stone);
            within.length_squared() < REACH * REACH
        })
    }

    fn steps(&self, stones: &[Stone], neighbours: &Neighbours) -> Vec<DVec2> {
        let step = |index: usize| {
            let stone = &stones[index];
            if stone.is_fixed {
                return DVec2::ZERO;
            }
            let mut pull = Pull::default();
            for source in neighbours.of(index) {
                let (other, by) = neighbours.sources[*source as usize];
                let other = &stones[other as usize];
                self.pull(stone, other, stone.point - other.point - by, &mut pull);
            }
            self.hold(stone, &mut pull);
            let step = pull.step();
            let most = 0.2 * stone.scale * self.stone.min_element();
            step.clamp_length_max(most)
        };
        let mut steps = vec![DVec2::ZERO; stones.len()];
        let chunks = steps.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, steps)| {
            for (within, place) in steps.iter_mut().enumerate() {
                *place = step(chunk * CHUNK + within);
            }
        });
        steps
    }

    /// What a neighbour asks of a stone that lies `offset` from it.
    fn pull(&self, stone: &Stone, other: &Stone, offset: DVec2, pull: &mut Pull) {
        let frame = nearest_turn(other.frame, stone.frame, self.symmetry);
        let frame = (frame + stone.frame).normalize_or(stone.frame);
        let middle = Stone { frame, ..*stone };
        let scale = 0.5 * (stone.scale + other.scale);
        let within = middle.within(offset) / (scale * self.stone);
        // The side of the neighbour that the stone lies beyond, if it lies beyond one.
        let side = nearest_turn(DVec2::X, within.normalize_or(DVec2::X), self.sides);
        let (along, aside) = (within.dot(side), side.perp_dot(within));
        // Of unlike stones the smaller one says how near they are to touch, and how far their sides face.
        let smaller = stone.scale.min(other.scale) / scale;
        let facing = if self.is_aligned { 0.55 } else { 0.2 };
        let beside = 1.0 - facing * smaller;
        if aside.abs() > beside || along > 1.0 + 0.35 * smaller {
            return;
        }
        let weight = 1.0 - 0.5 * (aside / beside).abs();
        let off = (1.0 - along) * scale;
        let normal = frame.rotate(side);
        let length = (side * self.stone).length();
        pull.add(normal, off * length, weight);
        if self.is_aligned && smaller > ALIKE {
            pull.add(normal.perp(), -aside * scale * length, ALIGNED * weight);
        }
    }

    /// Holds a stone of the first row along the border.
    fn hold(&self, stone: &Stone, pull: &mut Pull) {
        let Some(walls) = self.walls else { return };
        for foot in walls.feet(stone.point) {
            let across = stone.within(foot.inward);
            let half =
                0.5 * stone.scale * across.abs().dot(self.stone) / across.abs().element_sum();
            let height = foot.height(stone.point);
            if foot.distance < 1.8 * half && height > 0.98 * foot.distance {
                pull.add(foot.inward, half - height, BORDER);
            }
        }
    }
}
