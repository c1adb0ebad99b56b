//! Parts that are split across their length again and again: joints end at older joints.

use super::laid::Laid;
use crate::node::{Failure, Inputs};
use crate::nodes::random::Random;
use glam::DVec2;

/// Splits of splits.
pub(super) struct Recursive {
    /// Length and width of a piece, on the whole.
    pub(super) piece: DVec2,
    /// Where a part is split, in parts of its length.
    at: [f64; 2],
    /// How slanted a split is at most, in radians.
    slant: f64,
}

/// A part is split as long as it is larger than a random multiple of a piece, from so much to twice as much.
const LARGEST: f64 = 0.85;

impl Recursive {
    pub(super) fn read(
        inputs: &Inputs<'_>,
        piece: DVec2,
        slant: f64,
    ) -> Result<Recursive, Failure> {
        let at = inputs.get("lengths").map(|_| inputs.pair("lengths"));
        let at = at.unwrap_or([0.35, 0.65]);
        if !(at[0] <= at[1] && at[1] <= 0.95) {
            let message = format!(
                "a part cannot be split from {} to {} of its length",
                at[0], at[1]
            );
            return Err(Failure::of_input("lengths", message)
                .with_hint("write numbers from 0.05 to 0.95, the smaller first"));
        }
        Ok(Recursive { piece, at, slant })
    }

    /// Parts of a box.
    pub(super) fn cover(&self, [low, high]: [DVec2; 2], random: &mut Random) -> Vec<Laid> {
        let whole = Laid::rectangle(low, high - low, [0, 0]).corners;
        let mut waiting = vec![(whole, 0)];
        let mut laid = vec![];
        while let Some((corners, depth)) = waiting.pop() {
            let size = self.size(&corners);
            let limit = LARGEST * self.piece.x * self.piece.y * (1.0 + f64::from(random.share()));
            let is_small = size.x * size.y <= limit || depth >= 64;
            match is_small {
                true => {
                    let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
                    laid.push(Laid::straight(corners, along, [depth, laid.len() as i32]));
                }
                false => {
                    let halves = self.split(&corners, size, random);
                    waiting.extend(halves.map(|half| (half, depth + 1)));
                }
            }
        }
        laid
    }

    /// Width and height of the box around a part.
    fn size(&self, corners: &[DVec2]) -> DVec2 {
        let [low, high] = around(corners);
        high - low
    }

    /// Both parts of a convex part, split across what is long of it as a piece is.
    fn split(&self, corners: &[DVec2], size: DVec2, random: &mut Random) -> [Vec<DVec2>; 2] {
        let is_long = size.x / self.piece.x >= size.y / self.piece.y;
        let mut draw = |low: f64, high: f64| low + (high - low) * f64::from(random.share());
        let share = draw(self.at[0], self.at[1]);
        let slant = draw(-self.slant, self.slant);
        let [low, high] = around(corners);
        let middle = 0.5 * (low + high);
        let (point, normal) = match is_long {
            true => (DVec2::new(low.x + share * size.x, middle.y), DVec2::X),
            false => (DVec2::new(middle.x, low.y + share * size.y), DVec2::Y),
        };
        let normal = DVec2::new(libm::cos(slant), libm::sin(slant)).rotate(normal);
        let side = |corner: DVec2| normal.dot(corner - point);
        let mut halves = [vec![], vec![]];
        for (index, corner) in corners.iter().enumerate() {
            let next = corners[(index + 1) % corners.len()];
            let (here, there) = (side(*corner), side(next));
            halves[usize::from(here >= 0.0)].push(*corner);
            if (here < 0.0) != (there < 0.0) {
                let between = *corner + (next - *corner) * (here / (here - there));
                halves.iter_mut().for_each(|half| half.push(between));
            }
        }
        halves
    }
}

fn around(corners: &[DVec2]) -> [DVec2; 2] {
    corners
        .iter()
        .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| {
            [low.min(*at), high.max(*at)]
        })
}
