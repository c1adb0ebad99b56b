//! `mesh_cut`: cuts a solid material in the shape of a mesh, as maps in the mesh's places.
//!
//! A point (u, v) of the piece, in mm, is the place (u, v) / size on the mesh's square; it shows the solid where the
//! triangle there is in space. Beside all triangles it shows the nearest point of the nearest one, out to the corners of
//! the map, so that smaller pictures of the map hold no colour that is not the mesh's. `coverage` is 1 where a triangle
//! is, else 0. Differences do not cross from one chart of the mesh to another.
//!
//! The piece is a square with as much area for each area of the mesh as there is in space, on the whole, so pixels per mm
//! are about those on the mesh.

use super::placed::{PLACED, placed};
use super::surface::{self, CutSurface, Spot};
use crate::geometry::mesh::Atlas;
use crate::key::{Key, KeyHasher};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Type, Value};
use glam::{DAffine3, DVec2, DVec3};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Cuts a solid in the shape of a mesh.
pub static KIND: Kind = Kind {
    name: "mesh_cut",
    version: 1,
    about: "Cuts a solid material in the shape of a mesh: the maps that it wears. Beside the mesh's triangles its border goes \
            on; `coverage` tells where it is.",
    source: "Shibasaki & Aoyama, cut by an STL shape (figure 6); solid texture on a surface after Peachey 1985",
    inputs: &[
        Input::new("of", Type::Material, "The material to cut.").of(Domain::Solid),
        Input::new("mesh", Type::Mesh, "The shape."),
        PLACED,
    ],
    outputs: &[Output::field(
        "piece",
        Type::Material,
        "The piece, with the channel `coverage`.",
    )
    .on(Domain::Plane)],
    example: r##"(nodes: {
        "rings": solid_noise(size: (25, 25, 200)),
        "wood": material(base_color: "#c8a06e", height: "= 0.1 * rings"),
        "cow": mesh_from_file(file: "spot/spot.obj", unit: cm, up: y),
        "example": mesh_cut(of: "wood", mesh: "cow", placed: (scale: (10, 10, 10), move: (0, 0, 300))),
    })"##,
    build,
};

/// Sides in mm that a piece may have.
const SIDES: RangeInclusive<f64> = 1e-6..=1e9;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let mesh = inputs.mesh("mesh");
    let place = placed(inputs)?;
    let no_map = || {
        let message = "the triangles of the mesh have no area on its square";
        Failure::of_input("mesh", message).with_hint("read it with `places: box`")
    };
    if mesh.coordinates.is_empty() {
        let message = "the mesh has no places on a square, so nothing says how a map lies on it";
        return Err(Failure::of_input("mesh", message)
            .with_hint("link to a mesh of `mesh_from_file`, `mesh_from_patches` or `block`"));
    }
    let atlas = Atlas::new(mesh, &mut || build.go_on())?;
    let side = atlas.side(&place.matrix3).ok_or_else(no_map)?;
    if side <= 0.0 {
        return Err(Failure::of_input(
            "mesh",
            "the triangles of the mesh have no area",
        ));
    }
    if !SIDES.contains(&side) {
        let message = "the places of the mesh are of another size than the square: its map would have no usable scale";
        return Err(Failure::of_input("mesh", message).with_hint("read it with `places: box`"));
    }
    let bytes = postcard::to_stdvec(&**mesh).expect("a mesh is plain data");
    let surface = OnMesh {
        atlas,
        key: Key::of_bytes(&bytes),
        side,
        place,
    };
    surface::piece(inputs, build, Arc::new(surface), [side; 2])
}

/// The surface of a mesh.
#[derive(Debug)]
struct OnMesh {
    atlas: Atlas,
    /// Identifies the mesh.
    key: Key,
    /// The side of the piece in mm.
    side: f64,
    place: DAffine3,
}

impl CutSurface for OnMesh {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("mesh_cut").whole(i64::from(KIND.version));
        key.key(self.key).number(self.side);
        self.place.to_cols_array().iter().for_each(|part| {
            key.number(*part);
        });
    }

    fn spot(&self, at: DVec2) -> Spot {
        let Some(spot) = self.atlas.find(at / self.side) else {
            return Spot::default();
        };
        Spot {
            place: self.place.transform_point3(self.atlas.place(&spot)),
            chart: self.atlas.chart(&spot),
            is_covered: spot.is_covered,
        }
    }

    fn tangents(&self, at: DVec2) -> [DVec3; 2] {
        let Some(spot) = self.atlas.find(at / self.side) else {
            return [DVec3::ZERO; 2];
        };
        let tangents = self.atlas.tangents(&spot);
        tangents.map(|it| self.place.transform_vector3(it) / self.side)
    }
}
