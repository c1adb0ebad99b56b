//! The kernel against the model in double precision, and what its results do not depend on.

use super::levels::levels;
use super::{Grown, field, grow, grow_at, rounded, scattered, settings, tree};
use fearless_simd::Level;
use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use yosegi::field::{PixelGrid, Samples, Target};
use yosegi::key::{Key, KeyHasher};
use yosegi::nodes::wood::growth::{GrowthModel, GrowthSettings, Reach};
use yosegi::value::{Branch, Skeleton, Tangents, Thickness};

const WITH_REACH: Option<Reach> = Some(Reach {
    along: 260.0,
    across: 90.0,
});

fn model(skeleton: &Skeleton, sharpness: f64, reach: Option<Reach>) -> GrowthModel {
    GrowthModel::new(
        skeleton,
        GrowthSettings {
            reach,
            ..settings(sharpness)
        },
    )
    .unwrap()
}

/// Times within 1e-5 of the largest, shares within 2e-5, outside a ball of a thousandth of the trunk's
/// length round every start.
fn assert_agrees(model: &GrowthModel, points: &[DVec3]) {
    let [lowest, highest] = model.trunk.heights();
    let outside = |point: &&DVec3| {
        let far = |start: DVec3| start.distance(**point) > 1e-3 * (highest - lowest);
        model.branches.iter().all(|branch| far(branch.start))
    };
    let points: Vec<DVec3> = points
        .iter()
        .filter(outside)
        .map(|point| rounded(*point))
        .collect();
    let expected: Vec<_> = points.iter().map(|point| model.terms(*point)).collect();
    let largest = expected
        .iter()
        .map(|terms| terms.time.abs())
        .fold(0.0, f64::max);
    let found = grow_at(model, &points);
    for (index, expected) in expected.iter().enumerate() {
        let (time, branch) = (f64::from(found.time[index]), f64::from(found.branch[index]));
        let at = points[index];
        assert!(
            (time - expected.time).abs() <= 1e-5 * largest,
            "T at {at}: expected {}, found {time}, largest {largest}",
            expected.time
        );
        // Below the ground the share jumps where the smallest time does.
        assert!(
            (branch - expected.branch).abs() <= 2e-5 || expected.time < 1e-4 * largest,
            "share at {at}: expected {}, found {branch}",
            expected.branch
        );
    }
}

#[test]
fn every_sharpness_agrees_with_double_precision_with_and_without_reach() {
    let points = scattered(
        4000,
        DVec3::new(-250.0, -250.0, -60.0),
        DVec3::new(250.0, 250.0, 2600.0),
    );
    for sharpness in [1.0, 2.0, 3.3, 4.0, 8.0, 16.0] {
        for reach in [None, WITH_REACH] {
            assert_agrees(&model(&tree(), sharpness, reach), &points);
        }
    }
}

prop_compose! {
    fn skeletons()(
        local in any::<bool>(),
        below in -300.0..300.0f64,
        nodes in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, 1.0..3.0f64), 2..9),
        branches in prop::collection::vec(
            (0.0..1.0f64, (-1.0..1.0f64, -1.0..1.0f64, -0.5..1.0f64), 0.05..2.0f64), 0..6),
    ) -> Skeleton {
        let mut z = below;
        let trunk: Vec<DVec3> = nodes.iter().map(|(x, y, dz)| {
            z += 150.0 * dz;
            DVec3::new(60.0 * x, 60.0 * y, z)
        }).collect();
        let [low, high] = [trunk[0].z, trunk[trunk.len() - 1].z];
        let branches = branches.iter().map(|(at, direction, speed)| Branch {
            height: low + at * (high - low),
            direction: DVec3::from(*direction).normalize_or(DVec3::X),
            thickness: Thickness::Speed(*speed),
            length: None,
        }).collect();
        let tangents = if local { Tangents::Local } else { Tangents::Natural };
        Skeleton { trunk, tangents, branches }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn random_trees_agree_with_double_precision(
        skeleton in skeletons(),
        elongation in 100.0..900.0f64,
        thickening in 0.5..6.0f64,
        sharpness in prop_oneof![Just(2.0), Just(4.0), 1.0..16.0f64],
        reach in prop::option::of((50.0..400.0f64, 20.0..200.0f64)),
    ) {
        let reach = reach.map(|(along, across)| Reach { along, across });
        let settings = GrowthSettings { elongation, thickening, sharpness, reach };
        let model = GrowthModel::new(&skeleton, settings).unwrap();
        let [low, high] = model.trunk.heights();
        let points = scattered(400, DVec3::new(-200.0, -200.0, low - 100.0), DVec3::new(200.0, 200.0, high + 200.0));
        assert_agrees(&model, &points);
    }
}

#[test]
fn near_the_start_of_a_branch_no_digits_are_lost() {
    let model = model(&tree(), 2.0, None);
    let near = |branch: usize| {
        let around = DVec3::splat(6.0);
        scattered(
            2000,
            model.branches[branch].start - around,
            model.branches[branch].start + around,
        )
    };
    (0..3).for_each(|branch| assert_agrees(&model, &near(branch)));
}

#[test]
fn points_on_the_axes_and_at_the_starts_have_times() {
    let model = model(&tree(), 2.0, None);
    let mut points = vec![DVec3::ZERO, DVec3::new(0.0, 0.0, -5.0)];
    for branch in &model.branches {
        points.extend([0.0, 1e-3, 1.0, 50.0].map(|s| branch.start + branch.direction * s));
    }
    let found = grow_at(&model, &points);
    assert!(
        found
            .time
            .iter()
            .chain(&found.branch)
            .all(|value| value.is_finite())
    );
    assert_agrees(&model, &points);
}

#[test]
fn every_level_of_vector_instructions_gives_the_same_bits() {
    let points: Vec<_> = scattered(
        3001,
        DVec3::new(-250.0, -250.0, -60.0),
        DVec3::new(250.0, 250.0, 2600.0),
    )
    .iter()
    .map(DVec3::to_array)
    .collect();
    for sharpness in [2.0, 8.0, 3.3] {
        for reach in [None, WITH_REACH] {
            let model = model(&tree(), sharpness, reach);
            let at = |level| grow(&model, &Samples::Points(&points), level).bits();
            let expected = at(Level::baseline());
            levels()
                .into_iter()
                .for_each(|level| assert!(at(level) == expected, "{level:?}"));
        }
    }
}

/// A plane that cuts the tree at an angle.
struct Slice {
    origin: DVec3,
    right: DVec3,
    down: DVec3,
}

impl Target for Slice {
    fn key(&self) -> Key {
        KeyHasher::new("test slice", 1).finish()
    }

    fn pixels(&self) -> [u32; 2] {
        [200, 160]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, row: [&mut [f32]; 3]) {
        for (axis, row) in row.into_iter().enumerate() {
            for (index, value) in row.iter_mut().enumerate() {
                let x = x + index as f64 * step;
                *value = (self.origin[axis] + x * self.right[axis] + y * self.down[axis]) as f32;
            }
        }
    }
}

const SLICE: Slice = Slice {
    origin: DVec3::new(-160.0, -60.0, 950.0),
    right: DVec3::new(1.9, 0.3, 0.2),
    down: DVec3::new(0.1, 0.5, 3.1),
};

fn tile(model: &GrowthModel, corner: [u32; 2], size: [u32; 2]) -> Grown {
    let grid = PixelGrid::tile(corner, size, 0);
    grow(
        model,
        &Samples::Grid {
            target: &SLICE,
            grid,
        },
        Level::new(),
    )
}

#[test]
fn tiles_give_the_bits_of_the_whole() {
    for sharpness in [2.0, 3.3] {
        for reach in [None, WITH_REACH] {
            let model = model(&tree(), sharpness, reach);
            let whole = tile(&model, [0, 0], [200, 160]).bits();
            for (corner, size) in [
                ([3, 5], [190, 31]),
                ([77, 11], [17, 129]),
                ([199, 0], [1, 160]),
            ] {
                let part = tile(&model, corner, size).bits();
                for (row, part) in part.chunks(size[0] as usize).enumerate() {
                    let start = (corner[1] as usize + row) * 200 + corner[0] as usize;
                    assert_eq!(part, &whole[start..start + size[0] as usize]);
                }
            }
        }
    }
}

/// A tree with `count` branches all round.
fn bushy(count: usize) -> Skeleton {
    let branch = |index: usize| {
        let share = index as f64 / count as f64;
        let azimuth = 2.4 * index as f64;
        Branch {
            height: 100.0 + 2200.0 * share,
            direction: DVec3::new(libm::cos(azimuth), libm::sin(azimuth), 0.4).normalize(),
            thickness: Thickness::Speed(0.3 + 0.2 * share),
            length: None,
        }
    };
    Skeleton {
        branches: (0..count).map(branch).collect(),
        ..tree()
    }
}

#[test]
fn many_branches_with_reach_are_found_by_the_tree() {
    let reach = Some(Reach {
        along: 120.0,
        across: 30.0,
    });
    let points = scattered(
        1500,
        DVec3::new(-150.0, -150.0, 50.0),
        DVec3::new(150.0, 150.0, 2450.0),
    );
    for count in [16, 17, 600] {
        assert_agrees(&model(&bushy(count), 2.0, reach), &points);
    }
    let dense = model(&bushy(600), 2.0, reach);
    let whole = tile(&dense, [0, 0], [200, 160]).bits();
    let part = tile(&dense, [37, 51], [101, 60]).bits();
    for (row, part) in part.chunks(101).enumerate() {
        let start = (51 + row) * 200 + 37;
        assert_eq!(part, &whole[start..start + 101]);
    }
}

#[test]
fn beyond_the_reach_a_branch_changes_no_bit() {
    let skeleton = tree();
    let bare = Skeleton {
        branches: vec![],
        ..skeleton.clone()
    };
    let reach = Reach {
        along: 260.0,
        across: 90.0,
    };
    let points = scattered(
        5000,
        DVec3::new(-250.0, -250.0, 400.0),
        DVec3::new(250.0, 250.0, 1700.0),
    );
    for sharpness in [2.0, 3.3, 8.0] {
        let model = model(&skeleton, sharpness, Some(reach));
        let found = grow_at(&model, &points);
        let trunk = grow_at(&self::model(&bare, sharpness, None), &points);
        let (mut beyond, mut within) = (0, 0);
        for (index, point) in points.iter().enumerate() {
            if model.terms(*point).branches.iter().all(Option::is_none) {
                beyond += 1;
                assert_eq!(found.time[index].to_bits(), trunk.time[index].to_bits());
                assert_eq!(found.branch[index].to_bits(), 0);
            } else {
                within += 1;
                assert!(found.time[index] <= trunk.time[index]);
            }
        }
        assert!(beyond > 1000 && within > 100, "{beyond} {within}");
    }
}

#[test]
fn everything_that_matters_is_in_the_key() {
    let key =
        |skeleton: &Skeleton, settings| field(&GrowthModel::new(skeleton, settings).unwrap()).key();
    let (tree, plain) = (tree(), settings(2.0));
    let original = key(&tree, plain);
    assert_eq!(original, key(&tree.clone(), plain));
    let mut bent = tree.clone();
    bent.trunk[1].x += 1e-9;
    let mut thicker = tree.clone();
    thicker.branches[1].thickness = Thickness::Speed(0.41);
    let mut turned = tree.clone();
    turned.branches[2].direction = DVec3::X;
    let mut others = vec![key(&bent, plain), key(&thicker, plain), key(&turned, plain)];
    others.push(key(
        &Skeleton {
            tangents: Tangents::Local,
            ..tree.clone()
        },
        plain,
    ));
    others.push(key(
        &tree,
        GrowthSettings {
            elongation: 421.0,
            ..plain
        },
    ));
    others.push(key(
        &tree,
        GrowthSettings {
            thickening: 2.5,
            ..plain
        },
    ));
    others.push(key(
        &tree,
        GrowthSettings {
            sharpness: 2.5,
            ..plain
        },
    ));
    others.push(key(
        &tree,
        GrowthSettings {
            reach: WITH_REACH,
            ..plain
        },
    ));
    others.push(original);
    let count = others.len();
    others.sort();
    others.dedup();
    assert_eq!(others.len(), count);
}
