//! Cells cut off at the sides of a rectangle, so that neighbours agree about every bit.

use super::SAME;
use super::cells::Corner;
use super::triangulation::FAR;
use glam::DVec2;

/// The rectangle from the origin to `high`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box {
    high: DVec2,
}

impl Box {
    pub(super) fn new(high: DVec2) -> Box {
        Box { high }
    }

    /// Whether a point lies within or on a side.
    pub(super) fn holds(&self, at: DVec2) -> bool {
        at.x >= 0.0 && at.y >= 0.0 && at.x <= self.high.x && at.y <= self.high.y
    }

    /// Whether a point lies within, or on one of the lower sides.
    pub(super) fn holds_within(&self, at: DVec2) -> bool {
        self.holds(at) && at.x < self.high.x && at.y < self.high.y
    }

    /// A point that is hardly off a side is put on it.
    pub(super) fn snapped(&self, at: DVec2) -> DVec2 {
        let snapped = |at: f64, high: f64| {
            if at.abs() <= SAME {
                0.0
            } else if (at - high).abs() <= SAME {
                high
            } else {
                at
            }
        };
        DVec2::new(snapped(at.x, self.high.x), snapped(at.y, self.high.y))
    }

    /// Cuts off what of the cell of the seed at `seed` lies outside; `around` knows where the seeds beyond its edges are.
    pub(super) fn cut(&self, seed: DVec2, around: &[(u32, DVec2)], cell: &mut Vec<Corner>) {
        let mut cut: Vec<Corner> = vec![];
        // The first point within of all edges that are, and where the last of them left.
        let mut left: Option<DVec2> = None;
        let mut first = None;
        for (index, (from, beyond)) in cell.iter().enumerate() {
            let to = cell[(index + 1) % cell.len()].0;
            let (_, other) = around[index];
            let is_first = (seed.x, seed.y) < (other.x, other.y);
            let within = if is_first {
                self.within(*from, to)
            } else {
                self.within(to, *from).map(|[to, from]| [from, to])
            };
            let Some([enters, leaves]) = within else {
                continue;
            };
            match left {
                Some(left) => self.walk(left, enters, &mut cut),
                None => first = Some(enters),
            }
            cut.push((enters, *beyond));
            left = Some(leaves);
        }
        match (left, first) {
            (Some(left), Some(first)) => self.walk(left, first, &mut cut),
            _ if is_inside(cell, 0.5 * self.high) => {
                cut.extend((0..4).map(|it| (self.corner(it), FAR)))
            }
            _ => {}
        }
        *cell = cut;
    }

    /// The part of an edge that lies within, unless it only touches (Liang & Barsky 1984).
    fn within(&self, from: DVec2, to: DVec2) -> Option<[DVec2; 2]> {
        let step = to - from;
        let (mut enters, mut leaves) = ((0.0, from), (1.0, to));
        for axis in 0..2 {
            let (start, run, high) = (from[axis], step[axis], self.high[axis]);
            for (side, outward) in [(0.0, -run), (high, run)] {
                let is_beyond = |at: f64| if side == 0.0 { at < 0.0 } else { at > high };
                if outward == 0.0 {
                    if is_beyond(start) {
                        return None;
                    }
                    continue;
                }
                let share = (side - start) / run;
                let mut at = from + share * step;
                at[axis] = side;
                if outward < 0.0 && is_beyond(start) && share > enters.0 {
                    enters = (share, at);
                }
                if outward > 0.0 && is_beyond(to[axis]) && share < leaves.0 {
                    leaves = (share, at);
                }
            }
        }
        let ends = [enters.1, leaves.1].map(|at| self.snapped(at));
        (enters.0 < leaves.0 && ends[0] != ends[1] && ends.iter().all(|at| self.holds(*at)))
            .then_some(ends)
    }

    /// Goes along the sides, counterclockwise, from where a cell leaves to where it enters.
    fn walk(&self, from: DVec2, to: DVec2, cut: &mut Vec<Corner>) {
        if from == to {
            return;
        }
        cut.push((from, FAR));
        let (start, end) = (self.along(from), self.along(to));
        let end = if end <= start { end + 4.0 } else { end };
        let mut next = start.floor() + 1.0;
        while next < end {
            cut.push((self.corner(next as usize % 4), FAR));
            next += 1.0;
        }
    }

    /// How far along the sides a point on one of them is: a whole number at each corner.
    fn along(&self, at: DVec2) -> f64 {
        let share = at / self.high;
        if at.y == 0.0 && at.x < self.high.x {
            share.x
        } else if at.x == self.high.x && at.y < self.high.y {
            1.0 + share.y
        } else if at.y == self.high.y && at.x > 0.0 {
            3.0 - share.x
        } else {
            4.0 - share.y
        }
    }

    fn corner(&self, number: usize) -> DVec2 {
        let high = self.high;
        [
            DVec2::ZERO,
            DVec2::new(high.x, 0.0),
            high,
            DVec2::new(0.0, high.y),
        ][number]
    }
}

/// Whether a point is inside a cell.
fn is_inside(cell: &[Corner], point: DVec2) -> bool {
    let next = cell.iter().cycle().skip(1);
    let mut edges = cell.iter().zip(next);
    edges.all(|((from, _), (to, _))| (*to - *from).perp_dot(point - *from) > 0.0)
}
