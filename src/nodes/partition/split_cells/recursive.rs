//! Splits in two, again and again: each new border ends at older ones, as cracks and folds do.
//!
//! The largest cell is split next, across the axis in which it is longest by the second moments of its area.

use super::super::division::Plot;
use super::ground::{Laid, Tile, Window};
use crate::node::{Failure, Inputs};
use crate::nodes::random::Random;
use glam::DVec2;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// How cells are split.
#[derive(Clone, Copy, Debug)]
pub(super) struct Splits {
    /// The mean area of a cell in mm².
    area: f64,
    position: [f64; 2],
    turn: f64,
}

impl Splits {
    /// What the inputs state.
    ///
    /// # Errors
    /// If the range of positions is none.
    pub(super) fn read(inputs: &Inputs<'_>) -> Result<Splits, Failure> {
        let position = inputs.pair("position");
        if position[0] > position[1] {
            let message = format!(
                "expected a range from low to high, found from {} to {}",
                position[0], position[1]
            );
            return Err(Failure::of_input("position", message));
        }
        let width = inputs.number("width");
        Ok(Splits {
            area: width * width,
            position,
            turn: inputs.number("turn").to_radians(),
        })
    }
}

/// Splits a plot: its own outline if that is convex, else the window around it.
pub(super) fn lay(
    plot: &Plot,
    window: &Window,
    splits: Splits,
    mut random: Random,
    go_on: &mut dyn FnMut() -> Result<(), Failure>,
) -> Result<Laid, Failure> {
    let own = convex_outline(plot, window);
    let fit = own.is_some();
    let outline = own.unwrap_or_else(|| {
        let [low, high] = [window.low, window.high];
        vec![
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ]
    });
    let first = Part::new(outline, 0);
    let count = (first.area / splits.area).round().max(1.0) as usize;
    let mut parts = BinaryHeap::from([first]);
    while parts.len() < count {
        if parts.len().is_multiple_of(1024) {
            go_on()?;
        }
        let Some(largest) = parts.pop() else { break };
        let axis = largest.axis();
        let turn = random.between([-splits.turn, splits.turn]);
        let across = axis
            .perp()
            .rotate(DVec2::new(libm::cos(turn), libm::sin(turn)));
        let share = random.between(splits.position);
        match largest.split(axis, across, share) {
            Some(two) => parts.extend(two),
            None => {
                parts.push(largest);
                break;
            }
        }
    }
    let tiles = parts.into_sorted_vec().into_iter().rev().map(|part| {
        let axis = part.axis();
        let depth = f64::from(part.depth);
        let values = vec![
            ("depth", depth),
            ("length", part.extent(axis)[1] - part.extent(axis)[0]),
        ];
        Tile::straight(part.corners, axis, values)
    });
    Ok(Laid {
        tiles: tiles.collect(),
        stretch: DVec2::ONE,
        fit: fit || window.period.is_some(),
    })
}

/// The outline of a plot in the pattern's own coordinates, if it has no holes and no corner inwards.
fn convex_outline(plot: &Plot, window: &Window) -> Option<Vec<DVec2>> {
    let [polygon] = &plot.region.polygons[..] else {
        return None;
    };
    if plot.period.is_some() || !polygon.holes.is_empty() {
        return None;
    }
    let corners: Vec<DVec2> = polygon
        .outline
        .iter()
        .map(|at| window.axes().seen(*at))
        .collect();
    let count = corners.len();
    let turns_left = |index: usize| {
        let [a, b, c] = [0, 1, 2].map(|step| corners[(index + step) % count]);
        (b - a).perp_dot(c - b) >= -1e-12 * (b - a).length() * (c - b).length()
    };
    (0..count).all(turns_left).then_some(corners)
}

/// A convex part of what is divided.
struct Part {
    corners: Vec<DVec2>,
    area: f64,
    depth: u32,
}

impl Part {
    fn new(corners: Vec<DVec2>, depth: u32) -> Part {
        let area = crate::geometry::polygon::measure(&corners, &[]).area;
        Part {
            corners,
            area,
            depth,
        }
    }

    /// The direction in which it is longest.
    fn axis(&self) -> DVec2 {
        let [xx, xy, yy] = moments(&self.corners);
        let angle = 0.5 * libm::atan2(2.0 * xy, xx - yy);
        // Of a square any direction is as good: the first axis.
        if (xx - yy).abs() + xy.abs() < 1e-9 * (xx + yy) {
            return DVec2::X;
        }
        DVec2::new(libm::cos(angle), libm::sin(angle))
    }

    /// From where to where it reaches along a direction.
    fn extent(&self, along: DVec2) -> [f64; 2] {
        let places = self.corners.iter().map(|corner| corner.dot(along));
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
            [low.min(at), high.max(at)]
        })
    }

    /// The two parts on both sides of a line in the direction `across`, through a point of the axis.
    fn split(&self, axis: DVec2, across: DVec2, share: f64) -> Option<[Part; 2]> {
        let [low, high] = self.extent(axis);
        let beside = self.extent(axis.perp());
        let through =
            axis * (low + share * (high - low)) + axis.perp() * 0.5 * (beside[0] + beside[1]);
        let side = |at: DVec2| across.perp_dot(at - through);
        let (mut left, mut right) = (vec![], vec![]);
        for (index, from) in self.corners.iter().enumerate() {
            let to = self.corners[(index + 1) % self.corners.len()];
            let (here, there) = (side(*from), side(to));
            if here >= 0.0 {
                left.push(*from);
            }
            if here <= 0.0 {
                right.push(*from);
            }
            if here * there < 0.0 {
                let at = *from + (to - *from) * (here / (here - there));
                left.push(at);
                right.push(at);
            }
        }
        let parts = [left, right].map(|corners| Part::new(corners, self.depth + 1));
        parts
            .iter()
            .all(|part| part.corners.len() >= 3 && part.area > 0.0)
            .then_some(parts)
    }
}

/// Second moments of the area around its centre, all over the same factor.
fn moments(corners: &[DVec2]) -> [f64; 3] {
    let centre = crate::geometry::polygon::measure(corners, &[]).centre();
    let mut moments = [0.0; 3];
    for (index, from) in corners.iter().enumerate() {
        let [a, b] = [
            *from - centre,
            corners[(index + 1) % corners.len()] - centre,
        ];
        let cross = a.perp_dot(b);
        moments[0] += cross * (a.x * a.x + a.x * b.x + b.x * b.x);
        moments[1] += cross * (a.x * b.y + 2.0 * a.x * a.y + 2.0 * b.x * b.y + b.x * a.y) * 0.5;
        moments[2] += cross * (a.y * a.y + a.y * b.y + b.y * b.y);
    }
    moments
}

impl PartialEq for Part {
    fn eq(&self, other: &Part) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Part) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// By area, then by place.
    fn cmp(&self, other: &Part) -> Ordering {
        let [own, its] = [self, other].map(|part| part.corners[0]);
        let by_area = self.area.total_cmp(&other.area);
        by_area
            .then(own.x.total_cmp(&its.x))
            .then(own.y.total_cmp(&its.y))
    }
}
