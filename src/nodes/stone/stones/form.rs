//! The upper side of one stone: triangles seen from above, found by a small grid.
//!
//! Over the triangles of a smooth stone the height is a cubic with the heights and the slopes of the limit surface at the
//! corners (Bazeley, Cheung, Irons & Zienkiewicz 1965); where the surface stands steep it is straight.

use super::cage::Cage;
use glam::{DVec3, Vec2};

/// Bins along each side of the grid.
const SIDE: usize = 16;

/// Edges are straight where the surface stands steeper than this, as the upward part of its normal.
const STEEP: f64 = 0.25;

/// The upper side of a stone, around its centre.
#[derive(Debug)]
pub(super) struct Form {
    low: Vec2,
    /// Bins per mm.
    scale: Vec2,
    /// The first of each bin's triangles in `list`, and behind them its length.
    starts: Vec<u32>,
    list: Vec<u16>,
    facets: Vec<Facet>,
}

/// A triangle seen from above.
#[derive(Clone, Copy, Debug)]
struct Facet {
    origin: Vec2,
    /// The changes of the second and third corner's share along x and y.
    shares: [Vec2; 2],
    heights: [f32; 3],
    /// How much higher the tangent at corner i is at corner j than the surface; the six pairs (i, j) in the order
    /// 01, 02, 10, 12, 20, 21.
    bends: [f32; 6],
}

/// How far outside a triangle a point may lie, so that there are no cracks.
const SLACK: f32 = -1e-5;

impl Facet {
    /// The height at a point, if the triangle is there.
    #[inline]
    fn height(&self, point: Vec2) -> Option<f32> {
        let at = point - self.origin;
        let [b, c] = self.shares.map(|share| share.dot(at));
        let a = 1.0 - b - c;
        if a < SLACK || b < SLACK || c < SLACK {
            return None;
        }
        let [ab, ac, ba, bc, ca, cb] = self.bends;
        let flat = a * self.heights[0] + b * self.heights[1] + c * self.heights[2];
        let sides =
            a * b * (a * ab + b * ba) + b * c * (b * bc + c * cb) + c * a * (c * ca + a * ac);
        Some(flat + sides + 0.5 * a * b * c * (ab + ac + ba + bc + ca + cb))
    }
}

impl Form {
    /// The upper side over the corners of a prism: n below, then n on top.
    pub(super) fn new(cage: &Cage, corners: &[DVec3]) -> Form {
        let points: Vec<DVec3> = cage
            .vertices
            .iter()
            .map(|it| Cage::blend(it, corners))
            .collect();
        let slopes: Vec<Option<[f64; 2]>> =
            cage.tangents.iter().map(|it| slope(it, corners)).collect();
        let slope_of = |index: u32| slopes.get(index as usize).copied().flatten();
        let triangles = cage.triangles.iter();
        let facets = triangles.filter_map(|it| {
            let corners = it.map(|index| points[index as usize]);
            facet(corners, it.map(slope_of))
        });
        let facets: Vec<(Facet, [Vec2; 2])> = facets.collect();
        Form::in_bins(&facets)
    }

    /// Triangles with the boxes around them.
    fn in_bins(facets: &[(Facet, [Vec2; 2])]) -> Form {
        let boxes = || facets.iter().map(|(_, bounds)| *bounds);
        let low = boxes().fold(Vec2::INFINITY, |low, [it, _]| low.min(it));
        let high = boxes().fold(Vec2::NEG_INFINITY, |high, [_, it]| high.max(it));
        let scale = SIDE as f32 / (high - low).max(Vec2::splat(1e-6));
        let mut bins: Vec<Vec<u16>> = vec![vec![]; SIDE * SIDE];
        for (index, [from, to]) in boxes().enumerate() {
            let [from, to] = [from, to].map(|corner| {
                let bin = ((corner - low) * scale).floor().max(Vec2::ZERO);
                bin.as_uvec2().min(glam::UVec2::splat(SIDE as u32 - 1))
            });
            for (y, x) in (from.y..=to.y).flat_map(|y| (from.x..=to.x).map(move |x| (y, x))) {
                bins[y as usize * SIDE + x as usize].push(index as u16);
            }
        }
        let mut starts = vec![0];
        for bin in &bins {
            starts.push(starts[starts.len() - 1] + bin.len() as u32);
        }
        Form {
            low,
            scale,
            starts,
            list: bins.concat(),
            facets: facets.iter().map(|(facet, _)| *facet).collect(),
        }
    }

    /// The height of the surface at a point, if it is there: the highest, where it overhangs.
    #[inline]
    pub(super) fn height(&self, point: Vec2) -> Option<f32> {
        let bin = (point - self.low) * self.scale;
        if !(bin.cmpge(Vec2::ZERO).all() && bin.cmple(Vec2::splat(SIDE as f32)).all()) {
            return None;
        }
        let bin = bin.as_uvec2().min(glam::UVec2::splat(SIDE as u32 - 1));
        let bin = bin.y as usize * SIDE + bin.x as usize;
        let range = self.starts[bin] as usize..self.starts[bin + 1] as usize;
        let heights = self.list[range]
            .iter()
            .filter_map(|facet| self.facets[usize::from(*facet)].height(point));
        heights.reduce(f32::max)
    }
}

/// The slopes along x and y of a surface with two tangents; `None` where it stands steep.
fn slope(tangents: &[Vec<f64>; 2], corners: &[DVec3]) -> Option<[f64; 2]> {
    let [along, across] = [0, 1].map(|which| Cage::blend(&tangents[which], corners));
    let normal = along.cross(across).try_normalize()?;
    (normal.z > STEEP).then(|| [-normal.x / normal.z, -normal.y / normal.z])
}

/// A triangle and the box around it, unless it is seen from below or from the side.
fn facet(corners: [DVec3; 3], slopes: [Option<[f64; 2]>; 3]) -> Option<(Facet, [Vec2; 2])> {
    let [a, b, c] = corners;
    let (ab, ac) = ((b - a).truncate(), (c - a).truncate());
    let area = ab.perp_dot(ac);
    if area <= 1e-9 * ab.length_squared().max(ac.length_squared()) {
        return None;
    }
    let bend = |from: usize, to: usize| {
        let way = corners[to] - corners[from];
        // Along an edge both its triangles are the same, so it takes both ends.
        match [slopes[from], slopes[to]] {
            [Some([x, y]), Some(_)] => (x * way.x + y * way.y - way.z) as f32,
            _ => 0.0,
        }
    };
    let pairs = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];
    let facet = Facet {
        origin: a.truncate().as_vec2(),
        shares: [-ac.perp() / area, ab.perp() / area].map(|share| share.as_vec2()),
        heights: corners.map(|corner| corner.z as f32),
        bends: pairs.map(|(from, to)| bend(from, to)),
    };
    let flat = corners.map(|corner| corner.truncate().as_vec2());
    let low = flat[0].min(flat[1]).min(flat[2]);
    let high = flat[0].max(flat[1]).max(flat[2]);
    Some((facet, [low, high]))
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
