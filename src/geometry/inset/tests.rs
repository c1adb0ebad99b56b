//! Cells made smaller.

use super::*;
use crate::geometry::polygon::measure;

fn ring(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

fn area(left: &[Left]) -> f64 {
    left.iter()
        .map(|ring| measure(&ring.corners, &ring.bulges).area)
        .sum()
}

#[test]
fn a_rectangle_loses_a_strip_at_each_side() {
    let cell = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 6.0), (0.0, 6.0)]);
    let left = inset(&[&cell], &[1.0, 2.0, 0.5, 0.0], 0.0);
    assert!((area(&left) - 8.0 * 4.5).abs() < 1e-12);
    assert_eq!(left[0].edges.len(), 4);
    let bottom = left[0].edges.iter().position(|edge| *edge == 0).unwrap();
    assert_eq!(left[0].corners[bottom].y, 1.0);
    assert!(inset(&[&cell], &[3.0, 0.0, 3.0, 0.0], 0.0).is_empty());
    let rounded = inset(&[&cell], &[1.0; 4], 1.0);
    assert!((area(&rounded) - (32.0 - 4.0 + std::f64::consts::PI)).abs() < 1e-12);
}

#[test]
fn short_edges_vanish_and_the_others_stay_where_they_belong() {
    let cut_corner = ring(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 9.5),
        (9.5, 10.0),
        (0.0, 10.0),
    ]);
    let left = inset(&[&cut_corner], &[2.0; 5], 0.0);
    assert!((area(&left) - 36.0).abs() < 1e-12);
    assert_eq!(left[0].edges, [0, 1, 3, 4]);
}

#[test]
fn a_side_with_two_neighbours_stays_straight_and_keeps_both() {
    let cell = ring(&[(0.0, 0.0), (4.0, 0.0), (10.0, 0.0), (10.0, 6.0), (0.0, 6.0)]);
    let left = inset(&[&cell], &[1.0, 0.5, 1.0, 1.0, 1.0], 0.5);
    let straight: Vec<usize> = left[0]
        .edges
        .iter()
        .zip(&left[0].bulges)
        .filter(|(_, bulge)| **bulge == 0.0)
        .map(|it| *it.0)
        .collect();
    assert_eq!(straight, [0, 1, 2, 3, 4]);
    assert!(left[0].corners.contains(&DVec2::new(4.0, 1.0)));
    assert!((area(&left) - (32.0 - 0.25 * (4.0 - std::f64::consts::PI))).abs() < 1e-12);
}

#[test]
fn an_angle_keeps_its_pointed_inner_corner() {
    let angle = ring(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 4.0),
        (4.0, 4.0),
        (4.0, 10.0),
        (0.0, 10.0),
    ]);
    let left = inset(&[&angle], &[1.0; 6], 0.0);
    assert!((area(&left) - (2.0 * 8.0 + 2.0 * 6.0)).abs() < 1e-9);
    let mut edges = left[0].edges.clone();
    edges.sort_unstable();
    assert_eq!(edges, [0, 1, 2, 3, 4, 5]);
}

#[test]
fn what_falls_apart_keeps_its_largest_part() {
    let bell = ring(&[
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 1.5),
        (8.0, 1.5),
        (8.0, 0.0),
        (14.0, 0.0),
        (14.0, 4.0),
        (8.0, 4.0),
        (8.0, 2.5),
        (4.0, 2.5),
        (4.0, 4.0),
        (0.0, 4.0),
    ]);
    let left = inset(&[&bell], &[0.6; 12], 0.0);
    assert!((area(&left) - 4.8 * 2.8).abs() < 1e-9);
}

#[test]
fn a_frame_grows_narrower_from_both_sides() {
    let outline = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]);
    let hole = ring(&[(3.0, 3.0), (3.0, 7.0), (7.0, 7.0), (7.0, 3.0)]);
    let left = inset(&[&outline, &hole], &[1.0; 8], 0.0);
    assert_eq!(left.len(), 2);
    assert!((area(&left) - (64.0 - 36.0)).abs() < 1e-9);
    assert!(left[1].edges.iter().all(|edge| *edge >= 4));
}
