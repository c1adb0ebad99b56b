//! How far a point is inside an outline.

use super::outline::{edges, is_convex, radii, rounded};
use glam::{DVec2, Vec2, Vec4};
use std::ops::Range;

/// The outlines of all stones.
#[derive(Debug, Default)]
pub(super) struct Outlines {
    quads: Vec<Quad>,
    segments: Vec<Segment>,
}

/// Which outline a stone has.
#[derive(Clone, Debug)]
pub(super) enum Outline {
    /// Convex: four edges at a time.
    Convex(Range<u32>),
    /// Any other, with arcs as short edges.
    Any(Range<u32>),
}

/// Four edges of a convex outline, each with the rounded corner behind it.
#[derive(Clone, Copy, Debug)]
struct Quad {
    /// Unit normals inwards, and the distance of the edges from the centre.
    normals: [Vec4; 2],
    offsets: Vec4,
    /// The directions of the edges behind.
    next: [Vec4; 2],
    /// The middles and radii of the corners.
    corners: [Vec4; 2],
    radii: Vec4,
}

/// An edge of an outline that is not convex.
#[derive(Clone, Copy, Debug)]
struct Segment {
    from: Vec2,
    along: Vec2,
    /// 1 over the length's square.
    scale: f32,
}

/// An edge of a convex outline: inward normal, offset, direction of the edge behind, middle and radius of the corner.
type Side = (DVec2, f64, DVec2, DVec2, f64);

impl Outlines {
    /// Adds an outline with corners rounded to a radius.
    pub(super) fn add(&mut self, corners: &[DVec2], radius: f64) -> Outline {
        if !is_convex(corners) {
            let first = self.segments.len() as u32;
            let rounded = rounded(corners, radius);
            self.segments.extend(edges(&rounded).map(Segment::new));
            return Outline::Any(first..self.segments.len() as u32);
        }
        let first = self.quads.len() as u32;
        let sides: Vec<Side> = sides(corners, &radii(corners, radius));
        self.quads.extend(sides.chunks(4).map(Quad::new));
        Outline::Convex(first..self.quads.len() as u32)
    }

    /// How far a point is inside an outline; below 0 outside.
    #[inline]
    pub(super) fn depth(&self, outline: &Outline, point: Vec2) -> f32 {
        match outline {
            Outline::Convex(range) => {
                let quads = &self.quads[range.start as usize..range.end as usize];
                quads
                    .iter()
                    .map(|quad| quad.depth(point))
                    .fold(f32::INFINITY, f32::min)
            }
            Outline::Any(range) => depth(
                &self.segments[range.start as usize..range.end as usize],
                point,
            ),
        }
    }

    /// All its numbers, for keys.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f32> {
        let quads = self.quads.iter().flat_map(|quad| {
            let [x, y] = quad.normals;
            let parts = [
                x,
                y,
                quad.offsets,
                quad.corners[0],
                quad.corners[1],
                quad.radii,
            ];
            parts.into_iter().flat_map(|part| part.to_array())
        });
        let segments = self
            .segments
            .iter()
            .flat_map(|segment| [segment.from, segment.along]);
        quads.chain(segments.flat_map(|part| part.to_array()))
    }
}

/// The edges of a convex outline, each with the corner behind it.
fn sides(corners: &[DVec2], radii: &[f64]) -> Vec<Side> {
    let count = corners.len();
    let along =
        |index: usize| (corners[(index + 1) % count] - corners[index % count]).normalize_or_zero();
    let side = |index: usize| {
        let (own, next) = (along(index), along(index + 1));
        let (corner, radius) = (corners[(index + 1) % count], radii[(index + 1) % count]);
        // The middle is at the radius from both edges.
        let turn = own.perp_dot(next);
        let middle = corner + (next - own) * (radius / turn.max(1e-9));
        (own.perp(), corner.dot(own.perp()), next, middle, radius)
    };
    (0..count).map(side).collect()
}

impl Quad {
    /// Up to four edges; the last is repeated.
    fn new(sides: &[Side]) -> Quad {
        let part = |part: &dyn Fn(&Side) -> f64| {
            Vec4::from_array(
                [0, 1, 2, 3].map(|lane: usize| part(&sides[lane.min(sides.len() - 1)]) as f32),
            )
        };
        Quad {
            normals: [part(&|side| side.0.x), part(&|side| side.0.y)],
            offsets: part(&|side| side.1),
            next: [part(&|side| side.2.x), part(&|side| side.2.y)],
            corners: [part(&|side| side.3.x), part(&|side| side.3.y)],
            radii: part(&|side| side.4),
        }
    }

    #[inline]
    fn depth(&self, point: Vec2) -> f32 {
        let (x, y) = (Vec4::splat(point.x), Vec4::splat(point.y));
        let lines = x * self.normals[0] + y * self.normals[1] - self.offsets;
        let (from_x, from_y) = (x - self.corners[0], y - self.corners[1]);
        // Behind the end of the edge and before the start of the next, seen from the middle of the corner.
        let beyond = from_x * self.normals[1] - from_y * self.normals[0];
        let ahead = from_x * self.next[0] + from_y * self.next[1];
        let is_at_corner = beyond.cmpgt(Vec4::ZERO) & ahead.cmplt(Vec4::ZERO);
        let lines = lines.min_element();
        if !is_at_corner.any() {
            return lines;
        }
        let arcs = self.radii - (from_x * from_x + from_y * from_y).sqrt();
        Vec4::select(is_at_corner, arcs, Vec4::splat(lines)).min_element()
    }
}

impl Segment {
    fn new([from, to]: [DVec2; 2]) -> Segment {
        let along = (to - from).as_vec2();
        Segment {
            from: from.as_vec2(),
            along,
            scale: 1.0 / along.length_squared().max(f32::MIN_POSITIVE),
        }
    }
}

/// The depth in any outline: the distance to the nearest edge, and inside if a ray to the right crosses an odd number.
fn depth(segments: &[Segment], point: Vec2) -> f32 {
    let (mut nearest, mut is_inside) = (f32::INFINITY, false);
    for segment in segments {
        let from = point - segment.from;
        let share = (from.dot(segment.along) * segment.scale).clamp(0.0, 1.0);
        nearest = nearest.min((from - segment.along * share).length_squared());
        let is_across = (from.y < 0.0) != (from.y < segment.along.y);
        let is_beyond = (from.perp_dot(segment.along) > 0.0) == (segment.along.y > 0.0);
        is_inside ^= is_across && !is_beyond;
    }
    let distance = nearest.sqrt();
    if is_inside { distance } else { -distance }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [(f64, f64); 4] = [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)];

    fn depths(corners: &[(f64, f64)], radius: f64, points: [(f32, f32); 4]) -> [f32; 4] {
        let corners: Vec<DVec2> = corners.iter().map(|corner| DVec2::from(*corner)).collect();
        let mut outlines = Outlines::default();
        let outline = outlines.add(&corners, radius);
        points.map(|(x, y)| outlines.depth(&outline, Vec2::new(x, y)))
    }

    fn are_near(found: [f32; 4], expected: [f32; 4]) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-4, "{found}, not {expected}");
        }
    }

    #[test]
    fn convex_outlines_have_exact_depths() {
        let root = 2.0f32.sqrt();
        let points = [(0.0, 0.0), (8.0, -3.0), (13.0, 14.0), (-12.0, 0.0)];
        are_near(depths(&SQUARE, 0.0, points), [10.0, 2.0, -5.0, -2.0]);
        // The corner's middle is at (6, 6).
        let points = [(9.0, 9.0), (10.0, 10.0), (10.0, 0.0), (0.0, 7.0)];
        are_near(
            depths(&SQUARE, 4.0, points),
            [4.0 - 3.0 * root, 4.0 - 4.0 * root, 0.0, 3.0],
        );
        // Six corners take two groups of edges.
        let hexagon = [0, 1, 2, 3, 4, 5].map(|corner| {
            let (sine, cosine) = libm::sincos(std::f64::consts::FRAC_PI_3 * f64::from(corner));
            (10.0 * cosine, 10.0 * sine)
        });
        let points = [(0.0, 0.0), (12.0, 0.0), (0.0, -8.0), (0.0, 10.0)];
        let height = 75.0f32.sqrt();
        are_near(
            depths(&hexagon, 0.0, points),
            [height, -2.0, height - 8.0, height - 10.0],
        );
    }

    #[test]
    fn other_outlines_have_exact_depths() {
        let arrow = [
            (-10.0, -10.0),
            (10.0, -10.0),
            (10.0, 10.0),
            (0.0, 0.0),
            (-10.0, 10.0),
        ];
        let half = 2.0f32.sqrt();
        let points = [(0.0, 2.0), (0.0, -2.0), (8.0, -9.0), (14.0, 13.0)];
        are_near(depths(&arrow, 0.0, points), [-half, 2.0, 1.0, -5.0]);
    }
}
