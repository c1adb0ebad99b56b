//! The lookup against known values, and its filter against plain integration.
//!
//! `colour-vectors.json` was computed in f64 by an independent implementation of the lookup of Momoi & Takatera 2014.

use super::{Slope, columns, columns_with, grid, look_up};
use fearless_simd::Level;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use serde_json::Value as Json;
use yosegi::field::{Field, Samples};
use yosegi::value::{AfterEnd, ColourPattern, Domain};

fn numbers(json: &Json) -> Vec<f64> {
    json.as_array()
        .unwrap()
        .iter()
        .map(|number| number.as_f64().unwrap())
        .collect()
}

fn colours(json: &Json) -> Vec<[f32; 3]> {
    let colour = |json| {
        <[f64; 3]>::try_from(numbers(json))
            .unwrap()
            .map(|part| part as f32)
    };
    json.as_array().unwrap().iter().map(colour).collect()
}

fn one_year(colours: Vec<[f32; 3]>, smooth: bool) -> ColourPattern {
    let after_end = AfterEnd::Repeat;
    ColourPattern {
        colours,
        years: 1.0,
        ring_starts: vec![0.0],
        after_end,
        smooth,
    }
}

fn time() -> Field {
    Field::position(Domain::Plane).part(0, 1)
}

/// Red, green, blue, position and inside at single times.
fn at_points(pattern: &ColourPattern, times: &[f64]) -> Vec<Vec<f32>> {
    let points: Vec<[f64; 3]> = times.iter().map(|time| [*time, 0.0, 0.0]).collect();
    columns(&look_up(pattern, time()), &Samples::Points(&points))
}

#[test]
fn points_have_the_known_colours() {
    let vectors: Json = serde_json::from_str(include_str!("../data/colour-vectors.json")).unwrap();
    let times = numbers(&vectors["t"]);
    for (name, smooth) in [("nearest", false), ("linear", true)] {
        let found = at_points(&one_year(colours(&vectors["table"]), smooth), &times);
        for (index, expected) in colours(&vectors[name]).into_iter().enumerate() {
            for part in 0..3 {
                let (found, expected) = (found[part][index], expected[part]);
                // The times are f32: 0.1 is not the same number there.
                let tolerance = if smooth { 1e-6 } else { 0.0 };
                assert!(
                    (found - expected).abs() <= tolerance,
                    "{name} at {}",
                    times[index]
                );
            }
            let year = times[index] as f32 - (times[index] as f32).floor();
            assert!(
                (found[3][index] - year).abs() < 1e-7,
                "position at {}",
                times[index]
            );
            assert_eq!(found[4][index], 1.0);
        }
    }
}

#[test]
fn late_wood_borders_early_wood_without_a_ramp() {
    let pattern = one_year(vec![[1.0, 0.5, 0.25], [0.5, 0.25, 0.125], [0.0; 3]], true);
    let found = at_points(&pattern, &[0.999_999, 1.0, 99.999_99, 100.0, -1e-30]);
    assert_eq!(found[0], [0.0, 1.0, 0.0, 1.0, 0.0]);
}

#[test]
fn a_pattern_that_ends_has_its_first_colour_before_and_its_last_after() {
    let pattern = ColourPattern {
        years: 2.0,
        ring_starts: vec![0.0, 0.25],
        after_end: AfterEnd::End,
        ..one_year(vec![[0.25; 3], [0.75; 3]], false)
    };
    let found = at_points(&pattern, &[-3.0, 0.0, 0.25, 0.5, 1.0, 1.25, 2.0, 50.0]);
    assert_eq!(found[0], [0.25, 0.25, 0.25, 0.25, 0.75, 0.75, 0.75, 0.75]);
    let thirds = [0.0, 0.0, 0.5, 0.0, 1.0 / 3.0, 0.5, 1.0, 1.0];
    assert!(
        found[3]
            .iter()
            .zip(thirds)
            .all(|(found, expected): (&f32, f32)| (found - expected).abs() < 1e-7)
    );
    assert_eq!(found[4], [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
}

#[test]
fn numbers_beyond_all_years_do_no_harm() {
    let wild = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e30, -1e30];
    for after_end in [AfterEnd::Repeat, AfterEnd::End] {
        let pattern = ColourPattern {
            after_end,
            ..one_year(vec![[0.5; 3]; 4], true)
        };
        let found = at_points(&pattern, &wild);
        assert!(
            found.iter().flatten().all(|value| value.is_finite()),
            "{found:?}"
        );
    }
}

/// The definition, written down as plainly as possible: red, position and inside at a time.
fn plain(pattern: &ColourPattern, time: f64) -> [f64; 3] {
    let count = pattern.colours.len();
    let mut at = time / pattern.years;
    let inside = if at < 1.0 || pattern.after_end == AfterEnd::Repeat {
        1.0
    } else {
        0.0
    };
    match pattern.after_end {
        AfterEnd::Repeat => at -= at.floor(),
        AfterEnd::End => at = at.clamp(0.0, 1.0),
    }
    let red = |index: usize| f64::from(pattern.colours[index.min(count - 1)][0]);
    let colour = if pattern.smooth {
        let along = (at * count as f64 - 0.5).clamp(0.0, count as f64 - 1.0);
        let index = along.floor() as usize;
        red(index) + (along - index as f64) * (red(index + 1) - red(index))
    } else {
        red((at * count as f64) as usize)
    };
    let ring = pattern
        .ring_starts
        .iter()
        .rposition(|start| *start <= at)
        .unwrap();
    let start = pattern.ring_starts[ring];
    let end = pattern.ring_starts.get(ring + 1).copied().unwrap_or(1.0);
    [colour, (at - start) / (end - start), inside]
}

/// Means by the midpoint rule between all places where anything bends: exact for what is linear between.
fn integrated(pattern: &ColourPattern, time: f64, width: f64) -> [f64; 3] {
    let (from, to) = (time - 0.5 * width, time + 0.5 * width);
    let half_texels = 2 * pattern.colours.len();
    let bends = (0..half_texels).map(|index| index as f64 / half_texels as f64);
    let bends: Vec<f64> = bends.chain(pattern.ring_starts.iter().copied()).collect();
    let periods = (from / pattern.years).floor() as i64..=(to / pattern.years).floor() as i64;
    let mut borders: Vec<f64> = periods
        .flat_map(|period| {
            bends
                .iter()
                .map(move |bend| (period as f64 + bend) * pattern.years)
        })
        .chain([from, to])
        .filter(|border| (from..=to).contains(border))
        .collect();
    borders.sort_by(f64::total_cmp);
    let mut sums = [0.0; 3];
    for pair in borders.windows(2) {
        let [colour, position, inside] = plain(pattern, 0.5 * (pair[0] + pair[1]));
        let share = (pair[1] - pair[0]) * inside;
        sums = [
            sums[0] + share * colour,
            sums[1] + share * position,
            sums[2] + share,
        ];
    }
    if sums[2] < 1e-9 * width {
        return [
            f64::from(pattern.colours[pattern.colours.len() - 1][0]),
            1.0,
            0.0,
        ];
    }
    // What lies behind the end has the last colour.
    let inside = sums[2] / width;
    let last = f64::from(pattern.colours[pattern.colours.len() - 1][0]);
    [
        sums[0] / width + (1.0 - inside) * last,
        sums[1] / width + (1.0 - inside),
        inside,
    ]
}

/// The mean over a square whose sides span these times: one box, or two where the smaller side counts.
fn over_a_square(pattern: &ColourPattern, middle: f64, across: f64, along: f64) -> [f64; 3] {
    let (large, small) = (across.abs().max(along.abs()), across.abs().min(along.abs()));
    if large == 0.0 {
        return plain(pattern, middle);
    }
    if small <= 0.2 * large {
        return integrated(pattern, middle, libm::hypot(large, small));
    }
    let apart = small / libm::sqrt(12.0);
    let [first, second] = [-apart, apart].map(|by| integrated(pattern, middle + by, large));
    std::array::from_fn(|column| 0.5 * (first[column] + second[column]))
}

fn patterns() -> impl Strategy<Value = ColourPattern> {
    let colours = prop::collection::vec(0.0f32..1.0, 1..40)
        .prop_map(|reds| reds.into_iter().map(|red| [red, 1.0 - red, 0.5]).collect());
    let rings = prop::collection::btree_set(1u32..1000, 0..6).prop_map(|starts| {
        let starts = starts.into_iter().map(|start| f64::from(start) / 1000.0);
        std::iter::once(0.0).chain(starts).collect()
    });
    let years = prop_oneof![Just(1.0), Just(47.0), 0.3f64..9.0];
    (colours, rings, years, any::<bool>(), any::<bool>()).prop_map(
        |(colours, ring_starts, years, ends, smooth)| {
            let after_end = if ends {
                AfterEnd::End
            } else {
                AfterEnd::Repeat
            };
            ColourPattern {
                colours,
                years,
                ring_starts,
                after_end,
                smooth,
            }
        },
    )
}

/// Steps from the finest that f32 tells apart up to 30 years.
fn steps() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 1e-5f64..1e-2, 1e-2f64..1.0, 1.0f64..30.0]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn the_filter_is_the_mean(
        pattern in patterns(), start in -40.0f64..100.0, step in steps(), skew in steps(),
    ) {
        const SIDE: usize = 6;
        let target = Slope { start, step, skew };
        let found = columns(&look_up(&pattern, time()), &grid(&target, [SIDE as u32 - 2; 2]));
        for index in (1..SIDE - 1).flat_map(|y| (1..SIDE - 1).map(move |x| y * SIDE + x)) {
            let (x, y) = ((index % SIDE) as f64 - 0.5, (index / SIDE) as f64 - 0.5);
            let across = 0.5 * (target.at(x + 1.0, y) - target.at(x - 1.0, y));
            let along = 0.5 * (target.at(x, y + 1.0) - target.at(x, y - 1.0));
            let (across, along) = (f64::from(across), f64::from(along));
            let width = libm::hypot(across, along);
            let middle = f64::from(target.at(x, y));
            let [red, position, inside] = over_a_square(&pattern, middle, across, along);
            let expected = [red, 1.0 - red, 0.5, position, inside];
            // Where the span starts is known to half a digit of the distance from the start of a piece, in f32:
            // at a jump that is this share of a span, and another of the larger distance where it ends.
            let pieces_per_texel = if pattern.smooth { 2.0 } else { 1.0 };
            let pieces = width * pieces_per_texel * pattern.colours.len() as f64 / pattern.years;
            let place = if pieces > 0.0 { f64::from(f32::EPSILON) / pieces } else { 0.0 };
            // A share too small to be told from nothing has the last colour.
            let known = if inside > 1e-4 { 5 } else { 0 };
            for column in 0..known {
                let found = f64::from(found[column][index]);
                prop_assert!((found - expected[column]).abs() < 1e-5 + place,
                    "column {column}: {found} instead of {} at {middle} over {width}", expected[column]);
            }
            prop_assert!((f64::from(found[4][index]) - inside).abs() < 1e-5);
        }
    }

    #[test]
    fn every_machine_computes_the_same_bits(
        pattern in patterns(), start in -40.0f64..100.0, step in steps(),
    ) {
        let target = Slope { start, step, skew: 0.3 * step };
        let fields = look_up(&pattern, time());
        let bits = |level| {
            let columns = columns_with(level, &fields, &grid(&target, [30, 9]));
            columns.concat().into_iter().map(f32::to_bits).collect::<Vec<_>>()
        };
        let expected = bits(Level::baseline());
        prop_assert_eq!(&bits(Level::new()), &expected);
        if let Some(avx2) = Level::new().as_avx2() {
            prop_assert_eq!(&bits(Level::Avx2(avx2)), &expected);
        }
    }

    #[test]
    fn whole_periods_have_the_mean_of_the_table(
        pattern in patterns(), start in -50.0f64..50.0, periods in 1u32..5,
    ) {
        let pattern = ColourPattern { after_end: AfterEnd::Repeat, years: 0.5, ..pattern };
        let mean = pattern.colours.iter().map(|colour| colour[0]).sum::<f32>() / pattern.colours.len() as f32;
        // Times that f32 holds exactly.
        let target = Slope { start: (start * 64.0).round() / 64.0, step: 0.5 * f64::from(periods), skew: 0.0 };
        let found = columns(&look_up(&pattern, time()), &grid(&target, [3, 3]));
        prop_assert!((found[0][6] - mean).abs() < 1e-6);
        prop_assert!((found[3][6] - 0.5).abs() < 1e-6);
    }
}
