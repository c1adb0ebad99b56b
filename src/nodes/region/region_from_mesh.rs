//! `region_from_mesh`: the sides of a mesh as a part of the plane.
//!
//! A side is a chart: triangles that lie side by side on the square of the mesh's map as they do in space. Laid out, sides are where
//! `mesh_cut` puts them on a map of the same size. Seen from a direction, the mesh is the shadow that it throws along it.

use super::mended::{LARGEST, shown};
use crate::geometry::polygon::{Lattice, Operation, area};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Mesh, Region, Triangle, Type, Unit, Value};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// The sides of a mesh as a part of the plane.
pub static KIND: Kind = Kind {
    name: "region_from_mesh",
    version: 1,
    about: "The sides of a mesh, laid out as on its map or as seen from a direction, as a part of the plane.",
    source: "own construction: the union of the triangles on the integer grid of i_overlay",
    inputs: &[
        Input::new("of", Type::Mesh, "The triangles."),
        Input::new(
            "as",
            Type::Choice(&["map", "shadow"]),
            "Where the sides lie on the map, or what is seen along `towards`.",
        )
        .default("map"),
        Input::new("size", Type::Pair(Unit::Millimetre), "Width and height of the map.")
            .default("(1000, 1000)")
            .range(1e-3, 1e8),
        Input::new("sides", Type::List(&Type::Whole), "Which sides, counted from 0; none takes all.")
            .default("[]")
            .range(0.0, 4294967295.0),
        Input::new(
            "towards",
            Type::Vector(Unit::One),
            "Where one looks, for a `shadow`; (0, 0, -1) is from above. What is higher stays so; from above, y points up.",
        )
        .default("(0, 0, -1)")
        .range(-1e6, 1e6),
    ],
    outputs: &[Output::new("region", Type::Region, "The part of the plane.")],
    example: "(nodes: {
        \"cow\": mesh_from_file(file: \"spot/spot.obj\", unit: cm, up: y),
        \"example\": region_from_mesh(of: \"cow\", as: shadow, towards: (0, -1, 0)),
    })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let mesh = inputs.mesh("of");
    let wanted = wanted(inputs, mesh)?;
    let place = places(inputs, mesh)?;
    let mut rings: Vec<[DVec2; 3]> = vec![];
    let [mut low, mut high] = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    for triangle in mesh
        .triangles
        .iter()
        .filter(|it| wanted.is_empty() || wanted.contains(&it.chart))
    {
        let mut ring = place(triangle);
        if let Some(corner) = ring
            .iter()
            .find(|corner| corner.abs().max_element() > LARGEST)
        {
            let message = format!(
                "a corner is at {}; the farthest is {LARGEST} mm off",
                shown(*corner)
            );
            return Err(Failure::of_input("of", message));
        }
        // Triangles may be laid out mirrored.
        if (ring[1] - ring[0]).perp_dot(ring[2] - ring[0]) < 0.0 {
            ring.swap(1, 2);
        }
        ring.iter()
            .for_each(|corner| (low, high) = (low.min(*corner), high.max(*corner)));
        rings.push(ring);
    }
    build.go_on()?;
    let rings: Vec<&[DVec2]> = rings.iter().map(|ring| &ring[..]).collect();
    let mut polygons = Lattice::around([low, high]).overlay(Operation::Union, &rings, &[]);
    // What is left between triangles that should meet has no area to speak of.
    let least = 1e-12 * (high - low).element_product();
    polygons.retain(|polygon| area(std::slice::from_ref(polygon)) > least);
    if polygons.is_empty() {
        return Err(Failure::of_input(
            "of",
            "the triangles cover no area of the plane",
        ));
    }
    Ok(vec![Value::Region(Arc::new(Region { polygons }))])
}

/// The charts that are asked for.
fn wanted(inputs: &Inputs<'_>, mesh: &Mesh) -> Result<Vec<u32>, Failure> {
    let mut wanted = vec![];
    for (index, item) in inputs.list("sides").iter().enumerate() {
        let Value::Whole(side) = item else { continue };
        let side = *side as u32;
        if !mesh.triangles.iter().any(|triangle| triangle.chart == side) {
            let highest = mesh
                .triangles
                .iter()
                .map(|it| it.chart)
                .max()
                .unwrap_or_default();
            let message = format!("the mesh has no side {side}; the highest is {highest}");
            return Err(Failure::of_input("sides", message).at_item(index));
        }
        wanted.push(side);
    }
    Ok(wanted)
}

type Places<'m> = Box<dyn Fn(&Triangle) -> [DVec2; 3] + 'm>;

/// Where the corners of triangles lie on the plane.
fn places<'m>(inputs: &Inputs<'_>, mesh: &'m Mesh) -> Result<Places<'m>, Failure> {
    if inputs.choice("as") == "shadow" {
        let towards = inputs.vector("towards").try_normalize();
        let Some(towards) = towards else {
            return Err(Failure::of_input("towards", "the direction has no length"));
        };
        let up = if towards.z.abs() > 0.999_999 {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let right = towards.cross(up).normalize();
        let above = right.cross(towards);
        return Ok(Box::new(move |triangle: &Triangle| {
            let points = triangle.points.map(|index| mesh.points[index as usize]);
            points.map(|point| DVec2::new(point.dot(right), point.dot(above)))
        }));
    }
    if mesh.coordinates.is_empty() {
        let failure = Failure::of_input("of", "the mesh has no places on a map");
        return Err(
            failure.with_hint("`mesh_from_file` unwraps with `places: box`; or take a `shadow`")
        );
    }
    let size = DVec2::from_array(inputs.pair("size"));
    Ok(Box::new(move |triangle: &Triangle| {
        triangle
            .coordinates
            .map(|index| mesh.coordinates[index as usize] * size)
    }))
}
