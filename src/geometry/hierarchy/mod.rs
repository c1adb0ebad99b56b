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

/// Boxes side by side in a node.
const WIDTH: usize = 4;

/// Four boxes and what is in them; boxes that hold nothing lie where no ray comes.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Along each axis the lower sides of the four boxes, and the upper ones.
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    children: [Child; WIDTH],
}

impl Node {
    /// Where the ray enters the boxes, and whether it does so between two distances.
    #[inline(always)]
    fn entries(
        &self,
        ray: &ShortRay,
        nearest: f32,
        furthest: f32,
    ) -> ([f32; WIDTH], [bool; WIDTH]) {
        let (mut enter, mut leave) = ([nearest; WIDTH], [furthest; WIDTH]);
        for axis in 0..3 {
            let (origin, inverse) = (ray.origin[axis], ray.inverse[axis]);
            for lane in 0..WIDTH {
                let a = (self.low[axis][lane] - origin) * inverse;
                let b = (self.high[axis][lane] - origin) * inverse;
                let (near, far) = if a < b { (a, b) } else { (b, a) };
                enter[lane] = if near > enter[lane] {
                    near
                } else {
                    enter[lane]
                };
                leave[lane] = if far < leave[lane] { far } else { leave[lane] };
            }
        }
        (
            enter,
            std::array::from_fn(|lane| enter[lane] <= leave[lane]),
        )
    }
}

/// What is in a box: the number of a node, or triangles.
#[derive(Clone, Copy, Debug)]
struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const COUNT: u32 = 28;

    fn node(index: usize) -> Child {
        Child(index as u32)
    }

    /// Up to seven triangles from `first` on.
    fn leaf(first: usize, count: usize) -> Child {
        Child(Child::LEAF | (count as u32) << Child::COUNT | first as u32)
    }

    #[inline(always)]
    fn triangles(self) -> Option<std::ops::Range<usize>> {
        let first = (self.0 & ((1 << Child::COUNT) - 1)) as usize;
        let count = (self.0 >> Child::COUNT & 7) as usize;
        (self.0 & Child::LEAF != 0).then_some(first..first + count)
    }
}

/// The boxes over some triangles.
#[derive(Debug)]
pub(crate) struct Hierarchy {
    /// Corners of the box around everything.
    bounds: [[f32; 3]; 2],
    nodes: Vec<Node>,
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
        self.visit::<true>(ray, nearest, furthest, |meeting| {
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
        self.visit::<false>(ray, nearest, furthest, |_| {
            is_met = true;
            None
        });
        is_met
    }

    /// Calls `meet` for meetings, near ones before far ones if they are asked for in order; it gives the distance up to
    /// which more are of interest, or `None` to stop.
    #[inline(always)]
    fn visit<const IN_ORDER: bool>(
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
        if !self.is_near(&ray.short, near, far) {
            return;
        }
        let mut waiting = [(0.0f32, Child::node(0)); DEEPEST];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (entry, child) = waiting[count];
            if entry > far {
                continue;
            }
            let Some(range) = child.triangles() else {
                let node = &self.nodes[child.0 as usize];
                let first = count;
                let (entries, is_met) = node.entries(&ray.short, near, far);
                for lane in 0..WIDTH {
                    if is_met[lane] {
                        waiting[count] = (entries[lane], node.children[lane]);
                        count += 1;
                    }
                }
                // The nearest one is put on top.
                for index in first + 1..if IN_ORDER { count } else { 0 } {
                    let mut place = index;
                    while place > first && waiting[place].0 > waiting[place - 1].0 {
                        waiting.swap(place, place - 1);
                        place -= 1;
                    }
                }
                continue;
            };
            for index in range {
                let Some(meeting) = self.meeting(ray, index, nearest, furthest) else {
                    continue;
                };
                match meet(meeting) {
                    None => return,
                    Some(limit) => furthest = limit,
                }
                far = (furthest as f32) * 1.000_001;
            }
        }
    }

    /// Whether a ray meets the box around everything: most do not, and need no list of boxes.
    #[inline(always)]
    fn is_near(&self, ray: &ShortRay, nearest: f32, furthest: f32) -> bool {
        let (mut enter, mut leave) = (nearest, furthest);
        for axis in 0..3 {
            let [a, b] = self
                .bounds
                .map(|corner| (corner[axis] - ray.origin[axis]) * ray.inverse[axis]);
            let (near, far) = if a < b { (a, b) } else { (b, a) };
            enter = if near > enter { near } else { enter };
            leave = if far < leave { far } else { leave };
        }
        enter <= leave
    }

    /// Where the ray's line meets a triangle between two distances (Möller & Trumbore 1997).
    #[inline(always)]
    fn meeting(&self, ray: &Ray, index: usize, nearest: f64, furthest: f64) -> Option<Meeting> {
        let [corner, first, second] = self.triangles[index];
        let across = ray.direction.cross(second);
        let determinant = first.dot(across);
        let away = ray.origin - corner;
        // Seen from behind all signs are turned, so that nothing is divided for triangles that are not met.
        let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
        let size = determinant * sign;
        let edge = size * EDGE;
        let u = away.dot(across) * sign;
        if !(u >= -edge && u <= size + edge) || size == 0.0 {
            return None;
        }
        let other = away.cross(first);
        let v = ray.direction.dot(other) * sign;
        if !(v >= -edge && u + v <= size + edge) {
            return None;
        }
        let inverse = 1.0 / size;
        let distance = second.dot(other) * sign * inverse;
        (distance >= nearest && distance <= furthest).then(|| Meeting {
            distance,
            triangle: self.order[index],
            weights: [u * inverse, v * inverse],
            leaves: determinant < 0.0,
        })
    }
}
