//! What cuts leave of a mesh, as points that a picture has to show.

use super::scene::Cut;
use crate::value::{Mesh, Triangle};
use glam::DVec3;

/// The corners of all triangles of a mesh after its part before any of the cuts is taken away
/// (Sutherland & Hodgman 1974).
///
/// Where a triangle is cut, the new corners on its edges count; a triangle that only touches what is left does not.
pub(super) fn left_by(mesh: &Mesh, cuts: &[Cut]) -> Vec<DVec3> {
    let is_whole = |point: &DVec3| cuts.iter().all(|cut| cut.height(*point) < 0.0);
    let mut left: Vec<DVec3> = mesh.points.iter().copied().filter(is_whole).collect();
    let (mut polygon, mut clipped) = (vec![], vec![]);
    for triangle in &mesh.triangles {
        let corners = corners(mesh, triangle);
        if corners.iter().all(is_whole) {
            continue;
        }
        polygon.clear();
        polygon.extend(corners);
        for cut in cuts {
            clip(&polygon, cut, &mut clipped);
            std::mem::swap(&mut polygon, &mut clipped);
        }
        left.extend(&polygon);
    }
    left
}

/// The part of a polygon behind a plane; nothing if it only touches the plane.
fn clip(polygon: &[DVec3], cut: &Cut, left: &mut Vec<DVec3>) {
    left.clear();
    if polygon.iter().all(|point| cut.height(*point) >= 0.0) {
        return;
    }
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (from, to) = (cut.height(*a), cut.height(*b));
        if from <= 0.0 {
            left.push(*a);
        }
        if from.min(to) < 0.0 && from.max(to) > 0.0 {
            left.push(*a + (*b - *a) * (from / (from - to)));
        }
    }
}

/// Where three planes meet behind all others: what is left may have a corner there that lies on no triangle.
pub(super) fn corners_of(cuts: &[Cut], margin: f64) -> Vec<DVec3> {
    let mut corners = vec![];
    for (third, c) in cuts.iter().enumerate() {
        for (second, b) in cuts[..third].iter().enumerate() {
            for (first, a) in cuts[..second].iter().enumerate() {
                let is_behind = |point: &DVec3| {
                    let others = cuts.iter().enumerate();
                    let mut others =
                        others.filter(|(index, _)| ![first, second, third].contains(index));
                    others.all(|(_, cut)| cut.height(*point) <= margin)
                };
                corners.extend(meeting(a, b, c).filter(is_behind));
            }
        }
    }
    corners
}

/// The point of three planes; none if a line or plane of them is parallel to another.
fn meeting(a: &Cut, b: &Cut, c: &Cut) -> Option<DVec3> {
    let volume = a.normal.dot(b.normal.cross(c.normal));
    let along = |cut: &Cut, others: DVec3| others * cut.normal.dot(cut.point);
    let sum = along(a, b.normal.cross(c.normal))
        + along(b, c.normal.cross(a.normal))
        + along(c, a.normal.cross(b.normal));
    (volume.abs() > 1e-9).then(|| sum / volume)
}

/// Whether points of what is left lie behind all planes by no more than `margin`: then it has no inside.
pub(super) fn is_flat(left: &[DVec3], cuts: &[Cut], margin: f64) -> bool {
    let is_touched = |cut: &Cut| left.iter().all(|point| cut.height(*point) >= -margin);
    cuts.iter().any(is_touched)
}

/// The places of a triangle's corners.
pub(super) fn corners(mesh: &Mesh, triangle: &Triangle) -> [DVec3; 3] {
    triangle.points.map(|index| mesh.points[index as usize])
}
