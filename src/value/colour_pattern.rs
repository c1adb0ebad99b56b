//! Colour patterns: colour as a function of growth time.

use serde::{Deserialize, Serialize};

/// What follows the end of a pattern's table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AfterEnd {
    /// The table starts again: one year follows the other.
    Repeat,
    /// The wood ends there: `inside` falls to 0 and the colour stays the last one.
    End,
}

/// A table of colours from early to late, linear Rec. 709.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColourPattern {
    /// The texels, at least one; the first begins at time 0.
    pub colours: Vec<[f32; 3]>,
    /// Growth time that the table covers, in years: 1 for one year's pattern.
    pub years: f64,
    /// Where rings begin, from 0 at the start of the table towards 1 at its end: the first is 0, the
    /// others rise strictly. A ring ends where the next begins, the last one at 1.
    pub ring_starts: Vec<f64>,
    /// What follows its end.
    pub after_end: AfterEnd,
    /// Whether colours are interpolated between texel centres. The border between late and early wood
    /// stays sharp: nothing is interpolated across the ends of the table.
    pub smooth: bool,
}
