//! A grid of bins that says which stones may be at a point.

use super::ground::Stone;
use crate::key::KeyHasher;
use glam::{DVec2, IVec2};

/// Bins with lists of stones.
#[derive(Debug)]
pub(super) struct Grid {
    low: DVec2,
    /// Bins per mm, and how many there are along x and y.
    scale: DVec2,
    count: IVec2,
    /// The first of each bin's stones in `list`, and behind them its length.
    starts: Vec<u32>,
    list: Vec<u32>,
    pub(super) period: Option<DVec2>,
}

/// Bins for each stone.
const BINS: f64 = 8.0;

impl Grid {
    /// The bins of stones that are known up to `reach` around them.
    pub(super) fn new(stones: &[Stone], reach: f64, period: Option<DVec2>) -> Grid {
        let boxes = || stones.iter().map(|stone| bounds(stone, reach));
        let low = boxes().fold(DVec2::INFINITY, |low, [it, _]| low.min(it));
        let high = boxes().fold(DVec2::NEG_INFINITY, |high, [_, it]| high.max(it));
        let (low, size) = match period {
            Some(period) => (DVec2::ZERO, period),
            None => (low, (high - low).max(DVec2::splat(1e-3))),
        };
        let side = (size.x * size.y / (BINS * stones.len() as f64)).sqrt();
        let count = (size / side)
            .ceil()
            .clamp(DVec2::ONE, DVec2::splat(16384.0));
        let mut grid = Grid {
            low,
            scale: count / size,
            count: count.as_ivec2(),
            starts: vec![],
            list: vec![],
            period,
        };
        grid.fill(stones, reach);
        grid
    }

    fn fill(&mut self, stones: &[Stone], reach: f64) {
        let bins = self.count.x as usize * self.count.y as usize;
        let mut entries: Vec<(u32, u32)> = vec![];
        for (number, stone) in (0..).zip(stones) {
            let [from, to] = bounds(stone, reach).map(|corner| self.bin(corner));
            for (y, x) in (from.y..=to.y).flat_map(|y| (from.x..=to.x).map(move |x| (y, x))) {
                let [x, y] = match self.period {
                    Some(_) => [x.rem_euclid(self.count.x), y.rem_euclid(self.count.y)],
                    None => [x.clamp(0, self.count.x - 1), y.clamp(0, self.count.y - 1)],
                };
                entries.push(((y * self.count.x + x) as u32, number));
            }
        }
        entries.sort_unstable();
        entries.dedup();
        self.starts = vec![0; bins + 1];
        for (bin, _) in &entries {
            self.starts[*bin as usize + 1] += 1;
        }
        for bin in 0..bins {
            self.starts[bin + 1] += self.starts[bin];
        }
        self.list = entries.into_iter().map(|(_, stone)| stone).collect();
    }

    fn bin(&self, at: DVec2) -> IVec2 {
        ((at - self.low) * self.scale).floor().as_ivec2()
    }

    /// The stones that may be at a point, or near it.
    #[inline]
    pub(super) fn near(&self, at: DVec2) -> &[u32] {
        let at = match self.period {
            Some(period) => at - period * (at / period).floor(),
            None => at,
        };
        let place = (at - self.low) * self.scale;
        if place.cmplt(DVec2::ZERO).any() {
            return &[];
        }
        let bin = place.as_ivec2();
        let bin = match self.period {
            // Rounding may lead to the period itself.
            Some(_) => bin.min(self.count - 1),
            None => bin,
        };
        if bin.cmpge(self.count).any() {
            return &[];
        }
        let bin = bin.y as usize * self.count.x as usize + bin.x as usize;
        &self.list[self.starts[bin] as usize..self.starts[bin + 1] as usize]
    }

    /// From a stone's centre to a point, the shortest way round if the ground repeats.
    #[inline]
    pub(super) fn apart(&self, at: DVec2, centre: DVec2) -> DVec2 {
        let apart = at - centre;
        match self.period {
            Some(period) => apart - period * (apart / period).round(),
            None => apart,
        }
    }

    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        let period = self.period.unwrap_or_default();
        key.number(period.x).number(period.y);
    }
}

/// The box around a stone in which points know of it.
fn bounds(stone: &Stone, reach: f64) -> [DVec2; 2] {
    let (low, high) = (stone.low.as_dvec2(), stone.high.as_dvec2());
    [stone.centre + low - reach, stone.centre + high + reach]
}
