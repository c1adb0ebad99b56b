//! Loop subdivision of triangle meshes, of anything that can be blended at their points.
//!
//! ```text
//! edge     3/8 of both ends + 1/8 of both opposite points
//! point    (1 - n b) of itself + b of each of its n neighbours,  b = (5/8 - (3/8 + 1/4 cos 2 pi/n)^2) / n
//! border   midpoints, and 3/4 of itself + 1/8 of both neighbours along the border
//! ```
//!
//! (Loop 1987; borders: Hoppe et al. 1994.) An edge that does not have two triangles is a border: one of a single triangle
//! ends the surface, at one of three or more the parts are creased. A point where other than two borders meet stays.

mod limit;
#[cfg(test)]
mod tests;

pub(crate) use limit::normals;

use std::ops::{Add, Mul};

/// What can be blended: numbers and vectors.
pub(crate) trait Blend:
    Copy + Default + Add<Output = Self> + Mul<f64, Output = Self>
{
}

impl<T: Copy + Default + Add<Output = T> + Mul<f64, Output = T>> Blend for T {}

/// Stands for no point.
const NONE: u32 = u32::MAX;

/// How the triangles of a mesh hang together.
#[derive(Debug)]
pub(crate) struct Topology {
    triangles: Vec<[u32; 3]>,
    edges: Vec<Edge>,
    /// For each triangle the edges from its first corner to the second, on to the third, and back.
    sides: Vec<[u32; 3]>,
    points: Vec<Point>,
}

/// Two points that triangles have in common.
#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [u32; 2],
    /// The third points of its two triangles; [`NONE`] at a border.
    opposite: [u32; 2],
}

impl Edge {
    fn is_border(&self) -> bool {
        self.opposite[0] == NONE
    }
}

/// What lies around a point.
#[derive(Clone, Copy, Debug, Default)]
struct Point {
    /// How many edges there are.
    edges: u32,
    /// How many of them are borders.
    borders: u32,
}

impl Topology {
    /// The edges of triangles over `points` points.
    pub(crate) fn new(points: usize, triangles: Vec<[u32; 3]>) -> Topology {
        // Both ends of every side in rising order, and its number.
        let mut all: Vec<([u32; 2], u32)> = vec![];
        for (triangle, corners) in (0u32..).zip(&triangles) {
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                all.push(([from.min(to), from.max(to)], 3 * triangle + side as u32));
            }
        }
        all.sort_unstable();
        let mut topology = Topology {
            sides: vec![[0; 3]; triangles.len()],
            triangles,
            edges: vec![],
            points: vec![Point::default(); points],
        };
        for sides in all.chunk_by(|one, other| one.0 == other.0) {
            topology.add_edge(sides);
        }
        topology
    }

    fn add_edge(&mut self, sides: &[([u32; 2], u32)]) {
        let third = |side: u32| self.triangles[(side / 3) as usize][((side % 3 + 2) % 3) as usize];
        let edge = Edge {
            ends: sides[0].0,
            opposite: match sides {
                [one, other] => [third(one.1), third(other.1)],
                _ => [NONE; 2],
            },
        };
        for end in edge.ends {
            let point = &mut self.points[end as usize];
            point.edges += 1;
            point.borders += u32::from(edge.is_border());
        }
        for (_, side) in sides {
            self.sides[(side / 3) as usize][(side % 3) as usize] = self.edges.len() as u32;
        }
        self.edges.push(edge);
    }

    /// The triangles.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// How many points the mesh has after a step: the old ones, and behind them one for each edge.
    pub(crate) fn refined_points(&self) -> usize {
        self.points.len() + self.edges.len()
    }

    /// The triangles after a step: four for each, its own middle last.
    pub(crate) fn refined_triangles(&self) -> Vec<[u32; 3]> {
        let first = self.points.len() as u32;
        let parts = |(corners, sides): (&[u32; 3], &[u32; 3])| {
            let [a, b, c] = *corners;
            let [ab, bc, ca] = sides.map(|edge| first + edge);
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        let pairs = self.triangles.iter().zip(&self.sides);
        pairs.flat_map(parts).collect()
    }

    /// The values at the points after a step.
    pub(crate) fn refined<T: Blend>(&self, values: &[T]) -> Vec<T> {
        let mut refined = self.moved(values, [0.75, 0.125], |edges| {
            let share = share(edges);
            [1.0 - f64::from(edges) * share, share]
        });
        refined.extend(self.edges.iter().map(|edge| self.on_edge(edge, values)));
        refined
    }

    /// The values after a step if nothing is smoothed: the old ones, and the means of the ends of each edge.
    pub(crate) fn halved<T: Blend>(&self, values: &[T]) -> Vec<T> {
        let mean = |edge: &Edge| {
            let [from, to] = edge.ends.map(|end| values[end as usize]);
            (from + to) * 0.5
        };
        let means = self.edges.iter().map(mean);
        values.iter().copied().chain(means).collect()
    }

    fn on_edge<T: Blend>(&self, edge: &Edge, values: &[T]) -> T {
        let [from, to] = edge.ends.map(|end| values[end as usize]);
        if edge.is_border() {
            return (from + to) * 0.5;
        }
        let [left, right] = edge.opposite.map(|point| values[point as usize]);
        (from + to) * 0.375 + (left + right) * 0.125
    }

    /// Each point's blend with its neighbours: by `weights` of the number of its edges, of itself and of each
    /// neighbour; at a border by `border` with the two neighbours along it.
    fn moved<T: Blend>(
        &self,
        values: &[T],
        border: [f64; 2],
        weights: impl Fn(u32) -> [f64; 2],
    ) -> Vec<T> {
        let mut sums = vec![T::default(); values.len()];
        for edge in &self.edges {
            for (end, other) in [(0, 1), (1, 0)] {
                let (end, other) = (edge.ends[end] as usize, edge.ends[other] as usize);
                // A border is smoothed as a curve, without regard to what lies beside it.
                if self.points[end].borders == 0 || edge.is_border() {
                    sums[end] = sums[end] + values[other];
                }
            }
        }
        let around = self.points.iter().zip(values).zip(sums);
        let blended = |((point, value), sum): ((&Point, &T), T)| {
            let [own, each] = match point {
                Point { edges: 0, .. } => return *value,
                Point { borders: 0, .. } => weights(point.edges),
                Point { borders: 2, .. } => border,
                _ => return *value,
            };
            *value * own + sum * each
        };
        around.map(blended).collect()
    }
}

/// The share of each of `edges` neighbours in a point: Loop 1987, the b above.
fn share(edges: u32) -> f64 {
    let count = f64::from(edges);
    let inner = 0.375 + 0.25 * libm::cos(std::f64::consts::TAU / count);
    (0.625 - inner * inner) / count
}
