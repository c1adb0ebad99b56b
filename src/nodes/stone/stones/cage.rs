//! Control lattices of stones: prisms over cells, cut into triangles, and what subdivision makes of them.
//!
//! A prism over n corners has 4 n - 2 triangles: 2 for each side, n around a vertex in the middle of the top, and n - 2
//! below; that are 14 for a quad (Miyata, Itoh & Shimada 2000, fig. 7). A stone with corners has vertices more, on the
//! edges that meet at each corner of the top, at a share of their lengths (fig. 8).
//!
//! Every vertex is a blend of the 2 n corners of the prism, and so is what subdivision makes of them; so the blends are
//! worked out once for each number of corners.

use crate::geometry::subdivision::{Blend, Topology};

/// What a stone is made like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cut {
    /// The prism itself.
    Prism,
    /// Rounded by subdivision.
    Round,
    /// Rounded by subdivision, with corners held by vertices at this share of the edges.
    Corner(f64),
}

/// The surface over a prism, in terms of its corners.
#[derive(Debug)]
pub(super) struct Cage {
    /// The triangles that may be seen from above.
    pub(super) triangles: Vec<[u32; 3]>,
    /// For each vertex its blend of the prism's corners: n below, then n on top.
    pub(super) vertices: Vec<Vec<f64>>,
    /// For each vertex the blends that are its two tangents; empty for prisms, which are flat.
    pub(super) tangents: Vec<[Vec<f64>; 2]>,
}

/// Steps of subdivision: of prisms with many corners fewer, since their triangles are small.
fn levels(corners: usize) -> usize {
    if corners <= 10 { 2 } else { 1 }
}

impl Cage {
    /// The surface over prisms of `corners` corners.
    pub(super) fn new(corners: usize, cut: Cut) -> Cage {
        Cage::refined(corners, cut, levels(corners))
    }

    /// The same after some steps of subdivision.
    pub(super) fn refined(corners: usize, cut: Cut, levels: usize) -> Cage {
        let mut lattice = Lattice::new(corners);
        match cut {
            Cut::Corner(share) => lattice.add_cornered(share),
            _ => lattice.add_plain(),
        }
        if cut == Cut::Prism {
            return Cage {
                triangles: lattice.seen,
                vertices: lattice.vertices,
                tangents: vec![],
            };
        }
        // The bottom is part of the surface, but is never seen.
        let mut seen = lattice.seen.len();
        let triangles = [lattice.seen, bottom(corners)].concat();
        let mut topology = Topology::new(lattice.vertices.len(), triangles);
        let mut columns = columns(&lattice.vertices);
        for _ in 0..levels {
            columns = columns.iter().map(|it| topology.refined(it)).collect();
            topology = Topology::new(topology.refined_points(), topology.refined_triangles());
            seen *= 4;
        }
        let limits: Vec<Vec<f64>> = columns.iter().map(|it| topology.limit(it)).collect();
        let tangents: Vec<_> = columns.iter().map(|it| topology.tangents(it)).collect();
        let tangent = |vertex: usize| {
            [0, 1].map(|which| {
                tangents
                    .iter()
                    .map(|column| column[vertex][which])
                    .collect()
            })
        };
        Cage {
            triangles: topology.triangles()[..seen].to_vec(),
            tangents: (0..limits[0].len()).map(tangent).collect(),
            vertices: rows(&limits),
        }
    }

    /// About the highest point over the corners of a prism: the middle of the top, which is the vertex behind the corners.
    pub(super) fn highest(&self, corners: &[glam::DVec3]) -> f64 {
        Cage::blend(&self.vertices[corners.len()], corners).z
    }

    /// The blend of the corners' values.
    pub(super) fn blend<T: Blend>(weights: &[f64], corners: &[T]) -> T {
        weights
            .iter()
            .zip(corners)
            .fold(T::default(), |sum, (weight, corner)| {
                sum + *corner * *weight
            })
    }
}

/// Vertices as blends, and triangles over them, while they are put together.
struct Lattice {
    corners: usize,
    vertices: Vec<Vec<f64>>,
    seen: Vec<[u32; 3]>,
}

impl Lattice {
    /// The corners of the prism: below 0 to n - 1, on top n to 2 n - 1; behind them the middle of the top.
    fn new(corners: usize) -> Lattice {
        let unit = |index: usize| {
            let weights = (0..2 * corners).map(|other| f64::from(u8::from(other == index)));
            weights.collect()
        };
        let mut vertices: Vec<Vec<f64>> = (0..2 * corners).map(unit).collect();
        let share = 1.0 / corners as f64;
        vertices.push([vec![0.0; corners], vec![share; corners]].concat());
        Lattice {
            corners,
            vertices,
            seen: vec![],
        }
    }

    /// For every side its corners: below, on top, and the same of the next.
    fn sides(&self) -> impl Iterator<Item = [u32; 4]> + use<> {
        let count = self.corners as u32;
        (0..count).map(move |at| {
            let next = (at + 1) % count;
            [at, count + at, next, count + next]
        })
    }

    fn add_plain(&mut self) {
        let middle = 2 * self.corners as u32;
        for [below, top, next_below, next_top] in self.sides() {
            self.seen.extend([
                [middle, top, next_top],
                [below, next_below, next_top],
                [below, next_top, top],
            ]);
        }
    }

    fn add_cornered(&mut self, share: f64) {
        let middle = 2 * self.corners as u32;
        let on_way = |lattice: &mut Lattice, from: u32, to: u32| {
            let [from, to] = [from, to].map(|index| lattice.vertices[index as usize].clone());
            let pairs = from.iter().zip(&to);
            let blend = pairs.map(|(from, to)| from + share * (to - from)).collect();
            lattice.vertices.push(blend);
            lattice.vertices.len() as u32 - 1
        };
        let sides: Vec<[u32; 4]> = self.sides().collect();
        let lower: Vec<u32> = sides
            .iter()
            .map(|side| on_way(self, side[1], side[0]))
            .collect();
        for (index, [below, top, next_below, next_top]) in sides.into_iter().enumerate() {
            let ahead = on_way(self, top, next_top);
            let back = on_way(self, next_top, top);
            let [down, next_down] = [lower[index], lower[(index + 1) % lower.len()]];
            self.seen.extend([
                [middle, top, ahead],
                [middle, ahead, back],
                [middle, back, next_top],
                [top, down, ahead],
                [next_top, back, next_down],
                [ahead, down, next_down],
                [ahead, next_down, back],
                [down, below, next_below],
                [down, next_below, next_down],
            ]);
        }
    }
}

/// The triangles below, seen from there counterclockwise.
fn bottom(corners: usize) -> Vec<[u32; 3]> {
    (1..corners as u32 - 1).map(|at| [0, at + 1, at]).collect()
}

/// For each corner of the prism its weights in all vertices.
fn columns(vertices: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let column = |corner: usize| vertices.iter().map(|weights| weights[corner]).collect();
    (0..vertices[0].len()).map(column).collect()
}

/// The inverse of [`columns`].
fn rows(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let row = |vertex: usize| columns.iter().map(|column| column[vertex]).collect();
    (0..columns[0].len()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn prism() -> [DVec3; 8] {
        let corner = |index: usize| {
            let (x, y) = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)][index % 4];
            DVec3::new(x, y, if index < 4 { 0.0 } else { 2.0 })
        };
        [0, 1, 2, 3, 4, 5, 6, 7].map(corner)
    }

    #[test]
    fn quads_have_fourteen_triangles_that_face_outwards() {
        for (cut, count) in [
            (Cut::Prism, 12),
            (Cut::Round, 12 * 16),
            (Cut::Corner(0.2), 36 * 16),
        ] {
            let cage = Cage::new(4, cut);
            assert_eq!(cage.triangles.len(), count, "{cut:?}");
            let points: Vec<DVec3> = cage
                .vertices
                .iter()
                .map(|it| Cage::blend(it, &prism()))
                .collect();
            for corners in &cage.triangles {
                let [a, b, c] = corners.map(|index| points[index as usize]);
                let outwards = (a + b + c) / 3.0 - DVec3::Z;
                assert!(
                    (b - a).cross(c - a).dot(outwards) > 0.0,
                    "{cut:?}: {corners:?}"
                );
            }
        }
        assert_eq!(bottom(4).len() + 12, 14);
    }

    #[test]
    fn vertices_are_blends_whose_weights_add_up() {
        for cut in [Cut::Prism, Cut::Round, Cut::Corner(0.3)] {
            let cage = Cage::new(5, cut);
            for weights in &cage.vertices {
                assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            }
        }
    }
}
