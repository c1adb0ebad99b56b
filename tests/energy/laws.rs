//! What the model promises: exact cylinders, spheroids, rings that rise outwards.

use super::{columns, scattered, skeleton, tree, uniform};
use fearless_simd::Level;
use glam::DVec3;
use yosegi::nodes::wood::energy::{Axis, EnergyModel, Reference, Rod};

fn bare(reference: Reference) -> EnergyModel {
    let axis = Axis::new(&skeleton(&[[0.0; 3], [0.0, 0.0, 10.0]]), false).unwrap();
    EnergyModel::bare(axis, reference)
}

#[test]
fn on_a_bare_straight_trunk_the_radius_is_the_distance() {
    for point in scattered(300, DVec3::new(-4.0, -4.0, 0.2), DVec3::new(4.0, 4.0, 9.8)) {
        let distance = point.truncate().length();
        for reference in [Reference::Endless, Reference::Local] {
            let radius = bare(reference).terms(point).radius;
            assert!(
                (radius - distance).abs() < 1e-12 * distance.max(1.0),
                "{reference:?} at {point}"
            );
        }
        let at_middle = DVec3::new(point.x, point.y, 5.0);
        let radius = bare(Reference::Middle).terms(at_middle).radius;
        assert!((radius - distance).abs() < 1e-12 * distance.max(1.0));
    }
}

#[test]
fn equal_energies_of_a_rod_are_spheroids() {
    // The known half axes of the spheroid of energy 1.7 around a rod of length 10.
    let (along, across) = (7.2352, 5.2295);
    let rod = Rod::between(DVec3::ZERO, DVec3::new(0.0, 0.0, 10.0), 1.0);
    for angle in (0..32).map(|step| 0.2 * f64::from(step)) {
        let [cosine, sine] = [libm::cos(angle), libm::sin(angle)];
        let point = DVec3::new(across * cosine, 0.0, 5.0 + along * sine);
        assert!((rod.energy(point) - 1.7).abs() < 1e-4, "{point}");
    }
}

#[test]
fn a_rod_is_the_sum_of_its_pieces() {
    let (start, end) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, -2.0, 9.0));
    let middle = start.lerp(end, 0.3);
    for point in scattered(50, DVec3::splat(-9.0), DVec3::splat(9.0)) {
        let whole = Rod::between(start, end, 0.7).energy(point);
        let pieces = Rod::between(start, middle, 0.7).energy(point)
            + Rod::between(middle, end, 0.7).energy(point);
        assert!((whole - pieces).abs() < 1e-12);
    }
}

#[test]
fn charges_only_ever_lower_the_radius() {
    for reference in [Reference::Endless, Reference::Middle, Reference::Local] {
        let charged = tree(reference, false);
        let bare = EnergyModel::bare(charged.axis.clone(), reference);
        for point in scattered(
            300,
            DVec3::new(-300.0, -300.0, 10.0),
            DVec3::new(300.0, 300.0, 2390.0),
        ) {
            assert!(
                charged.terms(point).radius <= bare.terms(point).radius,
                "{reference:?} at {point}"
            );
        }
    }
}

#[test]
fn without_branches_and_burls_radii_less_waves_rise_along_rays() {
    let mut state = 3;
    for reference in [Reference::Endless, Reference::Middle, Reference::Local] {
        let mut model = tree(reference, false);
        (model.branches, model.burls) = (vec![], vec![]);
        // Rods along a bent trunk have rings that lean on each other: only the first is strict on any trunk.
        if reference != Reference::Endless {
            let axis = Axis::new(&skeleton(&[[0.0; 3], [0.0, 0.0, 2400.0]]), false).unwrap();
            model = EnergyModel {
                waves: model.waves,
                ..EnergyModel::bare(axis, reference)
            };
        }
        for _ in 0..1000 {
            let height = 2400.0 * (0.05 + 0.9 * uniform(&mut state));
            let angle = 7.0 * uniform(&mut state);
            let outwards = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0);
            let at = |step: i32| model.axis.at(height) + outwards * (0.25 + f64::from(step));
            let points: Vec<DVec3> = (0..300).map(|step| at(step).as_vec3().as_dvec3()).collect();
            let columns = columns(&model, &points, Level::new());
            let rings: Vec<f32> = columns[0]
                .iter()
                .zip(&columns[4])
                .map(|(radius, wave)| radius - wave)
                .collect();
            assert!(
                rings.windows(2).all(|pair| pair[0] < pair[1]),
                "{reference:?} at {height}, {angle}"
            );
            assert!(rings[0] > 0.0);
        }
    }
}

/// Nearer to the axis than a chord lies off it, rings would be those of the chord.
#[test]
fn rods_follow_a_curved_trunk_closely() {
    let trunk = skeleton(&[
        [0.0, 0.0, 0.0],
        [200.0, 80.0, 1500.0],
        [-150.0, 40.0, 3500.0],
        [60.0, 0.0, 6000.0],
    ]);
    let axis = Axis::new(&trunk, false).unwrap();
    let points = axis.points();
    assert!(points.len() < 1000, "{}", points.len());
    for ends in points.windows(2) {
        let middle = (ends[0] + ends[1]) * 0.5;
        let off = middle.distance(axis.at(middle.z));
        assert!(off < 0.012, "{off} mm at {middle}");
    }
    let upright = Axis::new(
        &skeleton(&[[0.0; 3], [0.0, 0.0, 10.0], [0.0, 0.0, 40.0]]),
        false,
    );
    assert_eq!(upright.unwrap().points().len(), 3);
}
