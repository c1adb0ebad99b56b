//! How long growth takes, for columns: from ways along and distances across a trunk to years.

use super::GrowthModel;
use super::rings::RingTable;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// What tells the time of a trunk.
#[derive(Debug)]
pub(super) enum Clock {
    /// Years for each mm along and across.
    Speeds { along: f32, across: f32 },
    /// A ring series.
    Rings(RingTable),
}

impl Clock {
    pub(super) fn new(model: &GrowthModel) -> Clock {
        match &model.rings {
            Some(rings) => Clock::Rings(RingTable::new(rings)),
            None => Clock::Speeds {
                along: (1.0 / model.settings.elongation) as f32,
                across: (1.0 / model.settings.thickening) as f32,
            },
        }
    }

    pub(super) fn nanoseconds(&self) -> f32 {
        match self {
            Clock::Speeds { .. } => 0.0,
            Clock::Rings(_) => 10.0,
        }
    }

    /// From ways along the trunk in mm and squares of distances across it in mm² to T_1 in years, in place of the squares.
    #[simd]
    pub(super) fn write_times<S: Simd>(&self, simd: S, along: &[f32], times: &mut [f32]) {
        let (of_along, of_across) = match self {
            Clock::Rings(rings) => return rings.times(simd, along, times),
            Clock::Speeds { along, across } => (*along, *across),
        };
        let lanes = S::f32s::LEN;
        let columns = along.chunks_exact(lanes).zip(times.chunks_exact_mut(lanes));
        for (along, times) in columns {
            let across = S::f32s::from_slice(simd, times).sqrt();
            let along = S::f32s::from_slice(simd, along);
            (along * of_along + across * of_across).store_slice(times);
        }
    }
}
