//! Scenes: the things that are seen, cut open by planes, and what rays meet in them.
//!
//! A thing is a mesh; beside things there may be a flat piece with its relief. Behind a cutting plane its inside is seen if the first triangle that a ray meets from there on
//! is left through, not entered: then the ray was inside, and it meets the plane.

use super::outline;
use super::relief::Relief;
use crate::geometry::hierarchy::{Hierarchy, Meeting, Ray};
use crate::key::{Key, KeyHasher};
use crate::value::{Mesh, Triangle};
use glam::{DVec2, DVec3};
use std::sync::{Arc, OnceLock};

/// Surface numbers of one thing; the first are its cuts.
const SURFACES: u32 = 1 << 16;

/// Most cuts through a thing.
pub(super) const MOST_CUTS: usize = 64;

/// A plane that removes what lies before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub(super) point: DVec3,
    /// Towards what is removed; of length 1.
    pub(super) normal: DVec3,
}

impl Cut {
    /// How far a point lies before the plane.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.point)
    }
}

/// A thing.
#[derive(Debug)]
pub(super) struct Thing {
    mesh: Arc<Mesh>,
    mesh_key: Key,
    hierarchy: OnceLock<Hierarchy>,
    cuts: Vec<Cut>,
    /// Whether only what lies before all cuts is removed, instead of what lies before any.
    is_notch: bool,
}

/// What a ray meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Where.
    pub(super) place: DVec3,
    /// Where rays to lights begin: beside the smooth surface that triangles stand for.
    pub(super) start: DVec3,
    /// At right angles to the smooth surface, and to the triangle.
    pub(super) normal: DVec3,
    pub(super) face: DVec3,
    /// Distance along the ray.
    pub(super) distance: f64,
    /// Which surface; 0 is none.
    pub(super) surface: u32,
    /// Place on the square of the mesh's maps; on a flat piece, in mm.
    pub(super) coordinates: DVec2,
}

/// What is seen.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) things: Vec<Thing>,
    /// A flat piece with its heights, on the ground. It hides nothing from rays to lights: it lights itself.
    pub(super) relief: Option<Relief>,
    /// Height of the ground.
    pub(super) ground: Option<f64>,
    /// Distance from a surface at which rays begin, in mm.
    pub(super) margin: f64,
}

/// Surface numbers of sawn faces, behind those of the cuts.
const SAWN: u32 = 1 + MOST_CUTS as u32;

/// The first surface number that bark may lie on.
const GROWN: u32 = SAWN + 32;

/// Whether a surface number is that of a face that was cut or sawn.
pub(super) fn is_cut_face(surface: u32) -> bool {
    (1..GROWN).contains(&(surface % SURFACES))
}

/// The surface number of a chart.
fn surface_of(chart: u32) -> u32 {
    match chart.checked_sub(Triangle::SAWN) {
        Some(face) => SAWN + face % (GROWN - SAWN),
        None => GROWN + chart % (SURFACES - GROWN),
    }
}

/// The surface number of a flat piece, or of one of its edges.
pub(super) fn relief_surface(edge: Option<u32>) -> u32 {
    edge.map_or(GROWN, |edge| SAWN + edge)
}

impl Scene {
    /// The first surface along a ray.
    pub(super) fn look(&self, ray: &Ray) -> Option<Point> {
        let points = self.things.iter().zip(0..).filter_map(|(thing, index)| {
            let mut point = thing.look(ray)?;
            point.surface += index * SURFACES;
            Some(point)
        });
        let relief = self.relief.iter().filter_map(|relief| relief.look(ray));
        points
            .chain(relief)
            .min_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    /// Where a ray meets the ground, if it comes from above.
    pub(super) fn ground_point(&self, ray: &Ray) -> Option<Point> {
        let height = self.ground?;
        let distance = (height - ray.point(0.0).z) / ray.direction().z;
        if !(distance > 0.0 && distance.is_finite() && ray.direction().z < 0.0) {
            return None;
        }
        Some(Point::on_plane(ray.point(distance), DVec3::Z, distance))
    }

    /// Whether anything lies between a point and what is seen in a direction.
    pub(super) fn is_hidden(&self, point: &Point, direction: DVec3, furthest: f64) -> bool {
        let ray = Ray::new(point.start + point.face * self.margin, direction);
        self.things.iter().any(|thing| thing.hides(&ray, furthest))
    }

    pub(super) fn add_to_key(&self, key: &mut KeyHasher) {
        for thing in &self.things {
            key.key(thing.mesh_key).whole(i64::from(thing.is_notch));
            key.whole(thing.cuts.len() as i64);
            let parts = thing.cuts.iter().flat_map(|cut| [cut.point, cut.normal]);
            parts.flat_map(|vector| vector.to_array()).for_each(|part| {
                key.number(part);
            });
        }
        if let Some(relief) = &self.relief {
            relief.add_to_key(key);
        }
        key.whole(i64::from(self.ground.is_some()))
            .number(self.ground.unwrap_or(0.0))
            .number(self.margin);
    }
}

impl Point {
    /// A point of a plane.
    pub(super) fn on_plane(place: DVec3, normal: DVec3, distance: f64) -> Point {
        Point {
            place,
            start: place,
            normal,
            face: normal,
            distance,
            surface: 0,
            coordinates: DVec2::ZERO,
        }
    }
}

/// The part of a ray on one side of planes, with the plane at which it begins or ends.
struct Span {
    from: f64,
    to: f64,
    first: usize,
    last: usize,
}

impl Thing {
    pub(super) fn new(mesh: Arc<Mesh>, cuts: Vec<Cut>, is_notch: bool) -> Thing {
        let bytes = postcard::to_stdvec(&*mesh).expect("plain data always has bytes");
        Thing {
            mesh_key: Key::of_bytes(&bytes),
            mesh,
            hierarchy: OnceLock::new(),
            is_notch: is_notch && !cuts.is_empty(),
            cuts,
        }
    }

    /// The boxes over its triangles, made when the first ray comes: a picture that is there needs none.
    fn hierarchy(&self) -> &Hierarchy {
        self.hierarchy.get_or_init(|| {
            let triangles = self.mesh.triangles.iter();
            Hierarchy::new(triangles.map(|triangle| outline::corners(&self.mesh, triangle)))
        })
    }

    /// Points that a picture has to show: the outermost ones of what is left are among them. None if nothing is.
    pub(super) fn outline(&self) -> Vec<DVec3> {
        let largest = |largest: f64, point: &DVec3| largest.max(point.abs().max_element());
        let margin = 1e-9 * self.mesh.points.iter().fold(0.0, largest);
        let behind = |cuts: &[Cut]| {
            let mut left = outline::left_by(&self.mesh, cuts);
            let corners = outline::corners_of(cuts, margin).into_iter();
            left.extend(corners.filter(|corner| self.is_inside(*corner)));
            match outline::is_flat(&left, cuts, margin) {
                true => vec![],
                false => left,
            }
        };
        match self.is_notch {
            // A notch leaves what lies behind one of its planes, whichever.
            true => self.cuts.chunks(1).flat_map(behind).collect(),
            false if self.cuts.is_empty() => self.mesh.points.clone(),
            false => behind(&self.cuts),
        }
    }

    /// Whether a point lies inside the closed mesh.
    fn is_inside(&self, point: DVec3) -> bool {
        let upwards = Ray::new(point, DVec3::Z);
        let meeting = self.hierarchy().first(&upwards, 0.0, f64::INFINITY);
        meeting.is_some_and(|meeting| meeting.leaves)
    }

    /// The part of a ray that lies on the given side of all cuts: behind them, or before.
    fn span(&self, ray: &Ray, before: bool) -> Option<Span> {
        let mut span = Span {
            from: 0.0,
            to: f64::INFINITY,
            first: usize::MAX,
            last: usize::MAX,
        };
        for (index, cut) in self.cuts.iter().enumerate() {
            let sign = if before { -1.0 } else { 1.0 };
            let height = sign * cut.height(ray.point(0.0));
            let rise = sign * cut.normal.dot(ray.direction());
            if rise == 0.0 {
                if height > 0.0 {
                    return None;
                }
                continue;
            }
            let distance = -height / rise;
            if rise > 0.0 && distance < span.to {
                (span.to, span.last) = (distance, index);
            } else if rise < 0.0 && distance > span.from {
                (span.from, span.first) = (distance, index);
            }
        }
        (span.from < span.to).then_some(span)
    }

    fn look(&self, ray: &Ray) -> Option<Point> {
        if self.is_notch {
            return self.look_into_notch(ray);
        }
        let span = self.span(ray, false)?;
        let meeting = self.hierarchy().first(ray, span.from, f64::INFINITY)?;
        if span.first != usize::MAX && meeting.leaves {
            return Some(self.on_cut(ray, span.from, span.first));
        }
        (meeting.distance <= span.to).then(|| self.on_mesh(ray, &meeting))
    }

    fn look_into_notch(&self, ray: &Ray) -> Option<Point> {
        let meeting = self.hierarchy().first(ray, 0.0, f64::INFINITY)?;
        let Some(notch) = self.span(ray, true) else {
            return Some(self.on_mesh(ray, &meeting));
        };
        if meeting.distance < notch.from {
            return Some(self.on_mesh(ray, &meeting));
        }
        if notch.last == usize::MAX {
            return None;
        }
        let meeting = self.hierarchy().first(ray, notch.to, f64::INFINITY)?;
        Some(match meeting.leaves {
            true => self.on_cut(ray, notch.to, notch.last),
            false => self.on_mesh(ray, &meeting),
        })
    }

    fn hides(&self, ray: &Ray, furthest: f64) -> bool {
        let hierarchy = self.hierarchy();
        if self.is_notch {
            return match self.span(ray, true) {
                None => hierarchy.any(ray, 0.0, furthest),
                Some(notch) => {
                    notch.from > 0.0 && hierarchy.any(ray, 0.0, furthest.min(notch.from))
                        || notch.to < furthest
                            && hierarchy.first(ray, notch.to, f64::INFINITY).is_some_and(
                                |meeting| meeting.leaves || meeting.distance < furthest,
                            )
                }
            };
        }
        match self.span(ray, false) {
            None => false,
            Some(span) if span.first == usize::MAX => {
                hierarchy.any(ray, 0.0, span.to.min(furthest))
            }
            Some(span) => hierarchy
                .first(ray, span.from, f64::INFINITY)
                .is_some_and(|meeting| {
                    span.from < furthest
                        && (meeting.leaves || meeting.distance <= span.to.min(furthest))
                }),
        }
    }

    fn on_cut(&self, ray: &Ray, distance: f64, cut: usize) -> Point {
        Point {
            surface: 1 + cut as u32,
            ..Point::on_plane(ray.point(distance), self.cuts[cut].normal, distance)
        }
    }

    fn on_mesh(&self, ray: &Ray, meeting: &Meeting) -> Point {
        let triangle = &self.mesh.triangles[meeting.triangle as usize];
        let [v, w] = meeting.weights;
        let weights = [1.0 - v - w, v, w];
        let corners = outline::corners(&self.mesh, triangle);
        let normals = triangle
            .normals
            .map(|index| self.mesh.normals[index as usize]);
        let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let face = face.try_normalize().unwrap_or(normals[0]);
        let blended: DVec3 = normals
            .iter()
            .zip(weights)
            .map(|(it, weight)| *it * weight)
            .sum();
        let normal = blended.try_normalize().unwrap_or(face);
        // A sheet without an inside is seen from both sides.
        let side = if meeting.leaves { -1.0 } else { 1.0 };
        let place = ray.point(meeting.distance);
        let coordinates = match self.mesh.coordinates.as_slice() {
            [] => DVec2::ZERO,
            all => {
                let corner = |index: u32| all[index as usize];
                let corners = triangle.coordinates.map(corner);
                corners
                    .iter()
                    .zip(weights)
                    .map(|(it, weight)| *it * weight)
                    .sum()
            }
        };
        Point {
            place,
            start: beside(place, corners, normals.map(|it| it * side), weights),
            normal: towards(normal * side, face * side),
            face: face * side,
            distance: meeting.distance,
            surface: surface_of(triangle.chart),
            coordinates,
        }
    }
}

/// The normal, bent to the side of the triangle that is seen.
fn towards(normal: DVec3, face: DVec3) -> DVec3 {
    let facing = normal.dot(face);
    if facing > 0.0 {
        return normal;
    }
    (normal - face * (facing - 1e-3)).normalize()
}

/// The point of the smooth surface over a point of a triangle (Hanika 2021): rays to lights that begin on the
/// triangle itself would meet its neighbours where the smooth surface turns away from the light.
fn beside(place: DVec3, corners: [DVec3; 3], normals: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    let lifted = |index: usize| {
        let away = place - corners[index];
        let height = away.dot(normals[index]).min(0.0);
        normals[index] * (-height * weights[index])
    };
    place + lifted(0) + lifted(1) + lifted(2)
}
