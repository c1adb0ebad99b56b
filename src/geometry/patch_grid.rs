//! Patches on a map: one square for each, in rows from the lower left corner, as near to a square as they fit.

use super::nurbs::{self, OnPatch};
use crate::value::Patches;
use glam::{DMat3, DVec2};

/// Points along each side of a patch at which its area is measured.
const MEASURED: u32 = 8;

/// How patches lie on a map, in squares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchGrid {
    count: usize,
    gutter: f64,
    /// Squares in a row, and rows.
    pub(crate) squares: [usize; 2],
}

/// A point of a patch on the map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    /// The patch.
    pub(crate) patch: usize,
    /// The point of it, from 0 to 1.
    pub(crate) at: [f64; 2],
    /// Whether the patch covers what was asked for, or is only the nearest.
    pub(crate) is_covered: bool,
}

impl PatchGrid {
    /// The grid of some patches.
    pub(crate) fn new(patches: &Patches) -> PatchGrid {
        let count = patches.patches.len();
        let columns = ((count as f64).sqrt().ceil() as usize).max(1);
        PatchGrid {
            count,
            gutter: patches.gutter,
            squares: [columns, count.div_ceil(columns)],
        }
    }

    /// The share of a square's side that its patch takes.
    pub(crate) fn share(&self) -> f64 {
        1.0 - 2.0 * self.gutter
    }

    /// Where a point of a patch is on the map, in squares.
    pub(crate) fn place(&self, patch: usize, at: DVec2) -> DVec2 {
        let corner = DVec2::new(
            (patch % self.squares[0]) as f64,
            (patch / self.squares[0]) as f64,
        );
        corner + self.gutter + at * self.share()
    }

    /// The patch at a point of the map, or the nearest to it; in squares.
    pub(crate) fn find(&self, at: DVec2) -> Spot {
        let index = |part: f64, count: usize| (part.max(0.0) as usize).min(count - 1);
        let (column, row) = (index(at.x, self.squares[0]), index(at.y, self.squares[1]));
        let patch = row * self.squares[0] + column;
        if patch < self.count {
            return self.within(patch, at);
        }
        // The last row is not full: below is a patch, and so is at its end.
        let (below, last) = (
            self.within(patch - self.squares[0], at),
            self.within(self.count - 1, at),
        );
        let distance = |spot: &Spot| self.place(spot.patch, spot.at.into()).distance_squared(at);
        if distance(&below) <= distance(&last) {
            below
        } else {
            last
        }
    }

    fn within(&self, patch: usize, at: DVec2) -> Spot {
        let asked = (at - self.place(patch, DVec2::ZERO)) / self.share();
        let nearest = asked.clamp(DVec2::ZERO, DVec2::ONE);
        Spot {
            patch,
            at: nearest.to_array(),
            is_covered: asked == nearest,
        }
    }
}

/// The point of a patch.
pub(crate) fn evaluate(patches: &Patches, spot: &Spot) -> OnPatch {
    nurbs::evaluate(&patches.patches[spot.patch], spot.at)
}

/// The area in mm^2 of a patch whose points are moved by `matrix`, about.
pub(crate) fn area(patches: &Patches, patch: usize, matrix: &DMat3) -> f64 {
    let middle = |step: u32| (f64::from(step) + 0.5) / f64::from(MEASURED);
    let places = (0..MEASURED).flat_map(|u| (0..MEASURED).map(move |v| [middle(u), middle(v)]));
    let areas = places.map(|at| {
        let [u, v] = nurbs::evaluate(&patches.patches[patch], at).along;
        (*matrix * u).cross(*matrix * v).length()
    });
    areas.sum::<f64>() / f64::from(MEASURED * MEASURED)
}
