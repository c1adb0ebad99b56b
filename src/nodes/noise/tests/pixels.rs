//! Laws of filtering: a coarse picture is the mean of a fine one, in its parts and on the whole.

use super::*;
use crate::field::{PixelGrid, Target};
use crate::key::{Key, KeyHasher};

/// A plane in a solid, given by the sides of a pixel in mm.
pub(super) struct Plane {
    right: DVec3,
    down: DVec3,
}

/// Where pixel (0, 0) is, so that no test sees the neighbourhood of 0 alone.
const ORIGIN: DVec3 = DVec3::new(17.3, 5.1, -8.8);

impl Plane {
    /// Pixels with sides of some mm that are at right angles and oblique to all axes.
    pub(super) fn oblique([width, height]: [f64; 2]) -> Plane {
        Plane {
            right: DVec3::new(2.0, 1.0, 2.0) / 3.0 * width,
            down: DVec3::new(-2.0, 2.0, 1.0) / 3.0 * height,
        }
    }
}

impl Target for Plane {
    fn key(&self) -> Key {
        let mut key = KeyHasher::new("plane", 1);
        let sides = [self.right, self.down].map(|side| side.to_array());
        sides.iter().flatten().for_each(|part| {
            key.number(*part);
        });
        key.finish()
    }

    fn pixels(&self) -> [u32; 2] {
        [4096; 2]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, row: [&mut [f32]; 3]) {
        for (axis, row) in row.into_iter().enumerate() {
            for (index, value) in (0i32..).zip(row) {
                let x = x + f64::from(index) * step;
                *value = (ORIGIN + self.right * x + self.down * y)[axis] as f32;
            }
        }
    }
}

/// A square of `count` x `count` pixels.
pub(super) fn painted(field: &Field, plane: &Plane, count: usize) -> Vec<f32> {
    let samples = Samples::Grid {
        target: plane,
        grid: PixelGrid::tile([0, 0], [count as u32; 2], 1),
    };
    let width = count + 2;
    let column = run(field, &samples, Level::new()).remove(0);
    let rows = column.chunks(width).skip(1).take(count);
    rows.flat_map(|row| row[1..width - 1].to_vec()).collect()
}

const FINENESS: usize = 16;

/// Mean and root of the mean square of what `side` mm wide pixels show in excess of the mean over them.
pub(super) fn errors(field: &Field, sides: [f64; 2]) -> [f64; 2] {
    let count = 40;
    let fine = Plane::oblique(sides.map(|side| side / FINENESS as f64));
    let fine = painted(field, &fine, count * FINENESS);
    let coarse = painted(field, &Plane::oblique(sides), count);
    let apart = coarse.iter().enumerate().map(|(index, coarse)| {
        let corner = (index / count * count * FINENESS + index % count) * FINENESS;
        let rows = (0..FINENESS).map(|row| corner + row * count * FINENESS);
        let sum: f32 = rows.flat_map(|start| &fine[start..start + FINENESS]).sum();
        coarse - sum / (FINENESS * FINENESS) as f32
    });
    let [mean, variance] = statistics(&apart.collect::<Vec<_>>());
    [mean, (mean * mean + variance).sqrt()]
}

/// The largest errors over pixels from a tenth to five times the features of 1 mm.
fn worst(noise: Noise, shape: [f64; 2]) -> [f64; 2] {
    let field = Noise {
        size: [1.0; 3],
        ..noise
    }
    .value();
    let mut worst = [0.0f64; 2];
    for side in [0.1, 0.25, 0.39, 0.5, 0.7, 1.0, 1.39, 1.9, 2.6, 3.5, 5.0] {
        let errors = errors(&field, shape.map(|part| part * side));
        worst = [0, 1].map(|index| worst[index].max(errors[index].abs()));
    }
    worst
}

/// Allowed errors, mean and root of mean square, of one octave and of five.
const ALLOWED: [(&str, [[f64; 2]; 2]); 3] = [
    ("fbm", [[0.001, 0.03], [0.002, 0.018]]),
    ("ridged", [[0.003, 0.035], [0.005, 0.025]]),
    ("billow", [[0.0015, 0.024], [0.002, 0.014]]),
];

#[test]
fn a_coarse_picture_is_the_mean_of_a_fine_one() {
    for (form, allowed) in ALLOWED {
        for (octaves, allowed) in [1, 5].into_iter().zip(allowed) {
            let found = worst(
                Noise {
                    form,
                    octaves,
                    ..PLAIN
                },
                [1.0, 1.0],
            );
            assert!(
                found[0] < allowed[0] && found[1] < allowed[1],
                "{form} {octaves}: {found:?}"
            );
        }
    }
}

#[test]
fn long_pixels_are_filtered_along_their_length() {
    for form in ["fbm", "billow"] {
        let found = worst(Noise { form, ..PLAIN }, [1.0, 0.05]);
        assert!(found[0] < 0.003 && found[1] < 0.055, "{form}: {found:?}");
    }
}

#[test]
fn nothing_is_left_of_noise_much_finer_than_a_pixel() {
    for form in ["fbm", "ridged", "billow"] {
        let noise = Noise {
            kind: &plane_noise::KIND,
            size: [0.1; 3],
            octaves: 5,
            form,
            ..PLAIN
        };
        let values = painted(&noise.value(), &Plane::oblique([1.0; 2]), 16);
        assert!(values.iter().all(|value| *value == values[0]));
        let mean = f64::from(Form::named(form).mean());
        let ridged = form == "ridged";
        assert!(
            ridged || (f64::from(values[0]) - mean).abs() < 1e-6,
            "{form} {}",
            values[0]
        );
    }
}

/// What is lost of noise in pixels from a quarter to four times the features: the variance of fine samples within them.
#[test]
fn what_is_lost_is_the_variance_within_pixels() {
    let noise = Noise {
        octaves: 2,
        ..PLAIN
    };
    let value = noise.value();
    let count = 24;
    for side in [0.75, 1.5, 3.0, 6.0, 12.0] {
        let fine = Plane::oblique([side / FINENESS as f64; 2]);
        let fine = painted(&value, &fine, count * FINENESS);
        let mut within = 0.0;
        for pixel in 0..count * count {
            let corner = (pixel / count * count * FINENESS + pixel % count) * FINENESS;
            let rows = (0..FINENESS).map(|row| corner + row * count * FINENESS);
            let samples: Vec<f32> = rows
                .flat_map(|start| fine[start..start + FINENESS].to_vec())
                .collect();
            within += statistics(&samples)[1] / (count * count) as f64;
        }
        let lost = value.lost().expect("noise loses");
        let lost = f64::from(painted(lost, &Plane::oblique([side; 2]), 3)[4]);
        assert!(
            (lost - within).abs() < 0.2 * within + 0.0005,
            "{side}: {lost}, not {within}"
        );
    }
    let folded = Noise {
        form: "billow",
        ..noise
    };
    assert!(folded.value().lost().is_none());
}
