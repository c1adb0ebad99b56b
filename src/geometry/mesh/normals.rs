//! Normals at the corners of triangles: from the file, or smoothed over faces that meet at a small angle.
//!
//! A smoothed normal is the mean of the faces around a point, each weighted by its angle there (Thürmer & Wüthrich
//! 1998), of those that lie within the crease angle of the corner's own face.

use super::{Finish, Soup, face_normal, numbered};
use glam::DVec3;
use std::collections::HashMap;

/// Most triangles around a point whose normals are smoothed: the work grows with the square.
const MOST_AROUND: usize = 256;

/// Points looked at between two questions whether to go on.
const AT_ONCE: usize = 4096;

/// The normals, and for each triangle those of its corners.
pub(super) fn of_corners<E>(
    soup: &Soup,
    finish: Finish,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), E> {
    let faces = soup.triangles.iter();
    let faces: Vec<DVec3> = faces
        .map(|corners| face_normal(&soup.points, corners.points).unwrap_or(DVec3::Z))
        .collect();
    let mut normals: Vec<[DVec3; 3]> = faces.iter().map(|normal| [*normal; 3]).collect();
    for (number, corners) in around_points(soup).iter().enumerate() {
        if number % AT_ONCE == 0 {
            go_on()?;
        }
        if corners.len() <= MOST_AROUND {
            smooth(soup, &faces, corners, finish.crease, &mut normals);
        }
    }
    if finish.keeps_normals {
        keep(soup, &mut normals);
    }
    let mut first = HashMap::new();
    let flat: Vec<DVec3> = normals.concat();
    let bits = |normal: &DVec3| normal.to_array().map(|part| (part + 0.0).to_bits());
    let numbers = numbered(flat.iter().map(bits), &mut first);
    let corners = numbers.chunks_exact(3).map(|it| [it[0], it[1], it[2]]);
    Ok((super::distinct(&flat, &numbers), corners.collect()))
}

/// For every point the corners there: triangle and number of the corner.
fn around_points(soup: &Soup) -> Vec<Vec<(u32, u8)>> {
    let mut around = vec![vec![]; soup.points.len()];
    for (triangle, corners) in (0..).zip(&soup.triangles) {
        for (corner, point) in (0..).zip(corners.points) {
            around[point as usize].push((triangle, corner));
        }
    }
    around
}

/// Smooths the normals of the corners at one point.
fn smooth(
    soup: &Soup,
    faces: &[DVec3],
    corners: &[(u32, u8)],
    crease: f64,
    normals: &mut [[DVec3; 3]],
) {
    let least = libm::cos(crease) - 1e-9;
    let weighted: Vec<(DVec3, f64)> = corners
        .iter()
        .map(|(triangle, corner)| {
            let points = soup.triangles[*triangle as usize].points;
            (faces[*triangle as usize], angle(soup, points, *corner))
        })
        .collect();
    for (triangle, corner) in corners {
        let own = faces[*triangle as usize];
        let near = weighted.iter().filter(|(face, _)| face.dot(own) >= least);
        let sum: DVec3 = near.map(|(face, angle)| *face * *angle).sum();
        if let Some(normal) = sum.try_normalize() {
            normals[*triangle as usize][usize::from(*corner)] = normal;
        }
    }
}

/// The angle of a triangle at one of its corners.
fn angle(soup: &Soup, points: [u32; 3], corner: u8) -> f64 {
    let point = |step: u8| soup.points[points[usize::from((corner + step) % 3)] as usize];
    let sides = [1, 2].map(|step| (point(step) - point(0)).normalize_or_zero());
    libm::acos(sides[0].dot(sides[1]).clamp(-1.0, 1.0))
}

/// Takes the normals of the file where they have a direction.
fn keep(soup: &Soup, normals: &mut [[DVec3; 3]]) {
    for (corners, normals) in soup.triangles.iter().zip(normals) {
        for (index, normal) in corners.normals.iter().flatten().zip(normals) {
            if let Some(stated) = soup.normals[*index as usize].try_normalize() {
                *normal = stated;
            }
        }
    }
}
