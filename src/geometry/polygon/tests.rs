//! What is wrong with drawn polygons, and what is made of it.

use super::{Nothing, Wrong, area, mend};
use crate::value::Polygon;
use glam::DVec2;
use proptest::prelude::*;

fn ring(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

fn drawn(outline: &[(f64, f64)], holes: &[&[(f64, f64)]]) -> Polygon {
    Polygon {
        outline: ring(outline),
        holes: holes.iter().map(|hole| ring(hole)).collect(),
    }
}

const SQUARE: &[(f64, f64)] = &[(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];

/// The area of what is mended, and what was wrong.
fn mended(polygons: &[Polygon]) -> (f64, Vec<Wrong>) {
    let (region, faults) = mend(polygons).unwrap();
    assert!(region.is_sound());
    let wrong = faults.iter().map(|fault| fault.wrong).collect();
    (area(&region.polygons), wrong)
}

#[test]
fn what_is_right_stays_as_it_is() {
    let frame = drawn(SQUARE, &[&[(2.0, 2.0), (2.0, 4.0), (4.0, 4.0), (4.0, 2.0)]]);
    let (region, faults) = mend(std::slice::from_ref(&frame)).unwrap();
    assert!(faults.is_empty());
    let polygon = &region.polygons[0];
    assert!(
        frame
            .outline
            .iter()
            .all(|corner| polygon.outline.contains(corner))
    );
    assert_eq!([polygon.outline.len(), polygon.holes.len()], [4, 1]);
    assert_eq!(area(&region.polygons), 60.0);
}

#[test]
fn each_mistake_is_mended_and_named() {
    let hole: &[(f64, f64)] = &[(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0)];
    let cases: [(&str, Polygon, f64, &[Wrong]); 14] = [
        (
            "spike at the start",
            drawn(
                &[&[(-3.0, 4.0), (0.0, 4.0)], SQUARE, &[(0.0, 4.0)]].concat(),
                &[],
            ),
            64.0,
            &[Wrong::Spike],
        ),
        (
            "bow-tie",
            drawn(&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)], &[]),
            8.0,
            &[Wrong::Crosses],
        ),
        (
            "closed",
            drawn(&[SQUARE, &[(0.0, 0.0)]].concat(), &[]),
            64.0,
            &[],
        ),
        (
            "repeated",
            drawn(&[&[(0.0, 0.0)], SQUARE].concat(), &[]),
            64.0,
            &[Wrong::Repeated],
        ),
        (
            "all repeated",
            drawn(
                &SQUARE.iter().flat_map(|at| [*at; 2]).collect::<Vec<_>>(),
                &[],
            ),
            64.0,
            &[Wrong::Repeated; 4],
        ),
        (
            "spike",
            drawn(
                &[SQUARE, &[(0.0, 4.0), (-3.0, 4.0), (0.0, 4.0)]].concat(),
                &[],
            ),
            64.0,
            &[Wrong::Spike],
        ),
        (
            "clockwise",
            drawn(&SQUARE.iter().rev().copied().collect::<Vec<_>>(), &[]),
            64.0,
            &[Wrong::Clockwise],
        ),
        (
            "twice around",
            drawn(&[SQUARE, SQUARE].concat(), &[]),
            64.0,
            &[Wrong::Crosses],
        ),
        (
            "outside",
            drawn(SQUARE, &[&[(9.0, 9.0), (10.0, 9.0), (10.0, 10.0)]]),
            64.0,
            &[Wrong::Outside],
        ),
        (
            "beyond",
            drawn(
                SQUARE,
                &[&[(6.0, 6.0), (10.0, 6.0), (10.0, 7.0), (6.0, 7.0)]],
            ),
            62.0,
            &[Wrong::Beyond],
        ),
        (
            "touches the outline",
            drawn(SQUARE, &[&[(0.0, 4.0), (2.0, 3.0), (2.0, 5.0)]]),
            62.0,
            &[Wrong::Touches],
        ),
        (
            "touching holes",
            drawn(
                SQUARE,
                &[hole, &[(4.0, 2.0), (6.0, 2.0), (6.0, 4.0), (4.0, 4.0)]],
            ),
            56.0,
            &[Wrong::Touches],
        ),
        ("hole either way", drawn(SQUARE, &[hole]), 60.0, &[]),
        (
            "sliver",
            drawn(
                &[
                    (0.0, 0.0),
                    (8.0, 0.0),
                    (8.0, 8.0),
                    (4.0, 8.0),
                    (4.0 + 1e-10, -5.0),
                    (4.0, 8.0),
                    (0.0, 8.0),
                ],
                &[],
            ),
            64.0,
            &[Wrong::Spike],
        ),
    ];
    for (name, polygon, expected, wrong) in cases {
        let (area, found) = mended(&[polygon]);
        assert!((area - expected).abs() < 1e-6, "{name}: {area}");
        assert_eq!(found, wrong, "{name}");
    }
}

#[test]
fn overlapping_outlines_count_once() {
    let other = drawn(&[(4.0, 4.0), (12.0, 4.0), (12.0, 12.0), (4.0, 12.0)], &[]);
    assert_eq!(
        mended(&[drawn(SQUARE, &[]), other]),
        (112.0, vec![Wrong::Overlaps])
    );
    let beside = drawn(&[(8.0, 0.0), (9.0, 0.0), (9.0, 8.0), (8.0, 8.0)], &[]);
    assert_eq!(mended(&[drawn(SQUARE, &[]), beside]), (72.0, vec![]));
}

#[test]
fn what_encloses_nothing_is_refused() {
    let nothing = |outline: &[(f64, f64)]| mend(&[drawn(outline, &[])]).unwrap_err().1;
    assert_eq!(nothing(&[]), Nothing::Corners(0));
    assert_eq!(
        nothing(&[(1.0, 1.0), (2.0, 1.0), (1.0, 1.0)]),
        Nothing::Corners(2)
    );
    assert_eq!(
        nothing(&[(1.0, 1.0), (2.0, 1.0), (4.0, 1.0)]),
        Nothing::Area
    );
    assert_eq!(
        nothing(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1e-11), (0.0, 1e-11)]),
        Nothing::Area
    );
    let hole = [&[(1.0, 1.0), (2.0, 1.0)][..]];
    assert_eq!(
        mend(&[drawn(SQUARE, &hole)]).unwrap_err(),
        ((0, Some(0)), Nothing::Corners(2))
    );
    assert_eq!(
        mend(&[drawn(SQUARE, &[SQUARE])]).unwrap_err().1,
        Nothing::Area
    );
}

/// The area that a ring winds around other than 0 times, by counting the places of a fine grid.
fn counted(ring: &[DVec2], side: i32, steps: i32) -> f64 {
    let mut count = 0;
    for place in 0..(side * steps).pow(2) {
        // Off the middle, so that no place lies on a line between lattice points.
        let at = |index: i32, off: f64| (f64::from(index) + off) / f64::from(steps);
        let point = DVec2::new(
            at(place % (side * steps), 0.4871),
            at(place / (side * steps), 0.5113),
        );
        let next = ring.iter().cycle().skip(1);
        let winding: i32 = ring
            .iter()
            .zip(next)
            .map(|(a, b)| {
                let side = (*b - *a).perp_dot(point - *a);
                match (a.y <= point.y, b.y <= point.y) {
                    (true, false) if side > 0.0 => 1,
                    (false, true) if side < 0.0 => -1,
                    _ => 0,
                }
            })
            .sum();
        count += i32::from(winding != 0);
    }
    f64::from(count) / f64::from(steps * steps)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// Lines over each other on a small lattice: every way of crossing, touching and turning back.
    #[test]
    fn any_drawing_on_a_lattice_is_mended(
        rings in prop::collection::vec(prop::collection::vec((0..6i32, 0..6i32), 0..14), 1..5),
        scale in prop::sample::select(vec![1.0, 1e-7, 3e7]),
    ) {
        let rings: Vec<Vec<DVec2>> = rings.iter().map(|ring| {
            ring.iter().map(|(x, y)| DVec2::new(f64::from(*x), f64::from(*y)) * scale).collect()
        }).collect();
        let polygon = Polygon { outline: rings[0].clone(), holes: rings[1..].to_vec() };
        if let Ok((region, _)) = mend(std::slice::from_ref(&polygon)) {
            prop_assert!(region.is_sound());
            let found = area(&region.polygons) / (scale * scale);
            prop_assert!(found > 0.0 && found <= 25.0 + 1e-9);
            let (again, faults) = mend(&region.polygons).unwrap();
            prop_assert!((area(&again.polygons) / (scale * scale) - found).abs() < 1e-9);
            // Rounded crossings may lie on the wrong side of an edge by a step.
            let by_rounding = [Wrong::Crosses, Wrong::Touches, Wrong::Sliver, Wrong::Spike];
            prop_assert!(faults.iter().all(|fault| by_rounding.contains(&fault.wrong)), "{faults:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_ring_encloses_what_it_winds_around(
        corners in prop::collection::vec((0..5i32, 0..5i32), 3..9),
    ) {
        let ring: Vec<DVec2> = corners.iter().map(|(x, y)| DVec2::new(f64::from(*x), f64::from(*y))).collect();
        let counted = counted(&ring, 4, 24);
        let found = mend(&[Polygon { outline: ring, holes: vec![] }]).map_or(0.0, |(region, _)| area(&region.polygons));
        prop_assert!((found - counted).abs() < 0.4, "{found} {counted}");
    }
}
