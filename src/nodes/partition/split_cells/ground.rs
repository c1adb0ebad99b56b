//! What patterns are laid over, and how whole numbers of cells are found that fit it.

use super::super::division::Plot;
use glam::DVec2;

/// The pattern's own coordinates.
pub(super) struct Axes {
    pub(super) origin: DVec2,
    pub(super) along: DVec2,
}

/// The rectangle, in the pattern's own coordinates, that is to be covered.
pub(super) struct Window {
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    /// Its size, if it repeats.
    pub(super) period: Option<DVec2>,
    axes: Axes,
}

/// A cell in the pattern's own coordinates.
pub(super) struct Tile {
    pub(super) corners: Vec<DVec2>,
    pub(super) bulges: Vec<f64>,
    /// The direction of its own first axis.
    pub(super) along: DVec2,
    pub(super) values: Vec<(&'static str, f64)>,
}

/// A pattern.
pub(super) struct Laid {
    pub(super) tiles: Vec<Tile>,
    /// How much longer and wider than asked for it is.
    pub(super) stretch: DVec2,
    /// Whether it ends where the ground ends.
    pub(super) fit: bool,
}

/// Equal steps along an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    pub(super) first: i64,
    pub(super) end: i64,
    pub(super) step: f64,
    /// How much larger than asked for a step is.
    pub(super) stretch: f64,
}

impl Axes {
    /// From the pattern's own coordinates to the plane.
    pub(super) fn place(&self, at: DVec2) -> DVec2 {
        self.origin + self.along * at.x + self.along.perp() * at.y
    }

    /// From the plane to the pattern's own coordinates.
    pub(super) fn seen(&self, at: DVec2) -> DVec2 {
        let aside = at - self.origin;
        DVec2::new(aside.dot(self.along), aside.dot(self.along.perp()))
    }
}

impl Window {
    pub(super) fn new(plot: &Plot, axes: &Axes) -> Window {
        let axes = Axes { ..*axes };
        if let Some(period) = plot.period {
            let period = axes.along.abs() * period.x + axes.along.perp().abs() * period.y;
            return Window {
                low: DVec2::ZERO,
                high: period,
                period: Some(period),
                axes,
            };
        }
        let corners = plot.region.rings().flatten().map(|at| axes.seen(*at));
        let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let [low, high] = corners.fold(none, |[low, high], at| [low.min(at), high.max(at)]);
        let period = None;
        Window {
            low,
            high,
            period,
            axes,
        }
    }

    /// The pattern's own coordinates.
    pub(super) fn axes(&self) -> &Axes {
        &self.axes
    }

    /// Steps that cover the window along an axis, and one more on either side; where it repeats so many that they close, a
    /// multiple of `multiple`.
    pub(super) fn steps(&self, axis: usize, step: f64, multiple: i64) -> Steps {
        let Some(period) = self.period else {
            return Steps {
                first: (self.low[axis] / step).floor() as i64 - 1,
                end: (self.high[axis] / step).ceil() as i64 + 1,
                step,
                stretch: 1.0,
            };
        };
        let count = (period[axis] / (step * multiple as f64)).round().max(1.0) as i64 * multiple;
        let closing = period[axis] / count as f64;
        Steps {
            first: 0,
            end: count,
            step: closing,
            stretch: closing / step,
        }
    }

    /// Whether a box comes near the window.
    pub(super) fn is_near(&self, low: DVec2, high: DVec2) -> bool {
        self.period.is_some() || (low.cmple(self.high).all() && high.cmpge(self.low).all())
    }
}

impl Tile {
    /// A tile with straight edges.
    pub(super) fn straight(
        corners: Vec<DVec2>,
        along: DVec2,
        values: Vec<(&'static str, f64)>,
    ) -> Tile {
        let bulges = vec![];
        Tile {
            corners,
            bulges,
            along,
            values,
        }
    }

    /// A rectangle between two corners.
    pub(super) fn rectangle(
        low: DVec2,
        high: DVec2,
        along: DVec2,
        values: Vec<(&'static str, f64)>,
    ) -> Tile {
        let corners = vec![
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ];
        Tile::straight(corners, along, values)
    }
}

impl Laid {
    /// A pattern that goes on beyond the window.
    pub(super) fn over(tiles: Vec<Tile>, stretch: [f64; 2]) -> Laid {
        Laid {
            tiles,
            stretch: DVec2::from_array(stretch),
            fit: false,
        }
    }
}
