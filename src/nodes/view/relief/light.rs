//! Light on relief: the sky and the lights as far as they stand above its horizon.
//!
//! It is found at the corners of the grid of heights, by the horizon in directions all around and towards the lights,
//! and between them it is blended. Of the sky each corner keeps the mean direction as well, so that slopes
//! between corners face what they face (the first two bands of Ramamoorthi & Hanrahan 2001, made exact for the
//! corner's own slope). Corners are looked at when they are first asked for, in tiles.

use super::Relief;
use super::tile::{SIDE, Tile};
use crate::geometry::heights::{Heights, Rises};
use crate::nodes::view::light::{Light, Seen, Sky, SkyLight, Turn};
use crate::nodes::view::scene::{Point, is_cut_face};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Corners along each side of a tile.
pub(super) const TILE: usize = 16;

/// Numbers that are kept of the sky.
pub(super) const OF_SKY: usize = 8;

/// Strips into which the face of a wide light is cut.
const STRIPS: usize = 7;

/// What rises by less hides hardly anything of the sky: a share of its square.
const LOW: f64 = 0.06;

/// Below this width a light has only one strip.
const NARROW: f64 = 0.03;

/// The light at the corners of a grid of heights.
#[derive(Debug)]
pub(super) struct LightMap {
    /// Level directions in the middle of equal slices of the sky.
    slices: Vec<DVec2>,
    /// Tiles in a row.
    columns: usize,
    /// For each tile its corners one after the other: [`OF_SKY`] numbers of the sky, and one for each light.
    tiles: Vec<OnceLock<Vec<f32>>>,
}

/// What a point sees of a sky that is white all over, and of one as bright as it is high: with a normal n, a white
/// surface is as bright as `even + n . towards`.
#[derive(Clone, Copy, Debug, Default)]
struct Open {
    even: f64,
    towards: DVec3,
}

impl Open {
    fn on(&self, normal: DVec3) -> f64 {
        (self.even + self.towards.dot(normal)).max(0.0)
    }
}

impl LightMap {
    /// A map of nothing yet, for a sky that is looked at in so many directions above the horizon.
    pub(super) fn over(heights: &Heights, directions: usize) -> LightMap {
        let [columns, rows] = heights.cells().map(|cells| (cells + 1).div_ceil(TILE));
        LightMap {
            slices: slices(directions),
            columns,
            tiles: (0..columns * rows).map(|_| OnceLock::new()).collect(),
        }
    }

    /// The light that reaches a point of the relief, of its edges or of the ground.
    pub(super) fn light(
        &self,
        relief: &Relief,
        point: &Point,
        sky: &Sky,
        lights: &[Light],
    ) -> (SkyLight, Vec<f64>) {
        if is_cut_face(point.surface) {
            // Nothing stands before an edge.
            return (
                sky.light(None, point, &Turn::at(0.0, 0.0)),
                vec![1.0; lights.len()],
            );
        }
        let numbers = match point.surface {
            0 => at(relief, point.place, point.normal, lights),
            _ => self.blended(relief, point.coordinates, lights),
        };
        let open = |first: usize| Open {
            even: numbers[first],
            towards: DVec3::from_slice(&numbers[first + 1..first + 4]),
        };
        let light = from_sky([open(0), open(4)], point.normal, sky);
        (light, numbers[OF_SKY..].to_vec())
    }

    /// What is between the corners of a cell.
    fn blended(&self, relief: &Relief, place: DVec2, lights: &[Light]) -> Vec<f64> {
        let ([x, y], at) = relief.heights.cell_at(place);
        let mut sum = vec![0.0; OF_SKY + lights.len()];
        for (corner, weight) in [
            ([x, y], (1.0 - at.x) * (1.0 - at.y)),
            ([x + 1, y], at.x * (1.0 - at.y)),
            ([x, y + 1], (1.0 - at.x) * at.y),
            ([x + 1, y + 1], at.x * at.y),
        ] {
            for (sum, number) in sum.iter_mut().zip(self.corner(relief, corner, lights)) {
                *sum += f64::from(*number) * weight;
            }
        }
        sum
    }

    fn corner<'a>(&'a self, relief: &Relief, [x, y]: [usize; 2], lights: &[Light]) -> &'a [f32] {
        let [column, row] = [x / TILE, y / TILE];
        let make = || tile(relief, [column * TILE, row * TILE], lights);
        let tile = self.tiles[row * self.columns + column].get_or_init(make);
        let width = OF_SKY + lights.len();
        &tile[(y % TILE * TILE + x % TILE) * width..][..width]
    }
}

/// The numbers of the corners of a tile; those beyond the grid are 0.
fn tile(relief: &Relief, first: [usize; 2], lights: &[Light]) -> Vec<f32> {
    let heights = &relief.heights;
    let width = OF_SKY + lights.len();
    let mut tile = vec![0.0; TILE * TILE * width];
    let sky = Tile { relief, first }.sky();
    for (index, numbers) in tile.chunks_exact_mut(width).enumerate() {
        let at = [index % TILE, index / TILE];
        let Some(of_sky) = sky[at[1] * SIDE + at[0]] else {
            continue;
        };
        let point = heights.point([first[0] + at[0], first[1] + at[1]]);
        numbers[..OF_SKY].copy_from_slice(&of_sky);
        for (number, light) in numbers[OF_SKY..].iter_mut().zip(lights) {
            *number = visible(heights, point, light) as f32;
        }
    }
    tile
}

/// What a point with a normal sees of the sky and of the lights.
fn at(relief: &Relief, point: DVec3, normal: DVec3, lights: &[Light]) -> Vec<f64> {
    let of_lights = lights
        .iter()
        .map(|light| visible(&relief.heights, point, light));
    sky(relief, point, normal)
        .into_iter()
        .chain(of_lights)
        .collect()
}

/// What a point with a normal sees of the sky.
pub(super) fn sky(relief: &Relief, point: DVec3, normal: DVec3) -> [f64; OF_SKY] {
    let [even, high] = around(&relief.heights, point, normal, &relief.map.slices);
    let ([a, b, c], [e, f, g]) = (even.towards.to_array(), high.towards.to_array());
    [even.even, a, b, c, high.even, e, f, g]
}

/// What a point sees of an even sky, and of one as bright as it is high.
///
/// In a slice of the sky between its horizon and the zenith, with e the elevation and n.x the part of the normal
/// towards the slice, a surface faces by n.x cos e + n.z sin e; this times cos e, and sin e for the second, is
/// integrated as it is.
fn around(heights: &Heights, point: DVec3, normal: DVec3, slices: &[DVec2]) -> [Open; 2] {
    let share = 2.0 / slices.len() as f64;
    let mut open = [Open::default(); 2];
    for direction in slices {
        let facing = normal.truncate().dot(*direction);
        let own = -facing / normal.z;
        let rises = Rises {
            least: own.max(0.0),
            most: f64::INFINITY,
            tolerance: LOW,
        };
        let rise = heights.horizon(point, *direction, f64::INFINITY, &rises);
        let cosine = 1.0 / (1.0 + rise * rise).sqrt();
        let (sine, square) = (rise * cosine, cosine * cosine);
        let elevation = libm::atan(rise);
        let level = 0.5 * (0.5 * PI - elevation - sine * cosine);
        let sums = [
            // Along the level direction, and upwards.
            [level, 0.5 * square],
            [cosine * square / 3.0, (1.0 - sine * sine * sine) / 3.0],
        ];
        for (open, [level, up]) in open.iter_mut().zip(sums) {
            let half = (*direction * level).extend(up) * (0.5 * share);
            open.towards += half;
            // The other half for the normal that the corner has.
            open.even += normal.dot(half);
        }
    }
    open
}

/// The light of a sky over a surface with a normal.
fn from_sky([even, high]: [Open; 2], normal: DVec3, sky: &Sky) -> SkyLight {
    let (even, high) = (even.on(normal), high.on(normal));
    let above = 0.5 * (1.0 + normal.z);
    let openness = (even / above.max(1e-6)).min(1.0);
    let colour = [0, 1, 2].map(|part| {
        let of_sky = sky.horizon[part] * even + (sky.zenith[part] - sky.horizon[part]) * high;
        of_sky + sky.ground[part] * (1.0 - above) * openness
    });
    SkyLight { colour, openness }
}

/// The light of a sky over level ground with nothing in the way.
pub(super) fn open(sky: &Sky) -> SkyLight {
    let open = [0.5, 1.0 / 3.0].map(|half| Open {
        even: half,
        towards: DVec3::Z * half,
    });
    from_sky(open, DVec3::Z, sky)
}

/// The part of a light that stands above the horizon of a point.
fn visible(heights: &Heights, point: DVec3, light: &Light) -> f64 {
    let seen = light.seen(point);
    let level = seen.direction.truncate();
    let Some(across) = level.perp().try_normalize() else {
        // Right above.
        return 1.0;
    };
    let furthest = light.distance(point) * level.length();
    let strips = if seen.width < NARROW { 1 } else { STRIPS };
    let (mut clear, mut whole) = (0.0, 0.0);
    for strip in 0..strips {
        let aside = (2 * strip + 1) as f64 / strips as f64 - 1.0;
        let half = (1.0 - aside * aside).sqrt();
        let middle = seen.direction + (across * (aside * seen.width)).extend(0.0);
        clear += half * above(heights, point, (middle, half * seen.width, furthest), &seen);
        whole += half;
    }
    clear / whole
}

/// The part of a strip of a light above the horizon; it reaches `half` up and down from its middle.
fn above(
    heights: &Heights,
    point: DVec3,
    (middle, half, furthest): (DVec3, f64, f64),
    seen: &Seen,
) -> f64 {
    let Some(direction) = middle.truncate().try_normalize() else {
        return 1.0;
    };
    // Along the strip the light rises by `level` and comes nearer by its z.
    let level = seen.direction.truncate().length();
    let forward = middle.truncate().length();
    let limb = |up: f64| {
        let (high, near) = (middle.z + up * level, forward - up * seen.direction.z);
        if near > 0.0 {
            high / near
        } else {
            f64::INFINITY
        }
    };
    let rises = Rises {
        least: limb(-half).max(0.0),
        most: limb(half),
        tolerance: 0.0,
    };
    if rises.most <= rises.least {
        // A point of light, or one that has set.
        let rises = Rises {
            most: f64::INFINITY,
            ..rises
        };
        let rise = heights.horizon(point, direction, furthest, &rises);
        return f64::from(u8::from(rise <= rises.least && limb(half) > 0.0));
    }
    let rise = heights.horizon(point, direction, furthest, &rises);
    // Where along the strip is it as steep as the horizon?
    let below = rise * forward - middle.z;
    let step = level + rise * seen.direction.z;
    (0.5 - 0.5 * below / (step * half)).clamp(0.0, 1.0)
}

/// Slices around a point, about as many as there are directions along the rim of an even pattern of `count`.
fn slices(count: usize) -> Vec<DVec2> {
    let count = (1.5 * (count as f64).sqrt()).round().clamp(8.0, 256.0) as usize;
    let slice = |index: usize| {
        let angle = (index as f64 + 0.5) * (2.0 * PI / count as f64);
        DVec2::new(libm::cos(angle), libm::sin(angle))
    };
    (0..count).map(slice).collect()
}
