//! The upper side of one stone: triangles seen from above, found by a small grid.
//!
//! Over the triangles of a smooth stone the height is a cubic with the heights and the slopes of the limit surface at the
//! corners (Bazeley, Cheung, Irons & Zienkiewicz 1965); where the surface stands steep it is straight.

use super::cage::Cage;
use glam::{DVec2, DVec3, UVec2, Vec2, Vec4};

/// Edges are straight where the surface stands steeper than this, as the upward part of its normal.
const STEEP: f64 = 0.25;

/// The upper side of a stone, around its centre.
#[derive(Debug)]
pub(super) struct Form {
    low: Vec2,
    /// Bins along each side of the grid, and bins per mm.
    side: u32,
    scale: Vec2,
    /// The first of each bin's groups in `list`, and behind them its length.
    starts: Vec<u32>,
    list: Vec<u16>,
    groups: Vec<Group>,
}

/// Four triangles seen from above; subdivision leaves four side by side where there was one.
#[derive(Clone, Copy, Debug)]
struct Group {
    /// Where the triangles' first corners are; not a number for those that are not seen.
    origins: [Vec4; 2],
    /// The changes of the second and third corners' shares along x and y.
    shares: [[Vec4; 2]; 2],
    heights: [Vec4; 3],
    /// How much higher the tangent at corner i is at corner j than the surface; the six pairs (i, j) in the order
    /// 01, 02, 10, 12, 20, 21.
    bends: [Vec4; 6],
}

/// How far outside a triangle a point may lie, so that there are no cracks.
const SLACK: f32 = -1e-5;

impl Group {
    /// The height at a point where one of the triangles is higher than `lowest`, or that.
    #[inline(always)]
    fn height(&self, point: Vec2, lowest: f32) -> f32 {
        let [x, y] = [point.x - self.origins[0], point.y - self.origins[1]];
        let [b, c] = self.shares.map(|[along, across]| along * x + across * y);
        let a = 1.0 - b - c;
        let is_hit = a.min(b).min(c).cmpge(Vec4::splat(SLACK));
        if !is_hit.any() {
            return lowest;
        }
        let heights = Vec4::select(is_hit, self.heights([a, b, c]), Vec4::splat(lowest));
        lowest.max(heights.max_element())
    }

    /// The heights of all four surfaces where the corners have these shares.
    #[inline(always)]
    fn heights(&self, [a, b, c]: [Vec4; 3]) -> Vec4 {
        let [ab, ac, ba, bc, ca, cb] = self.bends;
        let flat = a * self.heights[0] + b * self.heights[1] + c * self.heights[2];
        let sides =
            a * b * (a * ab + b * ba) + b * c * (b * bc + c * cb) + c * a * (c * ca + a * ac);
        flat + sides + 0.5 * a * b * c * (ab + ac + ba + bc + ca + cb)
    }
}

/// Least and largest x and y.
type Bounds = [Vec2; 2];

impl Form {
    /// The upper side over the corners of a prism: n below, then n on top.
    pub(super) fn new(cage: &Cage, corners: &[DVec3]) -> Form {
        let points: Vec<DVec3> = cage
            .vertices
            .iter()
            .map(|it| Cage::blend(it, corners))
            .collect();
        let corners_of = |it: &[u32; 3]| it.map(|index| points[index as usize]);
        // Slopes take long, and most of the triangles below are never seen.
        let mut slopes: Vec<Option<[f64; 2]>> = vec![None; points.len()];
        let mut is_known = vec![cage.tangents.is_empty(); points.len()];
        for index in cage
            .triangles
            .iter()
            .filter(|it| is_seen(&corners_of(it)))
            .flatten()
        {
            let index = *index as usize;
            if !std::mem::replace(&mut is_known[index], true) {
                slopes[index] = slope(&cage.tangents[index], corners);
            }
        }
        let slopes_of = |it: &[u32; 3]| it.map(|index| slopes[index as usize]);
        let groups = cage.triangles.chunks(4).filter_map(|triangles| {
            group(triangles.iter().map(|it| (corners_of(it), slopes_of(it))))
        });
        Form::in_bins(&groups.collect::<Vec<_>>())
    }

    /// Groups with the boxes around them.
    fn in_bins(groups: &[(Group, Bounds)]) -> Form {
        let boxes = || groups.iter().map(|(_, bounds)| *bounds);
        let low = boxes().fold(Vec2::INFINITY, |low, [it, _]| low.min(it));
        let high = boxes().fold(Vec2::NEG_INFINITY, |high, [_, it]| high.max(it));
        let side = (8 * groups.len()).isqrt().clamp(1, 64) as u32;
        let scale = side as f32 / (high - low).max(Vec2::splat(1e-6));
        let bins_of = |bounds: Bounds| {
            let [from, to] = bounds.map(|corner| bin((corner - low) * scale, side));
            (from.y..=to.y).flat_map(move |y| (from.x..=to.x).map(move |x| (y * side + x) as usize))
        };
        let mut starts = vec![0; (side * side) as usize + 1];
        boxes().flat_map(bins_of).for_each(|bin| starts[bin] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        // Backwards, so that each bin's groups end up in order and its start where they begin.
        let mut list = vec![0; sum as usize];
        for (index, bounds) in boxes().enumerate().rev() {
            for bin in bins_of(bounds) {
                starts[bin] -= 1;
                list[starts[bin] as usize] = index as u16;
            }
        }
        Form {
            low,
            side,
            scale,
            starts,
            list,
            groups: groups.iter().map(|(group, _)| *group).collect(),
        }
    }

    /// The height of the surface at a point, if it is there: the highest, where it overhangs.
    pub(super) fn height(&self, point: Vec2) -> Option<f32> {
        let at = (point - self.low) * self.scale;
        if !(at.cmpge(Vec2::ZERO).all() && at.cmple(Vec2::splat(self.side as f32)).all()) {
            return None;
        }
        let bin = bin(at, self.side);
        let bin = (bin.y * self.side + bin.x) as usize;
        let range = self.starts[bin] as usize..self.starts[bin + 1] as usize;
        let height = self.list[range]
            .iter()
            .fold(f32::NEG_INFINITY, |highest, group| {
                self.groups[usize::from(*group)].height(point, highest)
            });
        (height > f32::NEG_INFINITY).then_some(height)
    }
}

/// The bin at a place in widths of bins from the first corner.
#[inline]
fn bin(at: Vec2, side: u32) -> UVec2 {
    at.as_uvec2().min(UVec2::splat(side - 1))
}

/// The slopes along x and y of a surface with two tangents; `None` where it stands steep.
fn slope(tangents: &[Vec<f64>; 2], corners: &[DVec3]) -> Option<[f64; 2]> {
    let [along, across] = [0, 1].map(|which| Cage::blend(&tangents[which], corners));
    let normal = along.cross(across).try_normalize()?;
    (normal.z > STEEP).then(|| [-normal.x / normal.z, -normal.y / normal.z])
}

/// The first corner of a triangle, and the ways from it to the others.
fn seen_from_above([a, b, c]: &[DVec3; 3]) -> [DVec2; 3] {
    [a.truncate(), (b - a).truncate(), (c - a).truncate()]
}

/// Whether a triangle is seen from above, and not from below or from the side.
fn is_seen(corners: &[DVec3; 3]) -> bool {
    let [_, ab, ac] = seen_from_above(corners);
    ab.perp_dot(ac) > 1e-9 * ab.length_squared().max(ac.length_squared())
}

/// Up to four triangles, with the slopes at their corners, and the box around those that are seen from above, if any are.
fn group(
    triangles: impl Iterator<Item = ([DVec3; 3], [Option<[f64; 2]>; 3])>,
) -> Option<(Group, Bounds)> {
    let mut group = Group {
        origins: [Vec4::NAN; 2],
        shares: [[Vec4::ZERO; 2]; 2],
        heights: [Vec4::ZERO; 3],
        bends: [Vec4::ZERO; 6],
    };
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for (lane, (corners, slopes)) in triangles.enumerate() {
        if !is_seen(&corners) {
            continue;
        }
        let [a, ab, ac] = seen_from_above(&corners);
        let area = ab.perp_dot(ac);
        let shares = [-ac.perp() / area, ab.perp() / area];
        for axis in 0..2 {
            group.origins[axis][lane] = a[axis] as f32;
            for (to, share) in group.shares.iter_mut().zip(shares) {
                to[axis][lane] = share[axis] as f32;
            }
        }
        for (to, corner) in group.heights.iter_mut().zip(corners) {
            to[lane] = corner.z as f32;
        }
        for (to, bend) in group.bends.iter_mut().zip(bends(corners, slopes)) {
            to[lane] = bend;
        }
        for corner in corners.map(|corner| corner.truncate().as_vec2()) {
            (low, high) = (low.min(corner), high.max(corner));
        }
    }
    low.is_finite().then_some((group, [low, high]))
}

/// How much higher tangents with these slopes are than the corners of a triangle, in the order of [`Group::bends`].
fn bends(corners: [DVec3; 3], slopes: [Option<[f64; 2]>; 3]) -> [f32; 6] {
    let bend = |(from, to): (usize, usize)| {
        let way = corners[to] - corners[from];
        // Along an edge both its triangles are the same, so it takes both ends.
        match [slopes[from], slopes[to]] {
            [Some([x, y]), Some(_)] => (x * way.x + y * way.y - way.z) as f32,
            _ => 0.0,
        }
    };
    [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)].map(bend)
}

#[cfg(test)]
mod tests {
    use super::super::cage::Cut;
    use super::*;

    fn prism() -> [DVec3; 8] {
        let corner = |index: usize| {
            let (x, y) = [(-45.0, -50.0), (48.0, -46.0), (50.0, 47.0), (-44.0, 49.0)][index % 4];
            DVec3::new(x, y, [0.0, 0.0, 0.0, 0.0, 98.0, 103.0, 100.0, 95.0][index])
        };
        [0, 1, 2, 3, 4, 5, 6, 7].map(corner)
    }

    #[test]
    fn prisms_are_flat_between_their_corners() {
        let form = Form::new(&Cage::new(4, Cut::Prism), &prism());
        assert_eq!(form.height(Vec2::new(60.0, 0.0)), None);
        // Halfway along the edge of the top from 98 to 103.
        let found = form.height(Vec2::new(1.5, -47.999)).unwrap();
        assert!((found - 100.5).abs() < 1e-2, "{found}");
    }

    /// Points of the limit surface after two steps more lie on the form, where it does not stand steep.
    #[test]
    fn forms_are_the_limit_surface() {
        // Where the surface stands steep the form is straight between points, so near the tight corners of stones that have them it
        // is off by what arcs rise over chords, a quarter of that with each step. Two steps are what stones are drawn with.
        for (cut, steps, limit) in [
            (Cut::Round, 2, 0.5),
            (Cut::Corner(0.2), 2, 1.5),
            (Cut::Corner(0.2), 3, 0.5),
        ] {
            let form = Form::new(&Cage::refined(4, cut, steps), &prism());
            let fine = Cage::refined(4, cut, 4);
            let mut farthest = 0.0f64;
            for (weights, tangents) in fine.vertices.iter().zip(&fine.tangents) {
                let point = Cage::blend(weights, &prism());
                let is_level = slope(tangents, &prism()).is_some_and(|[x, y]| x * x + y * y < 2.25);
                if is_level && point.z > 60.0 {
                    let found = form.height(point.truncate().as_vec2()).unwrap();
                    farthest = farthest.max((f64::from(found) - point.z).abs());
                }
            }
            assert!(farthest < limit, "{cut:?}, {steps}: {farthest} mm off");
        }
    }
}
