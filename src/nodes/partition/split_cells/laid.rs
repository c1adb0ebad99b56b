//! Patterns: pieces laid in a plane of their own, which may close after a period.

use super::arcs::Arcs;
use super::hexagons::Hexagons;
use super::recursive::Recursive;
use super::rows::Rows;
use super::woven::{Basket, Chevron, Herringbone};
use crate::node::{Failure, Inputs};
use crate::nodes::random::Random;
use glam::DVec2;

/// A piece of a pattern.
#[derive(Clone, Debug)]
pub(super) struct Laid {
    /// Its corners, counterclockwise.
    pub(super) corners: Vec<DVec2>,
    /// How its edges are bent, as in a partition; empty if they are straight.
    pub(super) bulges: Vec<f64>,
    /// The direction of its length.
    pub(super) along: DVec2,
    pub(super) row: i32,
    pub(super) column: i32,
}

impl Laid {
    /// A piece with straight edges.
    pub(super) fn straight(corners: Vec<DVec2>, along: DVec2, [row, column]: [i32; 2]) -> Laid {
        Laid {
            corners,
            bulges: vec![],
            along,
            row,
            column,
        }
    }

    /// A rectangle that lies along an axis.
    pub(super) fn rectangle(low: DVec2, size: DVec2, place: [i32; 2]) -> Laid {
        let high = low + size;
        let corners = vec![
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ];
        let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
        Laid::straight(corners, along, place)
    }

    fn middle(&self) -> DVec2 {
        self.corners.iter().sum::<DVec2>() / self.corners.len() as f64
    }
}

/// Pieces that close after a period.
pub(super) struct Closed {
    pub(super) pieces: Vec<Laid>,
    /// How much larger they are than was asked for, along x and y.
    pub(super) stretched: DVec2,
}

/// What is laid.
pub(super) enum Pattern {
    Rows(Rows),
    Herringbone(Herringbone),
    Basket(Basket),
    Chevron(Chevron),
    Hexagons(Hexagons),
    Arcs(Arcs),
    Recursive(Recursive),
}

impl Pattern {
    /// The pattern that the inputs describe.
    pub(super) fn read(
        inputs: &Inputs<'_>,
        piece: DVec2,
        period: Option<DVec2>,
    ) -> Result<Pattern, Failure> {
        let strands = inputs.whole("strands") as f64;
        let slant = |otherwise: f64| {
            let stated = inputs.get("slant").map(|_| inputs.number("slant"));
            stated.unwrap_or(otherwise).to_radians()
        };
        Ok(match inputs.choice("pattern") {
            "herringbone" => Pattern::Herringbone(Herringbone::new(piece, strands.max(1.0))),
            "basket" => Pattern::Basket(Basket::new(piece, strands)),
            "chevron" => Pattern::Chevron(Chevron::new(piece, slant(45.0))?),
            "hexagons" => Pattern::Hexagons(Hexagons::new(piece.x)),
            "arcs" => Pattern::Arcs(Arcs::read(inputs, piece)),
            "recursive" => Pattern::Recursive(Recursive::read(inputs, piece, slant(0.0))?),
            _ => Pattern::Rows(Rows::read(inputs, piece, period)?),
        })
    }

    /// The mean area of a piece.
    pub(super) fn area(&self) -> f64 {
        match self {
            Pattern::Rows(rows) => rows.piece.x * rows.piece.y,
            Pattern::Herringbone(one) => one.area(),
            Pattern::Basket(one) => one.area(),
            Pattern::Chevron(one) => one.area(),
            Pattern::Hexagons(one) => one.area(),
            Pattern::Arcs(arcs) => arcs.piece.x * arcs.piece.y,
            Pattern::Recursive(one) => one.piece.x * one.piece.y,
        }
    }

    /// Pieces that cover a box.
    pub(super) fn cover(&self, around: [DVec2; 2], random: &mut Random) -> Vec<Laid> {
        match self {
            Pattern::Rows(rows) => rows.cover(around, random),
            Pattern::Herringbone(one) => one.cover(around),
            Pattern::Basket(one) => one.cover(around),
            Pattern::Chevron(one) => one.cover(around),
            Pattern::Hexagons(one) => one.cover(around),
            Pattern::Arcs(arcs) => arcs.cover(around),
            Pattern::Recursive(one) => one.cover(around, random),
        }
    }

    /// Pieces that close after a period.
    pub(super) fn closed(&self, period: DVec2, random: &mut Random) -> Closed {
        let repeat = match self {
            Pattern::Rows(rows) => return rows.closed(period, random),
            Pattern::Recursive(one) => {
                let pieces = one.cover([DVec2::ZERO, period], random);
                return Closed {
                    pieces,
                    stretched: DVec2::ONE,
                };
            }
            Pattern::Herringbone(one) => one.repeat(),
            Pattern::Basket(one) => one.repeat(),
            Pattern::Chevron(one) => one.repeat(),
            Pattern::Hexagons(one) => one.repeat(),
            Pattern::Arcs(arcs) => arcs.repeat(),
        };
        let counts = (period / repeat).round().max(DVec2::ONE);
        let stretched = period / (counts * repeat);
        let around = counts * repeat;
        let is_first = |laid: &Laid| {
            // A middle on the border belongs to one side, whatever rounding says.
            let middle = laid.middle() + 1e-7 * repeat;
            middle.cmpge(DVec2::ZERO).all() && middle.cmplt(around).all()
        };
        let mut pieces = self.cover([-repeat, around + repeat], random);
        pieces.retain(is_first);
        for laid in &mut pieces {
            laid.corners
                .iter_mut()
                .for_each(|corner| *corner *= stretched);
        }
        Closed { pieces, stretched }
    }
}

/// Numbers of steps from `low` to `high`, each `step` wide, that cover what is between.
pub(super) fn steps(low: f64, high: f64, step: f64) -> std::ops::RangeInclusive<i32> {
    (low / step).floor() as i32..=(high / step).ceil() as i32
}

/// The piece with each arc as four straight edges, so that it can be cut.
pub(super) fn flattened(laid: Laid) -> Laid {
    if laid.bulges.is_empty() {
        return laid;
    }
    let count = laid.corners.len();
    let mut corners = vec![];
    for (index, corner) in laid.corners.iter().enumerate() {
        corners.push(*corner);
        let (next, bulge) = (laid.corners[(index + 1) % count], laid.bulges[index]);
        if bulge != 0.0 {
            corners.extend([0.25, 0.5, 0.75].map(|share| on_arc(*corner, next, bulge, share)));
        }
    }
    Laid {
        corners,
        bulges: vec![],
        ..laid
    }
}

/// A point of an arc; the same bits from both of its ends.
fn on_arc(from: DVec2, to: DVec2, bulge: f64, share: f64) -> DVec2 {
    let is_down = to.y < from.y || (to.y == from.y && to.x < from.x);
    if is_down {
        return on_arc(to, from, -bulge, 1.0 - share);
    }
    let chord = to - from;
    // The angle that the arc turns through, and its part on each side of the point.
    let quarter = libm::atan(bulge);
    let (before, after) = (4.0 * quarter * share, 4.0 * quarter * (1.0 - share));
    let length = libm::sin(0.5 * before) / libm::sin(0.5 * (before + after));
    let turn = -0.5 * after;
    from + DVec2::new(libm::cos(turn), libm::sin(turn)).rotate(chord) * length
}
