//! Lines over a surface of heights, seen from above: the cells on their way, in squares as large as may be passed by.

use super::Heights;
use glam::DVec2;

/// A straight line over the plane of a surface, from a distance along it on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Place and direction in cells.
    origin: DVec2,
    direction: DVec2,
}

/// A part of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) from: f64,
    pub(super) to: f64,
}

/// What to do with a square of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Nothing in it counts.
    Past,
    /// Something in it may count: its parts are shown next, or [`Way::Past`] is taken for a single cell.
    Into,
    /// Nothing further along counts either.
    End,
}

/// What lies below a part of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    pub(super) stretch: Stretch,
    /// The greatest height in it.
    pub(super) greatest: f64,
    /// Its only cell, if it has one.
    pub(super) cell: Option<[usize; 2]>,
}

impl Line {
    /// The line through a place; distances along it count in lengths of `direction`.
    pub(super) fn new(heights: &Heights, origin: DVec2, direction: DVec2) -> Line {
        Line {
            origin: origin / heights.cell,
            direction: direction / heights.cell,
        }
    }

    /// The part of a stretch that lies over the surface.
    pub(super) fn over(&self, heights: &Heights, stretch: Stretch) -> Option<Stretch> {
        let Stretch { mut from, mut to } = stretch;
        for axis in 0..2 {
            let (origin, direction) = (self.origin[axis], self.direction[axis]);
            let end = heights.cells[axis] as f64;
            if direction == 0.0 {
                if !(0.0..=end).contains(&origin) {
                    return None;
                }
                continue;
            }
            let (a, b) = (-origin / direction, (end - origin) / direction);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from < to).then_some(Stretch { from, to })
    }

    /// Shows the squares below a stretch in their order to `choose`, beginning with the largest.
    pub(super) fn walk(
        &self,
        heights: &Heights,
        stretch: Stretch,
        mut choose: impl FnMut(&Square) -> Way,
    ) {
        let Some(whole) = self.over(heights, stretch) else {
            return;
        };
        let mut from = whole.from;
        let mut cell = [0, 1].map(|axis| self.first_cell(heights, axis, from));
        let mut level = heights.levels.len();
        while from < whole.to {
            let (to, axis) = self.leaving(cell, level);
            let square = Square {
                stretch: Stretch {
                    from,
                    to: to.min(whole.to),
                },
                greatest: heights.greatest(cell, level),
                cell: (level == 0).then_some(cell),
            };
            match choose(&square) {
                Way::End => return,
                Way::Into if level > 0 => {
                    level -= 1;
                    continue;
                }
                Way::Into | Way::Past => {}
            }
            from = to.max(from);
            let Some(next) = self.next(heights, cell, level, (axis, from)) else {
                return;
            };
            if next[axis] >> (level + 1) != cell[axis] >> (level + 1) {
                level = (level + 1).min(heights.levels.len());
            }
            cell = next;
        }
    }

    /// The cell at a distance; on the border of two the one that lies ahead.
    fn first_cell(&self, heights: &Heights, axis: usize, distance: f64) -> usize {
        let place = self.origin[axis] + self.direction[axis] * distance;
        let back = f64::from(u8::from(
            self.direction[axis] < 0.0 && place == place.floor(),
        ));
        ((place - back).max(0.0) as usize).min(heights.cells[axis] - 1)
    }

    /// Where the line leaves the square around a cell, and across which axis.
    fn leaving(&self, cell: [usize; 2], level: usize) -> (f64, usize) {
        let distance = |axis: usize| {
            let direction = self.direction[axis];
            let ahead = usize::from(direction > 0.0);
            let border = ((cell[axis] >> level) + ahead) << level;
            match direction == 0.0 {
                true => f64::INFINITY,
                false => (border as f64 - self.origin[axis]) / direction,
            }
        };
        let (x, y) = (distance(0), distance(1));
        if x < y { (x, 0) } else { (y, 1) }
    }

    /// The cell behind the border of a square; it stays within the square along the other axis.
    fn next(
        &self,
        heights: &Heights,
        cell: [usize; 2],
        level: usize,
        (axis, distance): (usize, f64),
    ) -> Option<[usize; 2]> {
        let other = 1 - axis;
        let first = cell[axis] >> level << level;
        let mut next = [0; 2];
        next[axis] = match self.direction[axis] > 0.0 {
            true => first + (1 << level),
            false => first.checked_sub(1)?,
        };
        let lowest = cell[other] >> level << level;
        let highest = (lowest + (1 << level)).min(heights.cells[other]) - 1;
        let place = (self.origin[other] + self.direction[other] * distance).max(0.0);
        next[other] = (place as usize).clamp(lowest, highest);
        (next[axis] < heights.cells[axis]).then_some(next)
    }
}

impl Heights {
    /// The heights along a line in a cell: those at distance 0, and how they grow with distance and with its square.
    pub(super) fn along(&self, cell: [usize; 2], line: &Line) -> [f64; 3] {
        let [a, b, c, d] = self.around(cell);
        let (right, up, both) = (b - a, c - a, a - b - c + d);
        let at = line.origin - DVec2::new(cell[0] as f64, cell[1] as f64);
        let to = line.direction;
        [
            a + right * at.x + up * at.y + both * at.x * at.y,
            right * to.x + up * to.y + both * (at.x * to.y + at.y * to.x),
            both * to.x * to.y,
        ]
    }
}
