//! Relief: a flat piece that lies on the ground, with its heights as they are, and how it shades itself and the ground.
//!
//! Its corner lies at the origin, its height 0 at z = 0. The heights are sampled once for a view, when it is built, as
//! finely as the picture shows them; kernels hold what came of it, and its key is that of the field.

mod guide;
mod light;
mod lighting;
mod raster;
mod tile;

pub(super) use self::guide::Guide;
use self::light::LightMap;
pub(super) use self::lighting::{Lighting, SmoothLight};
use self::raster::Corners;
use super::light::{Light, Sky, SkyLight};
use super::scene::{Point, relief_surface};
use crate::field::Field;
use crate::geometry::heights::Heights;
use crate::geometry::hierarchy::Ray;
use crate::key::{Key, KeyHasher};
use crate::node::{Build, Failure};
use crate::value::Material;
use glam::{DVec2, DVec3};

/// Most cells of a grid of heights; what would need more is sampled more coarsely.
const MOST_CELLS: f64 = (1 << 23) as f64;

/// A flat piece with its heights.
#[derive(Debug)]
pub(super) struct Relief {
    heights: Heights,
    size: DVec2,
    /// The height of its underside.
    bottom: f64,
    key: Key,
    map: LightMap,
}

/// How a piece is laid out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) size: DVec2,
    /// What heights are multiplied by.
    pub(super) factor: f64,
    /// From the lowest point of the relief down to the ground; left out, by the size of the piece.
    pub(super) thickness: Option<f64>,
    /// The side of what a pixel shows of the piece where it shows least, in mm.
    pub(super) finest: f64,
    /// In how many directions the sky is looked at.
    pub(super) directions: usize,
}

/// The thickness of a piece that states none, as a share of its mean side.
const THICKNESS: f64 = 0.03;

impl Relief {
    /// Samples the heights of a material.
    ///
    /// # Errors
    /// If the run was cancelled, or a height is not a number.
    pub(super) fn new(
        material: &Material,
        layout: &Layout,
        build: &Build<'_>,
    ) -> Result<Relief, Failure> {
        let Layout { size, factor, .. } = *layout;
        let flat = Field::constant(0.0);
        let field = material.channels.get("height").unwrap_or(&flat);
        let cells = match field.as_constant() {
            Some(_) => [1, 1],
            None => cells(size, layout.finest),
        };
        let corners = Corners { cells, size };
        let mut values = corners.sample(field, material.charts(), build)?;
        values
            .iter_mut()
            .for_each(|height| *height *= factor as f32);
        let heights = Heights::new(cells, size, values);
        let thickness = layout
            .thickness
            .unwrap_or(THICKNESS * 0.5 * (size.x + size.y));
        let mut key = KeyHasher::new("relief", 2);
        key.key(field.key()).number(factor).number(thickness);
        material.charts().iter().for_each(|chart| {
            key.key(chart.key());
        });
        for axis in 0..2 {
            key.whole(cells[axis] as i64).number(size[axis]);
        }
        Ok(Relief {
            bottom: heights.range()[0] - thickness,
            map: LightMap::over(&heights, layout.directions),
            heights,
            size,
            key: key.finish(),
        })
    }

    /// The box around it.
    pub(super) fn bounds(&self) -> [DVec3; 2] {
        [
            DVec3::ZERO.with_z(self.bottom),
            self.size.extend(self.heights.range()[1]),
        ]
    }

    /// What a ray meets of it.
    pub(super) fn look(&self, ray: &Ray) -> Option<Point> {
        let (distance, is_edge) = self.heights.first(ray)?;
        let place = ray.point(distance);
        let coordinates = place.truncate().clamp(DVec2::ZERO, self.size);
        let (normal, surface) = match is_edge {
            true => self.edge(place, ray.direction()),
            false => (self.normal(coordinates), relief_surface(None)),
        };
        let is_below = is_edge && place.z < self.bottom;
        (!is_below).then(|| Point {
            coordinates,
            surface,
            ..Point::on_plane(place, normal, distance)
        })
    }

    /// The distance at which a ray meets it from above.
    fn distance(&self, ray: &Ray) -> Option<f64> {
        let (distance, is_edge) = self.heights.first(ray)?;
        (!is_edge).then_some(distance)
    }

    /// The point at a distance along a ray, if it lies no further than `close` above or below the surface.
    fn near(&self, ray: &Ray, distance: f64, close: f64) -> Option<Point> {
        let place = ray.point(distance);
        let coordinates = place.truncate();
        let is_near = self.heights.is_over(coordinates)
            && (place.z - self.heights.height(coordinates)).abs() <= close;
        is_near.then(|| Point {
            coordinates,
            surface: relief_surface(None),
            ..Point::on_plane(place, self.normal(coordinates), distance)
        })
    }

    /// The normal and the surface of the edge at a place of it.
    fn edge(&self, place: DVec3, direction: DVec3) -> (DVec3, u32) {
        let depths = [0, 1].map(|axis| match direction[axis] > 0.0 {
            true => place[axis].abs(),
            false => (place[axis] - self.size[axis]).abs(),
        });
        let axis = usize::from(depths[1] < depths[0]);
        let sign = if direction[axis] > 0.0 { -1.0 } else { 1.0 };
        let number = 2 * axis as u32 + u32::from(sign > 0.0);
        (DVec3::AXES[axis] * sign, relief_surface(Some(number)))
    }

    /// The normal of the surface over a place.
    fn normal(&self, place: DVec2) -> DVec3 {
        (-self.heights.slope(place)).extend(1.0).normalize()
    }

    /// The light from the sky that reaches a point, and the part of each light.
    pub(super) fn light(&self, point: &Point, sky: &Sky, lights: &[Light]) -> (SkyLight, Vec<f64>) {
        self.map.light(self, point, sky, lights)
    }

    /// The light of a sky over the ground far away from it.
    pub(super) fn open_sky(sky: &Sky) -> SkyLight {
        light::open(sky)
    }

    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        key.key(self.key);
    }
}

/// How many cells a piece is divided into, for cells of about a side.
fn cells(size: DVec2, side: f64) -> [usize; 2] {
    let least = (size.x * size.y / MOST_CELLS).sqrt();
    let side = side.max(least);
    [size.x, size.y].map(|length| (length / side).ceil().clamp(1.0, MOST_CELLS) as usize)
}
