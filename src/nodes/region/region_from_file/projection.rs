//! Longitude and latitude on the plane: transverse Mercator (Snyder 1987).

use glam::DVec2;

/// The ellipsoid of WGS 84: its larger radius in m, and the square of its eccentricity.
const RADIUS: f64 = 6_378_137.0;
const ECCENTRICITY_SQUARED: f64 = 6.694_379_990_141_316e-3;

/// A projection around a point, true to scale there.
pub(super) struct Projection {
    /// Longitude and latitude in radians.
    centre: DVec2,
    /// The arc from the equator, in m.
    arc: f64,
}

impl Projection {
    /// The projection around a point, in degrees.
    pub(super) fn around(centre: DVec2) -> Projection {
        let centre = centre.map(f64::to_radians);
        Projection {
            centre,
            arc: meridian_arc(centre.y),
        }
    }

    /// Where a point in degrees lies, in mm: x east, y north. Snyder 1987, eqs. (8-9) and (8-10) with k0 = 1.
    pub(super) fn place(&self, degrees: DVec2) -> DVec2 {
        let [longitude, latitude] = degrees.to_array().map(f64::to_radians);
        let (sine, cosine) = libm::sincos(latitude);
        let second = ECCENTRICITY_SQUARED / (1.0 - ECCENTRICITY_SQUARED);
        let across = RADIUS / (1.0 - ECCENTRICITY_SQUARED * sine * sine).sqrt();
        let tangent = sine / cosine;
        let (t, c) = (tangent * tangent, second * cosine * cosine);
        let a = (longitude - self.centre.x) * cosine;
        let (a2, a3) = (a * a, a * a * a);
        let fifth = 5.0 - 18.0 * t + t * t + 72.0 * c - 58.0 * second;
        let x = across * (a + (1.0 - t + c) * a3 / 6.0 + fifth * a3 * a2 / 120.0);
        let fourth = 5.0 - t + 9.0 * c + 4.0 * c * c;
        let sixth = 61.0 - 58.0 * t + t * t + 600.0 * c - 330.0 * second;
        let bend = a2 / 2.0 + fourth * a2 * a2 / 24.0 + sixth * a3 * a3 / 720.0;
        let y = meridian_arc(latitude) - self.arc + across * tangent * bend;
        1000.0 * DVec2::new(x, y)
    }
}

/// The arc from the equator to a latitude, in m. Snyder 1987, eq. (3-21).
fn meridian_arc(latitude: f64) -> f64 {
    let e2 = ECCENTRICITY_SQUARED;
    let (e4, e6) = (e2 * e2, e2 * e2 * e2);
    let parts = (1.0 - e2 / 4.0 - 3.0 * e4 / 64.0 - 5.0 * e6 / 256.0) * latitude
        - (3.0 * e2 / 8.0 + 3.0 * e4 / 32.0 + 45.0 * e6 / 1024.0) * libm::sin(2.0 * latitude)
        + (15.0 * e4 / 256.0 + 45.0 * e6 / 1024.0) * libm::sin(4.0 * latitude)
        - 35.0 * e6 / 3072.0 * libm::sin(6.0 * latitude);
    RADIUS * parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_meridian_has_its_length() {
        // WGS 84: 10,001,965.729 m.
        assert!((meridian_arc(90f64.to_radians()) - 10_001_965.729).abs() < 0.01);
    }

    #[test]
    fn short_ways_have_the_lengths_of_the_radii_of_curvature() {
        let projection = Projection::around(DVec2::new(8.5, 47.0));
        let sine = libm::sin(47f64.to_radians());
        let w = 1.0 - ECCENTRICITY_SQUARED * sine * sine;
        let step = 1e-3f64;
        let east = projection.place(DVec2::new(8.5 + step, 47.0));
        let across = RADIUS / w.sqrt() * libm::cos(47f64.to_radians()) * step.to_radians() * 1000.0;
        assert!((east.x / across - 1.0).abs() < 1e-9);
        let north = projection.place(DVec2::new(8.5, 47.0 + step));
        let along =
            RADIUS * (1.0 - ECCENTRICITY_SQUARED) / (w * w.sqrt()) * step.to_radians() * 1000.0;
        assert!((north.y / along - 1.0).abs() < 1e-6);
        assert!(north.x.abs() < 1e-6);
    }

    /// What the series of Krüger to the sixth order gives (Karney 2011), computed apart.
    #[test]
    fn it_agrees_with_the_longer_series() {
        let far = Projection::around(DVec2::ZERO).place(DVec2::new(1.5, 40.5)) / 1000.0;
        assert!(
            (far - DVec2::new(127_153.948_885, 4_486_129.853_604)).length() < 0.01,
            "{far}"
        );
        let near = Projection::around(DVec2::new(8.5, 47.366)).place(DVec2::new(8.5021, 47.3671));
        assert!(
            (near - DVec2::new(158_620.345_671, 122_297.925_872)).length() < 0.01,
            "{near}"
        );
    }
}
