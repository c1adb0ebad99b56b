//! Laws of noise: known values, statistics, and independence of the machine.

mod bend;
mod pixels;
mod repeats;

use super::form::{Form, MEAN_SIZE, VARIANCE};
use super::lattice::gradient_noise;
use super::{plane_noise, solid_noise};
use crate::field::{Field, Program, RunContext, Samples, Scratch};
use crate::node::{Build, Failure, Inputs, Kind};
use crate::value::Value;
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};
use fearless_simd_macros::simd;
use glam::DVec3;
use std::sync::Arc;

/// The inputs of a noise node.
#[derive(Clone, Copy)]
struct Noise {
    kind: &'static Kind,
    recipe_seed: u64,
    seed: i64,
    size: [f64; 3],
    octaves: i64,
    lacunarity: f64,
    form: &'static str,
    period: [f64; 3],
}

/// One octave of solid noise with features of 3 mm.
const PLAIN: Noise = Noise {
    kind: &solid_noise::KIND,
    recipe_seed: 0,
    seed: 1,
    size: [3.0; 3],
    octaves: 1,
    lacunarity: 2.0,
    form: "fbm",
    period: [0.0; 3],
};

impl Noise {
    fn try_build(self) -> Result<Vec<Value>, Failure> {
        let value = |name| match name {
            "size" => Value::Vector(DVec3::from(self.size)),
            "octaves" => Value::Whole(self.octaves),
            "gain" => Value::Number(0.5),
            "lacunarity" => Value::Number(self.lacunarity),
            "form" => Value::Choice(self.form),
            "period" => Value::Vector(DVec3::from(self.period)),
            "variant" => Value::Number(0.0),
            _ => Value::Whole(self.seed),
        };
        let values: Vec<_> = self
            .kind
            .inputs
            .iter()
            .map(|input| Some(value(input.name)))
            .collect();
        build(self.kind, &values, self.recipe_seed)
    }

    /// The value and the vector.
    fn fields(self) -> [Field; 2] {
        let field = |value| match value {
            Value::Field(field) => field,
            other => panic!("expected a field, found a {}", other.type_name()),
        };
        let fields: Vec<_> = self
            .try_build()
            .expect("the inputs are right")
            .into_iter()
            .map(field)
            .collect();
        fields.try_into().expect("a value and a vector")
    }

    fn value(self) -> Field {
        let [value, _] = self.fields();
        value
    }
}

fn build(kind: &'static Kind, values: &[Option<Value>], seed: u64) -> Result<Vec<Value>, Failure> {
    let node: Arc<str> = Arc::from("node");
    let context = Build {
        node: &node,
        seed,
        cancel: None,
    };
    (kind.build)(&Inputs::new(kind, values), &context)
}

fn run(field: &Field, samples: &Samples<'_>, level: Level) -> Vec<Vec<f32>> {
    let program = Program::compile(std::slice::from_ref(field));
    let mut scratch = Scratch::default();
    let context = RunContext {
        level,
        cache: None,
        filtering: true,
        cancel: None,
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
    let [noise] = gradient_noise(
        simd,
        at.map(|part| S::f32s::splat(simd, part)),
        S::u32s::splat(simd, seed),
        [0.0; 3],
    );
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
    let field = Noise {
        octaves: 3,
        ..PLAIN
    }
    .value();
    let value = |x: f64| at_points(&field, &[[x, 0.3, 0.6], [0.3, x, 0.6]]);
    for far in [1e11, 1e30, f64::INFINITY] {
        assert_eq!(value(far), value(2e10));
        assert_eq!(value(-far), value(-2e10));
    }
    assert_ne!(value(2e10), value(1e5));
    assert!(value(f64::NAN).iter().all(|value| value.is_finite()));
}

#[test]
fn octaves_too_fine_for_positions_are_refused() {
    let noise = |octaves| Noise {
        octaves,
        lacunarity: 8.0,
        ..PLAIN
    };
    assert!(noise(6).try_build().is_ok());
    let failure = noise(7).try_build().expect_err("8^6 is more than 65536");
    assert_eq!(failure.input, Some("octaves"));
}

/// Mean and variance.
fn statistics(values: &[f32]) -> [f64; 2] {
    let mean = |of: &dyn Fn(f64) -> f64| {
        values
            .iter()
            .map(|value| of(f64::from(*value)))
            .sum::<f64>()
            / values.len() as f64
    };
    let average = mean(&|value| value);
    [average, mean(&|value| (value - average).powi(2))]
}

#[test]
fn statistics_are_as_stated() {
    let points = points(200_000, 4000.0);
    let values = |form, octaves| {
        at_points(
            &Noise {
                form,
                octaves,
                ..PLAIN
            }
            .value(),
            &points,
        )
    };
    let soft = values("fbm", 1);
    assert!(soft.iter().all(|value| value.abs() < 1.04));
    let [mean, variance] = statistics(&soft);
    assert!(mean.abs() < 0.002, "{mean}");
    assert!((variance - f64::from(VARIANCE)).abs() < 0.001, "{variance}");
    // Octaves do not know each other: variances add up.
    let [mean, of_three] = statistics(&values("fbm", 3));
    let expected = variance * (1.0 + 0.25 + 0.0625) / (1.75 * 1.75);
    assert!(
        mean.abs() < 0.002 && (of_three / expected - 1.0).abs() < 0.03,
        "{of_three} {expected}"
    );
    for octaves in [1, 4] {
        let billow = values("billow", octaves);
        assert!(billow.iter().all(|value| (0.0..1.04).contains(value)));
        let [mean, _] = statistics(&billow);
        assert!((mean - f64::from(MEAN_SIZE)).abs() < 0.001, "{mean}");
        let ridged = values("ridged", octaves);
        assert!(ridged.iter().all(|value| (0.0..=1.0).contains(value)));
    }
    let [mean, _] = statistics(&values("ridged", 1));
    assert!(
        (mean - f64::from(Form::Ridged.mean())).abs() < 0.002,
        "{mean}"
    );
}

#[test]
fn forms_are_the_textbooks() {
    let points = points(500, 400.0);
    let values = |form| at_points(&Noise { form, ..PLAIN }.value(), &points);
    let [soft, ridged, billow] = ["fbm", "ridged", "billow"].map(values);
    for ((soft, ridged), billow) in soft.iter().zip(&ridged).zip(&billow) {
        assert!((billow - soft.abs()).abs() < 1e-6);
        assert!((ridged - (1.0 - soft.abs()).powi(2)).abs() < 1e-6);
    }
}

#[test]
fn later_octaves_of_ridges_are_as_strong_as_earlier_ones_let_them() {
    let points = points(2000, 400.0);
    let values = |octaves| {
        at_points(
            &Noise {
                form: "ridged",
                octaves,
                ..PLAIN
            }
            .value(),
            &points,
        )
    };
    let [one, two] = [1, 2].map(values);
    for (one, two) in one.iter().zip(&two) {
        // Musgrave: signal 1 + 0.5 signal 2, signal 2 being at most min(1, 2 signal 1); over 1.5 in all.
        let second = (two * 1.5 - one) / 0.5;
        assert!(
            (-1e-5..(2.0 * one).min(1.0) + 1e-5).contains(&second),
            "{one} {second}"
        );
    }
}

#[test]
fn directions_columns_and_seeds_have_nothing_in_common() {
    let points = points(50_000, 1000.0);
    let [value, vector] = PLAIN.fields();
    let mut columns = run(&vector, &Samples::Points(&points), Level::new());
    columns.push(at_points(&value, &points));
    for (recipe_seed, seed) in [(1, 1), (0, 2), (u64::MAX, 1)] {
        let other = Noise {
            recipe_seed,
            seed,
            ..PLAIN
        };
        columns.push(at_points(&other.value(), &points));
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
    for (form, period) in [("fbm", 0.0), ("ridged", 0.0), ("billow", 70.0)] {
        let size = [0.7; 3];
        let noise = Noise {
            size,
            octaves: 4,
            form,
            period: [period; 3],
            ..PLAIN
        };
        let [_, vector] = noise.fields();
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
        levels.extend(best.as_avx512().map(Level::Avx512));
    }
    levels
}
