//! From radius, wave and position to growth time, by a ring series.

use super::growth::{RUN, RingTable};
use crate::field::{Block, Kernel};
use crate::key::KeyHasher;
use crate::value::RingSeries;
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use std::sync::Arc;

/// From radius and wave in mm and the position to growth time in years: that of the ring which has the radius less
/// the wave at that height.
#[derive(Debug)]
pub(super) struct RingTime {
    rings: Arc<RingSeries>,
    table: RingTable,
}

impl RingTime {
    pub(super) fn new(rings: &Arc<RingSeries>) -> RingTime {
        RingTime {
            table: RingTable::new(rings),
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
        10.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [radius, wave, _, _, z] = block.inputs else {
            return;
        };
        let columns = [radius.values, wave.values, z.values];
        let times = &mut block.outputs[0];
        dispatch!(block.level, simd => write_times(simd, &self.table, columns, times));
    }
}

#[simd]
fn write_times<S: Simd>(
    simd: S,
    table: &RingTable,
    [radius, wave, z]: [&[f32]; 3],
    times: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let columns = radius.chunks_exact(lanes).zip(wave.chunks_exact(lanes));
    for ((radius, wave), square) in columns.zip(times.chunks_exact_mut(lanes)) {
        let radius = S::f32s::from_slice(simd, radius) - S::f32s::from_slice(simd, wave);
        let radius = radius.max(0.0);
        (radius * radius).store_slice(square);
    }
    for (z, times) in z.chunks(RUN).zip(times.chunks_mut(RUN)) {
        table.times(simd, z, times);
    }
}
