//! Rings in wood: where they lie, that they close at the tip, and the kernel against double precision.

use super::levels::levels;
use super::workshop::Workshop;
use super::*;
use fearless_simd::Level;
use glam::DVec3;
use libm::{cos, sin};
use std::f64::consts::{PI, TAU};
use yosegi::engine::RunError;
use yosegi::field::{Field, Program, RunContext, Samples, Scratch};
use yosegi::nodes::wood::growth::{GrowthKernel, GrowthModel, GrowthSettings, Reach};
use yosegi::value::{Branch, Domain, Skeleton, Tangents, Thickness};

/// A crooked trunk as tall as the tree, with branches or without.
fn skeleton(branches: bool) -> Skeleton {
    let nodes = [
        (0.0, 0.0, 0.0),
        (40.0, 10.0, 4000.0),
        (-60.0, 50.0, 12000.0),
        (20.0, 0.0, 30000.0),
    ];
    let branch = |height, direction, speed| Branch {
        height,
        direction: DVec3::from(direction).normalize(),
        thickness: Thickness::Speed(speed),
        length: None,
    };
    let branches = match branches {
        false => vec![],
        true => vec![
            branch(900.0, (1.0, 0.2, 0.5), 0.5),
            branch(1500.0, (-0.4, 1.0, 0.3), 0.4),
        ],
    };
    Skeleton {
        trunk: nodes.map(DVec3::from).to_vec(),
        tangents: Tangents::Natural,
        branches,
    }
}

const SETTINGS: GrowthSettings = GrowthSettings {
    elongation: 150.0,
    thickening: 1.0,
    sharpness: 2.0,
    reach: None,
};

fn model(rings: &Arc<RingSeries>, branches: bool, reach: Option<Reach>) -> GrowthModel {
    let settings = GrowthSettings { reach, ..SETTINGS };
    GrowthModel::with_rings(&skeleton(branches), settings, Some(Arc::clone(rings))).unwrap()
}

fn oak() -> Arc<RingSeries> {
    grown(&oxford(), 0, &[("species", Value::Choice("oak"))]).unwrap()
}

/// The kernel's times at points.
fn times(model: &GrowthModel, points: &[DVec3], level: Level) -> Vec<f32> {
    let kernel = Arc::new(GrowthKernel::new(model.clone()));
    let field = Field::kernel(
        &Arc::from("growth"),
        kernel,
        vec![Field::position(Domain::Solid)],
    );
    let program = Program::compile(&[field]);
    let points: Vec<[f64; 3]> = points.iter().map(DVec3::to_array).collect();
    let mut scratch = Scratch::default();
    let context = RunContext {
        level,
        cache: None,
        filtering: true,
        cancel: None,
    };
    program.run(&Samples::Points(&points), &mut scratch, &context);
    program.output(&scratch, 0, 0)[..points.len()].to_vec()
}

/// Reproducible numbers from 0 to 1.
fn uniform() -> impl FnMut() -> f64 {
    let mut state = 11u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// The point at a height, in a direction and at a distance from the trunk's curve, as the kernel receives it.
fn point(model: &GrowthModel, height: f64, direction: f64, distance: f64) -> DVec3 {
    let out = DVec3::new(cos(direction), sin(direction), 0.0);
    let point = model.trunk.at(height) + distance * out;
    DVec3::new(point.x, point.y, height).as_vec3().as_dvec3()
}

#[test]
fn rings_have_the_radii_of_the_formula_at_a_thousand_heights() {
    let rings = oak();
    let model = model(&rings, false, None);
    let last = rings.years() - 1;
    let mut uniform = uniform();
    let (mut points, mut expected) = (vec![], vec![]);
    for _ in 0..1000 {
        // Half of the heights are in the lowest metres, where most wood is.
        let height = uniform().powi(2) * rings.heights[last];
        let reached = rings.time_of_height(height);
        let ring =
            (reached.ceil() + uniform() * (last as f64 + 1.0 - reached)).min(last as f64 + 1.0);
        let ring = ring as usize;
        let radius = ((rings.areas[ring - 1] - rings.area_at(reached)).max(0.0) / PI).sqrt();
        let direction = TAU * uniform();
        let exact =
            model.trunk.at(height) + radius * DVec3::new(cos(direction), sin(direction), 0.0);
        let found = model.trunk_time(exact);
        assert!(
            (found - ring as f64).abs() < 1e-7,
            "ring {ring} at {height}: {found}"
        );
        points.push(point(&model, height, direction, radius));
        expected.push(ring as f64);
    }
    let largest = rings.years() as f64;
    for (found, expected) in times(&model, &points, Level::new())
        .into_iter()
        .zip(expected)
    {
        assert!(
            (f64::from(found) - expected).abs() < 1e-4 * largest,
            "{found} instead of {expected}"
        );
    }
}

#[test]
fn time_rises_strictly_along_a_thousand_rays_and_beyond_the_bark() {
    let rings = oak();
    let model = model(&rings, false, None);
    let mut uniform = uniform();
    for _ in 0..1000 {
        let (height, direction) = (rings.heights[167] * uniform(), TAU * uniform());
        let ray: Vec<DVec3> = (0..64)
            .map(|step| point(&model, height, direction, 10.0 * f64::from(step)))
            .collect();
        let times = times(&model, &ray, Level::new());
        assert!(
            times.windows(2).all(|pair| pair[0] < pair[1]),
            "{height}: {times:?}"
        );
        assert!(times[0] > 0.0);
    }
}

#[test]
fn rings_close_at_the_tip_like_stacked_cones() {
    let rings = oak();
    let model = model(&rings, false, None);
    // On the axis a ring ends where the tree was as tall as that.
    let tips: Vec<DVec3> = rings
        .heights
        .iter()
        .map(|height| model.trunk.at(*height))
        .collect();
    for (year, tip) in (1..).zip(&tips) {
        assert!(
            (model.trunk_time(*tip) - f64::from(year)).abs() < 1e-6,
            "{year}"
        );
    }
    for (found, year) in times(&model, &tips, Level::new()).into_iter().zip(1..) {
        assert!(
            (f64::from(found) - f64::from(year)).abs() < 0.017,
            "{year}: {found}"
        );
    }
    // A ring's radius falls all the way up.
    let radius = |height: f64| {
        let area = rings.areas[99] - rings.area_at(rings.time_of_height(height));
        (area / PI).max(0.0).sqrt()
    };
    let radii: Vec<f64> = (0..100)
        .map(|part| radius(rings.heights[99] * f64::from(part) / 99.0))
        .collect();
    assert!(
        radii.windows(2).all(|pair| pair[1] < pair[0]) && radii[99] < 0.1,
        "{radii:?}"
    );
}

#[test]
fn the_drought_of_1976_is_found_by_its_ring() {
    let rings = grown(&oxford(), 0, &[]).unwrap();
    let model = model(&rings, false, None);
    let ring = (1976 - rings.first_year) as usize;
    let inside = rings.area_at(rings.time_of_height(300.0));
    let radius = |area: f64| ((area - inside) / PI).sqrt();
    let borders = [radius(rings.areas[ring - 1]), radius(rings.areas[ring])];
    let middle = (borders[0] + borders[1]) / 2.0;
    let time = times(&model, &[point(&model, 300.0, 1.0, middle)], Level::new())[0];
    assert_eq!(rings.first_year + time.floor() as i32, 1976);
    // It is narrower than those beside it.
    let widths: Vec<f64> = (ring - 1..ring + 2)
        .map(|ring| radius(rings.areas[ring]) - radius(rings.areas[ring - 1]))
        .collect();
    assert!(
        widths[1] < 0.9 * widths[0] && widths[1] < 0.9 * widths[2],
        "{widths:?}"
    );
}

#[test]
fn the_kernel_agrees_with_double_precision_at_every_level() {
    let rings = oak();
    let lean = {
        // Ten thousand years of which some are as lean as can be.
        let mut uniform = uniform();
        let growth: Vec<f64> = (0..10_000)
            .map(|_| if uniform() < 0.1 { 0.01 } else { 1.0 })
            .collect();
        let sums = |scale: f64| {
            let sum = growth.iter().scan(0.0, move |sum, growth| {
                *sum += scale * growth;
                Some(*sum)
            });
            sum.collect::<Vec<f64>>()
        };
        Arc::new(RingSeries {
            first_year: 1,
            areas: sums(80.0),
            heights: sums(2.5),
        })
    };
    let mut uniform = uniform();
    let mut scattered = |_| {
        let height = 31_000.0 * uniform().powi(3) - 200.0;
        DVec3::new(900.0 * uniform() - 450.0, 900.0 * uniform() - 450.0, height)
            .as_vec3()
            .as_dvec3()
    };
    let points: Vec<DVec3> = (0..6000).map(&mut scattered).collect();
    let reach = Some(Reach {
        along: 300.0,
        across: 80.0,
    });
    for rings in [&rings, &lean] {
        for model in [
            model(rings, false, None),
            model(rings, true, None),
            model(rings, true, reach),
        ] {
            let expected: Vec<f64> = points
                .iter()
                .map(|point| model.terms(*point).time)
                .collect();
            let largest = expected.iter().copied().fold(0.0, f64::max);
            let found = times(&model, &points, Level::new());
            for ((found, expected), point) in found.iter().zip(&expected).zip(&points) {
                let apart = (f64::from(*found) - expected).abs();
                assert!(
                    apart < 1e-4 * largest,
                    "{point}: {found} instead of {expected}, of {largest}"
                );
            }
            let bits = |times: &[f32]| {
                times
                    .iter()
                    .map(|time| time.to_bits())
                    .collect::<Vec<u32>>()
            };
            for level in levels() {
                assert_eq!(
                    bits(&times(&model, &points, level)),
                    bits(&found),
                    "{level:?}"
                );
            }
        }
    }
}

const TREE: &str = "
    \"tree\": skeleton(trunk: [(0, 0, 0), (0, 0, 9000)]),
    \"oxford\": weather(file: \"weather/oxforddata.txt\", to: 2020),
    \"rings\": growth_model(climate: \"oxford\", ring_width: 1, from: 1921),";

/// The fields of a node `growth` with these inputs, at points.
fn of_node(inputs: &str, points: &[[f64; 3]]) -> Result<Vec<Vec<f32>>, String> {
    let workshop = Workshop::new("recipes", Options::default());
    let recipe =
        format!("(nodes: {{ {TREE} \"growth\": growth_field(skeleton: \"tree\", {inputs}) }})");
    let told = |error: RunError| yosegi::diagnostics::render_all(error.diagnostics());
    let graph = workshop.graph(&recipe);
    let fields = workshop
        .engine
        .fields(&graph, "growth", &|_| {})
        .map_err(told)?;
    let values = workshop.engine.sample(&fields, points);
    Ok(values.into_iter().flatten().collect())
}

#[test]
fn wood_is_inside_up_to_the_bark() {
    // A hundred rings of 1 mm; at the ground the bark is 100 mm from the pith.
    let points = [
        [99.9, 0.0, 0.0],
        [0.0, 100.1, 0.0],
        [0.0, 0.0, 8999.0],
        [60.0, 60.0, 500.0],
    ];
    let inside = |inputs: &str| of_node(inputs, &points).unwrap().remove(2);
    let by_rings = inside("rings: \"rings\"");
    assert_eq!(by_rings[..2], [1.0, 0.0]);
    let younger = inside("rings: \"rings\", age: 99");
    assert_eq!(younger[..2], [0.0, 0.0]);
    assert_eq!(inside("elongation: 500, thickening: 1"), [1.0; 4]);
    // By speeds the tip is 500 years times mm tall.
    assert_eq!(
        inside("elongation: 50, thickening: 1, age: 100"),
        [1.0, 0.0, 0.0, 1.0]
    );
    assert_eq!(
        inside("elongation: 50, thickening: 1, age: 181"),
        [1.0, 1.0, 1.0, 1.0]
    );
}

#[test]
fn exactly_one_way_to_grow_is_given() {
    let told = |inputs: &str| of_node(inputs, &[[0.0; 3]]).unwrap_err();
    let message = told("thickening: 2");
    assert!(
        message.contains("neither `rings` nor `elongation` is set"),
        "{message}"
    );
    let message = told("elongation: 300");
    assert!(
        message.contains("neither `rings` nor `thickening` is set"),
        "{message}"
    );
    let message = told("rings: \"rings\", thickening: 2");
    assert!(
        message.contains("the `rings` say how thick the trunk was"),
        "{message}"
    );
    assert!(of_node("rings: \"rings\", elongation: 200", &[[0.0; 3]]).is_ok());
}
