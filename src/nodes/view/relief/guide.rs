//! Where rays within pixels meet relief: between the corners of the pixels, whose rays are followed once.

use super::Relief;
use crate::geometry::hierarchy::Ray;
use crate::nodes::view::camera::Camera;
use crate::nodes::view::scene::Point;
use std::sync::OnceLock;

/// Corners of pixels along each side of a tile.
const TILE: usize = 16;

/// Corners that are known beyond the picture, where samples have neighbours.
const BEYOND: usize = 2;

/// Most corners; of a larger picture none are kept.
const MOST: usize = 1 << 24;

/// Between corners that are further away from each other than so many cells every ray is followed.
const FURTHEST: f64 = 16.0;

/// So many cells a place may lie above or below the surface.
const CLOSE: f64 = 0.25;

/// The distances to the relief at the corners of pixels, found tile by tile when they are first asked for.
#[derive(Debug)]
pub(in super::super) struct Guide {
    /// Tiles in a row.
    columns: usize,
    /// Not a number where a ray does not meet the relief from above.
    tiles: Vec<OnceLock<Vec<f32>>>,
}

impl Guide {
    /// Of a picture with so many pixels.
    pub(in super::super) fn new(pixels: [f64; 2]) -> Guide {
        let corners = pixels.map(|side| side as usize + 1 + 2 * BEYOND);
        let [columns, rows] = match corners[0].saturating_mul(corners[1]) <= MOST {
            true => corners.map(|side| side.div_ceil(TILE)),
            false => [0, 0],
        };
        Guide {
            columns,
            tiles: (0..columns * rows).map(|_| OnceLock::new()).collect(),
        }
    }

    /// What a ray at a point of the picture meets, if the corners of its pixel say so.
    pub(in super::super) fn look(
        &self,
        (relief, camera): (&Relief, &Camera),
        ray: &Ray,
        [u, v]: [f64; 2],
    ) -> Option<Point> {
        let [x, y] = [u.floor(), v.floor()];
        let (right, down) = (u - x, v - y);
        if right == 0.5 && down == 0.5 {
            // The middle of a pixel, which has to be right.
            return None;
        }
        let corner = |x: f64, y: f64| self.corner((relief, camera), [x, y]);
        let [a, b] = [corner(x, y)?, corner(x + 1.0, y)?];
        let [c, d] = [corner(x, y + 1.0)?, corner(x + 1.0, y + 1.0)?];
        let cell = relief.heights.finest();
        let across = a.max(b).max(c).max(d) - a.min(b).min(c).min(d);
        // False if any is not a number.
        let are_close = (a + b + c + d).is_finite() && across <= FURTHEST * cell;
        if !are_close {
            return None;
        }
        let distance = (a + (b - a) * right) * (1.0 - down) + (c + (d - c) * right) * down;
        relief.near(ray, distance, CLOSE * cell)
    }

    /// The distance at a corner of pixels.
    fn corner(&self, (relief, camera): (&Relief, &Camera), place: [f64; 2]) -> Option<f64> {
        let [x, y] = place.map(|at| at + BEYOND as f64);
        if x < 0.0 || y < 0.0 {
            return None;
        }
        let [x, y] = [x as usize, y as usize];
        let [column, row] = [x / TILE, y / TILE];
        if column >= self.columns {
            return None;
        }
        let tile = self.tiles.get(row * self.columns + column)?;
        let distance = |index: usize| {
            let at = [column * TILE + index % TILE, row * TILE + index / TILE];
            let [u, v] = at.map(|at| at as f64 - BEYOND as f64);
            let found = relief.distance(&camera.ray(u, v));
            found.map_or(f32::NAN, |distance| distance as f32)
        };
        let tile = tile.get_or_init(|| (0..TILE * TILE).map(distance).collect());
        Some(f64::from(tile[y % TILE * TILE + x % TILE]))
    }
}
