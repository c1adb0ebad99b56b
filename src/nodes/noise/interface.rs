//! What the noise kinds have in common: inputs, outputs, and how they are built.

use super::octaves::NoiseKernel;
use super::random::Random;
use crate::field::Field;
use crate::node::{Build, Input, Inputs, Output};
use crate::value::{Domain, Type, Unit, Value};

/// Where the maths of the noise kinds comes from.
pub(super) const SOURCE: &str =
    "Perlin 2002 (gradients and fade); Musgrave 1994 (octaves, ridges); fading: own construction";

/// The inputs of the noise kinds.
pub(super) const INPUTS: &[Input] = &[
    Input::new(
        "size",
        Type::Vector(Unit::Millimetre),
        "Size of the features along x, y and z: a large part stretches them.",
    )
    .range(1e-4, 1e6),
    Input::new(
        "octaves",
        Type::Whole,
        "Layers of noise, each finer than the one before.",
    )
    .default("1")
    .range(1.0, 16.0),
    Input::number(
        "gain",
        Unit::One,
        "Strength of each octave relative to the one before.",
    )
    .default("0.5")
    .range(0.0, 1.0),
    Input::number(
        "lacunarity",
        Unit::One,
        "How many times finer each octave is.",
    )
    .default("2")
    .range(1.0, 8.0),
    Input::new(
        "form",
        Type::Choice(&["fbm", "ridged", "billow"]),
        "Soft around 0, sharp crests at 1, or round bumps between creases at -1.",
    )
    .default("fbm"),
    Input::new(
        "seed",
        Type::Whole,
        "Another number gives other noise; so does the recipe's seed.",
    )
    .default("0"),
];

/// The outputs of the noise kinds, on one domain.
pub(super) const fn outputs(domain: Domain) -> [Output; 2] {
    [
        Output::field(
            "value",
            Type::Number(Unit::One),
            "About -1 to 1; for `fbm` the mean is 0, and one octave deviates by 0.27.",
        )
        .on(domain),
        Output::field(
            "vector",
            Type::Vector(Unit::One),
            "Three values that have nothing to do with each other, nor with `value`.",
        )
        .on(domain),
    ]
}

/// The outputs of a noise node called `kind` whose points lie in `domain`.
pub(super) fn build(
    kind: &str,
    domain: Domain,
    inputs: &Inputs<'_>,
    build: &Build<'_>,
) -> Vec<Value> {
    let mut random = Random::new(build.seed, kind, inputs.whole("seed"));
    let mut columns = |count| {
        let kernel = NoiseKernel::new(inputs, &mut random, count);
        Value::Field(build.kernel(kernel, vec![Field::position(domain)]))
    };
    vec![columns(1), columns(3)]
}
