//! What stones give to one pixel, put together: the highest first, then what another leaves free.

use glam::Vec2;

/// A pixel on the ground, in mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
    /// The side of a square as large; 0 for a point.
    pub(super) width: f32,
    /// Four points in it, from its middle, no two of them in a row or a column.
    pub(super) points: [Vec2; 4],
}

impl Pixel {
    /// The pixel with these sides.
    #[inline]
    pub(super) fn new([along, across]: [Vec2; 2]) -> Pixel {
        let at = |a: f32, b: f32| along * a + across * b;
        Pixel {
            width: along.perp_dot(across).abs().sqrt(),
            points: [
                at(-0.125, -0.375),
                at(0.375, -0.125),
                at(-0.375, 0.125),
                at(0.125, 0.375),
            ],
        }
    }
}

/// What is on top in a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Mean height in mm of the stones in what they cover; 0 where there is none.
    pub(super) height: f32,
    /// By how much the height differs there.
    pub(super) range: f32,
    /// The share of the pixel that stones cover.
    pub(super) cover: f32,
    /// How far inside the outline of the stone the middle is; below 0 outside.
    pub(super) depth: f32,
    /// The stone that most of it is, or the nearest.
    pub(super) stone: Option<u32>,
    /// Another stone in the pixel, and its share of what is covered.
    pub(super) other: Option<u32>,
    pub(super) share: f32,
}

/// What one stone gives to a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Part {
    /// Mean height of what is seen of it, and by how much it differs there.
    pub(super) height: f32,
    pub(super) range: f32,
    /// Share of the pixel.
    pub(super) cover: f32,
}

impl Part {
    /// From the heights at some points; none where the stone is not.
    #[inline]
    pub(super) fn of<const POINTS: usize>(heights: [Option<f32>; POINTS]) -> Part {
        let (mut sum, mut count) = (0.0, 0.0);
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for height in heights.into_iter().flatten() {
            (sum, count) = (sum + height, count + 1.0);
            (low, high) = (low.min(height), high.max(height));
        }
        if count == 0.0 {
            return Part::default();
        }
        Part {
            height: sum / count,
            range: high - low,
            cover: count / POINTS as f32,
        }
    }
}

/// The two highest stones in a pixel, each with its depth.
#[derive(Debug, Default)]
pub(super) struct Top {
    first: Option<(u32, f32, Part)>,
    second: Option<(u32, f32, Part)>,
    /// The sum of all covers.
    cover: f32,
}

impl Top {
    #[inline]
    pub(super) fn add(&mut self, stone: u32, depth: f32, part: Part) {
        self.cover += part.cover;
        let is_above = |held: &Option<(u32, f32, Part)>| {
            held.is_none_or(|(_, _, held)| part.height > held.height)
        };
        if is_above(&self.first) {
            self.second = self.first.replace((stone, depth, part));
        } else if is_above(&self.second) {
            self.second = Some((stone, depth, part));
        }
    }

    /// What is found, with the nearest stone and its depth for where there is none.
    #[inline]
    pub(super) fn found(self, nearest: Option<u32>, depth: f32) -> Found {
        let Some((stone, inside, part)) = self.first else {
            return Found {
                height: 0.0,
                range: 0.0,
                cover: 0.0,
                depth,
                stone: nearest,
                other: None,
                share: 0.0,
            };
        };
        let alone = Found {
            height: part.height,
            range: part.range,
            cover: self.cover.min(1.0),
            depth: inside,
            stone: Some(stone),
            other: None,
            share: 0.0,
        };
        match self.second {
            Some((other, beside, under)) if part.cover < 1.0 => {
                let share = under.cover.min(1.0 - part.cover);
                let share = share / (share + part.cover);
                let height = part.height + (under.height - part.height) * share;
                let both = Found {
                    height,
                    range: part.range.max(under.range),
                    other: Some(other),
                    share,
                    ..alone
                };
                match share > 0.5 {
                    true => Found {
                        depth: beside,
                        stone: Some(other),
                        other: Some(stone),
                        share: 1.0 - share,
                        ..both
                    },
                    false => both,
                }
            }
            _ => alone,
        }
    }
}
