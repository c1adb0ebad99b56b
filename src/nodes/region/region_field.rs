//! `region_field`: whether points of a flat piece lie in a part of the plane, and how far from its outline.

use crate::field::{Block, Field, Kernel};
use crate::geometry::polygon::Edges;
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::field::threshold::transition;
use crate::value::{Domain, Region, Type, Unit, Value};
use glam::DVec2;
use std::sync::Arc;

/// A part of the plane as fields.
pub static KIND: Kind = Kind {
    name: "region_field",
    version: 1,
    about: "Whether points of a flat piece lie in a part of the plane, and how far from its outline.",
    source: "nearest edge by a tree of boxes; the share of a pixel by the threshold's box filter",
    inputs: &[
        Input::new("of", Type::Region, "The part of the plane."),
        Input::number(
            "width",
            Unit::Millimetre,
            "Width of a smooth transition across the outline; 0 is a hard edge.",
        )
        .default("0")
        .range(0.0, 1e8),
    ],
    outputs: &[
        Output::field(
            "inside",
            Type::Number(Unit::One),
            "1 inside, 0 outside, the share of a pixel on the outline.",
        )
        .on(Domain::Plane),
        Output::field(
            "distance",
            Type::Number(Unit::Millimetre),
            "To the nearest point of the outline; below 0 outside.",
        )
        .on(Domain::Plane),
    ],
    example: "(nodes: {
        \"plate\": region_shape(shape: ellipse, size: (80, 60)),
        \"example\": region_field(of: \"plate\"),
    })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let region = inputs.region("of");
    let kernel = Distance {
        region: Arc::clone(region),
        edges: Edges::new(region.rings()),
    };
    let plane = vec![Field::position(Domain::Plane), Field::remainder()];
    let distance = build.kernel(kernel, plane);
    let inside = transition(build, distance.clone(), inputs.number("width"));
    Ok(vec![Value::Field(inside), Value::Field(distance)])
}

/// How far a point is from the outline, below 0 outside.
#[derive(Debug)]
struct Distance {
    region: Arc<Region>,
    edges: Edges,
}

impl Kernel for Distance {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("region distance").whole(i64::from(KIND.version));
        for ring in self.region.rings() {
            key.whole(ring.len() as i64);
            ring.iter().for_each(|corner| {
                key.number(corner.x).number(corner.y);
            });
        }
    }

    fn width(&self) -> usize {
        1
    }

    fn nanoseconds(&self) -> f32 {
        500.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for index in 0..block.inputs[0].values.len() {
            let [u, v, _, rest] =
                [0, 1, 2, 3].map(|column| f64::from(block.inputs[column].values[index]));
            let point = DVec2::new(u + rest, v);
            let distance = self.edges.distance(point);
            let sign = if self.edges.enclose(point) { 1.0 } else { -1.0 };
            block.outputs[0][index] = (sign * distance) as f32;
        }
    }
}
