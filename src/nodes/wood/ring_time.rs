//! From radius and height to growth time, by a ring series, and from growth time to what is inside the bark.

use super::growth::Heights;
use crate::field::{Block, Kernel};
use crate::key::KeyHasher;
use crate::value::RingSeries;
use std::f64::consts::PI;
use std::sync::Arc;

/// From radius, wave (both in mm) and position to growth time in years: the ring that has the radius less the
/// wave at that height.
#[derive(Debug)]
pub(super) struct RingTime {
    rings: Arc<RingSeries>,
    areas: Steps,
    heights: Steps,
}

/// A function that is linear from step to step and goes on beyond the last as within it.
#[derive(Debug)]
struct Steps {
    places: Heights,
    /// For each step its start, the value there, and the slope.
    lines: Vec<[f32; 3]>,
}

impl Steps {
    /// Rises from (0, 0) through the points (ends\[i\], values\[i\]).
    fn new(ends: &[f64], values: impl Iterator<Item = f64>) -> Steps {
        let mut lines = vec![];
        let (mut start, mut before) = (0.0, 0.0);
        for (end, value) in ends.iter().zip(values) {
            let slope = (value - before) / (end - start);
            lines.push([start as f32, before as f32, slope as f32]);
            (start, before) = (*end, value);
        }
        // Below the first step and above the last the line goes on.
        let [first, last] = [lines[0], lines[lines.len() - 1]];
        lines.insert(0, first);
        lines.push(last);
        let places = std::iter::once(0.0).chain(ends.iter().map(|end| *end as f32));
        Steps {
            places: Heights::new(&places.collect::<Vec<f32>>()),
            lines,
        }
    }

    #[inline(always)]
    fn at(&self, place: f32) -> f32 {
        let [start, value, slope] = self.lines[self.places.piece(place)];
        value + (place - start) * slope
    }
}

impl RingTime {
    pub(super) fn new(rings: &Arc<RingSeries>) -> RingTime {
        let years = (1..=rings.years()).map(|year| year as f64);
        RingTime {
            areas: Steps::new(&rings.areas, years),
            // Within a year both height and area are linear in time, so one is linear in the other.
            heights: Steps::new(&rings.heights, rings.areas.iter().copied()),
            rings: Arc::clone(rings),
        }
    }
}

impl Kernel for RingTime {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("ring_time")
            .whole(1)
            .whole(self.rings.years() as i64);
        for number in self.rings.areas.iter().chain(&self.rings.heights) {
            key.number(*number);
        }
    }

    fn width(&self) -> usize {
        1
    }

    fn nanoseconds(&self) -> f32 {
        8.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [radius, wave, _, _, z] = block.inputs else {
            return;
        };
        let columns = radius.values.iter().zip(wave.values).zip(z.values);
        for (time, ((radius, wave), z)) in block.outputs[0].iter_mut().zip(columns) {
            let radius = (radius - wave).max(0.0);
            *time = self
                .areas
                .at(self.heights.at(*z) + PI as f32 * radius * radius);
        }
    }
}

/// From growth time to 1 inside the bark and 0 outside, mixed where a pixel is in both.
#[derive(Debug)]
pub(super) struct Inside {
    /// The time in years at which the bark was there.
    pub(super) age: f64,
}

impl Kernel for Inside {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("inside_bark").whole(1).number(self.age);
    }

    fn width(&self) -> usize {
        1
    }

    fn reads_spread(&self, _: usize) -> bool {
        true
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let (age, time) = (self.age as f32, &block.inputs[0]);
        let [across, down] = time.spread;
        for (index, inside) in block.outputs[0].iter_mut().enumerate() {
            let before = age - time.values[index];
            let spread = across
                .get(index)
                .map_or(0.0, |across| across.abs() + down[index].abs());
            *inside = if spread > 0.0 {
                (0.5 + before / spread).clamp(0.0, 1.0)
            } else {
                f32::from(u8::from(before >= 0.0))
            };
        }
    }
}
