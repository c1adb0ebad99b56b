//! A hierarchy of boxes over triangles: finds which triangle a ray meets first, and whether it meets any.
//!
//! Of our own instead of a library's, since results must have the same bits at every level of vector
//! instructions, and rays ask for the first hit behind a distance, which tells insides from outsides.
//! Boxes are held in single precision, a little too large; triangles are tested in double precision.

mod build;

use glam::DVec3;

/// A straight line with a beginning.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// What boxes are tested with.
    short: ShortRay,
}

#[derive(Clone, Copy, Debug)]
struct ShortRay {
    origin: [f32; 3],
    /// 1 / direction; infinite parts are made large instead, so that no product is undefined.
    inverse: [f32; 3],
}

impl Ray {
    /// The ray from `origin`; distances along it count in lengths of `direction`.
    pub(crate) fn new(origin: DVec3, direction: DVec3) -> Ray {
        let inverse = direction.to_array().map(|part| {
            let part = part as f32;
            if part.abs() < 1e-18 { 1e18 } else { 1.0 / part }
        });
        let short = ShortRay {
            origin: origin.as_vec3().to_array(),
            inverse,
        };
        Ray {
            origin,
            direction,
            short,
        }
    }

    /// The point at a distance.
    pub(crate) fn point(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }

    /// The direction, as given.
    pub(crate) fn direction(&self) -> DVec3 {
        self.direction
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meeting {
    /// Distance along the ray.
    pub(crate) distance: f64,
    /// Index of the triangle.
    pub(crate) triangle: u32,
    /// Weights of its second and third corner.
    pub(crate) weights: [f64; 2],
    /// Whether the ray comes from behind: it leaves what the triangle bounds.
    pub(crate) leaves: bool,
}

/// A box of two corners.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: [f32; 3],
    high: [f32; 3],
}

impl Bounds {
    /// Where the ray enters the box, if it does so before `furthest`.
    #[inline(always)]
    fn entry(&self, ray: &ShortRay, nearest: f32, furthest: f32) -> Option<f32> {
        let (mut enter, mut leave) = (nearest, furthest);
        for axis in 0..3 {
            let a = (self.low[axis] - ray.origin[axis]) * ray.inverse[axis];
            let b = (self.high[axis] - ray.origin[axis]) * ray.inverse[axis];
            let (near, far) = if a < b { (a, b) } else { (b, a) };
            enter = if near > enter { near } else { enter };
            leave = if far < leave { far } else { leave };
        }
        (enter <= leave).then_some(enter)
    }
}

/// Two boxes and what is in them.
#[derive(Clone, Copy, Debug)]
struct Branch {
    bounds: [Bounds; 2],
    children: [Child; 2],
}

/// What is in a box: other boxes, or triangles if `count` is not 0.
#[derive(Clone, Copy, Debug)]
struct Child {
    first: u32,
    count: u32,
}

/// The boxes over some triangles.
#[derive(Debug)]
pub(crate) struct Hierarchy {
    branches: Vec<Branch>,
    root: Child,
    bounds: Bounds,
    /// Corner and edges of each triangle, those of one box side by side.
    triangles: Vec<[DVec3; 3]>,
    /// The index of each of them as the caller counts.
    order: Vec<u32>,
}

/// How far beyond the edges of a triangle a ray still meets it, as a part of the triangle: neighbours leave no gap.
const EDGE: f64 = 1e-11;

/// Boxes that wait to be looked at, at most: more than the depth of any hierarchy.
const DEEPEST: usize = 96;

impl Hierarchy {
    /// The first meeting with a triangle between two distances.
    pub(crate) fn first(&self, ray: &Ray, nearest: f64, furthest: f64) -> Option<Meeting> {
        let mut best: Option<Meeting> = None;
        self.visit(ray, nearest, furthest, |meeting| {
            let distance = meeting.distance;
            // Of two that are equally near, such as at an edge, the lower index counts.
            let is_better = best.is_none_or(|best| {
                distance < best.distance
                    || distance == best.distance && meeting.triangle < best.triangle
            });
            if is_better {
                best = Some(meeting);
            }
            Some(best.map_or(furthest, |best| best.distance))
        });
        best
    }

    /// Whether there is a triangle between two distances.
    pub(crate) fn any(&self, ray: &Ray, nearest: f64, furthest: f64) -> bool {
        let mut is_met = false;
        self.visit(ray, nearest, furthest, |_| {
            is_met = true;
            None
        });
        is_met
    }

    /// Calls `meet` for meetings; it gives the distance up to which more are of interest, or `None` to stop.
    #[inline(always)]
    fn visit(
        &self,
        ray: &Ray,
        nearest: f64,
        furthest: f64,
        mut meet: impl FnMut(Meeting) -> Option<f64>,
    ) {
        let mut furthest = furthest;
        // Rounded outwards, as the boxes are.
        let near = (nearest as f32) * 0.999_999;
        let mut far = (furthest as f32) * 1.000_001;
        if self.bounds.entry(&ray.short, near, far).is_none() {
            return;
        }
        let mut waiting = [(0.0f32, self.root); DEEPEST];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (entry, child) = waiting[count];
            if entry > far {
                continue;
            }
            if child.count > 0 {
                let range = child.first as usize..(child.first + child.count) as usize;
                for index in range {
                    let Some(meeting) = self.meeting(ray, index) else {
                        continue;
                    };
                    if meeting.distance < nearest || meeting.distance > furthest {
                        continue;
                    }
                    match meet(meeting) {
                        None => return,
                        Some(limit) => furthest = limit,
                    }
                    far = (furthest as f32) * 1.000_001;
                }
                continue;
            }
            let branch = &self.branches[child.first as usize];
            let [first, second] = branch
                .bounds
                .map(|bounds| bounds.entry(&ray.short, near, far));
            // The nearer one is put on top.
            let pairs = match (first, second) {
                (Some(a), Some(b)) if a <= b => [Some((b, 1)), Some((a, 0))],
                (a, b) => [a.map(|a| (a, 0)), b.map(|b| (b, 1))],
            };
            for (entry, side) in pairs.into_iter().flatten() {
                waiting[count] = (entry, branch.children[side]);
                count += 1;
            }
        }
    }

    /// Where the ray's line meets a triangle (Möller & Trumbore 1997).
    #[inline(always)]
    fn meeting(&self, ray: &Ray, index: usize) -> Option<Meeting> {
        let [corner, first, second] = self.triangles[index];
        let across = ray.direction.cross(second);
        let determinant = first.dot(across);
        if determinant == 0.0 {
            return None;
        }
        let inverse = 1.0 / determinant;
        let away = ray.origin - corner;
        let u = away.dot(across) * inverse;
        if !(-EDGE..=1.0 + EDGE).contains(&u) {
            return None;
        }
        let other = away.cross(first);
        let v = ray.direction.dot(other) * inverse;
        if v < -EDGE || u + v > 1.0 + EDGE {
            return None;
        }
        Some(Meeting {
            distance: second.dot(other) * inverse,
            triangle: self.order[index],
            weights: [u, v],
            leaves: determinant < 0.0,
        })
    }
}
