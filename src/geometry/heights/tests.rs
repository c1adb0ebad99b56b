//! Rays and horizons against a search in small steps, and where both are known.

use super::{Heights, Rises};
use crate::geometry::hierarchy::Ray;
use glam::{DVec2, DVec3};

/// Numbers from 0 to 1 in no order.
fn noise(index: u64) -> f64 {
    let mixed = (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}

/// 37 x 23 cells of 0.5 x 0.7 with heights from 0 to 3.
fn rough() -> Heights {
    let heights = (0..38 * 24).map(|index| (3.0 * noise(index) * noise(index + 7000)) as f32);
    Heights::new([37, 23], DVec2::new(18.5, 16.1), heights.collect())
}

#[test]
fn rays_meet_what_small_steps_meet() {
    let heights = rough();
    let mut met = 0;
    for index in 0..400 {
        let part = |number: u64| noise(index * 10 + number + 20_000);
        let from = DVec3::new(
            part(0) * 40.0 - 10.0,
            part(1) * 40.0 - 12.0,
            3.5 + part(2) * 4.0,
        );
        let to = DVec3::new(part(3) * 18.5, part(4) * 16.1, part(5) * 2.0);
        let ray = Ray::new(from, (to - from).normalize());
        let is_over = |at: DVec3| (0.0..=18.5).contains(&at.x) && (0.0..=16.1).contains(&at.y);
        let mut distances = (0..80_000).map(|step| f64::from(step) * 1e-3);
        let expected = distances.find(|distance| {
            let at = ray.point(*distance);
            is_over(at) && at.z <= heights.height(at.truncate())
        });
        let found = heights.first(&ray).map(|(distance, _)| distance);
        match (found, expected) {
            (Some(found), Some(expected)) => {
                assert!(
                    (found - expected).abs() < 2e-3,
                    "{index}: {found}, {expected}"
                );
                met += 1;
            }
            // Steps may pass over a peak, rays do not.
            (Some(found), None) => {
                let at = ray.point(found);
                assert!(
                    (heights.height(at.truncate()) - at.z).abs() < 1e-9,
                    "{index}"
                );
            }
            (None, expected) => assert_eq!(expected, None, "{index}"),
        }
    }
    assert!(met > 200, "{met}");
}

/// Every rise, exactly.
const ALL: Rises = Rises {
    least: f64::NEG_INFINITY,
    most: f64::INFINITY,
    tolerance: 0.0,
};

#[test]
fn horizons_are_those_of_small_steps() {
    let heights = rough();
    for index in 0..300 {
        let part = |number: u64| noise(index * 10 + number + 50_000);
        let corner = [(part(0) * 37.0) as usize, (part(1) * 23.0) as usize];
        let point = heights.point(corner);
        let angle = part(2) * 7.0;
        let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
        let slope = |step: i32| {
            let distance = 1e-6 + f64::from(step) * 1e-3;
            let at = point.truncate() + direction * distance;
            let is_over = (0.0..=18.5).contains(&at.x) && (0.0..=16.1).contains(&at.y);
            is_over.then(|| (heights.height(at) - point.z) / distance)
        };
        let expected = (0..26_000)
            .filter_map(slope)
            .fold(f64::NEG_INFINITY, f64::max);
        let found = heights.horizon(point, direction, f64::INFINITY, &ALL);
        let is_same = found == expected || (found - expected).abs() < 5e-3 * found.abs().max(1.0);
        assert!(is_same, "{index}: {found}, {expected}");
        let rises = Rises {
            least: 0.1,
            most: 0.8,
            tolerance: 0.05,
        };
        let about = heights.horizon(point, direction, f64::INFINITY, &rises);
        let is_near = about >= found.clamp(0.1, 0.8) - 0.05 && about <= found.max(0.1);
        assert!(is_near, "{index}: {about}, {found}");
    }
}

#[test]
fn a_wall_is_seen_under_its_height_over_its_distance() {
    // A wall of height 2 between x = 5 and x = 6.
    let height = |index: usize| if index % 11 == 6 { 2.0 } else { 0.0 };
    let heights = Heights::new(
        [10, 4],
        DVec2::new(10.0, 4.0),
        (0..55).map(height).collect(),
    );
    let at = |x: f64| heights.horizon(DVec3::new(x, 1.3, 0.0), DVec2::X, f64::INFINITY, &ALL);
    assert!((at(2.0) - 0.5).abs() < 1e-12);
    assert!((at(-14.0) - 0.1).abs() < 1e-12, "from before the rectangle");
    assert_eq!(
        heights
            .horizon(DVec3::new(2.0, 1.3, 0.0), DVec2::X, 2.5, &ALL)
            .abs(),
        0.0
    );
    assert_eq!(at(10.0), f64::NEG_INFINITY);
    // From the rectangle's far side one looks back over the top.
    let back = heights.horizon(DVec3::new(10.0, 1.3, 4.0), -DVec2::X, f64::INFINITY, &ALL);
    assert!((back + 0.4).abs() < 1e-12, "{back}");
}

#[test]
fn slopes_of_planes_are_exact_and_steps_stay_in_their_cell() {
    let plane = (0..48).map(|index| (index % 8) as f32 * 0.5 - (index / 8) as f32 * 0.25);
    let heights = Heights::new([7, 5], DVec2::new(14.0, 5.0), plane.collect());
    for place in [
        DVec2::new(0.3, 0.2),
        DVec2::new(7.7, 3.3),
        DVec2::new(14.0, 5.0),
    ] {
        assert!((heights.slope(place) - DVec2::new(0.25, -0.25)).length() < 1e-12);
    }
    let step = (0..48).map(|index| if index % 8 < 4 { 0.0 } else { 3.0 });
    let heights = Heights::new([7, 5], DVec2::new(7.0, 5.0), step.collect());
    assert_eq!(heights.slope(DVec2::new(2.9, 2.0)), DVec2::ZERO);
    assert_eq!(heights.slope(DVec2::new(4.1, 2.0)), DVec2::ZERO);
    assert_eq!(heights.slope(DVec2::new(3.5, 2.0)), DVec2::new(4.5, 0.0));
}
