//! Virtual energy: known numbers, laws, and the kernel against double precision.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod kernel;
mod laws;
mod nodes;
mod vectors;

#[path = "../support/levels.rs"]
mod levels;

use fearless_simd::Level;
use glam::DVec3;
use std::sync::Arc;
use yosegi::field::{Field, Program, RunContext, Samples, Scratch};
use yosegi::nodes::wood::energy::{Axis, Burl, EnergyKernel, EnergyModel, Reference, Rod, Wave};
use yosegi::value::{Domain, Skeleton, Tangents};

/// The columns of the kernel at points: radius, energy, branch, burl and wave.
fn columns(model: &EnergyModel, points: &[DVec3], level: Level) -> Vec<Vec<f32>> {
    let kernel = Arc::new(EnergyKernel::new(model.clone()));
    let inputs = vec![Field::position(Domain::Solid)];
    let program = Program::compile(&[Field::kernel(&Arc::from("energy"), kernel, inputs)]);
    let points: Vec<[f64; 3]> = points.iter().map(DVec3::to_array).collect();
    let context = RunContext {
        level,
        cache: None,
        filtering: true,
        cancel: None,
    };
    let mut scratch = Scratch::default();
    program.run(&Samples::Points(&points), &mut scratch, &context);
    (0..EnergyKernel::WIDTH)
        .map(|column| program.output(&scratch, 0, column)[..points.len()].to_vec())
        .collect()
}

/// A reproducible number from 0 to 1.
fn uniform(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// `count` points in a box, as the kernel receives them.
fn scattered(count: usize, low: DVec3, high: DVec3) -> Vec<DVec3> {
    let mut state = 11;
    let mut share = || uniform(&mut state);
    let mut point = || low + (high - low) * DVec3::new(share(), share(), share());
    (0..count).map(|_| point().as_vec3().as_dvec3()).collect()
}

fn skeleton(trunk: &[[f64; 3]]) -> Skeleton {
    Skeleton {
        trunk: trunk.iter().copied().map(DVec3::from).collect(),
        tangents: Tangents::Natural,
        branches: vec![],
    }
}

/// A crooked trunk 2.4 m high with three branches, six burls and four waves.
fn tree(reference: Reference, is_straight: bool) -> EnergyModel {
    let trunk = skeleton(&[
        [0.0, 0.0, 0.0],
        [12.0, 4.0, 500.0],
        [-20.0, 9.0, 1300.0],
        [5.0, -8.0, 2400.0],
    ]);
    let axis = Axis::new(&trunk, is_straight).unwrap();
    let mut model = EnergyModel::bare(axis, reference);
    let rod = |height: f64, along: [f64; 3], charge| {
        let start = model.axis.at(height);
        Rod::between(start, start + DVec3::from(along), charge)
    };
    model.branches = vec![
        rod(400.0, [300.0, 40.0, 180.0], 0.3),
        rod(900.0, [-250.0, 120.0, 90.0], 0.2),
        rod(1700.0, [20.0, -400.0, 350.0], 0.45),
    ];
    let mut state = 5;
    model.burls = (0..6)
        .map(|_| Burl {
            centre: DVec3::new(
                300.0 * uniform(&mut state) - 150.0,
                300.0 * uniform(&mut state) - 150.0,
                2400.0 * uniform(&mut state),
            ),
            charge: 1.0 + 6.0 * uniform(&mut state),
        })
        .collect();
    let wave = |amplitude, length: f64, turns, phase| Wave {
        amplitude,
        per_millimetre: 1.0 / length,
        turns,
        phase,
    };
    model.waves = vec![
        wave(1.6, 26.0, 2, 0.0),
        wave(0.9, 17.0, -3, 0.2),
        wave(0.6, 11.0, 7, 0.7),
        wave(2.0, 140.0, 0, 0.9),
    ];
    model
}
