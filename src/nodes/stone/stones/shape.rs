//! The shape of single stones: how moved corners tilt a top, and how what is cut of a prism fills its cell.

use super::cage::Cage;
use glam::{DVec2, DVec3};

/// The slopes of the plane that comes nearest to corners that are moved up and down.
pub(super) fn plane(base: &[DVec2], moved: &[DVec3]) -> DVec2 {
    let pairs = || base.iter().zip(moved.iter().map(|by| by.z));
    let count = base.len() as f64;
    let middle = base.iter().sum::<DVec2>() / count;
    let mean = pairs().map(|(_, z)| z).sum::<f64>() / count;
    let (mut xx, mut xy, mut yy, mut z) = (0.0, 0.0, 0.0, DVec2::ZERO);
    for (corner, height) in pairs() {
        let from = *corner - middle;
        (xx, xy, yy) = (
            xx + from.x * from.x,
            xy + from.x * from.y,
            yy + from.y * from.y,
        );
        z += from * (height - mean);
    }
    let determinant = xx * yy - xy * xy;
    match determinant > 1e-9 * (xx + yy) * (xx + yy) {
        true => DVec2::new(yy * z.x - xy * z.y, xx * z.y - xy * z.x) / determinant,
        false => DVec2::ZERO,
    }
}

/// Enlarges a prism so that what is cut of it fills its cell and its height, or part of the way there.
pub(super) fn swell(cage: &Cage, corners: &mut [DVec3], base: &[DVec2], share: f64) {
    let points: Vec<DVec3> = cage
        .vertices
        .iter()
        .map(|it| Cage::blend(it, corners))
        .collect();
    let mut scale = f64::INFINITY;
    for (index, from) in base.iter().enumerate() {
        let outwards = -(base[(index + 1) % base.len()] - *from)
            .normalize_or_zero()
            .perp();
        let support = points
            .iter()
            .map(|point| point.truncate().dot(outwards))
            .fold(0.0, f64::max);
        if support > 0.0 {
            scale = scale.min(from.dot(outwards) / support);
        }
    }
    let high = points.iter().map(|point| point.z).fold(0.0, f64::max);
    let top = corners.iter().map(|corner| corner.z).fold(0.0, f64::max);
    let grown = |scale: f64| 1.0 + (scale.clamp(1.0, 3.0) - 1.0) * share;
    let (flat, up) = (grown(scale), grown(top / high.max(1e-9)));
    for corner in corners {
        *corner = DVec3::new(flat * corner.x, flat * corner.y, up * corner.z);
    }
}
