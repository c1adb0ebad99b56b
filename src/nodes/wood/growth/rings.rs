//! Growth time by a ring series, for columns: from heights and distances to years.
//!
//! The section that is there when the tree reaches the height z, `S(m(z))`, is straight between the heights of the
//! years, as is the time between the areas of the years; so both are looked up.

use super::kernel::RUN;
use super::steps::Steps;
use crate::value::RingSeries;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// A ring series, laid out to be looked up.
#[derive(Debug)]
pub(in crate::nodes::wood) struct RingTable {
    /// From the height in mm to the section's area in mm² when the tree was that tall.
    area_of_height: Steps,
    /// From that area to the time in years.
    time_of_area: Steps,
}

impl RingTable {
    pub(in crate::nodes::wood) fn new(series: &RingSeries) -> RingTable {
        let pairs = series.heights.iter().zip(&series.areas);
        let heights = pairs.map(|(height, area)| [*height, *area]);
        let times = (1..)
            .zip(&series.areas)
            .map(|(year, area)| [*area, f64::from(year)]);
        let with_origin = |knots: &mut dyn Iterator<Item = [f64; 2]>| -> Vec<[f64; 2]> {
            std::iter::once([0.0; 2]).chain(knots).collect()
        };
        RingTable {
            area_of_height: Steps::new(&with_origin(&mut heights.into_iter()), false),
            time_of_area: Steps::new(&with_origin(&mut times.into_iter()), true),
        }
    }

    /// From squares of distances to the trunk's curve, in mm², to years: `S^-1(S(m(z)) + pi d^2)`.
    #[simd]
    pub(in crate::nodes::wood) fn times<S: Simd>(
        &self,
        simd: S,
        heights: &[f32],
        times: &mut [f32],
    ) {
        let mut areas = [0.0; RUN];
        let areas = &mut areas[..times.len()];
        self.area_of_height.evaluate(simd, heights, areas);
        let lanes = S::f32s::LEN;
        for (area, square) in areas.chunks_exact_mut(lanes).zip(times.chunks_exact(lanes)) {
            let square = S::f32s::from_slice(simd, square);
            let inside = S::f32s::from_slice(simd, area);
            (square * std::f32::consts::PI + inside).store_slice(area);
        }
        self.time_of_area.evaluate(simd, areas, times);
    }
}
