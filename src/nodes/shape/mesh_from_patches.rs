//! `mesh_from_patches`: triangles on curved patches, with the patches' own places on the map.
//!
//! The mesh has the same map as `patch_cut`: one square for each patch, in rows from the lower left corner. Its points
//! and normals are those of the surface; between them triangles are flat.

use crate::geometry::mesh::{self, Corners, Finish, Soup};
use crate::geometry::nurbs;
use crate::geometry::patch_grid::PatchGrid;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Patch, Type, Value};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Triangles on curved patches.
pub static KIND: Kind = Kind {
    name: "mesh_from_patches",
    version: 1,
    about: "Triangles on curved patches, with the map that `patch_cut` makes.",
    source: "own construction: a grid of triangles on each patch",
    inputs: &[
        Input::new("patches", Type::Patches, "The patches."),
        Input::new(
            "divisions",
            Type::Whole,
            "Parts into which each side of a patch is divided.",
        )
        .default("16")
        .range(1.0, 1024.0),
    ],
    outputs: &[Output::new("mesh", Type::Mesh, "The triangles.")],
    example: r##"(nodes: {
        "teapot": patches_from_file(file: "teapot/teapot.txt", unit: inch),
        "example": mesh_from_patches(patches: "teapot", divisions: 12),
    })"##,
    build,
};

/// Most triangles of the mesh.
const MOST: usize = 20_000_000;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let patches = inputs.patches("patches");
    let divisions = usize::try_from(inputs.whole("divisions")).unwrap_or(1);
    let count = patches
        .patches
        .len()
        .saturating_mul(2 * divisions * divisions);
    if count > MOST {
        let message = format!("the mesh would have {count} triangles; the most is {MOST}");
        return Err(Failure::of_input("divisions", message).with_hint("divide into fewer parts"));
    }
    let grid = PatchGrid::new(patches);
    let squares = DVec2::new(grid.squares[0] as f64, grid.squares[1] as f64);
    let mut soup = Soup::default();
    for (index, patch) in patches.patches.iter().enumerate() {
        build.go_on()?;
        add_points(&mut soup, patch, divisions, |at| {
            grid.place(index, at) / squares
        });
        add_triangles(&mut soup, divisions);
    }
    let finish = Finish {
        keeps_normals: true,
        keeps_coordinates: true,
        crease: std::f64::consts::PI,
    };
    let (mesh, _) = mesh::assemble(soup, finish, &mut || build.go_on())?;
    match mesh.triangles.is_empty() {
        true => Err(Failure::of_input("patches", "the patches have no area")),
        false => Ok(vec![Value::Mesh(Arc::new(mesh))]),
    }
}

fn add_points(soup: &mut Soup, patch: &Patch, divisions: usize, place: impl Fn(DVec2) -> DVec2) {
    let part = |step: usize| step as f64 / divisions as f64;
    for (row, column) in (0..=divisions).flat_map(|row| (0..=divisions).map(move |it| (row, it))) {
        let at = [part(column), part(row)];
        soup.points.push(nurbs::evaluate(patch, at).place);
        soup.normals.push(normal(patch, at));
        soup.coordinates.push(place(at.into()));
    }
}

/// The normal of a patch; where all of a side is one point, that of a point close by.
fn normal(patch: &Patch, at: [f64; 2]) -> DVec3 {
    let inwards = at.map(|part| part + (0.5 - part) * 1e-4);
    let normal = |at: [f64; 2]| {
        let [u, v] = nurbs::evaluate(patch, at).along;
        let normal = u.cross(v);
        (normal.length() > 1e-9 * u.length().max(v.length()).powi(2)).then_some(normal)
    };
    normal(at)
        .or_else(|| normal(inwards))
        .unwrap_or(DVec3::ZERO)
}

/// Adds two triangles for each part of the last patch's points.
fn add_triangles(soup: &mut Soup, divisions: usize) {
    let (side, end) = (divisions + 1, soup.points.len());
    let first = end - side * side;
    for (row, column) in (0..divisions).flat_map(|row| (0..divisions).map(move |it| (row, it))) {
        let corner = |right: usize, up: usize| (first + (row + up) * side + column + right) as u32;
        for points in [
            [corner(0, 0), corner(1, 0), corner(1, 1)],
            [corner(0, 0), corner(1, 1), corner(0, 1)],
        ] {
            soup.triangles.push(Corners {
                points,
                normals: Some(points),
                coordinates: Some(points),
            });
        }
    }
}
