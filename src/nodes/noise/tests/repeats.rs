//! Laws of noise that repeats.

use super::*;

/// Noise that repeats after 60 mm along x, 48 mm along y, and never along z.
fn repeating(form: &'static str, octaves: i64) -> Noise {
    Noise {
        size: [5.0, 16.0, 3.7],
        octaves,
        form,
        period: [60.0, 48.0, 0.0],
        ..PLAIN
    }
}

#[test]
fn a_period_later_come_the_same_bits() {
    // Coordinates that stay exact when periods are added.
    let points: Vec<_> = (0..2000)
        .map(|i| {
            [
                f64::from(i * 37 % 960) / 16.0,
                f64::from(i * 11 % 768) / 16.0,
                f64::from(i) / 8.0,
            ]
        })
        .collect();
    for form in ["fbm", "ridged", "billow"] {
        let fields = repeating(form, 5).fields();
        for field in fields {
            let here = run(&field, &Samples::Points(&points), Level::new());
            for [x, y] in [[60.0, 0.0], [0.0, 48.0], [-60.0, 96.0], [6000.0, -4800.0]] {
                let shifted: Vec<_> = points
                    .iter()
                    .map(|point| [point[0] + x, point[1] + y, point[2]])
                    .collect();
                let there = run(&field, &Samples::Points(&shifted), Level::new());
                for (here, there) in here.iter().zip(&there) {
                    assert_eq!(bits(here), bits(there), "{form}: {x} {y}");
                }
            }
        }
    }
}

#[test]
fn there_is_no_seam() {
    let field = repeating("fbm", 4).value();
    for i in 0..400 {
        let [y, z] = [f64::from(i) * 0.37, f64::from(i) * 0.73];
        // The slope of the finest octave is less than 2 in 0.6 mm, an eighth of the whole.
        let step = 1e-4;
        let values = at_points(&field, &[[-step, y, z], [0.0, y, z], [60.0 - step, y, z]]);
        assert!((values[0] - values[1]).abs() < 2e-3, "{values:?}");
        assert!((values[2] - values[1]).abs() < 2e-3, "{values:?}");
    }
}

#[test]
fn it_repeats_along_the_axes_asked_for_only_and_not_sooner() {
    let points = points(20_000, 500.0);
    let field = repeating("fbm", 1).value();
    let [_, variance] = statistics(&at_points(&field, &points));
    let here = at_points(&field, &points);
    for shift in [
        [30.0, 0.0, 0.0],
        [12.0, 0.0, 0.0],
        [0.0, 16.0, 0.0],
        [0.0, 0.0, 60.0],
    ] {
        let shifted: Vec<_> = points
            .iter()
            .map(|point| [0, 1, 2].map(|axis| point[axis] + shift[axis]))
            .collect();
        let there = at_points(&field, &shifted);
        let product: f32 =
            here.iter().zip(&there).map(|(a, b)| a * b).sum::<f32>() / here.len() as f32;
        // Few cells share what little they have, so a period of 12 x 3 cells leaves some correlation.
        assert!(
            f64::from(product.abs()) < 0.3 * variance,
            "{shift:?}: {product} of {variance}"
        );
    }
}

#[test]
fn a_single_cell_may_repeat() {
    let noise = Noise {
        size: [7.0; 3],
        period: [7.0; 3],
        octaves: 3,
        ..PLAIN
    };
    let field = noise.value();
    let values = at_points(
        &field,
        &[[1.5, 2.0, 3.25], [8.5, -5.0, 10.25], [1.5, 2.5, 3.25]],
    );
    assert_eq!(values[0], values[1]);
    assert_ne!(values[0], values[2]);
}

#[test]
fn sizes_are_made_to_fit_or_refused() {
    let with = |size: f64, lacunarity, octaves| Noise {
        size: [size, 16.0, 3.7],
        lacunarity,
        octaves,
        ..repeating("fbm", 1)
    };
    // 60 / 5.03 is 11.93, so that twelve cells fit.
    let [exact, close] = [5.0, 5.03].map(|size| with(size, 2.0, 3).value());
    assert_eq!(exact.key(), close.key());
    let wrong = |noise: Noise| noise.try_build().expect_err("nothing fits");
    let failure = wrong(with(5.2, 2.0, 1));
    assert_eq!(failure.input, Some("period"));
    assert_eq!(
        failure.message,
        "a period of 60 mm along x holds 11.54 features of 5.2 mm, expected a whole number"
    );
    assert_eq!(
        failure.hint.as_deref(),
        Some("let the size along x be 5.4545 or 5.0000 mm")
    );
    let failure = wrong(with(70.0, 2.0, 1));
    assert_eq!(
        failure.hint.as_deref(),
        Some("let the size along x be 60.0000 mm")
    );
    assert_eq!(wrong(with(5.0, 2.5, 2)).input, Some("lacunarity"));
    assert!(with(5.0, 2.5, 1).try_build().is_ok());
    assert_eq!(wrong(with(1e-3, 8.0, 4)).input, Some("octaves"));
}
