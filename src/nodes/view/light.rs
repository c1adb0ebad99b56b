//! Lights: where they are, what of them a point sees, and the sky around.
//!
//! Everything is sampled by the same patterns at every point, a spiral over the face of a light and a Fibonacci lattice
//! over the sky, turned by an angle that is hashed from the point of the picture. So shadows have steps that are
//! smaller than a picture can show, and these do not lie in bands.

use super::record::Record;
use super::scene::{Point, Scene};
use crate::key::KeyHasher;
use crate::node::{Failure, Input};
use crate::value::{Type, Unit, Value};
use glam::DVec3;
use std::f64::consts::PI;

/// The parts of an item of the input `lights`.
pub(super) const LIGHT: &[Input] = &[
    Input::new(
        "direction",
        Type::Vector(Unit::One),
        "Of a distant light: from the things towards it.",
    )
    .optional(),
    Input::number(
        "angle",
        Unit::Degree,
        "Of a distant light: its apparent width; the sun's is 0.53.",
    )
    .default("3")
    .range(0.0, 90.0),
    Input::new(
        "position",
        Type::Vector(Unit::Millimetre),
        "Of a lamp: where it is.",
    )
    .optional()
    .range(-1e7, 1e7),
    Input::number("radius", Unit::Millimetre, "Of a lamp: half of its width.")
        .default("100")
        .range(0.0, 1e7),
    Input::new("colour", Type::Colour, "Its colour.").default("(1, 1, 1)"),
    Input::number(
        "strength",
        Unit::One,
        "How bright it makes a white surface that faces it; of a lamp, in the middle of the scene.",
    )
    .default("1")
    .range(0.0, 1000.0),
];

/// The parts of the input `sky`.
pub(super) const SKY: &[Input] = &[
    Input::new("zenith", Type::Colour, "Light from above.").default("(1.0, 1.0, 1.0)"),
    Input::new("horizon", Type::Colour, "Light from the sides.").default("(0.8, 0.8, 0.8)"),
    Input::new(
        "ground",
        Type::Colour,
        "Light that comes back from the ground.",
    )
    .default("(0.34, 0.33, 0.32)"),
    Input::number("strength", Unit::One, "Multiplies all three.")
        .default("0.5")
        .range(0.0, 1000.0),
];

/// Points on the rim of a light.
const RIM: usize = 16;

/// Points within a light; each `FIRST`th is asked first, and if they agree with the rim, so does nearly all of it.
const WITHIN: usize = 256;
const FIRST: usize = 8;

/// Each of so many directions of the sky is asked first: if nothing is in the way of any, the rest is free too.
const SKY_FIRST: usize = 4;

/// The angle between neighbours on a spiral of even density, 2 pi over the square of the golden ratio.
const GOLDEN: f64 = 2.399_963_229_728_653;

/// Points of the unit disc at which a light is asked for.
#[derive(Clone, Debug)]
pub(super) struct Disc {
    rim: Vec<[f64; 2]>,
    within: Vec<[f64; 2]>,
}

impl Disc {
    /// The rim in even steps, and a spiral of even density within.
    pub(super) fn new() -> Disc {
        let point =
            |angle: f64, radius: f64| [radius * libm::cos(angle), radius * libm::sin(angle)];
        let rim = |index: usize| point(index as f64 * (2.0 * PI / RIM as f64), 1.0);
        let within = |index: usize| {
            let radius = ((index as f64 + 0.5) / WITHIN as f64).sqrt();
            point(index as f64 * GOLDEN, radius)
        };
        Disc {
            rim: (0..RIM).map(rim).collect(),
            within: (0..WITHIN).map(within).collect(),
        }
    }
}

/// How far the patterns are turned at a point of the picture: cosine and sine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn([f64; 2]);

impl Turn {
    /// The turn at (u, v): the bits mixed as in Murmur3's finish.
    pub(super) fn at(u: f64, v: f64) -> Turn {
        let mut bits = u.to_bits() ^ v.to_bits().rotate_left(32);
        for factor in [0xff51_afd7_ed55_8ccd, 0xc4ce_b9fe_1a85_ec53] {
            bits = (bits ^ (bits >> 33)).wrapping_mul(factor);
        }
        let angle = ((bits >> 33) as f64) * (2.0 * PI / (1u64 << 31) as f64);
        Turn([libm::cos(angle), libm::sin(angle)])
    }

    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cosine, sine] = self.0;
        [cosine * x - sine * y, sine * x + cosine * y]
    }
}

#[derive(Clone, Copy, Debug)]
enum Place {
    /// The direction towards it, and the tangent of half of its width.
    Distant(DVec3, f64),
    /// Its middle and its radius, and the square of the distance at which its strength holds.
    Lamp(DVec3, f64, f64),
}

/// A light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Light {
    place: Place,
    /// How bright it makes a white surface that faces it.
    pub(super) colour: [f64; 3],
}

/// A light as one point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// The direction towards its middle.
    pub(super) direction: DVec3,
    /// The tangent of half of its width.
    pub(super) width: f64,
    /// What its strength is multiplied by.
    pub(super) falloff: f64,
}

impl Light {
    /// The distant light in a direction of length 1.
    pub(super) fn distant(direction: DVec3, degrees: f64, colour: [f64; 3]) -> Light {
        let width = libm::tan(0.5 * degrees.to_radians());
        Light {
            place: Place::Distant(direction, width),
            colour,
        }
    }

    /// The light that item `index` of the input states, in a scene with this middle.
    pub(super) fn read(item: &Value, index: usize, middle: DVec3) -> Result<Light, Failure> {
        let stated = Record::of(Some(item));
        let failure = |message: &str| {
            let message = format!("light {}: {message}", index + 1);
            Failure::of_input("lights", message).at_item(index)
        };
        let strength = stated.number("strength").unwrap_or(1.0);
        let colour = stated.colour("colour").unwrap_or([1.0; 3]);
        let colour = colour.map(|part| part * strength);
        match (stated.vector("direction"), stated.vector("position")) {
            (Some(direction), None) => {
                let direction = direction
                    .try_normalize()
                    .ok_or_else(|| failure("`direction` has no length"))?;
                let degrees = stated.number("angle").unwrap_or(3.0);
                Ok(Light::distant(direction, degrees, colour))
            }
            (None, Some(position)) => {
                let radius = stated.number("radius").unwrap_or(100.0);
                let place = Place::Lamp(position, radius, position.distance_squared(middle));
                Ok(Light { place, colour })
            }
            _ => Err(failure("expected either `direction` or `position`")
                .with_hint("a sun has a `direction`, a lamp a `position`")),
        }
    }

    /// The light as seen from a point.
    pub(super) fn seen(&self, from: DVec3) -> Seen {
        match self.place {
            Place::Distant(direction, width) => Seen {
                direction,
                width,
                falloff: 1.0,
            },
            Place::Lamp(position, radius, full) => {
                let away = position - from;
                let squared = away.length_squared().max(1e-12);
                Seen {
                    direction: away / squared.sqrt(),
                    width: radius / squared.sqrt(),
                    falloff: full / squared,
                }
            }
        }
    }

    /// How far the light is.
    pub(super) fn distance(&self, from: DVec3) -> f64 {
        match self.place {
            Place::Distant(..) => f64::INFINITY,
            Place::Lamp(position, ..) => position.distance(from),
        }
    }

    /// Which part of the light a point sees, from 0 to 1.
    pub(super) fn visibility(&self, scene: &Scene, disc: &Disc, point: &Point, turn: &Turn) -> f64 {
        let seen = self.seen(point.place);
        if point.normal.dot(seen.direction) <= 0.0 {
            // It lights nothing here.
            return 0.0;
        }
        let furthest = self.distance(point.place);
        let [right, up] = perpendicular(seen.direction);
        let is_clear = |place: [f64; 2]| {
            let [x, y] = turn.turned(place);
            let direction = seen.direction + (right * x + up * y) * seen.width;
            let direction = direction.normalize();
            // What is below the surface's own horizon is hidden by it.
            point.face.dot(direction) > 0.0 && !scene.is_hidden(point, direction, furthest)
        };
        let middle = is_clear([0.0; 2]);
        let mut first = disc.rim.iter().chain(disc.within.iter().step_by(FIRST));
        if seen.width == 0.0 || first.all(|place| is_clear(*place) == middle) {
            return f64::from(u8::from(middle));
        }
        let clear = disc.within.iter().filter(|place| is_clear(**place));
        clear.count() as f64 / WITHIN as f64
    }

    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        let (vector, numbers) = match self.place {
            Place::Distant(direction, width) => (direction, [0.0, width, 0.0]),
            Place::Lamp(position, radius, full) => (position, [1.0, radius, full]),
        };
        let parts = vector.to_array().into_iter().chain(numbers);
        parts.chain(self.colour).for_each(|part| {
            key.number(part);
        });
    }
}

/// Two directions at right angles to one another and to a third (Duff and others 2017).
fn perpendicular(normal: DVec3) -> [DVec3; 2] {
    let sign = if normal.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    [
        DVec3::new(
            1.0 + sign * normal.x * normal.x * a,
            sign * b,
            -sign * normal.x,
        ),
        DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
    ]
}

/// What of the sky a point sees.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SkyLight {
    /// How bright it makes a white surface there.
    pub(super) colour: [f64; 3],
    /// The share of the sky that is seen, weighted as the surface faces it.
    pub(super) openness: f64,
}

/// The light from all sides.
#[derive(Clone, Debug)]
pub(super) struct Sky {
    /// Colours above, at the horizon, and below.
    pub(super) zenith: [f64; 3],
    pub(super) horizon: [f64; 3],
    pub(super) ground: [f64; 3],
    /// Directions of equal solid angle, all around.
    directions: Vec<DVec3>,
    /// What lies between the ground's light and things that touch it, in mm.
    reach: f64,
}

impl Sky {
    /// The sky that a recipe states, in `count` directions above the horizon; `reach` is the size of the scene.
    pub(super) fn read(stated: &Record<'_>, count: usize, reach: f64) -> Sky {
        let strength = stated.number("strength").unwrap_or(0.5);
        let colour = |name: &str, default: [f64; 3]| {
            stated
                .colour(name)
                .unwrap_or(default)
                .map(|part| part * strength)
        };
        let direction = |index: usize| {
            let z = 1.0 - (index as f64 + 0.5) / count as f64;
            let angle = index as f64 * GOLDEN;
            let radius = (1.0 - z * z).sqrt();
            DVec3::new(radius * libm::cos(angle), radius * libm::sin(angle), z)
        };
        Sky {
            zenith: colour("zenith", [1.0; 3]),
            horizon: colour("horizon", [0.8; 3]),
            ground: colour("ground", [0.34, 0.33, 0.32]),
            directions: (0..2 * count).map(direction).collect(),
            reach,
        }
    }

    /// What comes from a direction.
    fn radiance(&self, direction: DVec3) -> [f64; 3] {
        if direction.z < 0.0 {
            return self.ground;
        }
        let mix = |part: usize| {
            self.horizon[part] + (self.zenith[part] - self.horizon[part]) * direction.z
        };
        [mix(0), mix(1), mix(2)]
    }

    /// What a point sees, with nothing in the way for `None`.
    pub(super) fn light(&self, scene: Option<&Scene>, point: &Point, turn: &Turn) -> SkyLight {
        let turned = |direction: &DVec3| {
            let [x, y] = turn.turned([direction.x, direction.y]);
            DVec3::new(x, y, direction.z)
        };
        let is_hidden = |scene: &Scene, direction: DVec3| {
            point.normal.dot(direction) > 0.0
                && (point.face.dot(direction) <= 0.0
                    || scene.is_hidden(point, direction, f64::INFINITY))
        };
        let scene_in_the_way = scene.filter(|scene| {
            let mut first = self.directions.iter().step_by(SKY_FIRST).map(turned);
            first.any(|direction| is_hidden(scene, direction))
        });
        let mut light = SkyLight::default();
        let mut whole = 0.0;
        // The solid angle of a direction over pi: a white surface reflects 1 / pi of what comes in.
        let share = 4.0 / self.directions.len() as f64;
        for direction in self.directions.iter().map(turned) {
            let facing = point.normal.dot(direction);
            if facing <= 0.0 {
                continue;
            }
            whole += facing;
            if scene_in_the_way.is_some_and(|scene| is_hidden(scene, direction)) {
                continue;
            }
            light.openness += facing;
            let near = scene.map_or(1.0, |scene| self.of_ground(scene, point, direction));
            let radiance = self.radiance(direction);
            for (sum, radiance) in light.colour.iter_mut().zip(radiance) {
                *sum += radiance * (facing * share * near);
            }
        }
        light.openness /= f64::max(whole, 1e-12);
        light
    }

    /// The ground close to a thing lies in its shade and sends less back.
    fn of_ground(&self, scene: &Scene, point: &Point, direction: DVec3) -> f64 {
        match scene.ground {
            Some(ground) if direction.z < 0.0 => {
                let distance = ((point.place.z - ground) / -direction.z).max(0.0);
                distance / (distance + 0.1 * self.reach)
            }
            _ => 1.0,
        }
    }

    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        let colours = [self.zenith, self.horizon, self.ground];
        colours.iter().flatten().for_each(|part| {
            key.number(*part);
        });
        key.whole(self.directions.len() as i64).number(self.reach);
    }
}
