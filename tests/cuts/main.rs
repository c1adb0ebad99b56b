//! Meshes, patches and cuts: files, known values, laws of what lies where.

#![allow(clippy::unwrap_used)] // helpers of tests

mod meshes;
mod odd_files;

use std::sync::Arc;
use yosegi::node::{Build, Failure, Inputs};
use yosegi::nodes::shape::mesh_from_file;
use yosegi::value::{FileContents, Mesh, Value};

/// What a kind gives for some inputs; the others are left out.
fn built(
    kind: &'static yosegi::node::Kind,
    given: &[(&str, Value)],
) -> Result<Vec<Value>, Failure> {
    let mut values = vec![None; kind.inputs.len()];
    for (name, value) in given {
        values[kind.input(name).unwrap().0] = Some(value.clone());
    }
    let build = Build {
        node: &Arc::from("test"),
        seed: 0,
        cancel: None,
    };
    (kind.build)(&Inputs::new(kind, &values), &build)
}

fn file(path: &str, bytes: impl Into<Vec<u8>>) -> Value {
    Value::File(FileContents {
        path: path.into(),
        bytes: bytes.into().into(),
    })
}

/// How a mesh file is read, as the inputs' defaults say unless a test changes them.
struct Reading {
    unit: &'static str,
    up: &'static str,
    parts: Vec<Value>,
    normals: &'static str,
    crease: f64,
    places: &'static str,
}

const PLAIN: Reading = Reading {
    unit: "mm",
    up: "z",
    parts: vec![],
    normals: "file",
    crease: 40.0,
    places: "file",
};

fn read(path: &str, bytes: impl Into<Vec<u8>>, how: &Reading) -> Result<Arc<Mesh>, Failure> {
    let given = [
        ("file", file(path, bytes)),
        ("unit", Value::Choice(how.unit)),
        ("up", Value::Choice(how.up)),
        ("parts", Value::List(how.parts.clone())),
        ("normals", Value::Choice(how.normals)),
        ("crease", Value::Number(how.crease)),
        ("places", Value::Choice(how.places)),
    ];
    match built(&mesh_from_file::KIND, &given)?.remove(0) {
        Value::Mesh(mesh) => {
            assert!(mesh.is_sound());
            Ok(mesh)
        }
        other => panic!("found a {}", other.type_name()),
    }
}

/// Six times the volume that a mesh encloses; positive if its triangles run counterclockwise seen from outside.
fn six_volumes(mesh: &Mesh) -> f64 {
    let of = |triangle: &yosegi::value::Triangle| {
        let [a, b, c] = triangle.points.map(|index| mesh.points[index as usize]);
        a.dot(b.cross(c))
    };
    mesh.triangles.iter().map(of).sum()
}
