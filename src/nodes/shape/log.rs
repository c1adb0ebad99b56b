//! `log`: the closed surface of a piece of a tree, from a field that says when or where there is wood.
//!
//! The piece lies in a box, sawn off flat at its sides. With `time` the surface lies where the wood of the year `age`
//! grew, so trunk, branches and their collars come out as they grew; with `inside` it lies where the field is 0.5.

use crate::cancel::Cancel;
use crate::field::{Field, Program, RunContext, Samples, Scratch};
use crate::geometry::level_surface::{Grid, MOST_POINTS, NoSurface, Surface};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Mesh, Triangle, Type, Unit, Value};
use fearless_simd::Level;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// The surface of a piece of a tree.
pub static KIND: Kind = Kind {
    name: "log",
    version: 1,
    about: "The closed surface of a piece of a tree at an age, found in the field of growth time.",
    source: "own construction: tetrahedra after Doi & Koide 1991, points on the surface by halving",
    inputs: &[
        Input::number("time", Unit::Year, "When the wood at each point grew.")
            .per_point()
            .of(Domain::Solid)
            .optional(),
        Input::number("age", Unit::Year, "With `time`: the year whose wood is the outermost.")
            .optional()
            .range(1e-3, 1e5),
        Input::number("inside", Unit::One, "Instead: 1 within the tree, 0 outside.")
            .per_point()
            .of(Domain::Solid)
            .optional(),
        Input::new(
            "low",
            Type::Vector(Unit::Millimetre),
            "Corner of the box that the piece is cut from: the smallest x, y and z.",
        )
        .range(-1e6, 1e6),
        Input::new(
            "high",
            Type::Vector(Unit::Millimetre),
            "The largest x, y and z.",
        )
        .range(-1e6, 1e6),
        Input::number(
            "detail",
            Unit::Millimetre,
            "Size of the smallest features; left out, a 150th of the box's longest side.",
        )
        .optional()
        .range(1e-3, 1e5),
    ],
    outputs: &[Output::new("mesh", Type::Mesh, "The surface.")],
    example: "(nodes: {
        \"tree\": skeleton(trunk: [(0, 0, 0), (12, 4, 900), (-6, 9, 2100)]),
        \"growth\": growth_field(skeleton: \"tree\", elongation: 420, thickening: 2.4),
        \"example\": log(time: \"growth.time\", age: 30, low: (-120, -120, 400), high: (120, 120, 900), detail: 40),
    })",
    build,
};

/// Cells along the longest side of the box, if the recipe does not say.
const CELLS: f64 = 150.0;

/// The share of the age by which the surface lies beneath it: between its points it is flat, and there the wood of the
/// next year would show in places.
const BENEATH: f64 = 1e-3;

/// Points that a thread evaluates in one go.
const BLOCK: usize = 4096;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (field, sign, level) = level(inputs)?;
    let (low, high) = (inputs.vector("low"), inputs.vector("high"));
    if (high - low).min_element() <= 0.0 {
        let message = "expected `high` above `low` in x, y and z, found a box without an inside";
        return Err(Failure::of_input("high", message));
    }
    let cell = match inputs.get("detail") {
        Some(_) => inputs.number("detail"),
        None => (high - low).max_element() / CELLS,
    };
    let sampler = Sampler {
        program: Program::compile(&[field]),
        sign,
        level,
        cancel: build.cancel,
    };
    let evaluate = |points: &[DVec3]| sampler.evaluate(points);
    let surface = Grid::new(low, high, cell).surface(&evaluate);
    let surface = surface.map_err(|reason| explained(reason, inputs, cell))?;
    // What is inside jumps from 0 to 1 and has no slope.
    let normals = match inputs.get("inside") {
        Some(_) => Some(facing(&surface)),
        None => sampler.normals(&surface.points, 0.25 * cell),
    };
    build.go_on()?;
    let normals = normals.ok_or_else(|| Failure::new("the run was cancelled"))?;
    Ok(vec![Value::Mesh(Arc::new(mesh(surface, normals)))])
}

/// The field, the sign that makes it positive inside, and the value that it has at the surface.
fn level(inputs: &Inputs<'_>) -> Result<(Field, f64, f64), Failure> {
    match (
        inputs.optional_field("time"),
        inputs.optional_field("inside"),
    ) {
        (Some(time), None) => match inputs.get("age") {
            Some(_) => Ok((time, -1.0, inputs.number("age") * (1.0 - BENEATH))),
            None => Err(Failure::of_input("time", "`time` is set, but no `age`")
                .with_hint("say of which year the outermost wood is: `age: 40`")),
        },
        (None, Some(inside)) => Ok((inside, 1.0, 0.5)),
        _ => Err(
            Failure::new("expected either `time` with `age`, or `inside`")
                .with_hint("link one of them: `time: \"growth.time\", age: 40`"),
        ),
    }
}

fn explained(reason: NoSurface, inputs: &Inputs<'_>, cell: f64) -> Failure {
    match reason {
        NoSurface::Cancelled => Failure::new("the run was cancelled"),
        NoSurface::Empty if inputs.get("inside").is_some() => Failure::of_input(
            "inside",
            "the field is nowhere above 0.5 in the box, so there is no surface",
        )
        .with_hint("check `low` and `high`, or lower `detail` if the piece is thin"),
        NoSurface::Empty => {
            let age = inputs.number("age");
            let message =
                format!("the field never crosses {age} years in the box, so there is no surface");
            Failure::of_input("age", message)
                .with_hint("check `low` and `high`, or lower `detail` if the piece is thin")
        }
        NoSurface::TooFine { points } => {
            let message = format!(
                "the surface with details of {cell} mm takes {points} points or more; the most are {MOST_POINTS}"
            );
            Failure::of_input("detail", message).with_hint("raise `detail`, or take a smaller box")
        }
    }
}

/// Evaluates a field at points.
struct Sampler<'a> {
    program: Program,
    sign: f64,
    level: f64,
    cancel: Option<&'a Cancel>,
}

impl Sampler<'_> {
    /// How far the field is above its level, inwards; `None` if the run was cancelled.
    fn evaluate(&self, points: &[DVec3]) -> Option<Vec<f64>> {
        let context = RunContext {
            level: Level::new(),
            cache: None,
            filtering: true,
            cancel: self.cancel,
        };
        let evaluate = |scratch: &mut Scratch, points: &[DVec3]| {
            let points: Vec<[f64; 3]> = points.iter().map(DVec3::to_array).collect();
            self.program
                .run(&Samples::Points(&points), scratch, &context);
            if context.is_cancelled() {
                return None;
            }
            let values = &self.program.output(scratch, 0, 0)[..points.len()];
            let values = values.iter();
            Some(
                values
                    .map(|value| self.sign * (f64::from(*value) - self.level))
                    .collect(),
            )
        };
        let blocks = points
            .par_chunks(BLOCK)
            .map_init(Scratch::default, evaluate);
        let blocks: Option<Vec<Vec<f64>>> = blocks.collect();
        Some(blocks?.concat())
    }

    /// Unit normals, outwards, from differences over `step`.
    fn normals(&self, points: &[DVec3], step: f64) -> Option<Vec<DVec3>> {
        let mut slopes = vec![DVec3::ZERO; points.len()];
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let moved = |by: f64| points.iter().map(|it| *it + axis * by).collect::<Vec<_>>();
            let (ahead, behind) = (self.evaluate(&moved(step))?, self.evaluate(&moved(-step))?);
            for (slope, (ahead, behind)) in slopes.iter_mut().zip(ahead.iter().zip(behind)) {
                *slope += axis * (ahead - behind);
            }
        }
        let normal = |slope: DVec3| (-slope).try_normalize().unwrap_or(DVec3::Z);
        Some(slopes.into_iter().map(normal).collect())
    }
}

/// Unit normals, outwards, as means of those of the triangles around by their areas; sawn ones do not count.
fn facing(surface: &Surface) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; surface.points.len()];
    let triangles = surface.triangles.iter().zip(&surface.sides);
    for (triangle, _) in triangles.filter(|(_, side)| **side == 6) {
        let [a, b, c] = triangle.map(|point| surface.points[point as usize]);
        let area = (b - a).cross(c - a);
        triangle
            .iter()
            .for_each(|point| sums[*point as usize] += area);
    }
    sums.into_iter()
        .map(|sum| sum.try_normalize().unwrap_or(DVec3::Z))
        .collect()
}

/// The mesh, with the box's own normals where it is sawn off; every sawn face is a chart.
fn mesh(surface: Surface, normals: Vec<DVec3>) -> Mesh {
    let smooth = normals.len() as u32;
    let sawn = [
        DVec3::NEG_X,
        DVec3::X,
        DVec3::NEG_Y,
        DVec3::Y,
        DVec3::NEG_Z,
        DVec3::Z,
    ];
    let triangle = |(points, side): (&[u32; 3], &u8)| Triangle {
        points: *points,
        normals: match *side {
            6 => *points,
            side => [smooth + u32::from(side); 3],
        },
        coordinates: [0; 3],
        chart: if *side == 6 {
            0
        } else {
            Triangle::SAWN + u32::from(*side)
        },
    };
    let triangles = surface.triangles.iter().zip(&surface.sides).map(triangle);
    Mesh {
        triangles: triangles.collect(),
        normals: normals.into_iter().chain(sawn).collect(),
        points: surface.points,
        coordinates: vec![],
    }
}
