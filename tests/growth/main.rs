//! Growth along curved skeletons: known numbers, laws, and the kernel against double precision.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod continuity;
mod kernel;
mod log;
mod nodes;
mod straight;
mod vectors;

#[path = "../support/levels.rs"]
mod levels;

use fearless_simd::Level;
use glam::DVec3;
use std::sync::Arc;
use yosegi::field::{Field, Program, RunContext, Samples, Scratch};
use yosegi::nodes::wood::growth::{GrowthKernel, GrowthModel, GrowthSettings};
use yosegi::value::{Branch, Domain, Skeleton, Tangents, Thickness};

/// Both outputs of a kernel.
#[derive(Clone, Debug, PartialEq)]
struct Grown {
    time: Vec<f32>,
    branch: Vec<f32>,
}

impl Grown {
    fn bits(&self) -> Vec<[u32; 2]> {
        self.time
            .iter()
            .zip(&self.branch)
            .map(|(t, b)| [t.to_bits(), b.to_bits()])
            .collect()
    }
}

/// The field of a model, as `growth_field` makes it.
fn field(model: &GrowthModel) -> Field {
    let kernel = Arc::new(GrowthKernel::new(model.clone()));
    Field::kernel(
        &Arc::from("growth"),
        kernel,
        vec![Field::position(Domain::Solid)],
    )
}

/// The kernel's results at some samples.
fn grow(model: &GrowthModel, samples: &Samples<'_>, level: Level) -> Grown {
    let program = Program::compile(&[field(model)]);
    let mut scratch = Scratch::default();
    program.run(
        samples,
        &mut scratch,
        &RunContext {
            level,
            cache: None,
            filtering: true,
            cancel: None,
        },
    );
    let column = |column| program.output(&scratch, 0, column)[..samples.len()].to_vec();
    Grown {
        time: column(0),
        branch: column(1),
    }
}

fn grow_at(model: &GrowthModel, points: &[DVec3]) -> Grown {
    let points: Vec<_> = points.iter().map(DVec3::to_array).collect();
    grow(model, &Samples::Points(&points), Level::new())
}

/// The point as the kernel receives it.
fn rounded(point: DVec3) -> DVec3 {
    point.as_vec3().as_dvec3()
}

/// A reproducible number from 0 to 1.
fn uniform(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// `count` points in a box.
fn scattered(count: usize, low: DVec3, high: DVec3) -> Vec<DVec3> {
    let mut state = 7;
    let mut point = || {
        let amount = DVec3::new(
            uniform(&mut state),
            uniform(&mut state),
            uniform(&mut state),
        );
        rounded(low + (high - low) * amount)
    };
    (0..count).map(|_| point()).collect()
}

fn settings(sharpness: f64) -> GrowthSettings {
    GrowthSettings {
        elongation: 420.0,
        thickening: 2.4,
        sharpness,
        reach: None,
    }
}

/// A crooked tree 2.4 m high with three branches.
fn tree() -> Skeleton {
    let nodes = [
        (0.0, 0.0, 0.0),
        (12.0, 4.0, 500.0),
        (-20.0, 15.0, 1100.0),
        (-6.0, 9.0, 1700.0),
        (30.0, -12.0, 2400.0),
    ];
    let branch = |height, direction, speed| Branch {
        height,
        direction: DVec3::from(direction).normalize(),
        thickness: Thickness::Speed(speed),
        length: None,
    };
    Skeleton {
        trunk: nodes.map(DVec3::from).to_vec(),
        tangents: Tangents::Natural,
        branches: vec![
            branch(700.0, (1.0, 0.2, 0.5), 0.5),
            branch(1200.0, (-0.4, 1.0, 0.3), 0.4),
            branch(1210.0, (0.3, -1.0, 0.6), 0.8),
        ],
    }
}
