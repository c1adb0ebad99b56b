//! The law of filtering: what a coarse pixel shows is the mean of the fine ones in it.
//!
//! It holds for everything that the example of a kind shows, but for an eighth of its deviation.

use super::*;
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};
use yosegi::key::{Key, KeyHasher};
use yosegi::node::{Output, Varies};

/// Pixels of some mm: of a plane, or of an oblique cut through a solid.
struct Picture {
    domain: Domain,
    side: f64,
}

impl Target for Picture {
    fn key(&self) -> Key {
        KeyHasher::new("picture", 1)
            .text(&self.domain.to_string())
            .number(self.side)
            .finish()
    }

    fn pixels(&self) -> [u32; 2] {
        [4096; 2]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        for index in 0..u.len() {
            let (x, y) = (self.side * (x + index as f64 * step), self.side * y);
            let point = match self.domain {
                Domain::Plane => [x, y, 0.0],
                _ => [
                    17.0 + (2.0 * x - 2.0 * y) / 3.0,
                    5.0 + (x + 2.0 * y) / 3.0,
                    300.0 + (2.0 * x + y) / 3.0,
                ],
            };
            [u[index], v[index], w[index]] = point.map(|part| part as f32);
        }
    }
}

/// The columns of a field in a square of pixels.
fn painted(field: &Field, side: f64, count: usize) -> Vec<Vec<f32>> {
    let program = Program::compile(std::slice::from_ref(field));
    let margin = program.margin();
    let picture = Picture {
        domain: field.domain(),
        side,
    };
    let samples = Samples::Grid {
        target: &picture,
        grid: PixelGrid::tile([0, 0], [count as u32; 2], margin),
    };
    let context = RunContext {
        level: levels::levels()[0],
        cache: None,
        filtering: true,
        cancel: None,
    };
    let mut scratch = Scratch::default();
    program.run(&samples, &mut scratch, &context);
    let width = count + 2 * margin;
    let inside = |column: &[f32]| {
        let rows = column.chunks(width).skip(margin).take(count);
        rows.flat_map(|row| row[margin..margin + count].to_vec())
            .collect()
    };
    program
        .columns(&scratch, 0)
        .into_iter()
        .map(inside)
        .collect()
}

/// Numbers that name something: a mean of them would name something else.
const IDS: [&str; 5] = ["id", "beyond", "choice", "stone", "optical_index"];

const FINENESS: usize = 16;
const COUNT: usize = 24;

/// Mean of what coarse pixels are in excess of the mean of the fine ones in them, the root of the mean of
/// its squares, and the deviation of the fine ones.
fn errors(fine: &[f32], coarse: &[f32]) -> [f64; 3] {
    let apart = coarse.iter().enumerate().map(|(index, coarse)| {
        let corner = (index / COUNT * COUNT * FINENESS + index % COUNT) * FINENESS;
        let rows = (0..FINENESS).map(|row| corner + row * COUNT * FINENESS);
        let inside = rows.flat_map(|start| &fine[start..start + FINENESS]);
        let sum: f64 = inside.map(|value| f64::from(*value)).sum();
        f64::from(*coarse) - sum / (FINENESS * FINENESS) as f64
    });
    let apart: Vec<f64> = apart.collect();
    let moment = |values: &[f64], power| {
        values.iter().map(|value| value.powi(power)).sum::<f64>() / values.len() as f64
    };
    let fine: Vec<f64> = fine.iter().map(|value| f64::from(*value)).collect();
    let deviation = (moment(&fine, 2) - moment(&fine, 1).powi(2))
        .max(0.0)
        .sqrt();
    [moment(&apart, 1), moment(&apart, 2).sqrt(), deviation]
}

/// What 32-bit floats about 1 may differ by where nothing varies.
const ROUNDING: f64 = 1e-6;

/// Checks a field at pixels of some sizes; says whether any column of it varies.
fn keeps_its_means(kind: &Kind, sampled: &SampledField) -> bool {
    let mut varies = false;
    for side in [0.1, 0.4, 1.5, 6.0] {
        let fine = painted(&sampled.field, side / FINENESS as f64, COUNT * FINENESS);
        let coarse = painted(&sampled.field, side, COUNT);
        for ((fine, coarse), name) in fine.iter().zip(&coarse).zip(&sampled.columns) {
            let [mean, root, deviation] = errors(fine, coarse);
            assert!(
                mean.abs() <= 0.02 * deviation + ROUNDING && root <= 0.12 * deviation + ROUNDING,
                "`{}`: {name} in pixels of {side} mm is {mean} too much, with errors of {root}, of {deviation}",
                kind.name
            );
            varies |= deviation > 0.0;
        }
    }
    varies
}

#[test]
fn a_coarse_pixel_is_the_mean_of_the_fine_ones() {
    let workshop = workshop();
    for kind in KINDS {
        // What fits everywhere varies only where it is used.
        let per_point = |output: &Output| {
            output.varies == Varies::PerPoint && output.domain != Some(Domain::Everywhere)
        };
        if !kind.outputs.iter().any(per_point) {
            continue;
        }
        let mut varies = false;
        for sampled in fields(&workshop, kind, &loaded(kind, kind.example)) {
            let is_id = IDS
                .iter()
                .any(|id| sampled.columns.iter().any(|name| name == id));
            if sampled.field.domain() != Domain::Everywhere && !is_id {
                varies |= keeps_its_means(kind, &sampled);
            }
        }
        assert!(
            varies,
            "nothing in the example of `{}` varies from point to point: let it show something",
            kind.name
        );
    }
}
