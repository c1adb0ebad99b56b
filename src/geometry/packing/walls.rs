//! The border of a region, sorted so that what lies near a point is found at once.

use crate::value::Region;
use glam::DVec2;

/// The segments of a region's border, in a grid of square tiles.
#[derive(Debug)]
pub(crate) struct Walls {
    low: DVec2,
    high: DVec2,
    tile: f64,
    columns: usize,
    rows: usize,
    segments: Vec<[DVec2; 2]>,
    /// Of each tile the first of its segments in `near`, and behind them the number of all.
    starts: Vec<u32>,
    near: Vec<u32>,
    /// Of each row of tiles the segments that cross its heights.
    crossing: Vec<Vec<u32>>,
}

/// A place on the border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Foot {
    /// The nearest point of the border.
    pub(crate) point: DVec2,
    /// The segment that it lies on.
    pub(crate) segment: u32,
    /// How far away it is, in mm.
    pub(crate) distance: f64,
    /// From the border into the region, of length 1: the segment's own normal.
    pub(crate) inward: DVec2,
}

/// Most tiles of a side.
const MOST: f64 = 4096.0;

impl Walls {
    /// The border of a region; what is nearer than `reach` mm to a point is found.
    pub(crate) fn new(region: &Region, reach: f64) -> Walls {
        let mut segments = vec![];
        for ring in region.rings() {
            let next = ring.iter().cycle().skip(1);
            segments.extend(ring.iter().zip(next).map(|(from, to)| [*from, *to]));
        }
        let corners = region.rings().flatten();
        let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), corner| {
            (low.min(*corner), high.max(*corner))
        });
        let extent = high - low;
        let tile = reach.max(extent.max_element() / MOST);
        let (columns, rows) = ((extent.x / tile) as usize + 1, (extent.y / tile) as usize + 1);
        let mut walls = Walls {
            low,
            high,
            tile,
            columns,
            rows,
            segments,
            starts: vec![],
            near: vec![],
            crossing: vec![vec![]; rows],
        };
        walls.sort(reach);
        walls
    }

    fn sort(&mut self, reach: f64) {
        let mut entries = vec![];
        for (index, [from, to]) in self.segments.iter().enumerate() {
            let pieces = (from.distance(*to) / self.tile).ceil().max(1.0) as usize;
            for piece in 0..pieces {
                let at = |piece: usize| from.lerp(*to, piece as f64 / pieces as f64);
                let (a, b) = (at(piece), at(piece + 1));
                let [x0, y0] = self.tile_of(a.min(b) - reach);
                let [x1, y1] = self.tile_of(a.max(b) + reach);
                for y in y0..=y1 {
                    entries.extend((x0..=x1).map(|x| ((y * self.columns + x) as u32, index as u32)));
                }
            }
            let (bottom, top) = (self.tile_of(from.min(*to))[1], self.tile_of(from.max(*to))[1]);
            self.crossing[bottom..=top]
                .iter_mut()
                .for_each(|row| row.push(index as u32));
        }
        entries.sort_unstable();
        entries.dedup();
        self.starts = vec![0; self.columns * self.rows + 1];
        for (tile, _) in &entries {
            self.starts[*tile as usize + 1] += 1;
        }
        for tile in 1..self.starts.len() {
            self.starts[tile] += self.starts[tile - 1];
        }
        self.near = entries.into_iter().map(|(_, index)| index).collect();
    }

    fn tile_of(&self, point: DVec2) -> [usize; 2] {
        let at = (point - self.low) / self.tile;
        let clamp = |at: f64, count: usize| (at.max(0.0) as usize).min(count - 1);
        [clamp(at.x, self.columns), clamp(at.y, self.rows)]
    }

    /// Lowest and highest coordinates.
    pub(crate) fn bounds(&self) -> [DVec2; 2] {
        [self.low, self.high]
    }

    /// The segments of the border, in the order of the region's rings.
    pub(crate) fn segments(&self) -> &[[DVec2; 2]] {
        &self.segments
    }

    /// Whether a point lies inside.
    pub(crate) fn contains(&self, point: DVec2) -> bool {
        if point.cmplt(self.low).any() || point.cmpgt(self.high).any() {
            return false;
        }
        let row = self.tile_of(point)[1];
        let mut inside = false;
        for index in &self.crossing[row] {
            let [a, b] = self.segments[*index as usize];
            if (a.y > point.y) != (b.y > point.y) {
                let side = (b - a).perp_dot(point - a);
                inside ^= (side > 0.0) == (b.y > a.y);
            }
        }
        inside
    }

    /// The nearest place of the border, if it is as near as was asked for: of equally near ones that whose segment
    /// the point lies most in front of.
    pub(crate) fn nearest(&self, point: DVec2) -> Option<Foot> {
        let mut best: Option<Foot> = None;
        for foot in self.feet(point) {
            let is_better = best.is_none_or(|best| {
                let tie = foot.distance <= best.distance * (1.0 + 1e-12);
                foot.distance < best.distance * (1.0 - 1e-12)
                    || (tie && foot.height(point) > best.height(point))
            });
            if is_better {
                best = Some(foot);
            }
        }
        best
    }

    /// The nearest places of all segments that may be as near as was asked for.
    pub(crate) fn feet(&self, point: DVec2) -> impl Iterator<Item = Foot> {
        let [x, y] = self.tile_of(point);
        let tile = y * self.columns + x;
        let near = self.starts[tile] as usize..self.starts[tile + 1] as usize;
        self.near[near].iter().map(move |index| self.foot(*index, point))
    }

    fn foot(&self, segment: u32, point: DVec2) -> Foot {
        let [from, to] = self.segments[segment as usize];
        let along = to - from;
        let length = along.length_squared().max(f64::MIN_POSITIVE);
        let share = ((point - from).dot(along) / length).clamp(0.0, 1.0);
        let nearest = from + share * along;
        Foot {
            point: nearest,
            segment,
            distance: point.distance(nearest),
            inward: along.perp() / length.sqrt(),
        }
    }
}

impl Foot {
    /// How far in front of the segment's line a point lies; below 0 behind it.
    pub(crate) fn height(&self, point: DVec2) -> f64 {
        (point - self.point).dot(self.inward)
    }
}
