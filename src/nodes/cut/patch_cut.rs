//! `patch_cut`: cuts a solid material along curved patches, as maps with one square for each patch.
//!
//! The squares stand in rows from the lower left corner of the piece, as near to a square as they fit, each with the free
//! border that the patches have. A point of a square shows the solid at the point of the surface itself, which no
//! triangles approximate. Beside the patches, the nearest border goes on; `coverage` is 1 on a patch, else 0. Differences
//! do not cross from one patch to another.
//!
//! Squares are as large as the patches are on the whole, so pixels per mm are about those on the surface.

use super::placed::{PLACED, placed};
use super::surface::{self, CutSurface, Spot};
use crate::geometry::patch_grid::{self, PatchGrid};
use crate::key::{Key, KeyHasher};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Patches, Type, Value};
use glam::{DAffine3, DVec2, DVec3};
use std::sync::Arc;

/// Cuts a solid along curved patches.
pub static KIND: Kind = Kind {
    name: "patch_cut",
    version: 1,
    about: "Cuts a solid material along curved patches, each a square of the map. Beside them their borders go on; `coverage` \
            tells where they are.",
    source: "Momoi & Takatera 2014, section 1 (solid texture on a parametric surface); own layout in squares",
    inputs: &[
        Input::new("of", Type::Material, "The material to cut.").of(Domain::Solid),
        Input::new("patches", Type::Patches, "The surface."),
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
        "shell": nurbs_surface(degrees: (2, 1), gutter: 0, points: [
            [(200, 0, 0), (200, 200, 0), (0, 200, 0)],
            [(200, 0, 300), (200, 200, 300), (0, 200, 300)],
        ], weights: [[1, 1, 2], [1, 1, 2]]),
        "example": patch_cut(of: "wood", patches: "shell", placed: (move: (0, 0, 300))),
    })"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let patches = inputs.patches("patches");
    let place = placed(inputs)?;
    let grid = PatchGrid::new(patches);
    let mut area = 0.0;
    for patch in 0..patches.patches.len() {
        build.go_on()?;
        area += patch_grid::area(patches, patch, &place.matrix3);
    }
    if area <= 0.0 {
        return Err(Failure::of_input("patches", "the patches have no area"));
    }
    let side = (area / patches.patches.len() as f64).sqrt() / grid.share();
    let bytes = postcard::to_stdvec(&**patches).expect("patches are plain data");
    let surface = OnPatches {
        patches: Arc::clone(patches),
        key: Key::of_bytes(&bytes),
        grid,
        side,
        place,
    };
    let size = grid.squares.map(|count| count as f64 * side);
    surface::piece(inputs, build, Arc::new(surface), size)
}

/// The surface of patches.
#[derive(Debug)]
struct OnPatches {
    patches: Arc<Patches>,
    /// Identifies the patches.
    key: Key,
    grid: PatchGrid,
    /// The side of a square in mm.
    side: f64,
    place: DAffine3,
}

impl CutSurface for OnPatches {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("patch_cut").whole(i64::from(KIND.version));
        key.key(self.key).number(self.side);
        self.place.to_cols_array().iter().for_each(|part| {
            key.number(*part);
        });
    }

    fn spot(&self, at: DVec2) -> Spot {
        let spot = self.grid.find(at / self.side);
        let point = patch_grid::evaluate(&self.patches, &spot);
        Spot {
            place: self.place.transform_point3(point.place),
            chart: spot.patch as u32,
            is_covered: spot.is_covered,
        }
    }

    fn tangents(&self, at: DVec2) -> [DVec3; 2] {
        let spot = self.grid.find(at / self.side);
        let along = patch_grid::evaluate(&self.patches, &spot).along;
        let length = self.side * self.grid.share();
        along.map(|it| self.place.transform_vector3(it) / length)
    }
}
