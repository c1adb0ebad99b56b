//! Parquet: boards in two directions.

use super::laid::{Laid, steps};
use crate::node::Failure;
use glam::DVec2;

/// Boards at right angles, each against the side of the next.
///
/// With boards n wide and 1 high, lying ones begin at k (1, 1) + m (2n, 0), and standing ones at (n, 1 - n) from there.
pub(super) struct Herringbone {
    /// Width of what is laid as one.
    width: f64,
    /// How many widths long it is.
    ratio: f64,
    /// Boards side by side.
    strands: f64,
}

impl Herringbone {
    pub(super) fn new(piece: DVec2, strands: f64) -> Herringbone {
        let width = piece.y * strands;
        Herringbone {
            width,
            ratio: (piece.x / width).round().max(1.0),
            strands,
        }
    }

    pub(super) fn area(&self) -> f64 {
        self.width * self.width * self.ratio / self.strands
    }

    pub(super) fn repeat(&self) -> DVec2 {
        DVec2::splat(2.0 * self.ratio * self.width)
    }

    pub(super) fn cover(&self, [low, high]: [DVec2; 2]) -> Vec<Laid> {
        let reach = self.ratio * self.width;
        let mut laid = vec![];
        for k in steps(low.y - reach, high.y + reach, self.width) {
            let (left, right) = (low.x - 2.0 * reach, high.x + 2.0 * reach);
            let aside = f64::from(k) * self.width;
            for m in steps(left - aside, right - aside, 2.0 * reach) {
                let corner =
                    DVec2::new(f64::from(k) + 2.0 * self.ratio * f64::from(m), f64::from(k));
                let standing = corner + DVec2::new(self.ratio, 1.0 - self.ratio);
                self.strands_of(corner, DVec2::new(self.ratio, 1.0), [k, 2 * m], &mut laid);
                self.strands_of(
                    standing,
                    DVec2::new(1.0, self.ratio),
                    [k, 2 * m + 1],
                    &mut laid,
                );
            }
        }
        laid
    }

    /// The boards of a rectangle, side by side.
    fn strands_of(&self, corner: DVec2, size: DVec2, place: [i32; 2], laid: &mut Vec<Laid>) {
        let across = if size.x > size.y { DVec2::Y } else { DVec2::X };
        let count = self.strands as i32;
        for strand in 0..count {
            let share = |number: i32| across * (f64::from(number) / self.strands);
            let from = corner + share(strand);
            let to = corner + size - across + share(strand + 1);
            laid.push(Laid::rectangle(
                from * self.width,
                (to - from) * self.width,
                place,
            ));
        }
    }
}

/// Squares of boards that lie and stand by turns.
pub(super) struct Basket {
    side: f64,
    strands: f64,
}

impl Basket {
    pub(super) fn new(piece: DVec2, strands: f64) -> Basket {
        let fitting = (piece.x / piece.y).round().max(1.0);
        Basket {
            side: piece.x,
            strands: if strands > 0.0 { strands } else { fitting },
        }
    }

    pub(super) fn area(&self) -> f64 {
        self.side * self.side / self.strands
    }

    pub(super) fn repeat(&self) -> DVec2 {
        DVec2::splat(2.0 * self.side)
    }

    pub(super) fn cover(&self, [low, high]: [DVec2; 2]) -> Vec<Laid> {
        let mut laid = vec![];
        for row in steps(low.y, high.y, self.side) {
            for column in steps(low.x, high.x, self.side) {
                let corner = DVec2::new(f64::from(column), f64::from(row)) * self.side;
                let is_lying = (row + column).rem_euclid(2) == 0;
                let across = if is_lying { DVec2::Y } else { DVec2::X };
                for strand in 0..self.strands as i32 {
                    let at = |number: i32| across * (self.side * f64::from(number) / self.strands);
                    let from = corner + at(strand);
                    let to = corner + (DVec2::ONE - across) * self.side + at(strand + 1);
                    let mut piece = Laid::rectangle(from, to - from, [row, column]);
                    piece.along = DVec2::ONE - across;
                    laid.push(piece);
                }
            }
        }
        laid
    }
}

/// Slanted boards that meet in a straight seam.
pub(super) struct Chevron {
    /// Width of a strip, and the height of a board's end.
    strip: f64,
    end: f64,
    /// How far a board rises across its strip.
    rise: f64,
}

impl Chevron {
    pub(super) fn new(piece: DVec2, slant: f64) -> Result<Chevron, Failure> {
        let (sine, cosine) = libm::sincos(slant);
        if sine == 0.0 {
            return Err(
                Failure::of_input("slant", "boards that do not slant make no chevron")
                    .with_hint("state an angle such as 45 or 60"),
            );
        }
        Ok(Chevron {
            strip: piece.x * cosine,
            end: piece.y / cosine,
            rise: piece.x * sine,
        })
    }

    pub(super) fn area(&self) -> f64 {
        self.strip * self.end
    }

    pub(super) fn repeat(&self) -> DVec2 {
        DVec2::new(2.0 * self.strip, self.end)
    }

    pub(super) fn cover(&self, [low, high]: [DVec2; 2]) -> Vec<Laid> {
        let mut laid = vec![];
        for column in steps(low.x, high.x, self.strip) {
            let is_rising = column.rem_euclid(2) == 0;
            let [left, right] = [column, column + 1].map(|edge| f64::from(edge) * self.strip);
            let [at_left, at_right] = if is_rising {
                [0.0, self.rise]
            } else {
                [self.rise, 0.0]
            };
            let along = DVec2::new(self.strip, at_right - at_left).normalize();
            for row in steps(low.y - self.rise, high.y, self.end) {
                let [bottom, top] = [row, row + 1].map(|edge| f64::from(edge) * self.end);
                let corners = vec![
                    DVec2::new(left, bottom + at_left),
                    DVec2::new(right, bottom + at_right),
                    DVec2::new(right, top + at_right),
                    DVec2::new(left, top + at_left),
                ];
                laid.push(Laid::straight(corners, along, [row, column]));
            }
        }
        laid
    }
}
