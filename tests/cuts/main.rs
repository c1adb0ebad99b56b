//! Meshes, patches and cuts: files, known values, laws of what lies where.

#![allow(clippy::unwrap_used)] // helpers of tests

mod bytes;
mod charts;
mod idle;
mod meshes;
mod odd_files;
mod placed;
mod rotary;
mod surfaces;

#[path = "../support/levels.rs"]
mod levels;
#[path = "../support/workshop.rs"]
#[allow(dead_code, reason = "cuts need no log of events")]
mod workshop;

use fearless_simd::Level;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;
use yosegi::field::{Field, Program, RunContext, Samples, Scratch};
use yosegi::node::{Build, Failure, Inputs};
use yosegi::nodes::shape::mesh_from_file;
use yosegi::value::{Domain, FileContents, Material, Mesh, Value};

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

/// A solid whose channel `place` is where one is in it.
fn where_one_is() -> Value {
    let place = ("place".to_owned(), Field::position(Domain::Solid));
    Value::Material(Arc::new(Material {
        domain: Domain::Solid,
        channels: BTreeMap::from([place]),
        size: None,
        surface: None,
    }))
}

/// A piece of a solid, which a kind cuts.
fn cut(
    kind: &'static yosegi::node::Kind,
    given: &[(&str, Value)],
) -> Result<Arc<Material>, Failure> {
    let given = [given, &[("of", where_one_is())]].concat();
    match built(kind, &given)?.remove(0) {
        Value::Material(material) => Ok(material),
        other => panic!("found a {}", other.type_name()),
    }
}

fn context() -> RunContext<'static> {
    RunContext {
        level: Level::new(),
        cache: None,
        filtering: true,
        cancel: None,
    }
}

/// Where points of a piece are in the solid.
fn places(piece: &Material, points: &[[f64; 3]]) -> Vec<DVec3> {
    let program = Program::compile(&[piece.channels["place"].clone()]);
    let mut scratch = Scratch::default();
    program.run(&Samples::Points(points), &mut scratch, &context());
    let columns = program.columns(&scratch, 0);
    let place = |index: usize| [0, 1, 2].map(|axis: usize| f64::from(columns[axis][index]));
    (0..points.len()).map(|index| place(index).into()).collect()
}
