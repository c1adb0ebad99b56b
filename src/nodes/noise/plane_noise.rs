//! `plane_noise`: irregular values at every point of a flat piece.

use super::interface::{self, SOURCE};
use super::octaves::VERSION;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Value};

/// Noise in a flat piece.
pub static KIND: Kind = Kind {
    name: "plane_noise",
    version: VERSION,
    about: "Irregular values at every point of a flat piece, in octaves from coarse to fine; what is finer than \
            a pixel melts into its mean.",
    source: SOURCE,
    inputs: INPUTS,
    outputs: OUTPUTS,
    example: r##"(nodes: { "example": plane_noise(size: (5, 5, 5), octaves: 3) })"##,
    build,
};

const INPUTS: &[Input] = &interface::inputs(Domain::Plane);
const OUTPUTS: &[Output] = &interface::outputs(Domain::Plane);

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    interface::build(KIND.name, Domain::Plane, inputs, build)
}
