//! Laws of noise and distortion: known values, statistics, filtering, and independence of the machine.

use super::lattice::gradient_noise;
use super::{distort, plane_noise, solid_noise};
use crate::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};
use crate::key::Key;
use crate::node::{Build, Inputs, Kind};
use crate::value::{Domain, Material, Value};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};
use fearless_simd_macros::simd;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The outputs of a noise node.
fn noise(
    kind: &'static Kind,
    seeds: [u64; 2],
    size: f64,
    octaves: i64,
    form: &'static str,
) -> [Field; 2] {
    let values = [
        Value::Vector(DVec3::splat(size)),
        Value::Whole(octaves),
        Value::Number(0.5),
        Value::Number(2.0),
        Value::Choice(form),
        Value::Whole(seeds[1] as i64),
    ]
    .map(Some);
    build(kind, &values, seeds[0]).map(|value| match value {
        Value::Field(field) => field,
        other => panic!("expected a field, found a {}", other.type_name()),
    })
}

fn build<const N: usize>(kind: &'static Kind, values: &[Option<Value>], seed: u64) -> [Value; N] {
    let node: Arc<str> = Arc::from("node");
    let context = Build { node: &node, seed };
    (kind.build)(&Inputs::new(kind, values), &context)
        .expect("the inputs are right")
        .try_into()
        .expect("as many outputs as declared")
}

fn run(field: &Field, samples: &Samples<'_>, level: Level) -> Vec<Vec<f32>> {
    let program = Program::compile(std::slice::from_ref(field));
    let mut scratch = Scratch::default();
    let context = RunContext {
        level,
        cache: None,
        filtering: true,
    };
    program.run(samples, &mut scratch, &context);
    let columns = program.columns(&scratch, 0);
    columns
        .iter()
        .map(|column| column[..samples.len()].to_vec())
        .collect()
}

fn at_points(field: &Field, points: &[[f64; 3]]) -> Vec<f32> {
    run(field, &Samples::Points(points), Level::new()).remove(0)
}

/// Points without a pattern that a lattice could share.
fn points(count: usize, scale: f64) -> Vec<[f64; 3]> {
    let share = |i: usize, step: f64| (i as f64 * step).fract() * scale - 0.4 * scale;
    (0..count)
        .map(|i| {
            [
                share(i, 0.754_877_666),
                share(i, 0.569_840_291),
                share(i, 0.438_578_909),
            ]
        })
        .collect()
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[simd]
fn lattice_at<S: Simd>(simd: S, at: [f32; 3], seed: u32) -> f32 {
    let [noise] = gradient_noise(simd, at.map(|part| S::f32s::splat(simd, part)), seed);
    noise[0]
}

#[test]
fn gradient_noise_is_zero_at_lattice_points_and_has_the_slope_of_a_gradient() {
    for cell in [
        [0.0, 0.0, 0.0],
        [3.0, -7.0, 1.0],
        [-90_001.0, 5_000.0, 12.0],
    ] {
        let value = |at: [f32; 3]| dispatch!(Level::new(), simd => lattice_at(simd, at, 5));
        assert_eq!(value(cell), 0.0);
        let step = 1.0 / 128.0;
        let mut slopes = [0, 1, 2].map(|axis| {
            let mut at = cell;
            at[axis] += step;
            (value(at) / step).abs()
        });
        slopes.sort_by(f32::total_cmp);
        // A gradient of Perlin 2002 has one part 0 and two of size 1.
        assert!(
            slopes[0] < 0.01 && slopes[1] > 0.98 && slopes[2] < 1.02,
            "{slopes:?}"
        );
    }
}

#[test]
fn coordinates_beyond_all_cells_give_the_border() {
    for far in [3e9, 1e30, f32::INFINITY] {
        let value = |x: f32| dispatch!(Level::new(), simd => lattice_at(simd, [x, 0.3, 0.6], 1));
        assert_eq!(value(far), value(1_073_741_824.0));
        assert_eq!(value(-far), value(-1_073_741_824.0));
    }
}

#[test]
fn statistics_are_as_stated() {
    let points = points(200_000, 4000.0);
    let statistics = |form, octaves| {
        let values = at_points(
            &noise(&solid_noise::KIND, [0, 1], 3.0, octaves, form)[0],
            &points,
        );
        assert!(values.iter().all(|value| value.abs() < 1.04));
        let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64;
        let squares = values.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
        (mean, squares / values.len() as f64 - mean * mean)
    };
    let (mean, variance) = statistics("fbm", 1);
    assert!(mean.abs() < 0.002, "{mean}");
    assert!((variance - 0.073).abs() < 0.003, "{variance}");
    // Octaves do not know each other: variances add up.
    let (mean, of_three) = statistics("fbm", 3);
    let expected = variance * (1.0 + 0.25 + 0.0625) / (1.75 * 1.75);
    assert!(
        mean.abs() < 0.002 && (of_three / expected - 1.0).abs() < 0.03,
        "{of_three} {expected}"
    );
    let (mean_size, _) = statistics("billow", 1);
    let mean_size = 0.5 * (mean_size + 1.0);
    assert!(
        (mean_size - f64::from(super::octaves::MEAN_SIZE)).abs() < 0.002,
        "{mean_size}"
    );
    assert!((statistics("ridged", 1).0 - (1.0 - 2.0 * mean_size)).abs() < 0.002);
}

#[test]
fn directions_columns_and_seeds_have_nothing_in_common() {
    let points = points(50_000, 1000.0);
    let [value, vector] = noise(&solid_noise::KIND, [0, 1], 3.0, 1, "fbm");
    let mut columns = run(&vector, &Samples::Points(&points), Level::new());
    columns.push(at_points(&value, &points));
    for seeds in [[1, 1], [0, 2], [u64::MAX, 1]] {
        columns.push(at_points(
            &noise(&solid_noise::KIND, seeds, 3.0, 1, "fbm")[0],
            &points,
        ));
    }
    for axis in 0..3 {
        let shifted = points.iter().map(|point| {
            let mut point = *point;
            point[axis] += 3.0;
            point
        });
        columns.push(at_points(&value, &shifted.collect::<Vec<_>>()));
    }
    for (index, a) in columns.iter().enumerate() {
        for b in &columns[..index] {
            let product: f32 = a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>() / a.len() as f32;
            assert!(product.abs() < 0.073 * 0.08, "{index}: {product}");
        }
    }
}

#[test]
fn every_level_and_every_block_gives_the_same_bits() {
    let points = points(1000, 5000.0);
    for form in ["fbm", "ridged"] {
        let [_, vector] = noise(&solid_noise::KIND, [3, 1], 0.7, 4, form);
        let expected = run(&vector, &Samples::Points(&points), Level::baseline());
        let parts = [&points[..37], &points[37..]]
            .map(|points| run(&vector, &Samples::Points(points), Level::new()));
        for (column, expected) in expected.iter().enumerate() {
            let joined = [&parts[0][column][..], &parts[1][column]].concat();
            assert_eq!(bits(&joined), bits(expected));
        }
        for level in levels() {
            let found = run(&vector, &Samples::Points(&points), level);
            for (found, expected) in found.iter().zip(&expected) {
                assert_eq!(bits(found), bits(expected), "{level:?}");
            }
        }
    }
}

/// Every level of vector instructions that this machine has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![best];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        levels.extend(best.as_avx2().map(Level::Avx2));
    }
    levels
}

/// A plane with pixels of some mm.
struct Pixels(f64);

impl Target for Pixels {
    fn key(&self) -> Key {
        Key::of_bytes(&self.0.to_le_bytes())
    }

    fn pixels(&self) -> [u32; 2] {
        [4096; 2]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        for (index, u) in u.iter_mut().enumerate() {
            *u = (self.0 * (x + index as f64 * step)) as f32;
        }
        v.fill((self.0 * y) as f32);
        w.fill(0.0);
    }
}

/// A square of pixels of `side` mm, `count` in a row.
fn painted(field: &Field, side: f64, count: u32) -> Vec<f32> {
    let samples = Samples::Grid {
        target: &Pixels(side),
        grid: PixelGrid::tile([0, 0], [count; 2], 1),
    };
    let width = count as usize + 2;
    let column = run(field, &samples, Level::new()).remove(0);
    let rows = column.chunks(width).skip(1).take(count as usize);
    rows.flat_map(|row| row[1..width - 1].to_vec()).collect()
}

#[test]
fn a_coarse_picture_is_the_mean_of_a_fine_one() {
    let fineness = 8;
    for form in ["fbm", "ridged", "billow"] {
        let field = &noise(&plane_noise::KIND, [0, 1], 1.0, 1, form)[0];
        let mut worst = 0.0f64;
        for side in [0.1, 0.25, 0.5, 0.7, 1.0, 1.5, 3.0] {
            let count = 40;
            let fine = painted(field, side / f64::from(fineness), count * fineness);
            let coarse = painted(field, side, count);
            let (mut squares, step) = (0.0, fineness as usize);
            for (index, coarse) in coarse.iter().enumerate() {
                let (x, y) = (index % count as usize * step, index / count as usize * step);
                let rows = (y..y + step).map(|y| y * count as usize * step + x);
                let mean = rows
                    .flat_map(|start| &fine[start..start + step])
                    .sum::<f32>();
                squares += f64::from(mean / (step * step) as f32 - coarse).powi(2);
            }
            let error = (squares / coarse.len() as f64).sqrt();
            worst = worst.max(error);
        }
        // No weight of a single sample could give less than 0.087 and 0.106.
        let allowed = if form == "fbm" { 0.1 } else { 0.12 };
        assert!(worst < allowed, "{form}: {worst}");
    }
}

#[test]
fn nothing_is_left_of_noise_much_finer_than_a_pixel() {
    for (form, mean) in [
        ("fbm", 0.0),
        ("billow", 2.0 * super::octaves::MEAN_SIZE - 1.0),
    ] {
        let [value, _] = noise(&plane_noise::KIND, [0, 1], 0.1, 5, form);
        assert!(painted(&value, 1.0, 16).iter().all(|value| *value == mean));
    }
}

#[test]
fn distortion_by_a_constant_is_a_shift() {
    let [field, _] = noise(&solid_noise::KIND, [0, 1], 3.0, 2, "fbm");
    let constant = Field::constant(0.5);
    let solid = Material {
        domain: Domain::Solid,
        channels: BTreeMap::from([
            ("height".into(), field.clone()),
            ("roughness".into(), constant),
        ]),
        size: None,
    };
    let values = [
        Value::Material(Arc::new(solid)),
        Value::Vector(DVec3::new(1.0, -2.0, 0.5)),
        Value::Vector(DVec3::new(0.5, 0.25, 8.0)),
    ]
    .map(Some);
    let [Value::Material(bent)] = build(&distort::KIND, &values, 0) else {
        panic!("distort gives a material")
    };
    assert_eq!(bent.domain, Domain::Solid);
    assert_eq!(bent.channels["roughness"].as_constant(), Some(&[0.5][..]));
    // Sums without rounding, so that the bits agree.
    let points: Vec<_> = (0..200)
        .map(|i| [f64::from(i) * 0.125, 3.0 - f64::from(i) * 0.25, 7.75])
        .collect();
    let shifted: Vec<_> = points
        .iter()
        .map(|[x, y, z]| [x + 0.5, y - 0.5, z + 4.0])
        .collect();
    assert_eq!(
        bits(&at_points(&bent.channels["height"], &points)),
        bits(&at_points(&field, &shifted))
    );
}
