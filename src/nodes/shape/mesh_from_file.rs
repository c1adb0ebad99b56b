//! `mesh_from_file`: triangles in space from an STL or an OBJ file.
//!
//! STL is read in both forms, told apart by the length of the file, since binary files may begin with `solid` too. Of
//! OBJ are read points, places, normals, faces with any number of corners, which may be counted from the end, groups,
//! objects and materials by name; lines, curves and free-form surfaces are not.
//!
//! Equal points are one point. Triangles without an area are left out, with a warning. Without normals in the file, or
//! with `normals: smooth`, faces that meet at less than `crease` are smoothed. Without places in the file, or with
//! `places: box`, every triangle is projected along the axis that it faces most, and the charts are packed into the
//! square at one scale.

mod obj;
mod stl;

use super::scan::{self, UNIT, UP};
use crate::geometry::mesh::{self, Finish, Soup};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, counted};
use crate::value::{Type, Unit, Value};
use std::sync::Arc;

/// Triangles in space from a file.
pub static KIND: Kind = Kind {
    name: "mesh_from_file",
    version: 2,
    about: "Triangles in space from an STL or OBJ file; a mesh without places on the square gets a box unwrap.",
    source: "formats of 3D Systems 1989 (STL) and Wavefront (OBJ, appendix B1); smoothing after Thürmer & Wüthrich 1998",
    inputs: &[
        Input::new(
            "file",
            Type::File,
            "An STL file, text or binary, or an OBJ file.",
        ),
        UNIT,
        UP,
        Input::new(
            "parts",
            Type::List(&Type::Text),
            "Names of groups, objects or materials of an OBJ file to take; none takes all.",
        )
        .default("[]"),
        Input::new(
            "normals",
            Type::Choice(&["file", "smooth"]),
            "Normals of the file where it has them, or smoothed ones.",
        )
        .default("file"),
        Input::number(
            "crease",
            Unit::Degree,
            "Faces that meet at a larger angle than this meet at a sharp edge.",
        )
        .default("40")
        .range(0.0, 180.0),
        Input::new(
            "places",
            Type::Choice(&["file", "box"]),
            "Places on the square of the file if it has them, or a box unwrap.",
        )
        .default("file"),
    ],
    outputs: &[Output::new("mesh", Type::Mesh, "The triangles.")],
    example: r##"(nodes: {
        "example": mesh_from_file(file: "spot/spot.obj", unit: cm, up: y),
    })"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let bytes = &inputs.file("file").bytes;
    let mut soup = match is_obj(inputs) {
        true => obj::read(bytes, &parts(inputs), inputs, build)?,
        false if !inputs.list("parts").is_empty() => {
            let message = "`parts` is set, but an STL file has no parts with names";
            return Err(Failure::of_input("parts", message).with_hint("remove `parts`"));
        }
        false => stl::read(bytes, inputs, build)?,
    };
    scan::place(inputs, &mut soup.points)?;
    scan::turn_upright(inputs, &mut soup.normals);
    warn_of_places(&soup, inputs);
    let finish = Finish {
        keeps_normals: inputs.choice("normals") == "file",
        keeps_coordinates: inputs.choice("places") == "file",
        crease: inputs.number("crease").to_radians(),
    };
    let (mesh, left_out) = mesh::assemble(soup, finish, &mut || build.go_on())?;
    if mesh.triangles.is_empty() {
        let message = "the file has no triangle with an area";
        let hint =
            "it is read as STL or OBJ; patches of curved surfaces are for `patches_from_file`";
        return Err(Failure::of_input("file", message).with_hint(hint));
    }
    if left_out > 0 {
        let triangles = counted(
            left_out,
            "triangle without an area is",
            "triangles without an area are",
        );
        inputs.warn(format!("{triangles} left out"));
    }
    Ok(vec![Value::Mesh(Arc::new(mesh))])
}

/// Whether the file is an OBJ: by its name, else by its first words.
fn is_obj(inputs: &Inputs<'_>) -> bool {
    let file = inputs.file("file");
    let ending = file.path.extension().unwrap_or_default();
    match ending.to_string_lossy().to_lowercase().as_str() {
        "obj" => true,
        "stl" => false,
        _ => !stl::looks_like_one(&file.bytes),
    }
}

fn parts(inputs: &Inputs<'_>) -> Vec<String> {
    let items = inputs.list("parts").iter();
    let text = |item: &Value| match item {
        Value::Text(text) => Some(text.clone()),
        _ => None,
    };
    items.filter_map(text).collect()
}

/// Warns of places that are not used.
fn warn_of_places(soup: &Soup, inputs: &Inputs<'_>) {
    if inputs.choice("places") == "box" || soup.coordinates.is_empty() {
        return;
    }
    let without = soup.triangles.iter().filter(|it| it.coordinates.is_none());
    let count = without.count();
    if count > 0 {
        inputs.warn(format!(
            "{count} of {} triangles have no places in the file, so all get those of a box unwrap",
            soup.triangles.len()
        ));
    }
}
