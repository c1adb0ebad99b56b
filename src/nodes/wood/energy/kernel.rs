//! Virtual energy for columns of positions.
//!
//! A block is worked off in runs of samples, charge by charge, so that sums stay in the fastest cache.

use super::axis_columns::AxisTable;
use super::model::{EnergyModel, Reference, Rod};
use super::potential::{
    BurlConstants, RodConstants, add_burl, add_rod, endless, half_exponential, inverse_sinh,
};
use super::wave_columns::{add_wave, fade_waves};
use crate::field::{Block, Kernel};
use crate::key::KeyHasher;
use crate::nodes::wood::virtual_energy;
use fearless_simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use std::fmt;

/// Samples in a run.
pub(super) const RUN: usize = 128;

/// From the position (x, y, z) in mm to radius in mm, energy, the shares of branches and of burls, the wave in mm, and
/// the place in the bare trunk in x and y, in mm.
pub struct EnergyKernel {
    model: EnergyModel,
    axis: AxisTable,
    trunk: Vec<RodConstants>,
    branches: Vec<RodConstants>,
    burls: Vec<BurlConstants>,
    half_length: f32,
}

impl EnergyKernel {
    /// The columns it writes.
    pub const WIDTH: usize = 7;

    /// Lays the model out for columns.
    pub fn new(model: EnergyModel) -> EnergyKernel {
        let rods = |rods: &[Rod]| rods.iter().map(RodConstants::new).collect();
        EnergyKernel {
            axis: AxisTable::new(&model.axis),
            trunk: rods(&model.trunk),
            branches: rods(&model.branches),
            burls: model.burls.iter().map(BurlConstants::new).collect(),
            half_length: (0.5 * model.length()) as f32,
            model,
        }
    }
}

impl fmt::Debug for EnergyKernel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("EnergyKernel")
            .field("reference", &self.model.reference)
            .field("branches", &self.branches.len())
            .field("burls", &self.burls.len())
            .finish_non_exhaustive()
    }
}

impl Kernel for EnergyKernel {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("virtual_energy")
            .whole(i64::from(virtual_energy::KIND.version))
            .whole(self.model.reference as i64);
        self.model.axis.add_to_key(key);
        for rods in [&self.model.trunk, &self.model.branches] {
            key.whole(rods.len() as i64);
            for rod in rods {
                add_numbers(key, &rod.start.to_array());
                add_numbers(key, &rod.direction.to_array());
                add_numbers(key, &[rod.length, rod.charge]);
            }
        }
        key.whole(self.model.burls.len() as i64);
        for burl in &self.model.burls {
            add_numbers(key, &burl.centre.to_array());
            key.number(burl.charge);
        }
        for wave in &self.model.waves {
            add_numbers(key, &[wave.amplitude, wave.per_millimetre, wave.phase]);
            key.whole(wave.turns);
        }
    }

    fn width(&self) -> usize {
        EnergyKernel::WIDTH
    }

    fn nanoseconds(&self) -> f32 {
        let rods = self.trunk.len() + self.branches.len();
        10.0 + 3.0 * rods as f32
            + 0.7 * self.burls.len() as f32
            + 4.0 * self.model.waves.len() as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [x, y, z] = [0, 1, 2].map(|column| block.inputs[column].values);
        let [radius, energy, branch, burl, wave, place_x, place_y] = block.outputs else {
            return;
        };
        let starts = (0..x.len()).step_by(RUN);
        for range in starts.map(|start| start..(start + RUN).min(x.len())) {
            let run = Run {
                kernel: self,
                position: [&x[range.clone()], &y[range.clone()], &z[range.clone()]],
            };
            let columns = Columns {
                radius: &mut radius[range.clone()],
                energy: &mut energy[range.clone()],
                branch: &mut branch[range.clone()],
                burl: &mut burl[range.clone()],
                wave: &mut wave[range.clone()],
                place: [&mut place_x[range.clone()], &mut place_y[range]],
            };
            dispatch!(block.level, simd => run.evaluate(simd, columns));
        }
    }
}

pub(super) fn add_numbers(key: &mut KeyHasher, numbers: &[f64]) {
    numbers.iter().for_each(|number| {
        key.number(*number);
    });
}

/// The columns of a run that are written.
struct Columns<'a> {
    radius: &'a mut [f32],
    energy: &'a mut [f32],
    branch: &'a mut [f32],
    burl: &'a mut [f32],
    wave: &'a mut [f32],
    place: [&'a mut [f32]; 2],
}

/// Samples of which all charges are summed up.
struct Run<'a> {
    kernel: &'a EnergyKernel,
    position: [&'a [f32]; 3],
}

impl Run<'_> {
    #[simd]
    fn evaluate<S: Simd>(&self, simd: S, columns: Columns<'_>) {
        let kernel = self.kernel;
        let length = columns.radius.len();
        let mut offsets = [[0.0; RUN]; 3];
        let [dx, dy, distance] = &mut offsets;
        let offset = [
            &mut dx[..length],
            &mut dy[..length],
            &mut distance[..length],
        ];
        kernel.axis.write_offsets(simd, self.position, offset);
        let distance = &distance[..length];
        columns.branch.fill(0.0);
        columns.burl.fill(0.0);
        for rod in &kernel.branches {
            add_rod(simd, rod, self.position, columns.branch);
        }
        for burl in &kernel.burls {
            add_burl(simd, burl, self.position, columns.burl);
        }
        match kernel.model.reference {
            Reference::Endless => endless(simd, distance, columns.energy),
            _ => {
                columns.energy.fill(0.0);
                for rod in &kernel.trunk {
                    add_rod(simd, rod, self.position, columns.energy);
                }
            }
        }
        self.finish(
            simd,
            distance,
            &mut *columns.radius,
            &mut *columns.energy,
            [columns.branch, columns.burl],
        );
        columns.wave.fill(0.0);
        for wave in &kernel.model.waves {
            add_wave(
                simd,
                wave,
                [&dx[..length], &dy[..length], self.position[2]],
                columns.wave,
            );
        }
        if !kernel.model.waves.is_empty() {
            fade_waves(
                simd,
                kernel.model.largest_wave() as f32,
                columns.radius,
                columns.wave,
            );
        }
        let offset = [&dx[..length], &dy[..length]];
        bare_places(simd, offset, [columns.radius, columns.wave], columns.place);
    }

    /// From the energies to the radius, and to the shares of branches and burls.
    #[simd]
    fn finish<S: Simd>(
        &self,
        simd: S,
        distance: &[f32],
        radius: &mut [f32],
        energy: &mut [f32],
        [branch, burl]: [&mut [f32]; 2],
    ) {
        let lanes = S::f32s::LEN;
        let [low, high] = self.kernel.model.axis.heights().map(|height| height as f32);
        let (middle, per_half) = (0.5 * (low + high), 2.0 / (high - low));
        let charges = branch
            .chunks_exact_mut(lanes)
            .zip(burl.chunks_exact_mut(lanes));
        let columns = radius
            .chunks_exact_mut(lanes)
            .zip(energy.chunks_exact_mut(lanes));
        let places = distance
            .chunks_exact(lanes)
            .zip(self.position[2].chunks_exact(lanes));
        for (((radius, energy), (branch, burl)), (distance, z)) in columns.zip(charges).zip(places)
        {
            let of_branches = S::f32s::from_slice(simd, branch);
            let of_burls = S::f32s::from_slice(simd, burl);
            let whole = S::f32s::from_slice(simd, energy) + of_branches + of_burls;
            let found = match self.kernel.model.reference {
                Reference::Endless => {
                    S::f32s::from_slice(simd, distance)
                        * half_exponential(simd, of_branches + of_burls)
                }
                Reference::Middle => inverse_sinh(simd, whole)[0] * self.kernel.half_length,
                Reference::Local => {
                    let [inverse, tanh] = inverse_sinh(simd, whole);
                    let along = (S::f32s::from_slice(simd, z) - middle) * per_half * tanh;
                    let narrower = (-along * along + 1.0).max(0.0).sqrt();
                    inverse * narrower * self.kernel.half_length
                }
            };
            found.store_slice(radius);
            whole.store_slice(energy);
            (-half_exponential(simd, of_branches) + 1.0).store_slice(branch);
            (-half_exponential(simd, of_burls) + 1.0).store_slice(burl);
        }
    }
}

/// Offsets shorter than this in mm have no direction; quotients by it are finite.
const NO_LENGTH: f32 = 1e-20;

/// Writes where points would be if rings were circles about an upright axis: at the radius of their ring.
#[simd]
fn bare_places<S: Simd>(
    simd: S,
    [dx, dy]: [&[f32]; 2],
    [radius, wave]: [&[f32]; 2],
    [x, y]: [&mut [f32]; 2],
) {
    let lanes = S::f32s::LEN;
    for start in (0..radius.len()).step_by(lanes) {
        let range = start..start + lanes;
        let load = |column: &[f32]| S::f32s::from_slice(simd, &column[range.clone()]);
        let (dx, dy) = (load(dx), load(dy));
        let ring = (load(radius) - load(wave)).max(0.0);
        // On the axis, beyond the ends of a rod, rings have a radius but no direction.
        let scale = ring / (dx * dx + dy * dy).sqrt().max(NO_LENGTH);
        (dx * scale).store_slice(&mut x[range.clone()]);
        (dy * scale).store_slice(&mut y[range.clone()]);
    }
}
