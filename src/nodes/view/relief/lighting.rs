//! The kernels that light relief: what reaches the places that are seen, and its mean over pixels.
//!
//! The light has detail where materials have none, and asking for it within a pixel is cheap. So its mean is taken before
//! the materials come in, and these are asked for once a pixel, but where a pixel shows near and far things.

use crate::colour::luminance;
use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::nodes::view::KIND;
use crate::nodes::view::rays::{NOWHERE, Stage, each, lit, seen};
use crate::nodes::view::scene::Point;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// How it is lit, from what is seen: the columns of [`lit`], but of each light how much of it falls on the surface; then
/// the normal, and a number by which edges are found.
#[derive(Debug)]
pub(in super::super) struct Lighting(pub(in super::super) Arc<Stage>);

/// Columns behind those of [`lit`]: the normal, and the number by which edges are found.
const MORE: usize = 4;

/// How much the brightness of the sky's light counts where edges are looked for.
const SKY: f64 = 0.3;

impl Lighting {
    /// The first column of the normal.
    pub(in super::super) fn normal(&self) -> usize {
        lit::LIGHTS + self.0.lights.len()
    }

    /// The point that is seen, or `None` if there is not even ground.
    fn point(&self, sight: &[f64]) -> Option<Point> {
        let vector = |first: usize| DVec3::from_slice(&sight[first..first + 3]);
        let (normal, surface) = (vector(seen::NORMAL), sight[seen::SURFACE] as u32);
        let is_there = surface != 0 || self.0.scene.ground.is_some() && normal == DVec3::Z;
        is_there.then(|| Point {
            surface,
            coordinates: DVec2::from_slice(&sight[seen::COORDINATES..seen::COORDINATES + 2]),
            ..Point::on_plane(vector(seen::PLACE), normal, 0.0)
        })
    }
}

impl Kernel for Lighting {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view lighting").whole(i64::from(KIND.version));
        self.0.add_to_key(key);
    }

    fn width(&self) -> usize {
        self.normal() + MORE
    }

    fn nanoseconds(&self) -> f32 {
        20_000.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let Stage { lights, sky, .. } = &*self.0;
        each(block, |sight, row| {
            row.fill(0.0);
            row[lit::OPENNESS] = NOWHERE;
            let (Some(point), Some(relief)) = (self.point(sight), &self.0.scene.relief) else {
                return;
            };
            let (of_sky, of_lights) = relief.light(&point, sky, lights);
            row[lit::OPENNESS] = of_sky.openness;
            row[lit::SKY..][..3].copy_from_slice(&of_sky.colour);
            let mut direct = 0.0;
            for (index, (light, visibility)) in lights.iter().zip(of_lights).enumerate() {
                let seen = light.seen(point.place);
                let falling = point.normal.dot(seen.direction).max(0.0) * visibility;
                row[lit::LIGHTS + index] = falling;
                direct += brightness(light.colour) * seen.falloff * falling;
            }
            let normal = self.normal();
            row[normal..][..3].copy_from_slice(&point.normal.to_array());
            row[normal + 3] = direct + SKY * brightness(of_sky.colour);
        });
    }
}

fn brightness(colour: [f64; 3]) -> f64 {
    f64::from(luminance(colour.map(|part| part as f32)))
}

/// Gives all columns but the last; where that shows an edge, their means within the pixel.
#[derive(Debug)]
pub(in super::super) struct SmoothLight {
    /// How many columns there are.
    pub(in super::super) columns: usize,
}

/// Bend of brightness from which on the light of a pixel is divided: a step of 0.1 bends by an eighth of that.
const EDGE: f32 = 0.02;

impl Kernel for SmoothLight {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view smooth light")
            .whole(i64::from(KIND.version))
            .whole(self.columns as i64);
    }

    fn width(&self) -> usize {
        self.columns - 1
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereStraight {
            column: self.columns - 1,
            absolute: EDGE,
            relative: 0.0,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            output.copy_from_slice(input.values);
        }
    }
}
