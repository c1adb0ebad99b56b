//! Cameras: which ray belongs to a point of the picture, and how a scene is framed without being told.

use crate::geometry::hierarchy::Ray;
use crate::key::KeyHasher;
use crate::node::{Failure, Input};
use crate::nodes::view::record::Record;
use crate::value::{Type, Unit};
use glam::{DVec2, DVec3};

/// The parts of the input `camera`.
pub(super) const CAMERA: &[Input] = &[
    Input::new(
        "projection",
        Type::Choice(&["perspective", "orthographic"]),
        "How space becomes flat.",
    )
    .default("perspective"),
    Input::new(
        "position",
        Type::Vector(Unit::Millimetre),
        "Where it stands; left out, as far away as shows everything.",
    )
    .optional()
    .range(-1e7, 1e7),
    Input::new(
        "target",
        Type::Vector(Unit::Millimetre),
        "What stands in the middle of the picture.",
    )
    .optional()
    .range(-1e7, 1e7),
    Input::new(
        "side",
        Type::Vector(Unit::One),
        "From which side it looks, without a `position`: the direction from the things to the camera.",
    )
    .optional(),
    Input::new("up", Type::Vector(Unit::One), "What is up in the picture.").default("(0, 0, 1)"),
    Input::number(
        "angle",
        Unit::Degree,
        "Field of view of a perspective, along the picture's height; left out, 24.",
    )
    .optional()
    .range(0.1, 150.0),
    Input::number(
        "height",
        Unit::Millimetre,
        "What an orthographic picture shows along its height.",
    )
    .optional()
    .range(1e-3, 1e7),
];

/// The share of the picture that is left free on each side of a scene that is framed automatically.
const BORDER: f64 = 0.06;

/// Points of the picture along each side that are asked what they show.
const PROBES: u32 = 33;

/// A camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    position: DVec3,
    /// Directions of the picture: to the right, upwards, and from the scene towards the camera.
    right: DVec3,
    up: DVec3,
    back: DVec3,
    /// Half of the picture's height: at distance 1 in a perspective, in mm otherwise.
    half: f64,
    is_perspective: bool,
    /// Width and height of the picture in its own unit.
    size: [f64; 2],
}

impl Camera {
    /// The camera that a recipe states; what it leaves out is chosen so that all `points` are seen.
    pub(super) fn new(
        stated: &Record<'_>,
        size: [f64; 2],
        points: &[DVec3],
        side: DVec3,
    ) -> Result<Camera, Failure> {
        let failure = |message: &str| Failure::of_input("camera", message);
        let (position, target) = (stated.vector("position"), stated.vector("target"));
        let middle = target.unwrap_or_else(|| middle(points));
        let back = match (position, stated.vector("side")) {
            (Some(_), Some(_)) => {
                return Err(failure("both `position` and `side` of the camera are set")
                    .with_hint("remove one of them"));
            }
            (Some(position), None) => (position - middle)
                .try_normalize()
                .ok_or_else(|| failure("the camera stands at its target"))?,
            (None, Some(side)) => side
                .try_normalize()
                .ok_or_else(|| failure("the direction `side` of the camera has no length"))?,
            (None, None) => side,
        };
        let up = stated.vector("up").unwrap_or(DVec3::Z).try_normalize();
        let up = up.ok_or_else(|| failure("the direction `up` of the camera has no length"))?;
        let right = up.cross(back).try_normalize().ok_or_else(|| {
            failure("the camera looks along its `up`, so nothing says what is up in the picture")
                .with_hint("set `up: (0, 1, 0)`")
        })?;
        let is_perspective = stated.choice("projection") != Some("orthographic");
        check_scale(stated, is_perspective)?;
        let angle = stated.number("angle").unwrap_or(24.0).to_radians();
        let mut camera = Camera {
            position: middle,
            right,
            up: back.cross(right),
            back,
            half: libm::tan(0.5 * angle),
            is_perspective,
            size,
        };
        let stated_half = stated.number("height").map(|height| 0.5 * height);
        if is_perspective {
            camera.position = position.unwrap_or_else(|| camera.framing(points, target));
        } else {
            camera.half = stated_half.unwrap_or_else(|| camera.half_height(points, target));
            camera.position = match (position, target) {
                (None, None) => camera.centred(points),
                _ => middle,
            };
            camera.position += back * camera.depth(points);
        }
        Ok(camera)
    }

    /// The ray at a point of the picture, from its lower left corner; its direction has length 1.
    pub(super) fn ray(&self, u: f64, v: f64) -> Ray {
        let [width, height] = self.size;
        let scale = 2.0 * self.half / height;
        let (x, y) = ((u - 0.5 * width) * scale, (v - 0.5 * height) * scale);
        let offset = self.right * x + self.up * y;
        if self.is_perspective {
            Ray::new(self.position, (offset - self.back).normalize())
        } else {
            Ray::new(self.position + offset, -self.back)
        }
    }

    /// The distance of a point in pixels of the picture, as wide as they are there.
    pub(super) fn pixels_away(&self, point: DVec3) -> f64 {
        let depth = self.back.dot(self.position - point);
        let pixel = 2.0 * self.half / self.size[1];
        match self.is_perspective {
            true => libm::log(depth.max(1e-9)) / pixel,
            false => depth / pixel,
        }
    }

    /// The side of what a pixel shows of a rectangle at height 0, where it shows least; of what it shows in the middle
    /// of the rectangle if that is not seen.
    pub(super) fn finest(&self, size: DVec2) -> f64 {
        let pixel = 2.0 * self.half / self.size[1];
        if !self.is_perspective {
            return pixel;
        }
        let depth = |point: DVec3| self.back.dot(self.position - point);
        let seen = (0..PROBES * PROBES).filter_map(|index| {
            let part = |index: u32| f64::from(index) / f64::from(PROBES - 1);
            let [x, y] = [part(index % PROBES), part(index / PROBES % PROBES)];
            let ray = self.ray(x * self.size[0], y * self.size[1]);
            let distance = -ray.point(0.0).z / ray.direction().z;
            let point = ray.point(distance);
            let is_seen =
                distance > 0.0 && point.truncate().clamp(DVec2::ZERO, size) == point.truncate();
            is_seen.then(|| depth(point))
        });
        let nearest = seen.fold(f64::INFINITY, f64::min);
        let middle = depth((0.5 * size).extend(0.0)).abs();
        pixel * if nearest.is_finite() { nearest } else { middle }
    }

    /// From the scene to the camera, at the middle of the picture.
    pub(super) fn back(&self) -> DVec3 {
        self.back
    }

    /// To the right in the picture.
    pub(super) fn right(&self) -> DVec3 {
        self.right
    }

    /// Tangents of the halves of the picture that things may fill.
    fn slopes(&self) -> [f64; 2] {
        let free = 1.0 - 2.0 * BORDER;
        [
            self.half * self.size[0] / self.size[1] * free,
            self.half * free,
        ]
    }

    /// Where a perspective shows all points, and no smaller than it must; with a target, in the middle.
    ///
    /// A point is inside if it lies within four planes; along each axis the camera moves to where the
    /// outermost points of both sides touch theirs, then back until the other axis fits too.
    fn framing(&self, points: &[DVec3], target: Option<DVec3>) -> DVec3 {
        let along = |axis: DVec3, slope: f64| {
            let reach = |sign: f64| {
                let reach = points
                    .iter()
                    .map(|point| sign * axis.dot(*point) + slope * self.back.dot(*point));
                reach.fold(f64::NEG_INFINITY, f64::max)
            };
            let (right, left) = (reach(1.0), reach(-1.0));
            match target {
                // Both sides as far as the one that reaches further.
                Some(target) => {
                    let middle = axis.dot(target);
                    let distance = (right - middle).max(left + middle) / slope;
                    (middle, distance)
                }
                None => (0.5 * (right - left), 0.5 * (right + left) / slope),
            }
        };
        let [across, upwards] = self.slopes();
        let (x, first) = along(self.right, across);
        let (y, second) = along(self.up, upwards);
        self.right * x + self.up * y + self.back * first.max(second)
    }

    /// Half of the height that an orthographic picture needs.
    fn half_height(&self, points: &[DVec3], target: Option<DVec3>) -> f64 {
        let half = |axis: DVec3| {
            let [low, high] = extent(points, axis);
            match target.map(|target| axis.dot(target)) {
                Some(middle) => (high - middle).max(middle - low),
                None => 0.5 * (high - low),
            }
        };
        let (across, upwards) = (half(self.right), half(self.up));
        let needed = upwards.max(across * self.size[1] / self.size[0]) / (1.0 - 2.0 * BORDER);
        needed.max(1e-3)
    }

    /// The middle of the points as the camera sees them.
    fn centred(&self, points: &[DVec3]) -> DVec3 {
        let part = |axis: DVec3| {
            let [low, high] = extent(points, axis);
            axis * (0.5 * (low + high))
        };
        part(self.right) + part(self.up) + part(self.back)
    }

    /// How far behind its middle a camera stands to have all points before it.
    fn depth(&self, points: &[DVec3]) -> f64 {
        let [low, high] = extent(points, self.back);
        (high - self.back.dot(self.position)).max(0.0) + (high - low) + 1.0
    }

    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        for vector in [self.position, self.right, self.up, self.back] {
            vector.to_array().iter().for_each(|part| {
                key.number(*part);
            });
        }
        key.number(self.half)
            .whole(i64::from(self.is_perspective))
            .number(self.size[0])
            .number(self.size[1]);
    }
}

/// A perspective has its scale from `angle`, an orthographic picture from `height`.
fn check_scale(stated: &Record<'_>, is_perspective: bool) -> Result<(), Failure> {
    let (other, message, hint) = match is_perspective {
        true => (
            "height",
            "`height` is set, but the camera is a perspective",
            "set `projection: orthographic`, or state `angle` instead",
        ),
        false => (
            "angle",
            "`angle` is set, but the camera is orthographic",
            "set `projection: perspective`, or state `height` instead",
        ),
    };
    match stated.number(other) {
        Some(_) => Err(Failure::of_input("camera", message).with_hint(hint)),
        None => Ok(()),
    }
}

/// Smallest and largest distance of points along an axis.
fn extent(points: &[DVec3], axis: DVec3) -> [f64; 2] {
    let along = || points.iter().map(|point| axis.dot(*point));
    [
        along().fold(f64::INFINITY, f64::min),
        along().fold(f64::NEG_INFINITY, f64::max),
    ]
}

/// The middle of the box around points.
fn middle(points: &[DVec3]) -> DVec3 {
    let part = |axis: DVec3| {
        let [low, high] = extent(points, axis);
        0.5 * (low + high)
    };
    DVec3::new(part(DVec3::X), part(DVec3::Y), part(DVec3::Z))
}
