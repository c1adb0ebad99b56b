//! The kernels that send rays: what every point of the picture sees, and how that is lit.
//!
//! They know nothing of materials, so a new colour finds their columns where they were. They are two, since materials
//! that are sampled within a pixel need to know where, but not how it is lit there.

use super::camera::Camera;
use super::light::{Disc, Light, Sky, Turn};
use super::relief::Guide;
use super::scene::{Point, Scene};
use crate::field::{Block, InputColumn, Kernel};
use crate::geometry::hierarchy::Ray;
use crate::key::KeyHasher;
use glam::DVec3;
use std::sync::Arc;

/// What the columns of [`Sight`] hold, by the first of each.
pub(super) mod seen {
    /// Where the surface is, in mm.
    pub(in super::super) const PLACE: usize = 0;
    /// The normal of the smooth surface.
    pub(in super::super) const NORMAL: usize = 3;
    /// The number of the surface; 0 where there is none.
    pub(in super::super) const SURFACE: usize = 6;
    /// How many of the columns the shading reads.
    pub(in super::super) const SHADED: usize = 7;
    /// The place on the square of a mesh's maps, and 0.
    pub(in super::super) const COORDINATES: usize = 7;
    /// How many there are.
    pub(in super::super) const ALL: usize = 10;
}

/// What the columns of [`Illumination`], or of a relief's, hold, by the first of each.
pub(super) mod lit {
    /// The share of the sky that is seen; less than 0 where there is not even ground.
    pub(in super::super) const OPENNESS: usize = 0;
    /// How bright the sky makes a white surface.
    pub(in super::super) const SKY: usize = 1;
    /// The part of each light that is seen.
    pub(in super::super) const LIGHTS: usize = 4;
}

/// What stands for the share of the sky that is seen, where a ray meets nothing.
pub(super) const NOWHERE: f64 = -1.0;

/// Everything but the materials.
#[derive(Debug)]
pub(super) struct Stage {
    pub(super) camera: Camera,
    pub(super) scene: Scene,
    pub(super) lights: Vec<Light>,
    pub(super) disc: Disc,
    pub(super) sky: Sky,
    /// For relief.
    pub(super) guide: Option<Guide>,
}

impl Stage {
    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        self.camera.add_to_key(key);
        self.scene.add_to_key(key);
        self.sky.add_to_key(key);
        key.whole(self.lights.len() as i64);
        self.lights.iter().for_each(|light| light.add_to_key(key));
    }
}

impl Stage {
    /// What is seen at a point of the picture: a thing, or the ground.
    fn look(&self, u: f64, v: f64) -> (Ray, Option<Point>) {
        let ray = self.camera.ray(u, v);
        let relief = self.scene.relief.iter();
        let near = relief
            .zip(&self.guide)
            .find_map(|(relief, guide)| guide.look((relief, &self.camera), &ray, [u, v]));
        let seen = near.or_else(|| self.scene.look(&ray));
        (ray, seen.or_else(|| self.scene.ground_point(&ray)))
    }
}

/// What is seen.
#[derive(Debug)]
pub(super) struct Sight(pub(super) Arc<Stage>);

impl Kernel for Sight {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view sight").whole(i64::from(super::KIND.version));
        self.0.add_to_key(key);
    }

    fn width(&self) -> usize {
        seen::ALL
    }

    fn nanoseconds(&self) -> f32 {
        1000.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        each(block, |position, row| {
            let (ray, point) = self.0.look(position[0], position[1]);
            let point =
                point.unwrap_or_else(|| Point::on_plane(DVec3::ZERO, -ray.direction(), 0.0));
            row[seen::PLACE..][..3].copy_from_slice(&point.place.to_array());
            row[seen::NORMAL..][..3].copy_from_slice(&point.normal.to_array());
            row[seen::SURFACE] = f64::from(point.surface);
            row[seen::COORDINATES] = point.coordinates.x;
            row[seen::COORDINATES + 1] = point.coordinates.y;
        });
    }
}

/// How it is lit.
#[derive(Debug)]
pub(super) struct Illumination(pub(super) Arc<Stage>);

impl Kernel for Illumination {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view illumination")
            .whole(i64::from(super::KIND.version));
        self.0.add_to_key(key);
    }

    fn width(&self) -> usize {
        lit::LIGHTS + self.0.lights.len()
    }

    fn nanoseconds(&self) -> f32 {
        20_000.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let Stage {
            scene,
            lights,
            disc,
            sky,
            ..
        } = &*self.0;
        each(block, |position, row| {
            let (u, v) = (position[0], position[1]);
            let Some(point) = self.0.look(u, v).1 else {
                row.fill(0.0);
                row[lit::OPENNESS] = NOWHERE;
                return;
            };
            let turn = Turn::at(u, v);
            let of_sky = sky.light(Some(scene), &point, &turn);
            row[lit::OPENNESS] = of_sky.openness;
            row[lit::SKY..][..3].copy_from_slice(&of_sky.colour);
            for (part, light) in row[lit::LIGHTS..].iter_mut().zip(lights) {
                *part = light.visibility(scene, disc, &point, &turn);
            }
        });
    }
}

/// Writes a row of columns for every row of the inputs.
pub(super) fn each(block: &mut Block<'_>, mut write: impl FnMut(&[f64], &mut [f64])) {
    let mut row = vec![0.0; block.outputs.len()];
    let mut inputs = vec![0.0; block.inputs.len()];
    for index in 0..block.outputs[0].len() {
        // Columns are padded with copies of the last sample.
        let is_copy = index > 0 && {
            let is_same = |it: &InputColumn<'_>| it.values[index] == it.values[index - 1];
            block.inputs.iter().all(is_same)
        };
        if !is_copy {
            for (input, column) in inputs.iter_mut().zip(block.inputs) {
                *input = f64::from(column.values[index]);
            }
            write(&inputs, &mut row);
        }
        for (output, value) in block.outputs.iter_mut().zip(&row) {
            output[index] = *value as f32;
        }
    }
}
