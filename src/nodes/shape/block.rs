//! `block`: a board as a body with six faces, where a flat cut lies.
//!
//! Its front face is the rectangle that `slice_cut` shows for the same `origin`, `across`, `along` and `size`, seen from
//! the side from which `across` points to the right and `along` upwards; the rest of the wood lies behind it. Edges are
//! rounded by quarter circles. The coordinates of the front face run over the whole square, those of the other
//! faces are as if looked through from the front.

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Mesh, Triangle, Type, Unit, Value};
use glam::{DMat3, DVec2, DVec3};
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;
use std::sync::Arc;

/// A body with six faces.
pub static KIND: Kind = Kind {
    name: "block",
    version: 1,
    about: "A board as a body with six faces and rounded edges, lying where a flat cut of the same place lies.",
    source: "own construction",
    inputs: &[
        Input::new(
            "origin",
            Type::Vector(Unit::Millimetre),
            "Centre of the front face.",
        )
        .default("(0, 0, 0)")
        .range(-1e7, 1e7),
        Input::new("across", Type::Vector(Unit::One), "Direction of the width.")
            .default("(1, 0, 0)"),
        Input::new(
            "along",
            Type::Vector(Unit::One),
            "Direction of the height; what of it runs along `across` is taken off.",
        )
        .default("(0, 0, 1)"),
        Input::new(
            "size",
            Type::Pair(Unit::Millimetre),
            "Width and height of the front face.",
        )
        .range(0.001, 100_000.0),
        Input::number(
            "thickness",
            Unit::Millimetre,
            "How far it reaches behind the front face.",
        )
        .range(0.001, 100_000.0),
        Input::number(
            "rounding",
            Unit::Millimetre,
            "Radius of the edges; at most half of the smallest side.",
        )
        .default("0.5")
        .range(0.0, 10_000.0),
    ],
    outputs: &[Output::new("mesh", Type::Mesh, "The body.")],
    example: r##"(nodes: {
        "example": block(origin: (0, -40, 500), size: (140, 900), thickness: 28, rounding: 1),
    })"##,
    build,
};

/// Steps in which an edge turns by 45 degrees.
const STEPS: usize = 4;

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let frame = frame(inputs)?;
    let [width, height] = inputs.pair("size");
    let thickness = inputs.number("thickness");
    let half = DVec3::new(width, height, thickness) * 0.5;
    let rounding = inputs.number("rounding").min(half.min_element());
    let centre = inputs.vector("origin") - frame.z_axis * half.z;
    let mut body = Body {
        mesh: Mesh {
            points: vec![],
            normals: vec![],
            coordinates: vec![],
            triangles: vec![],
        },
        points: HashMap::new(),
        half,
        rounding,
    };
    (0..6).for_each(|face| body.add_face(face));
    let mut mesh = body.mesh;
    mesh.coordinates = mesh
        .points
        .iter()
        .map(|point| DVec2::new(point.x / width + 0.5, point.y / height + 0.5))
        .collect();
    mesh.points
        .iter_mut()
        .for_each(|point| *point = centre + frame * *point);
    mesh.normals
        .iter_mut()
        .for_each(|normal| *normal = frame * *normal);
    Ok(vec![Value::Mesh(Arc::new(mesh))])
}

/// The directions of width, height and thickness, the last towards the front.
fn frame(inputs: &Inputs<'_>) -> Result<DMat3, Failure> {
    let (across, along) = (inputs.vector("across"), inputs.vector("along"));
    let across = across
        .try_normalize()
        .ok_or_else(|| Failure::of_input("across", "the direction `across` has no length"))?;
    let rejected = along - across * across.dot(along);
    if rejected.length() <= 1e-6 * along.length() {
        let message = "`along` points the same way as `across`, so they span no plane";
        return Err(Failure::of_input("along", message)
            .with_hint("choose `along` at a right angle to `across`"));
    }
    let along = rejected.normalize();
    Ok(DMat3::from_cols(across, along, across.cross(along)))
}

/// A body on its way, in its own frame around its centre.
struct Body {
    mesh: Mesh,
    /// Points that are there, by their bits: faces share those of their edges.
    points: HashMap<[u64; 3], u32>,
    half: DVec3,
    rounding: f64,
}

impl Body {
    /// A face with its half of the edges around it; its chart has the face's number.
    fn add_face(&mut self, face: usize) {
        let axis = face / 2;
        let sign = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        let steps = self.steps();
        let side = steps.len();
        let mut corners = Vec::with_capacity(side * side);
        for (second_end, second_slope) in &steps {
            for (first_end, first_slope) in &steps {
                let (mut end, mut normal) = (DVec3::ZERO, DVec3::ZERO);
                (end[axis], normal[axis]) = (sign, sign);
                (end[first], normal[first]) = (*first_end, first_end * first_slope);
                (end[second], normal[second]) = (*second_end, second_end * second_slope);
                let normal = normal.normalize();
                let point = end * (self.half - self.rounding) + normal * self.rounding;
                corners.push((self.point(point), self.normal(normal)));
            }
        }
        for index in 0..(side - 1) * side {
            if index % side == side - 1 {
                continue;
            }
            let corner = |offset: usize| corners[index + offset];
            let square = [corner(0), corner(1), corner(side + 1), corner(side)];
            self.add_square(square, sign < 0.0, face as u32);
        }
    }

    /// The points of a face along one side: at which end of the box, and how far the normal leans there.
    fn steps(&self) -> Vec<(f64, f64)> {
        if self.rounding == 0.0 {
            return vec![(-1.0, 0.0), (1.0, 0.0)];
        }
        let slope = |step: usize| libm::tan(FRAC_PI_4 * step as f64 / STEPS as f64);
        // The tangent of 45 degrees is not quite 1, but faces meet there.
        let slope = |step: usize| if step == STEPS { 1.0 } else { slope(step) };
        let low = (0..=STEPS).rev().map(|step| (-1.0, slope(step)));
        low.chain((0..=STEPS).map(|step| (1.0, slope(step))))
            .collect()
    }

    fn point(&mut self, point: DVec3) -> u32 {
        let bits = (point + 0.0).to_array().map(f64::to_bits);
        let next = self.mesh.points.len() as u32;
        let index = *self.points.entry(bits).or_insert(next);
        if index == next {
            self.mesh.points.push(point);
        }
        index
    }

    fn normal(&mut self, normal: DVec3) -> u32 {
        self.mesh.normals.push(normal);
        self.mesh.normals.len() as u32 - 1
    }

    fn add_square(&mut self, corners: [(u32, u32); 4], is_turned: bool, chart: u32) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let (b, c) = if is_turned { (c, b) } else { (b, c) };
            let points = [a, b, c].map(|corner| corners[corner].0);
            let is_flat =
                points[0] == points[1] || points[1] == points[2] || points[0] == points[2];
            if !is_flat {
                self.mesh.triangles.push(Triangle {
                    points,
                    normals: [a, b, c].map(|corner| corners[corner].1),
                    coordinates: points,
                    chart,
                });
            }
        }
    }
}
