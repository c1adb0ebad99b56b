//! The kernel that shades: what is seen, how it is lit and what it is made of become light.
//!
//! Lights: GGX (Walter and others 2007) with the height-correlated Smith term (Heitz 2014) and Schlick's Fresnel
//! term over Lambert's diffuse. The sky: its light over a white surface from `rays`, and its mirror image by the
//! split sum (Karis 2013), both with what is scattered more than once (Fdez-Agüera 2019), so that a white
//! surface under a white sky is white at any roughness. Between things light is reflected many times, which
//! keeps bright corners bright (Jimenez and others 2016).

use super::rays::{Stage, lit, seen};
use super::scene::is_cut_face;
use crate::colour::luminance;
use crate::field::{Block, InputColumn, Kernel};
use crate::key::KeyHasher;
use glam::{DVec3, Vec3};
use std::f32::consts::PI;
use std::sync::Arc;

/// Columns of a material: colour, height, roughness, metalness, occlusion.
pub(super) const MATERIAL: usize = 7;

/// How much light a surface reflects that is looked at straight and is no metal.
const PLAIN: f32 = 0.04;

/// Shades; the first input are the picture's positions, then what is seen, how it is lit, and the materials.
///
/// What is seen of relief, and how it is lit, are means over pixels; of a light these are of how much of it falls on the
/// surface.
#[derive(Debug)]
pub(super) struct Shade {
    pub(super) stage: Arc<Stage>,
    /// Whether there is a second material, for what is not a cut face.
    pub(super) has_bark: bool,
    /// Whether heights bend the light.
    pub(super) has_relief: bool,
    /// Multiplies all light but the background's.
    pub(super) exposure: f32,
    /// What is seen behind everything.
    pub(super) background: [f32; 3],
    /// How bright the sky makes the ground where nothing hides it.
    pub(super) open_sky: [f32; 3],
}

/// How much the brightness of shadows counts where edges are looked for: sharp ones are found, and the
/// small steps of soft ones are not.
const SHADOW: f32 = 0.3;

/// How much a step of a pixel's width away from the camera counts where edges are looked for.
const DEPTH: f32 = 0.02;

/// Columns before those of what is seen, and before those of how it is lit.
const SEEN: usize = 3;
const LIT: usize = SEEN + seen::SHADED;

/// A surface at one sample.
#[derive(Clone, Copy)]
struct Surface {
    colour: Vec3,
    roughness: f32,
    metalness: f32,
    occlusion: f32,
}

/// How bright the sides of a flat piece are beside its upper edge, which is all that its material knows of them.
const SIDE: f32 = 0.45;

impl Kernel for Shade {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view shade").whole(i64::from(super::KIND.version));
        self.stage.add_to_key(key);
        key.whole(i64::from(self.has_bark))
            .whole(i64::from(self.has_relief));
        key.number(f64::from(self.exposure));
        self.background
            .iter()
            .chain(&self.open_sky)
            .for_each(|part| {
                key.number(f64::from(*part));
            });
    }

    /// Linear colour, and a number by which edges are found.
    fn width(&self) -> usize {
        4
    }

    fn reads_spread(&self, input: usize) -> bool {
        let is_seen =
            |first: usize, count: usize| (SEEN + first..SEEN + first + count).contains(&input);
        let materials = self.materials();
        let is_height = input >= materials && (input - materials) % MATERIAL == 3;
        self.has_relief && (is_seen(seen::PLACE, 3) || is_height)
    }

    fn nanoseconds(&self) -> f32 {
        100.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for index in 0..block.inputs[0].values.len() {
            let shaded = self.shade(block.inputs, index);
            for (output, value) in block.outputs.iter_mut().zip(shaded) {
                output[index] = value;
            }
        }
    }
}

impl Shade {
    /// The first column of the materials.
    fn materials(&self) -> usize {
        LIT + lit::LIGHTS + self.stage.lights.len()
    }

    fn shade(&self, inputs: &[InputColumn<'_>], index: usize) -> [f32; 4] {
        let column = |first: usize| inputs[first].values[index];
        let vector = |first: usize| Vec3::new(column(first), column(first + 1), column(first + 2));
        let number = column(SEEN + seen::SURFACE);
        let normal = match self.stage.scene.relief {
            Some(_) => vector(SEEN + seen::NORMAL).normalize_or(Vec3::Z),
            None => vector(SEEN + seen::NORMAL),
        };
        let place = vector(SEEN + seen::PLACE);
        let sky = vector(LIT + lit::SKY);
        let openness = column(LIT + lit::OPENNESS);
        let lights = self.lights(place, normal, |light| column(LIT + lit::LIGHTS + light));
        if number == 0.0 {
            return self.ground(openness >= 0.0, normal, sky, &lights);
        }
        let is_bark = self.has_bark && !is_cut_face(number as u32);
        let first = self.materials() + if is_bark { MATERIAL } else { 0 };
        let value = |part: usize| column(first + part);
        let mut surface = Surface {
            colour: Vec3::new(value(0), value(1), value(2)).clamp(Vec3::ZERO, Vec3::ONE),
            roughness: value(4).clamp(0.045, 1.0),
            metalness: value(5).clamp(0.0, 1.0),
            occlusion: value(6).clamp(0.0, 1.0),
        };
        if self.stage.scene.relief.is_some() && is_cut_face(number as u32) {
            surface = surface.side();
        }
        let bent = if self.has_relief {
            bend(normal, inputs, index, first + 3)
        } else {
            normal
        };
        let (u, v) = (inputs[0].values[index], inputs[1].values[index]);
        let towards = -self
            .stage
            .camera
            .ray(f64::from(u), f64::from(v))
            .direction();
        let towards = towards.as_vec3();
        let openness = openness * surface.occlusion;
        let mut light = self.sky(&surface, bent, towards, sky, openness);
        for lit in &lights {
            light += surface.reflect(bent, towards, lit);
        }
        light *= self.exposure;
        [
            light.x,
            light.y,
            light.z,
            self.edge(number, place, normal, sky, &lights),
        ]
    }

    /// The number by which edges are found.
    fn edge(&self, number: f32, place: Vec3, normal: Vec3, sky: Vec3, lights: &[Lit]) -> f32 {
        if self.stage.scene.relief.is_some() {
            return number + self.depth(place);
        }
        let facing =
            |lit: &Lit| luminance(lit.colour.to_array()) * normal.dot(lit.direction).max(0.0);
        let whole: f32 = lights.iter().map(facing).sum();
        let lit: f32 = lights.iter().map(|lit| facing(lit) * lit.visibility).sum();
        let shadow = (lit + luminance(sky.to_array())).sqrt();
        number + whole + SHADOW * shadow
    }

    /// What makes edges of a relief before itself count: how far away it is.
    fn depth(&self, place: Vec3) -> f32 {
        DEPTH * self.stage.camera.pixels_away(place.as_dvec3()) as f32
    }

    /// The lights as they reach a place, by their columns.
    fn lights(&self, place: Vec3, normal: Vec3, column: impl Fn(usize) -> f32) -> Vec<Lit> {
        let lit = |(index, light): (usize, &super::light::Light)| {
            let seen = light.seen(place.as_dvec3());
            let direction = seen.direction.as_vec3();
            let (facing, column) = (normal.dot(direction), column(index));
            Lit {
                direction,
                width: seen.width as f32,
                colour: DVec3::from_array(light.colour).as_vec3() * seen.falloff as f32,
                visibility: match self.stage.scene.relief {
                    Some(_) if facing > 0.0 => column / facing,
                    Some(_) => 0.0,
                    None => column,
                },
                mean: self.stage.scene.relief.is_some().then_some(column),
            }
        };
        self.stage.lights.iter().enumerate().map(lit).collect()
    }

    /// The background, darker where things keep light from the ground.
    fn ground(&self, is_there: bool, normal: Vec3, sky: Vec3, lights: &[Lit]) -> [f32; 4] {
        let background = Vec3::from_array(self.background);
        let direct = |lit: &Lit| lit.colour * normal.dot(lit.direction).max(0.0);
        let lit: Vec3 = lights.iter().map(|lit| direct(lit) * lit.visibility).sum();
        let whole: Vec3 = lights.iter().map(direct).sum();
        let whole = (whole + Vec3::from_array(self.open_sky)).max(Vec3::splat(1e-6));
        let share = match is_there {
            true => ((lit + sky) / whole).min(Vec3::ONE),
            false => Vec3::ONE,
        };
        let shaded = background * share;
        let brightness = luminance(share.to_array()).max(0.0);
        let edge = match self.stage.scene.relief {
            Some(_) => 0.0,
            None => SHADOW * brightness.sqrt(),
        };
        [shaded.x, shaded.y, shaded.z, edge]
    }

    /// What the surface reflects of the sky.
    fn sky(
        &self,
        surface: &Surface,
        normal: Vec3,
        towards: Vec3,
        sky: Vec3,
        openness: f32,
    ) -> Vec3 {
        let facing = normal.dot(towards).clamp(1e-3, 1.0);
        let [scale, bias] = split_sum(facing, surface.roughness);
        let straight = surface.straight();
        let single = straight * scale + Vec3::splat(bias);
        let lost = 1.0 - (scale + bias);
        let mean = straight + (Vec3::ONE - straight) / 21.0;
        let multiple = single * mean / (Vec3::ONE - mean * lost) * lost;
        let diffuse = surface.diffuse() * (Vec3::ONE - single - multiple);
        let mirrored = normal * (2.0 * normal.dot(towards)) - towards;
        let exponent = libm::exp2f(-16.0 * surface.roughness - 1.0);
        let seen = libm::powf(facing + openness, exponent) - 1.0 + openness;
        let image = self.mirrored(mirrored, surface.roughness) * seen.clamp(0.0, 1.0);
        // Some of what things keep away they send themselves.
        let between = many_times(surface.colour, openness) * surface.occlusion;
        single * image + (diffuse + multiple) * sky * between
    }

    /// The mean of the sky around a direction, wider for rough surfaces.
    fn mirrored(&self, direction: Vec3, roughness: f32) -> Vec3 {
        let sky = &self.stage.sky;
        let [zenith, horizon, ground] =
            [sky.zenith, sky.horizon, sky.ground].map(|it| DVec3::from_array(it).as_vec3());
        let width = 0.08 + roughness;
        let share = ((direction.z / width + 1.0) * 0.5).clamp(0.0, 1.0);
        let share = share * share * (3.0 - 2.0 * share);
        let above = horizon.lerp(zenith, direction.z.clamp(0.0, 1.0));
        ground.lerp(above, share)
    }
}

/// A light that reaches a surface.
struct Lit {
    direction: Vec3,
    width: f32,
    /// Without anything in the way.
    colour: Vec3,
    visibility: f32,
    /// How much falls on the surface, if that is known as a mean.
    mean: Option<f32>,
}

impl Surface {
    /// The side below such an edge.
    fn side(self) -> Surface {
        Surface {
            colour: self.colour * SIDE,
            roughness: self.roughness.max(0.8),
            occlusion: 1.0,
            ..self
        }
    }

    /// What is reflected of light from straight ahead.
    fn straight(&self) -> Vec3 {
        Vec3::splat(PLAIN).lerp(self.colour, self.metalness)
    }

    fn diffuse(&self) -> Vec3 {
        self.colour * (1.0 - self.metalness)
    }

    /// What is reflected of a light.
    fn reflect(&self, normal: Vec3, towards: Vec3, lit: &Lit) -> Vec3 {
        let facing_light = normal.dot(lit.direction).max(0.0);
        let falling = lit.mean.unwrap_or(facing_light * lit.visibility);
        if falling <= 0.0 {
            return Vec3::ZERO;
        }
        let facing = normal.dot(towards).clamp(1e-3, 1.0);
        let half = (lit.direction + towards).normalize_or_zero();
        let (along, across) = (normal.dot(half).max(0.0), towards.dot(half).max(0.0));
        // A wide light makes a wide highlight.
        let alpha = (self.roughness * self.roughness + 0.5 * lit.width).min(1.0);
        let squared = alpha * alpha;
        let bottom = along * along * (squared - 1.0) + 1.0;
        let density = squared / (PI * bottom * bottom);
        let smith = |a: f32, b: f32| a * (b * b * (1.0 - squared) + squared).sqrt();
        let hidden = 0.5 / (smith(facing_light, facing) + smith(facing, facing_light));
        let grazing = 1.0 - across;
        let power = grazing * grazing * grazing * grazing * grazing;
        let straight = self.straight();
        let fresnel = straight + (Vec3::ONE - straight) * power;
        let mirror = fresnel * (density * hidden * PI);
        let diffuse = self.diffuse() * (Vec3::ONE - fresnel);
        (diffuse + mirror) * lit.colour * falling
    }
}

/// How the share that is mirrored depends on the view: factor and addend of what is reflected straight ahead
/// (the polynomials of Karis 2014, after Lazarov 2013).
fn split_sum(facing: f32, roughness: f32) -> [f32; 2] {
    let [x, y, z, w] = [
        1.0 - roughness,
        0.0425 - 0.0275 * roughness,
        1.04 - 0.572 * roughness,
        0.022 * roughness - 0.04,
    ];
    let edge = (x * x).min(libm::exp2f(-9.28 * facing)) * x + y;
    [(z - 1.04 * edge).max(0.0), (1.04 * edge + w).max(0.0)]
}

/// How much brighter the many reflections between things make a surface that sees part of the sky.
fn many_times(colour: Vec3, openness: f32) -> Vec3 {
    let [a, b, c] = [
        colour * 2.0404 - 0.3324,
        colour * -4.7951 + 0.6417,
        colour * 2.7552 + 0.6903,
    ];
    (((a * openness) + b) * openness + c).max(Vec3::ONE)
}

/// The normal bent by the slope of the relief (Mikkelsen 2010): from how height and place change from
/// sample to sample of the same surface.
fn bend(normal: Vec3, inputs: &[InputColumn<'_>], index: usize, height: usize) -> Vec3 {
    let change = |input: usize, axis: usize| inputs[input].spread[axis][index];
    let place = |axis: usize| {
        let part = |part: usize| change(SEEN + seen::PLACE + part, axis);
        Vec3::new(part(0), part(1), part(2))
    };
    let (along_row, along_column) = (place(0), place(1));
    let (first, second) = (along_column.cross(normal), normal.cross(along_row));
    let determinant = along_row.dot(first);
    if determinant == 0.0 {
        return normal;
    }
    let slope = (first * change(height, 0) + second * change(height, 1)) / determinant;
    (normal - slope).normalize_or(normal)
}
