//! `subdivide`: a mesh made finer and smoother.
//!
//! Places on the square stay where they are and are halved between, so that charts keep their outlines.

use crate::geometry::subdivision::{Topology, normals};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Mesh, Triangle, Type, Value};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Subdivision of meshes.
pub static KIND: Kind = Kind {
    name: "subdivide",
    version: 1,
    about: "A mesh made finer and smoother: each step makes four triangles of one. Borders stay borders; \
            where three triangles or more share an edge there is a crease.",
    source: "Loop 1987; borders and limits: Hoppe et al. 1994",
    inputs: &[
        Input::new("mesh", Type::Mesh, "The mesh."),
        Input::new(
            "levels",
            Type::Whole,
            "How many steps; each makes four times as many triangles.",
        )
        .default("2")
        .range(0.0, 10.0),
        Input::new(
            "scheme",
            Type::Choice(&["loop"]),
            "How points move: `loop` is for triangles.",
        )
        .default("loop"),
        Input::new(
            "limit",
            Type::Toggle,
            "Whether points are put on the surface that infinitely many steps lead to.",
        )
        .default("false"),
    ],
    outputs: &[Output::new(
        "mesh",
        Type::Mesh,
        "The finer mesh, with the normals of the smooth surface.",
    )],
    example: r##"(nodes: {
        "bowl": mesh_from_file(file: "bowl/bowl.stl"),
        "example": subdivide(mesh: "bowl", levels: 1),
    })"##,
    build,
};

/// Most triangles of the mesh.
const MOST: usize = 50_000_000;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let mesh = inputs.mesh("mesh");
    let levels = u32::try_from(inputs.whole("levels")).unwrap_or_default();
    check_count(mesh.triangles.len(), levels)?;
    let mut finer = Finer {
        surface: Part::new(&mesh.points, mesh.triangles.iter().map(|it| it.points)),
        places: match mesh.coordinates.is_empty() {
            true => None,
            false => Some(Part::new(
                &mesh.coordinates,
                mesh.triangles.iter().map(|it| it.coordinates),
            )),
        },
        charts: mesh.triangles.iter().map(|it| it.chart).collect(),
    };
    for _ in 0..levels {
        build.go_on()?;
        finer.step();
    }
    build.go_on()?;
    Ok(vec![Value::Mesh(Arc::new(
        finer.into_mesh(inputs.toggle("limit")),
    ))])
}

fn check_count(triangles: usize, levels: u32) -> Result<(), Failure> {
    let count = triangles.saturating_mul(4usize.saturating_pow(levels));
    if count <= MOST {
        return Ok(());
    }
    let message = format!("the mesh would have {count} triangles; the most is {MOST}");
    Err(Failure::of_input("levels", message).with_hint("take fewer steps"))
}

/// Points with triangles over them.
struct Part<T> {
    topology: Topology,
    values: Vec<T>,
}

impl<T: Copy> Part<T> {
    fn new(values: &[T], triangles: impl Iterator<Item = [u32; 3]>) -> Part<T> {
        Part {
            topology: Topology::new(values.len(), triangles.collect()),
            values: values.to_vec(),
        }
    }

    /// The triangles of the next step with values of the rule.
    fn step(&mut self, rule: impl Fn(&Topology, &[T]) -> Vec<T>) {
        self.values = rule(&self.topology, &self.values);
        let triangles = self.topology.refined_triangles();
        self.topology = Topology::new(self.topology.refined_points(), triangles);
    }
}

/// A mesh between two steps: surface and places have points of their own.
struct Finer {
    surface: Part<DVec3>,
    places: Option<Part<DVec2>>,
    /// For each triangle its chart.
    charts: Vec<u32>,
}

impl Finer {
    fn step(&mut self) {
        self.surface.step(Topology::refined);
        if let Some(places) = &mut self.places {
            places.step(Topology::halved);
        }
        self.charts = self.charts.iter().flat_map(|chart| [*chart; 4]).collect();
    }

    fn into_mesh(self, is_limit: bool) -> Mesh {
        let Part { topology, values } = &self.surface;
        let smooth = normals(topology, values);
        let points = match is_limit {
            true => topology.limit(values),
            false => values.clone(),
        };
        let mut normals: Vec<DVec3> = smooth.iter().map(|it| it.unwrap_or(DVec3::Z)).collect();
        let of_places = self.places.as_ref().map(|part| part.topology.triangles());
        let mut triangles = vec![];
        for (index, corners) in topology.triangles().iter().enumerate() {
            let is_smooth = |corner: u32| smooth[corner as usize].is_some();
            if !corners.iter().all(|corner| is_smooth(*corner)) {
                normals.push(face_normal(&points, *corners));
            }
            let face = (normals.len() - 1) as u32;
            triangles.push(Triangle {
                points: *corners,
                normals: corners.map(|corner| if is_smooth(corner) { corner } else { face }),
                coordinates: of_places.map_or([0; 3], |triangles| triangles[index]),
                chart: self.charts[index],
            });
        }
        Mesh {
            points,
            normals,
            coordinates: self.places.map(|places| places.values).unwrap_or_default(),
            triangles,
        }
    }
}

/// The normal of a triangle, for corners at creases; upwards if it has no area.
fn face_normal(points: &[DVec3], corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|index| points[index as usize]);
    (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z)
}
