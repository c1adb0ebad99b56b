//! Surfaces of shapes whose area and volume are known.

use super::*;
use std::collections::HashMap;

/// Every edge belongs to two triangles, which run through it in opposite directions.
fn assert_closed(surface: &Surface) {
    let mut edges: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for [a, b, c] in &surface.triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let uses = edges.entry([*from.min(to), *from.max(to)]).or_default();
            uses[usize::from(from > to)] += 1;
        }
    }
    assert!(edges.values().all(|[there, back]| there == back));
    let more = edges.values().filter(|uses| **uses != [1, 1]).count();
    assert_eq!(more, 0, "of {}", edges.len());
}

fn volume(surface: &Surface) -> f64 {
    let part = |[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|index| surface.points[*index as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    surface.triangles.iter().map(part).sum()
}

fn of(grid: &Grid, function: impl Fn(DVec3) -> f64) -> Result<Surface, NoSurface> {
    grid.surface(&|points| Some(points.iter().map(|point| function(*point)).collect()))
}

#[test]
fn a_ball_is_closed_and_round() {
    let grid = Grid::new(DVec3::splat(-60.0), DVec3::splat(60.0), 4.0);
    let centre = DVec3::new(1.3, -2.1, 0.7);
    let surface = of(&grid, |point| 50.0 - point.distance(centre)).unwrap();
    assert_closed(&surface);
    assert!(surface.sides.iter().all(|side| *side == 6));
    for point in &surface.points {
        assert!((point.distance(centre) - 50.0).abs() < 0.005, "{point}");
    }
    let expected = 4.0 / 3.0 * std::f64::consts::PI * 50f64.powi(3);
    let found = volume(&surface);
    assert!((found / expected - 1.0).abs() < 0.005, "{found} {expected}");
    // Euler: V - E + F = 2, with E = 3 F / 2.
    assert_eq!(surface.points.len(), 2 + surface.triangles.len() / 2);
}

#[test]
fn a_trunk_is_sawn_off_flat_at_the_sides_of_the_box() {
    let (low, high) = (
        DVec3::new(-50.0, -50.0, 10.0),
        DVec3::new(50.0, 30.0, 210.0),
    );
    let grid = Grid::new(low, high, 5.0);
    let surface = of(&grid, |point| 40.0 - point.truncate().length()).unwrap();
    assert_closed(&surface);
    let mut on_sides = [0.0; 7];
    for (corners, side) in surface.triangles.iter().zip(&surface.sides) {
        let [a, b, c] = corners.map(|index| surface.points[index as usize]);
        let area = 0.5 * (b - a).cross(c - a);
        on_sides[usize::from(*side)] += match side {
            6 => area.length(),
            _ => area.dot([DVec3::X, DVec3::Y, DVec3::Z][usize::from(side / 2)]),
        };
        if *side == 5 {
            assert!([a, b, c].iter().all(|point| point.z == 210.0));
        }
    }
    // The disc of radius 40 without what lies beyond y = 30.
    let half = libm::acos(30.0 / 40.0);
    let disc = 1600.0 * (std::f64::consts::PI - half) + 30.0 * 40.0 * libm::sin(half);
    assert!(
        (on_sides[5] / disc - 1.0).abs() < 0.005,
        "{on_sides:?} {disc}"
    );
    assert!((on_sides[4] / -disc - 1.0).abs() < 0.005);
    let chord = 2.0 * 40.0 * libm::sin(half) * 200.0;
    assert!(
        (on_sides[3] / chord - 1.0).abs() < 0.01,
        "{on_sides:?} {chord}"
    );
    assert_eq!(on_sides[0..3], [0.0; 3]);
    assert!((volume(&surface) / (disc * 200.0) - 1.0).abs() < 0.005);
}

#[test]
fn a_thin_arm_is_followed_from_where_it_was_seen() {
    // A rod of radius 3 far thinner than the coarse grid's steps of 16, on a ball.
    let grid = Grid::new(
        DVec3::new(-30.0, -30.0, -30.0),
        DVec3::new(400.0, 30.0, 30.0),
        4.0,
    );
    let ball = |point: DVec3| 20.0 - point.length();
    let rod = |point: DVec3| {
        let across = libm::hypot(point.y - 5.0, point.z - 7.0);
        (6.0 - across).min(380.0 - point.x).min(point.x)
    };
    let surface = of(&grid, |point| ball(point).max(rod(point))).unwrap();
    assert_closed(&surface);
    let furthest = surface
        .points
        .iter()
        .map(|point| point.x)
        .fold(0.0, f64::max);
    assert!((furthest - 380.0).abs() < 0.01, "{furthest}");
}

#[test]
fn what_is_nowhere_or_too_fine_is_refused_before_it_is_made() {
    let grid = Grid::new(DVec3::ZERO, DVec3::splat(100.0), 5.0);
    assert!(matches!(of(&grid, |_| -1.0), Err(NoSurface::Empty)));
    let fine = Grid::new(DVec3::ZERO, DVec3::splat(1000.0), 0.5);
    let count = std::cell::Cell::new(0);
    let wavy = |points: &[DVec3]| {
        count.set(count.get() + points.len());
        Some(points.iter().map(|point| 500.0 - point.z).collect())
    };
    let refused = fine.surface(&wavy);
    assert!(matches!(refused, Err(NoSurface::TooFine { points }) if points > MOST_POINTS));
    assert!(count.get() < 2 * MOST_POINTS as usize);
    assert!(matches!(grid.surface(&|_| None), Err(NoSurface::Cancelled)));
}
