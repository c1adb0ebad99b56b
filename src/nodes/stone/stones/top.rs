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

/// What some points of a pixel see of one stone.
#[derive(Debug)]
pub(super) struct Seen {
    points: f32,
    count: f32,
    sum: f32,
    low: f32,
    high: f32,
}

impl Default for Seen {
    fn default() -> Seen {
        Seen {
            points: 0.0,
            count: 0.0,
            sum: 0.0,
            low: f32::INFINITY,
            high: f32::NEG_INFINITY,
        }
    }
}

impl Seen {
    /// Adds a point with the stone's height there; none where the stone is not.
    #[inline]
    pub(super) fn add(&mut self, height: Option<f32>) {
        self.points += 1.0;
        if let Some(height) = height {
            self.count += 1.0;
            self.sum += height;
            self.low = self.low.min(height);
            self.high = self.high.max(height);
        }
    }

    #[inline]
    pub(super) fn part(&self) -> Part {
        if self.count == 0.0 {
            return Part::default();
        }
        Part {
            height: self.sum / self.count,
            range: self.high - self.low,
            cover: self.count / self.points,
        }
    }
}

/// The two stones whose outlines are nearest to the middle of a pixel, each with its depth; at first none, as far away as
/// stones count.
#[derive(Debug)]
pub(super) struct Nearest([(Option<u32>, f32); 2]);

impl Nearest {
    pub(super) fn new(depth: f32) -> Nearest {
        Nearest([(None, depth), (None, f32::NEG_INFINITY)])
    }

    #[inline]
    pub(super) fn depth(&self) -> f32 {
        self.0[0].1
    }

    #[inline]
    pub(super) fn add(&mut self, stone: u32, depth: f32) {
        let [first, second] = self.0;
        if depth > first.1 {
            self.0 = [(Some(stone), depth), first];
        } else if depth > second.1 {
            self.0[1] = (Some(stone), depth);
        }
    }

    /// What is found in a joint: the nearest stone, and the share of a pixel of some width that is nearer to the other.
    #[inline]
    fn found(&self, width: f32) -> Found {
        let [(stone, depth), (other, beyond)] = self.0;
        Found {
            height: 0.0,
            range: 0.0,
            cover: 0.0,
            depth,
            stone,
            other,
            share: share(depth - beyond, [stone, other], width),
        }
    }
}

/// The share of a pixel that is nearer to the other of two stones, where one is deeper by `ahead` in its middle. Between two
/// stones that face each other the difference changes by two widths of the pixel within it; where no stone is known of, by one.
#[inline]
pub(super) fn share(ahead: f32, stones: [Option<u32>; 2], width: f32) -> f32 {
    let change = if stones.iter().all(Option::is_some) {
        2.0
    } else {
        1.0
    };
    match width > 0.0 {
        true => (0.5 - ahead / (change * width)).clamp(0.0, 1.0),
        false => 0.0,
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

    /// What is found in a pixel, with the nearest stones for where it is a joint.
    #[inline]
    pub(super) fn found(self, nearest: &Nearest, width: f32) -> Found {
        let Some((stone, inside, part)) = self.first else {
            return nearest.found(width);
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
