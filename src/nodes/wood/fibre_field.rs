//! `fibre_field`: which way fibres run, from growth time.
//!
//! Fibres lie in the surfaces of equal growth time and run up the trunk. With the unit normal n of the surface,
//! towards younger wood, the fibre is what is left of the upright direction when its part along n is taken
//! off:
//!
//! ```text
//! f = (e_z - n_z n) / |e_z - n_z n|        f_z = sqrt(1 - n_z^2)        tilt = -n_z
//! ```
//!
//! The tilt is the sine of the angle by which the fibre leans outwards from upright; it is what makes curly
//! figure shine: two fibres that lean by t to either side send light into directions that are 4 t apart
//! (Marschner and others 2005). The gradient of time is taken by differences to points a step away along x, y and z.

use crate::field::{Block, Field, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::noise::distort::Offset;
use crate::value::{Domain, Type, Unit, Value};
use glam::DVec3;

/// The direction of fibres.
pub static KIND: Kind = Kind {
    name: "fibre_field",
    version: 1,
    about: "Which way the fibres run: up the trunk, in the surfaces of equal growth time.",
    source: "Liu, Dong, Hasan & Marschner 2016 (fibres by the distortion of a trunk); own construction from time",
    inputs: &[
        Input::number("time", Unit::Year, "When the wood at each point grew.")
            .per_point()
            .of(Domain::Solid),
        Input::number(
            "step",
            Unit::Millimetre,
            "Distance over which time is compared.",
        )
        .default("0.5")
        .range(1e-3, 100.0),
    ],
    outputs: &[
        Output::field(
            "fibre",
            Type::Vector(Unit::One),
            "Unit vector along the fibre, upwards.",
        )
        .on(Domain::Solid),
        Output::field(
            "tilt",
            Type::Number(Unit::One),
            "Sine of the angle by which it leans outwards: -1 to 1, 0 for upright fibres.",
        )
        .on(Domain::Solid),
    ],
    example: "(nodes: {
        \"tree\": skeleton(trunk: [(0, 0, 0), (60, 4, 900), (-6, 9, 2100)]),
        \"growth\": growth_field(skeleton: \"tree\", elongation: 420, thickening: 2.4),
        \"example\": fibre_field(time: \"growth.time\"),
    })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (time, step) = (inputs.field("time"), inputs.number("step"));
    let away = DVec3::AXES.map(|axis| {
        let amount = axis * step;
        let whole = vec![Field::position(Domain::Solid), Field::constants(&[1.0; 3])];
        time.at(&build.kernel(Offset { amount }, whole))
    });
    let times = std::iter::once(time).chain(away).collect();
    let gradient = build.kernel(Differences { step }, times);
    let fibre = build.kernel(Fibre, vec![gradient]);
    Ok(vec![
        Value::Field(fibre.part(0, 3)),
        Value::Field(fibre.part(3, 1)),
    ])
}

/// From the times here and a step away along x, y and z to the gradient in years per mm.
#[derive(Debug)]
struct Differences {
    step: f64,
}

impl Kernel for Differences {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("time_gradient")
            .whole(i64::from(KIND.version))
            .number(self.step);
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let scale = (1.0 / self.step) as f32;
        let [here, away @ ..] = block.inputs else {
            return;
        };
        for (output, away) in block.outputs.iter_mut().zip(away) {
            for ((output, away), here) in output.iter_mut().zip(away.values).zip(here.values) {
                *output = scale * (away - here);
            }
        }
    }
}

/// From the gradient to the fibre and its tilt.
#[derive(Debug)]
struct Fibre;

/// From one sample to the next the gradient along the trunk, in years per mm, may change so much.
const EVEN: f32 = 0.02;

impl Kernel for Fibre {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("fibre").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        4
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereEven {
            column: 2,
            absolute: EVEN,
        }
    }

    fn nanoseconds(&self) -> f32 {
        3.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [x, y, z] = [0, 1, 2].map(|axis| block.inputs[axis].values);
        for index in 0..x.len() {
            let (x, y, z) = (x[index], y[index], z[index]);
            let level = (x * x + y * y).sqrt();
            let whole = (level * level + z * z).sqrt();
            // Where time does not change across the trunk, fibres have no direction of their own.
            let values = if level > 1e-12 {
                let lean = -z / whole;
                [lean * x / level, lean * y / level, level / whole, lean]
            } else {
                [0.0, 0.0, 1.0, 0.0]
            };
            for (output, value) in block.outputs.iter_mut().zip(values) {
                output[index] = value;
            }
        }
    }
}
