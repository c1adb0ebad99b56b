//! The sky over the corners of a tile: looked at where it changes, and blended between corners that see it alike
//! (after Ward, Rubinstein & Clear 1988).

use super::Relief;
use super::light::{OF_SKY, TILE, sky};
use glam::DVec3;

/// Corners along a side of a tile with the first of the next.
pub(super) const SIDE: usize = TILE + 1;

/// Every so many corners the sky is looked at; between them as far as that is needed.
const COARSE: usize = 4;

/// Between corners that see the sky so much alike it is blended.
const ALIKE: f32 = 0.03;

/// And only if the height departs from their mean by no more than this share of their distance.
const EVEN: f64 = 0.1;

/// A tile whose sky is looked at.
pub(super) struct Tile<'a> {
    pub(super) relief: &'a Relief,
    /// Its first corner.
    pub(super) first: [usize; 2],
}

/// What each corner of a tile sees of the sky; nothing beyond the grid.
pub(super) type Skies = Vec<Option<[f32; OF_SKY]>>;

impl Tile<'_> {
    /// What the corners see. Corners on the rim follow from others on the rim, so that tiles agree there.
    pub(super) fn sky(&self) -> Skies {
        let mut skies: Skies = vec![None; SIDE * SIDE];
        let mut step = COARSE;
        while step > 0 {
            // In the last round nobody asks for the first corners of the next tile.
            let end = if step == 1 { TILE } else { SIDE };
            for y in (0..end).step_by(step) {
                for x in (0..end).step_by(step) {
                    if skies[y * SIDE + x].is_none() && self.is_on_grid([x, y]) {
                        let blended = self.blended([x, y], step, &skies);
                        let found = blended.unwrap_or_else(|| self.seen([x, y]));
                        skies[y * SIDE + x] = Some(found);
                    }
                }
            }
            step /= 2;
        }
        skies
    }

    fn is_on_grid(&self, at: [usize; 2]) -> bool {
        let cells = self.relief.heights.cells();
        (0..2).all(|axis| self.first[axis] + at[axis] <= cells[axis])
    }

    fn point(&self, [x, y]: [usize; 2]) -> DVec3 {
        self.relief
            .heights
            .point([self.first[0] + x, self.first[1] + y])
    }

    fn seen(&self, at: [usize; 2]) -> [f32; OF_SKY] {
        let point = self.point(at);
        let normal = self.relief.normal(point.truncate());
        sky(self.relief, point, normal).map(|number| number as f32)
    }

    /// The mean of the corners around one, known from an earlier round, if that is what it sees.
    fn blended(&self, [x, y]: [usize; 2], step: usize, skies: &Skies) -> Option<[f32; OF_SKY]> {
        if step == COARSE {
            return None;
        }
        let [aside, above] = [x, y].map(|at| if at % (2 * step) == 0 { 0 } else { step });
        let [low, high] = [[x - aside, y - above], [x + aside, y + above]];
        let around = [low, high, [low[0], high[1]], [high[0], low[1]]];
        let mut sum = [0.0; OF_SKY];
        let (mut least, mut most) = ([f32::INFINITY; OF_SKY], [f32::NEG_INFINITY; OF_SKY]);
        let mut height = 0.0;
        for [x, y] in around {
            let sky = skies[y * SIDE + x]?;
            for part in 0..OF_SKY {
                sum[part] += 0.25 * sky[part];
                least[part] = least[part].min(sky[part]);
                most[part] = most[part].max(sky[part]);
            }
            height += 0.25 * self.point([x, y]).z;
        }
        let away = (self.point(high) - self.point(low)).truncate().length();
        let is_even = (self.point([x, y]).z - height).abs() <= EVEN * 0.5 * away;
        let are_alike = (0..OF_SKY).all(|part| most[part] - least[part] <= ALIKE);
        (is_even && are_alike).then_some(sum)
    }
}
