//! What the benchmark paints: an oblique plane through trees of several sizes.

use glam::DVec3;
use yosegi::field::Target;
use yosegi::key::{Key, KeyHasher};
use yosegi::nodes::wood::growth::{GrowthModel, GrowthSettings, Reach};
use yosegi::value::{AfterEnd, Branch, ColourPattern, Skeleton, Tangents, Thickness};

/// Pixels along each side of the picture.
pub(crate) const SIZE: u32 = 2048;

const HEIGHT: f64 = 2400.0;

/// A plane on which x, y and z all vary along rows and columns.
pub(crate) struct Plane;

impl Target for Plane {
    fn key(&self) -> Key {
        KeyHasher::new("bench plane", 1).finish()
    }

    fn pixels(&self) -> [u32; 2] {
        [SIZE, SIZE]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, row: [&mut [f32]; 3]) {
        let scale = 1.0 / f64::from(SIZE);
        let right = DVec3::new(380.0, 60.0, 400.0) * scale;
        let down = DVec3::new(-20.0, 180.0, 1800.0) * scale;
        let origin = DVec3::new(-180.0, -120.0, 100.0) + right * x + down * y;
        for (axis, row) in row.into_iter().enumerate() {
            let (origin, step) = (origin[axis], step * right[axis]);
            for (index, value) in (0i32..).zip(row) {
                *value = (origin + f64::from(index) * step) as f32;
            }
        }
    }
}

/// A tree with unevenly spaced nodes.
pub(crate) fn model(
    nodes: usize,
    branches: usize,
    reach: Option<Reach>,
    sharpness: f64,
) -> GrowthModel {
    grown(&skeleton(nodes, branches), reach, sharpness)
}

/// A tree with 100 branches in every 2400 mm of its height.
pub(crate) fn tall(times: usize, reach: Option<Reach>) -> GrowthModel {
    let mut skeleton = skeleton(64, 100);
    let (trunk, branches) = (skeleton.trunk.clone(), skeleton.branches.clone());
    for floor in (1..times).map(|floor| HEIGHT * floor as f64) {
        // The first node of a floor would lie on the last one of the floor below.
        let above = |node: &DVec3| *node + DVec3::Z * floor;
        skeleton.trunk.extend(trunk[1..].iter().map(above));
        let above = |branch: &Branch| Branch {
            height: branch.height + floor,
            ..*branch
        };
        skeleton.branches.extend(branches.iter().map(above));
    }
    grown(&skeleton, reach, 2.0)
}

/// One year in 256 texels.
pub(crate) fn year() -> ColourPattern {
    let colour = |index: usize| {
        let late = index as f32 / 256.0;
        [
            0.7 - 0.4 * late * late,
            0.5 - 0.3 * late,
            0.3 - 0.2 * late * late,
        ]
    };
    ColourPattern {
        colours: (0..256).map(colour).collect(),
        years: 1.0,
        ring_starts: vec![0.0],
        after_end: AfterEnd::Repeat,
        smooth: true,
    }
}

fn grown(skeleton: &Skeleton, reach: Option<Reach>, sharpness: f64) -> GrowthModel {
    let settings = GrowthSettings {
        elongation: 420.0,
        thickening: 2.4,
        sharpness,
        reach,
    };
    GrowthModel::new(skeleton, settings).expect("the bench's tree is sound")
}

fn skeleton(nodes: usize, branches: usize) -> Skeleton {
    let node = |index: usize| {
        let last = (nodes - 1) as f64;
        let share = index as f64 / last;
        let uneven = if index == 0 || index == nodes - 1 {
            0.0
        } else {
            0.3 / last * libm::sin(1.7 * index as f64)
        };
        DVec3::new(
            40.0 * libm::sin(7.0 * share),
            30.0 * libm::cos(5.0 * share),
            HEIGHT * (share + uneven),
        )
    };
    let branch = |index: usize| {
        let share = (index as f64 + 0.5) / branches as f64;
        let azimuth = 2.1 * index as f64;
        Branch {
            height: HEIGHT * share,
            direction: DVec3::new(libm::cos(azimuth), libm::sin(azimuth), 0.5).normalize(),
            thickness: Thickness::Speed(0.5),
            length: None,
        }
    };
    Skeleton {
        trunk: (0..nodes).map(node).collect(),
        tangents: Tangents::Natural,
        branches: (0..branches).map(branch).collect(),
    }
}
