//! Tests of Loop subdivision: values of a cube, borders, edges of many triangles, and the limit.

use super::*;
use glam::DVec3;

/// The cube from -1 to 1, each side of two triangles.
const CUBE: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

fn cube() -> (Topology, Vec<DVec3>) {
    let side = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    let point = |index: usize| DVec3::new(side(index & 1), side(index & 2), side(index & 4));
    (Topology::new(8, CUBE.to_vec()), (0..8).map(point).collect())
}

fn step(topology: &Topology, points: &[DVec3]) -> (Topology, Vec<DVec3>) {
    let next = Topology::new(topology.refined_points(), topology.refined_triangles());
    (next, topology.refined(points))
}

/// Sums of the points, of their squares and of their fourth powers, along each axis.
fn sums(points: &[DVec3]) -> [DVec3; 3] {
    [1, 2, 4].map(|power| {
        points
            .iter()
            .map(|it| it.map(|part| part.powi(power)))
            .sum()
    })
}

fn is_near(found: DVec3, expected: DVec3) {
    assert!(
        (found - expected).length() < 1e-12,
        "{found}, not {expected}"
    );
}

#[test]
fn cubes_become_what_was_computed_apart() {
    let (topology, points) = cube();
    let (topology, points) = step(&topology, &points);
    let [first, second, fourth] = sums(&points);
    assert_eq!(points.len(), 26);
    is_near(first, DVec3::ZERO);
    is_near(second, DVec3::splat(9.6182861328125));
    is_near(fourth, DVec3::splat(5.786578424274921));
    let points = topology.refined(&points);
    let [first, second, fourth] = sums(&points);
    assert_eq!(points.len(), 98);
    is_near(first, DVec3::ZERO);
    is_near(second, DVec3::splat(28.72342947125435));
    is_near(fourth, DVec3::splat(14.032199920744716));
}

#[test]
fn corners_of_a_cube_come_to_lie_where_they_should() {
    let (topology, points) = cube();
    let limits = topology.limit(&points);
    let (low, high) = (0.4363636363636364, 0.7181818181818183);
    is_near(limits[0], DVec3::splat(-0.5));
    is_near(limits[1], DVec3::new(high, -low, -low));
    is_near(limits[3], DVec3::new(low, low, -high));
    is_near(limits[5], DVec3::new(low, -high, low));
    is_near(limits[7], DVec3::splat(0.5));
}

/// After some steps the points lie near their limits, and triangles face along the normals.
#[test]
fn limits_are_where_steps_lead() {
    let (mut topology, mut points) = cube();
    let (limits, normals) = (topology.limit(&points), normals(&topology, &points));
    for _ in 0..5 {
        (topology, points) = step(&topology, &points);
    }
    let mut faces = [DVec3::ZERO; 8];
    for corners in topology.refined_triangles() {
        let refined = topology.refined(&points);
        let [a, b, c] = corners.map(|index| refined[index as usize]);
        for corner in corners.iter().filter(|corner| **corner < 8) {
            faces[*corner as usize] += (b - a).cross(c - a);
        }
        if faces.iter().all(|face| face.length() > 0.0) {
            break;
        }
    }
    for index in 0..8 {
        assert!((points[index] - limits[index]).length() < 1e-3);
        let normal = normals[index].unwrap();
        assert!(faces[index].normalize().dot(normal) > 0.99, "{index}");
    }
}

/// A strip of squares in a plane: its normals point up also at the border, and its corners stay.
#[test]
fn borders_stay_in_the_plane_and_turn_like_curves() {
    let point = |index: u32| DVec3::new(f64::from(index % 4), f64::from(index / 4), 0.0);
    let points: Vec<DVec3> = (0..16).map(point).collect();
    let squares = (0..9u32).map(|square| square / 3 * 4 + square % 3);
    let triangles = squares.flat_map(|at| [[at, at + 1, at + 5], [at, at + 5, at + 4]]);
    let topology = Topology::new(16, triangles.collect());
    for normal in normals(&topology, &points) {
        is_near(normal.unwrap(), DVec3::Z);
    }
    let refined = topology.refined(&points);
    // 1/8 of (2, 0), 3/4 of (3, 0), 1/8 of (3, 1).
    is_near(refined[3], DVec3::new(2.875, 0.125, 0.0));
    is_near(refined[1], DVec3::X);
    is_near(
        topology.limit(&points)[3],
        DVec3::new(3.0 - 1.0 / 6.0, 1.0 / 6.0, 0.0),
    );
}

/// Three fins at one edge: it is a crease, its ends stay, and nothing has a normal there.
#[test]
fn edges_of_three_triangles_are_creases() {
    let points = [DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::Y, DVec3::NEG_X];
    let topology = Topology::new(5, vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
    let refined = topology.refined(&points);
    is_near(refined[0], points[0]);
    is_near(refined[1], points[1]);
    assert!(refined.contains(&DVec3::new(0.0, 0.0, 0.5)));
    assert!(normals(&topology, &points)[0].is_none());
    // A point that no triangle has stays as well.
    let alone = Topology::new(1, vec![]);
    is_near(alone.refined(&[DVec3::ONE])[0], DVec3::ONE);
}
