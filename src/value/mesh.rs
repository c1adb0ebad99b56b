//! Meshes: triangles in space, with normals and with places on a flat square.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Triangles in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Points in mm.
    pub points: Vec<DVec3>,
    /// Unit normals, outwards.
    pub normals: Vec<DVec3>,
    /// Places on the square from (0, 0), the lower left corner of a map, to (1, 1). Empty if the mesh has none.
    pub coordinates: Vec<DVec2>,
    /// The triangles; seen from outside their corners run counterclockwise.
    pub triangles: Vec<Triangle>,
}

/// Three corners, each an index into the lists of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Triangle {
    /// Points.
    pub points: [u32; 3],
    /// Normals.
    pub normals: [u32; 3],
    /// Places on the square; not used if the mesh has none.
    pub coordinates: [u32; 3],
    /// The chart it belongs to: triangles of one chart lie side by side on the square as they do in space.
    pub chart: u32,
}

impl Triangle {
    /// Charts from this number on are faces at which the thing was sawn off: no bark lies on them.
    pub const SAWN: u32 = 1 << 31;
}

/// Most triangles or points of a mesh, and the largest coordinate in mm.
const MOST: usize = 50_000_000;
const LARGEST: f64 = 1e9;

impl Mesh {
    /// Whether it is what nodes make: finite, with indices that exist.
    pub fn is_sound(&self) -> bool {
        let within = |indices: [u32; 3], count: usize| {
            indices.into_iter().all(|index| (index as usize) < count)
        };
        let triangle_is_sound = |triangle: &Triangle| {
            within(triangle.points, self.points.len())
                && within(triangle.normals, self.normals.len())
                && (self.coordinates.is_empty()
                    || within(triangle.coordinates, self.coordinates.len()))
        };
        (1..=MOST).contains(&self.triangles.len())
            && self.points.len() <= MOST
            && self
                .points
                .iter()
                .all(|point| point.is_finite() && point.abs().max_element() <= LARGEST)
            && self
                .normals
                .iter()
                .all(|normal| (normal.length() - 1.0).abs() < 1e-6)
            && self.coordinates.iter().all(|place| place.is_finite())
            && self.triangles.iter().all(triangle_is_sound)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nodes_make_is_sound() {
        let mesh = |change: fn(&mut Mesh)| {
            let mut mesh = Mesh {
                points: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
                normals: vec![DVec3::Z],
                coordinates: vec![DVec2::ZERO, DVec2::X, DVec2::Y],
                triangles: vec![Triangle {
                    points: [0, 1, 2],
                    normals: [0, 0, 0],
                    coordinates: [0, 1, 2],
                    chart: 0,
                }],
            };
            change(&mut mesh);
            mesh.is_sound()
        };
        assert!(mesh(|_| {}));
        assert!(mesh(|it| it.coordinates.clear()));
        let unsound: [fn(&mut Mesh); 7] = [
            |it| it.triangles.clear(),
            |it| it.points.truncate(2),
            |it| it.points[1].x = f64::NAN,
            |it| it.points[1].x = 1e300,
            |it| it.normals[0] = DVec3::ZERO,
            |it| it.triangles[0].normals[2] = 1,
            |it| it.coordinates.truncate(1),
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            assert!(!mesh(change), "{number}");
        }
    }
}
