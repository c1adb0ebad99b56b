//! Cells made smaller.

use super::*;
use std::f64::consts::{FRAC_PI_2, PI};

fn ring(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

/// What is left of a cell of straight edges.
fn inset(rings: &[&[DVec2]], offs: &[f64], radius: f64) -> Vec<Left> {
    let contours: Vec<Contour<'_>> = rings
        .iter()
        .map(|corners| Contour {
            corners,
            bulges: &[],
        })
        .collect();
    super::inset(&contours, offs, radius).rings
}

/// What is left of a cell of one ring.
fn bent(corners: &[DVec2], bulges: &[f64], off: f64, radius: f64) -> Remains {
    let contour = Contour { corners, bulges };
    super::inset(&[contour], &vec![off; corners.len()], radius)
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
    assert!((area(&rounded) - (32.0 - 4.0 + PI)).abs() < 1e-12);
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
    assert!((area(&left) - (32.0 - 0.25 * (4.0 - PI))).abs() < 1e-12);
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
    let remains = bent(&bell, &[], 0.6, 0.0);
    assert_eq!(remains.parts, 2);
    assert!((area(&remains.rings) - 4.8 * 2.8).abs() < 1e-9);
    // With a bow at the end of the larger part: a half disk of radius 2, of which one of radius 1.4 is left.
    let bulges: Vec<f64> = (0..12).map(|edge| f64::from(edge == 5)).collect();
    let remains = bent(&bell, &bulges, 0.6, 0.0);
    assert_eq!(remains.parts, 2);
    let whole = 5.4 * 2.8 + 0.5 * PI * 1.4 * 1.4;
    assert!((area(&remains.rings) - whole).abs() < 1e-9);
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

/// The centre and the radius of each arc of a ring.
fn circles(left: &Left) -> Vec<(DVec2, f64)> {
    let count = left.corners.len();
    let arcs = (0..count).filter(|edge| left.bulges[*edge] != 0.0);
    arcs.map(|edge| {
        let (from, to) = (left.corners[edge], left.corners[(edge + 1) % count]);
        match curve::Curve::of(from, to, left.bulges[edge]) {
            curve::Curve::Circle { centre, radius, .. } => (centre, radius),
            curve::Curve::Line { .. } => panic!("expected an arc"),
        }
    })
    .collect()
}

#[test]
fn a_disk_shrinks_about_its_centre() {
    let ends = ring(&[(2.0, 5.0), (12.0, 5.0)]);
    let remains = bent(&ends, &[1.0, 1.0], 2.0, 0.0);
    assert!((area(&remains.rings) - 9.0 * PI).abs() < 1e-9);
    assert_eq!(remains.rings[0].edges.len(), 2);
    assert_eq!(bent(&ends, &[1.0, 1.0], 5.1, 0.0), Remains::default());
}

#[test]
fn arcs_of_a_sett_stay_concentric() {
    // Between circles of 10 and 20 about the origin, one radian wide.
    let at = |radius: f64, angle: f64| DVec2::new(libm::cos(angle), libm::sin(angle)) * radius;
    let sett = [at(10.0, 0.0), at(20.0, 0.0), at(20.0, 1.0), at(10.0, 1.0)];
    let bulge = libm::tan(0.25);
    let remains = bent(&sett, &[0.0, bulge, 0.0, -bulge], 1.5, 0.0);
    assert_eq!((remains.parts, &remains.rings[0].edges.len()), (1, &4));
    let mut radii: Vec<f64> = circles(&remains.rings[0])
        .iter()
        .inspect(|(centre, _)| assert!(centre.length() < 1e-9))
        .map(|(_, radius)| *radius)
        .collect();
    radii.sort_by(f64::total_cmp);
    assert!((radii[0] - 11.5).abs() < 1e-9 && (radii[1] - 18.5).abs() < 1e-9);
    // The integral of r (1 - 2 asin(1.5 / r)) from 11.5 to 18.5.
    let to = |r: f64| 0.5 * r * r - r * r * libm::asin(1.5 / r) - 1.5 * (r * r - 2.25).sqrt();
    assert!((area(&remains.rings) - (to(18.5) - to(11.5))).abs() < 1e-9);
}

/// A convex polygon with `count` corners, and the same grown by `radius`.
fn grown(count: usize, seed: usize, radius: f64) -> (Vec<DVec2>, Vec<DVec2>, Vec<f64>) {
    let share = |index: usize| ((index * 7919 + seed * 104_729) % 1009) as f64 / 1009.0;
    let angle = |index: usize| (index as f64 + 0.8 * share(index)) * 2.0 * PI / count as f64;
    let inner: Vec<DVec2> = (0..count)
        .map(|index| DVec2::new(7.0 * libm::cos(angle(index)), 4.0 * libm::sin(angle(index))))
        .collect();
    let (mut corners, mut bulges) = (vec![], vec![]);
    for index in 0..count {
        let along = (inner[(index + 1) % count] - inner[index]).normalize();
        let next = (inner[(index + 2) % count] - inner[(index + 1) % count]).normalize();
        let turned = libm::atan2(along.perp_dot(next), along.dot(next));
        corners.extend([index, index + 1].map(|at| inner[at % count] - radius * along.perp()));
        bulges.extend([0.0, libm::tan(0.25 * turned)]);
    }
    (inner, corners, bulges)
}

#[test]
fn what_grew_by_a_radius_shrinks_by_the_rule_of_steiner() {
    for seed in 0..40 {
        let (inner, corners, bulges) = grown(3 + seed % 7, seed, 2.0);
        let next = inner.iter().cycle().skip(1);
        let around: f64 = inner.iter().zip(next).map(|(a, b)| a.distance(*b)).sum();
        for off in [0.0, 0.3, 1.0, 1.9] {
            let remains = bent(&corners, &bulges, off, 0.0);
            let rest = 2.0 - off;
            let expected = 0.5 * doubled_area(&inner) + around * rest + PI * rest * rest;
            let found = area(&remains.rings);
            assert!(
                (found - expected).abs() < 1e-8,
                "{seed}, {off}: {found} {expected}"
            );
            assert_eq!(remains.rings[0].corners.len(), corners.len());
        }
        // Beyond the radius of the corners what is left is that of the polygon itself.
        let remains = bent(&corners, &bulges, 2.5, 0.0);
        let plain = inset(&[&inner], &vec![0.5; inner.len()], 0.0);
        assert!((area(&remains.rings) - area(&plain)).abs() < 1e-6, "{seed}");
    }
}

#[test]
fn smooth_edges_move_together() {
    let (inner, corners, bulges) = grown(4, 3, 2.0);
    let contour = Contour {
        corners: &corners,
        bulges: &bulges,
    };
    let offs: Vec<f64> = (0..corners.len()).map(|edge| 0.1 * edge as f64).collect();
    let together = super::inset(&[contour], &offs, 0.0);
    assert_eq!(together, bent(&corners, &bulges, offs[7], 0.0));
    let centres = circles(&together.rings[0]);
    assert!(centres.iter().all(|(centre, radius)| {
        let nearest = inner.iter().map(|at| at.distance(*centre));
        nearest.fold(f64::INFINITY, f64::min) < 1e-9 && (radius - 1.3).abs() < 1e-9
    }));
}

#[test]
fn corners_between_lines_and_arcs_are_rounded_by_arcs_that_touch_both() {
    // A half disk of radius 10 on a straight side.
    let half = ring(&[(-10.0, 0.0), (10.0, 0.0)]);
    let remains = bent(&half, &[0.0, 1.0], 0.0, 2.0);
    let left = &remains.rings[0];
    let circles = circles(left);
    assert_eq!(circles.len(), 3);
    for (centre, radius) in circles {
        if (radius - 2.0).abs() < 1e-9 {
            // It touches the side, and the large arc from inside.
            assert!((centre.y - 2.0).abs() < 1e-9);
            assert!((centre.length() - 8.0).abs() < 1e-9);
        } else {
            assert!(centre.length() < 1e-9 && (radius - 10.0).abs() < 1e-9);
        }
    }
    // Beside each corner the part above 2 and below the touching points is cut off:
    // the half disk without what the arcs leave out.
    let x = 60.0_f64.sqrt();
    let angle = libm::asin(0.25);
    let out = 0.5 * 100.0 * angle - 0.5 * 2.0 * x - 0.5 * 4.0 * (FRAC_PI_2 + angle);
    assert!((area(&remains.rings) - (50.0 * PI - 2.0 * out)).abs() < 1e-9);
    // An arc as large as fits takes no more than half of the side.
    let round = bent(&half, &[0.0, 1.0], 0.0, 50.0);
    let feet = round.rings[0].corners.iter().filter(|at| at.y.abs() < 1e-9);
    assert!(feet.clone().count() >= 1 && feet.into_iter().all(|at| at.x.abs() < 1e-6));
}

#[test]
fn an_arc_that_turns_right_grows() {
    // A square with a bite of radius 2 out of its right side.
    let bitten = ring(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 3.0),
        (10.0, 7.0),
        (10.0, 10.0),
        (0.0, 10.0),
    ]);
    let remains = bent(&bitten, &[0.0, 0.0, -1.0, 0.0, 0.0, 0.0], 0.5, 0.0);
    let [(centre, radius)] = circles(&remains.rings[0])[..] else {
        panic!("expected one arc");
    };
    assert!(centre.distance(DVec2::new(10.0, 5.0)) < 1e-9 && (radius - 2.5).abs() < 1e-9);
    // The side at 9.5 cuts off the part of the larger bite beyond it.
    let half = libm::acos(0.2);
    let bite = 6.25 * (half - libm::sin(half) * libm::cos(half));
    assert!((area(&remains.rings) - (81.0 - bite)).abs() < 1e-9);
}
