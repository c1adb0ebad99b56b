//! `solid_noise`: irregular values at every point of a solid.

use super::interface::{self, SOURCE};
use super::octaves::VERSION;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Value};

/// Noise in a solid.
pub static KIND: Kind = Kind {
    name: "solid_noise",
    version: VERSION,
    about: "Irregular values at every point of a solid, in octaves from coarse to fine; what is finer than \
            a pixel melts into its mean.",
    source: SOURCE,
    inputs: INPUTS,
    outputs: OUTPUTS,
    example: r##"(nodes: { "example": solid_noise(size: (0.5, 0.5, 25), octaves: 3) })"##,
    build,
};

const INPUTS: &[Input] = &interface::inputs(Domain::Solid);
const OUTPUTS: &[Output] = &interface::outputs(Domain::Solid);

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    interface::build(KIND.name, Domain::Solid, inputs, build)
}
