//! Where particles begin: a row along the border, and the inside at the density that stones need.

use super::Stone;
use super::guide::Guide;
use super::neighbours::Tiles;
use super::walls::Walls;
use crate::value::Region;
use glam::DVec2;

/// Corners of the border that turn by less than this are rounded by a row of stones (cosine of 35 degrees).
const SHARP: f64 = 0.82;

/// Stones between two questions whether to go on.
const OFTEN: usize = 1 << 14;

/// How the inside is filled at first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// Places of a square lattice, each moved by up to a quarter of a stone.
    Lattice,
    /// Random places.
    Random,
}

/// What is to be filled.
pub(crate) struct Ground<'a> {
    pub(crate) region: &'a Region,
    pub(crate) walls: &'a Walls,
    pub(crate) guide: &'a Guide,
    /// Length and width of a stone of size 1, in mm.
    pub(crate) stone: DVec2,
    /// Smallest and largest random size.
    pub(crate) spread: [f64; 2],
    /// Smallest size factor anywhere.
    pub(crate) least: f64,
    /// Area of a stone of size 1 in mm².
    pub(crate) area: f64,
}

impl Ground<'_> {
    /// A stone at a point; `share` of a random number gives its size.
    pub(crate) fn stone_at(&self, point: DVec2, share: f64) -> Stone {
        let wish = self.guide.at(point);
        Stone {
            point,
            frame: wish.frame,
            scale: wish.scale * (self.spread[0] + share * (self.spread[1] - self.spread[0])),
            is_fixed: false,
        }
    }

    /// Rows of fixed particles half a stone inside the border, one in every sharp corner.
    ///
    /// The paper puts them on the border itself; there half of each stone would have to be cut off.
    pub(crate) fn border(&self, random: &mut dyn FnMut() -> f64) -> Vec<Stone> {
        let mut stones: Vec<Stone> = vec![];
        let mut chains: Vec<Vec<DVec2>> = self
            .region
            .rings()
            .flat_map(|ring| self.chains(ring))
            .collect();
        let ends: Vec<DVec2> = chains
            .iter()
            .filter_map(|chain| chain.first().copied())
            .collect();
        for end in ends {
            stones.push(self.stone_at(end, random()));
        }
        for chain in &mut chains {
            self.fill(chain, random, &mut stones);
        }
        let half = 0.5 * self.stone.min_element();
        stones.retain(|stone| {
            let near = self.walls.nearest(stone.point);
            self.walls.contains(stone.point)
                && near.is_none_or(|foot| {
                    foot.distance > 0.8 * half * self.guide.at(stone.point).scale
                })
        });
        let mut stones = self.apart(stones, 0.75);
        stones.iter_mut().for_each(|stone| stone.is_fixed = true);
        stones
    }

    /// A ring moved inwards by half a stone, cut at its sharp corners.
    fn chains(&self, ring: &[DVec2]) -> Vec<Vec<DVec2>> {
        let count = ring.len();
        let along = |index: usize| (ring[(index + 1) % count] - ring[index]).normalize_or(DVec2::X);
        let mut corners = vec![];
        for (index, corner) in ring.iter().enumerate() {
            let (before, after) = (along((index + count - 1) % count), along(index));
            let half = 0.5 * self.stone.min_element() * self.guide.at(*corner).scale;
            let bisector = before.perp() + after.perp();
            let length = bisector.length_squared().max(0.4);
            let moved = *corner + bisector * (2.0 * half / length);
            corners.push((moved, before.dot(after) < SHARP));
        }
        let first = corners.iter().position(|corner| corner.1).unwrap_or(0);
        let mut chains = vec![];
        let mut chain = vec![corners[first].0];
        for step in 1..=count {
            let (corner, is_sharp) = corners[(first + step) % count];
            chain.push(corner);
            if is_sharp || step == count {
                chains.push(std::mem::replace(&mut chain, vec![corner]));
            }
        }
        chains
    }

    /// Puts stones along a line, without its ends, as evenly as their sizes allow.
    fn fill(&self, chain: &[DVec2], random: &mut dyn FnMut() -> f64, stones: &mut Vec<Stone>) {
        let lengths: Vec<f64> = chain
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .collect();
        let total: f64 = lengths.iter().sum();
        let size = self.stone.x
            * self
                .guide
                .at(chain[0].midpoint(chain[chain.len() - 1]))
                .scale;
        let count = (total / size).round() as usize;
        for index in 1..count {
            let mut left = total * index as f64 / count as f64;
            let mut piece = 0;
            while piece + 1 < lengths.len() && left > lengths[piece] {
                left -= lengths[piece];
                piece += 1;
            }
            let point = chain[piece].lerp(
                chain[piece + 1],
                left / lengths[piece].max(f64::MIN_POSITIVE),
            );
            stones.push(self.stone_at(point, random()));
        }
    }

    /// Particles inside, none on those that are there already.
    ///
    /// # Errors
    /// What `go_on` says.
    pub(crate) fn inside<E>(
        &self,
        there: &[Stone],
        start: Start,
        random: &mut dyn FnMut() -> f64,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Vec<Stone>, E> {
        let [low, high] = self.walls.bounds();
        let mean = 0.5 * (self.spread[0] + self.spread[1]);
        let size = (self.area / (self.stone.x * self.stone.y)).sqrt();
        let step = self.least * mean * size * self.stone;
        let count = ((high - low) / step).ceil().max(DVec2::ONE);
        let (columns, rows) = (count.x as usize, count.y as usize);
        let step = (high - low) / count;
        let mut stones = there.to_vec();
        for index in 0..columns * rows {
            if index % OFTEN == 0 {
                go_on()?;
            }
            let moved = DVec2::new(random(), random());
            let (keep, size) = (random(), random());
            let at = match start {
                Start::Lattice => {
                    let site = DVec2::new((index % columns) as f64, (index / columns) as f64);
                    low + (site + 0.5 + 0.5 * (moved - 0.5)) * step
                }
                Start::Random => low + moved * (high - low),
            };
            let scale = self.guide.at(at).scale / self.least;
            if self.walls.contains(at) && keep * scale * scale < 1.0 {
                stones.push(self.stone_at(at, size));
            }
        }
        self.apart_from(stones, there.len(), 0.7, go_on)
    }

    /// Particles at places of a lattice, each moved by up to a quarter of a stone, none on those that are there already.
    ///
    /// # Errors
    /// What `go_on` says.
    pub(crate) fn beside<E>(
        &self,
        there: &[Stone],
        places: &[DVec2],
        turns: &[(f64, f64)],
        random: &mut dyn FnMut() -> f64,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Vec<Stone>, E> {
        let moved = |(place, turn): (&DVec2, &(f64, f64))| {
            let wish = self.guide.at(*place);
            let off = 0.5 * (DVec2::new(random(), random()) - 0.5) * self.stone * wish.scale;
            let at = *place + wish.frame.rotate(off);
            let size = random();
            let stone = self.stone_at(at, size);
            let frame = stone.frame.rotate(DVec2::from(*turn));
            self.walls.contains(at).then_some(Stone { frame, ..stone })
        };
        let inside: Vec<Stone> = places
            .iter()
            .zip(turns.iter().cycle())
            .filter_map(moved)
            .collect();
        self.apart_from([there, &inside].concat(), there.len(), 0.7, go_on)
    }

    /// Leaves out stones that are nearer than `least` stones to one before them.
    pub(crate) fn apart(&self, stones: Vec<Stone>, least: f64) -> Vec<Stone> {
        let tiles = self.tiles(&stones);
        let mut is_kept = vec![true; stones.len()];
        for index in 0..stones.len() {
            let one = &stones[index];
            let reach = least * self.stone.min_element() * one.scale;
            tiles.within(one.point, reach, |other| {
                let other = other as usize;
                let near = least * self.stone.min_element() * one.scale.min(stones[other].scale);
                if other < index && is_kept[other] && stones[other].point.distance(one.point) < near
                {
                    is_kept[index] = false;
                }
            });
        }
        let mut kept = is_kept.into_iter();
        stones
            .into_iter()
            .filter(|_| kept.next().unwrap_or(true))
            .collect()
    }

    /// The stones behind the first `count` that are no nearer than `least` stones to one of these.
    fn apart_from<E>(
        &self,
        stones: Vec<Stone>,
        count: usize,
        least: f64,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Vec<Stone>, E> {
        let there = &stones[..count];
        let tiles = self.tiles(there);
        let largest = there.iter().map(|stone| stone.scale).fold(0.0, f64::max);
        let is_apart = |stone: &Stone| {
            let mut nearest = f64::INFINITY;
            let reach = 0.5 * least * (stone.scale + largest) * self.stone.max_element();
            tiles.within(stone.point, reach, |other| {
                let other = &stones[other as usize];
                let scale = 0.5 * (stone.scale + other.scale);
                nearest = nearest
                    .min((other.within(stone.point - other.point) / (scale * self.stone)).length());
            });
            nearest > least
        };
        let mut apart = vec![];
        for stones in stones[count..].chunks(OFTEN) {
            go_on()?;
            apart.extend(stones.iter().copied().filter(is_apart));
        }
        Ok(apart)
    }

    fn tiles(&self, stones: &[Stone]) -> Tiles {
        let points: Vec<DVec2> = stones.iter().map(|stone| stone.point).collect();
        Tiles::new(&points, self.least * self.stone.min_element())
    }
}
