//! Lets particles settle (Miyata, Itoh & Shimada, section 3): masses on dampers that push and pull each other.

use super::Stone;
use super::force::{Force, REACH};
use super::guide::{Guide, nearest_turn};
use super::neighbours::{CHUNK, Neighbours};
use glam::DVec2;
use rayon::prelude::*;

/// Length of a step, and damping (semi-implicit Euler, as for bubble meshes).
const STEP: f64 = 0.08;
const DAMPING: f64 = 1.5;

/// Largest force that counts as none, in stones.
const AT_REST: f64 = 1e-3;

/// How much farther than the force reaches neighbours are listed, in stones.
const SKIN: f64 = 0.16;

/// Stones whose mean is more than this many times the smaller one are unlike.
const UNLIKE: f64 = 1.25;

/// As near as particles that overlap much are taken to be, in stones.
const LEAST_SIDE: f64 = 0.05;

/// Steps after which directions are read anew.
const TURNED: usize = 8;

/// What particles settle in.
pub(crate) struct Dynamics<'a> {
    pub(crate) force: Force,
    /// Length and width of a stone of size 1, in mm.
    pub(crate) stone: DVec2,
    pub(crate) guide: &'a Guide,
    pub(crate) symmetry: u32,
    pub(crate) period: Option<DVec2>,
    /// Largest number of steps.
    pub(crate) steps: usize,
}

impl Dynamics<'_> {
    /// Moves what is not fixed until nothing feels a force, or the steps are used up. `go_on` hears the share of the steps.
    ///
    /// # Errors
    /// What `go_on` says.
    pub(crate) fn settle<E>(
        &self,
        stones: &mut [Stone],
        go_on: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut speeds = vec![DVec2::ZERO; stones.len()];
        let mut forces = speeds.clone();
        let mut neighbours = Neighbours::default();
        let mut images = vec![];
        let mut listed: Vec<DVec2> = vec![];
        let mut moved = f64::INFINITY;
        let size = self.stone.max_element();
        let smallest = stones
            .iter()
            .map(|stone| stone.scale)
            .fold(f64::INFINITY, f64::min);
        for step in 0..self.steps {
            go_on(step as f64 / self.steps as f64)?;
            if step % TURNED == 0 {
                self.turn(stones);
            }
            let slack = 0.5 * SKIN * smallest * self.stone.min_element();
            if moved > slack * slack {
                if let Some(period) = self.period {
                    stones
                        .iter_mut()
                        .for_each(|stone| stone.point = stone.point.rem_euclid(period));
                }
                neighbours = self.neighbours(stones);
                listed = stones.iter().map(|stone| stone.point).collect();
                moved = 0.0;
            }
            place_images(&mut images, stones, &neighbours);
            self.forces(stones, &neighbours, &images, &mut forces);
            let mut largest: f64 = 0.0;
            let moving = stones.iter_mut().zip(&mut speeds).zip(&listed);
            for (((stone, speed), listed), force) in moving.zip(&forces) {
                if !stone.is_fixed {
                    *speed = (*speed + STEP * *force) / (1.0 + STEP * DAMPING);
                    stone.point += STEP * *speed;
                    largest = largest.max(force.length_squared());
                    moved = moved.max(stone.point.distance_squared(*listed));
                }
            }
            if largest < (AT_REST * size) * (AT_REST * size) {
                break;
            }
        }
        self.turn(stones);
        Ok(())
    }

    fn turn(&self, stones: &mut [Stone]) {
        stones.par_iter_mut().for_each(|stone| {
            let wished = self.guide.at(stone.point).frame;
            stone.frame = nearest_turn(wished, stone.frame, self.symmetry);
        });
    }

    fn neighbours(&self, stones: &[Stone]) -> Neighbours {
        let points: Vec<DVec2> = stones.iter().map(|stone| stone.point).collect();
        let reach = (REACH + SKIN) * self.stone.max_element();
        let reaches: Vec<f64> = stones.iter().map(|stone| reach * stone.scale).collect();
        let round = self.stone.x == self.stone.y;
        Neighbours::new(&points, self.period, &reaches, |index, other, offset| {
            let (one, other) = (&stones[index], &stones[other]);
            let scale = 0.5 * (one.scale + other.scale);
            let reach = (REACH + SKIN) * scale;
            let within = if round { offset } else { other.within(offset) };
            !(one.is_fixed && other.is_fixed)
                && (within / self.stone).length_squared() < reach * reach
        })
    }

    /// The force on every particle: the sum over its neighbours in the order of their list.
    fn forces(
        &self,
        stones: &[Stone],
        neighbours: &Neighbours,
        images: &[Stone],
        forces: &mut [DVec2],
    ) {
        let inverse = 1.0 / self.stone;
        let scales = || stones.iter().map(|stone| stone.scale);
        let largest = scales().fold(0.0, f64::max);
        let has_unlike = scales().any(|scale| largest > (2.0 * UNLIKE - 1.0) * scale);
        let on = |index: usize| {
            let stone = &stones[index];
            let mut sum = DVec2::ZERO;
            for source in neighbours.of(index) {
                let source = *source as usize;
                let other = match source.checked_sub(stones.len()) {
                    Some(image) => &images[image],
                    None => &stones[source],
                };
                let mut scale = 0.5 * (stone.scale + other.scale);
                let mut within =
                    other.within(stone.point - other.point) * (inverse * (1.0 / scale));
                if has_unlike {
                    let smaller = (UNLIKE * stone.scale.min(other.scale)).min(scale) / scale;
                    (within, scale) = (beside(within, smaller), smaller * scale);
                }
                sum += other.frame.rotate(self.force.at(within) * self.stone) * scale;
            }
            sum
        };
        let chunks = forces.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, forces)| {
            for (within, force) in forces.iter_mut().enumerate() {
                let index = chunk * CHUNK + within;
                if !stones[index].is_fixed {
                    *force = on(index);
                }
            }
        });
    }
}

/// Where a particle is in the frame of one that is much larger or smaller, if the distance between their sides counts in
/// stones that are `smaller` than the mean of both: with that, only the first row feels a large one.
fn beside(within: DVec2, smaller: f64) -> DVec2 {
    let side = within.abs().max_element();
    if smaller == 1.0 || side == 0.0 {
        return within;
    }
    within * ((1.0 + (side - 1.0) / smaller).max(LEAST_SIDE) / side)
}

/// Where the particles of neighbouring periods are, which stand behind the particles themselves in `neighbours`.
fn place_images(images: &mut Vec<Stone>, stones: &[Stone], neighbours: &Neighbours) {
    images.clear();
    images.extend(
        neighbours.sources[stones.len()..]
            .iter()
            .map(|(index, by)| {
                let stone = stones[*index as usize];
                let point = stone.point + *by;
                Stone { point, ..stone }
            }),
    );
}
