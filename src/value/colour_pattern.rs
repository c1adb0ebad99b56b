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

/// Most colours, rings and years that a pattern has.
const MOST: [usize; 2] = [65_536, 100_000];

impl ColourPattern {
    /// Whether it is what nodes make: finite, with colours, and rings that start one behind the other.
    pub fn is_sound(&self) -> bool {
        let [colours, rings] = MOST;
        let starts = &self.ring_starts;
        (1..=colours).contains(&self.colours.len())
            && (1..=rings).contains(&starts.len())
            && self.colours.as_flattened().iter().all(|it| it.is_finite())
            && (1e-6..=rings as f64).contains(&self.years)
            && starts[0] == 0.0
            && starts.windows(2).all(|pair| pair[0] < pair[1])
            && starts[starts.len() - 1] < 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(change: fn(&mut ColourPattern)) -> ColourPattern {
        let mut pattern = ColourPattern {
            colours: vec![[0.5; 3]],
            years: 2.0,
            ring_starts: vec![0.0, 0.5],
            after_end: AfterEnd::Repeat,
            smooth: true,
        };
        change(&mut pattern);
        pattern
    }

    #[test]
    fn only_what_nodes_make_is_sound() {
        assert!(pattern(|_| {}).is_sound());
        let unsound: [fn(&mut ColourPattern); 11] = [
            |it| it.colours.clear(),
            |it| it.colours = vec![[0.0; 3]; 65_537],
            |it| it.colours[0][1] = f32::NAN,
            |it| it.years = 0.0,
            |it| it.years = f64::NAN,
            |it| it.years = 1e9,
            |it| it.ring_starts.clear(),
            |it| it.ring_starts[0] = 0.1,
            |it| it.ring_starts[1] = 0.0,
            |it| it.ring_starts[1] = f64::NAN,
            |it| it.ring_starts[1] = 1.0,
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            assert!(!pattern(change).is_sound(), "{number}");
        }
    }
}
