//! What the noise kinds have in common: inputs, outputs, and how they are built.

use super::form::Form;
use super::octaves::{NoiseKernel, Octave};
use super::period;
use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Output};
use crate::nodes::random::Random;
use crate::value::{Domain, Type, Unit, Value};

/// Where the maths of the noise kinds comes from.
pub(super) const SOURCE: &str = "Perlin 1985 (octaves, turbulence), 2002 (gradients and fade); Musgrave 1998 in Ebert et al., Texturing and Modeling \
     (ridged multifractal, offset 1 and gain 2); filtering: own construction";

/// The inputs of the noise kinds, on one domain.
pub(super) const fn inputs(domain: Domain) -> [Input; 8] {
    [
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
        "`fbm` is soft around 0, `ridged` has sharp crests at 1, `billow` round bumps between creases at 0.",
    )
    .default("fbm"),
    Input::new(
        "period",
        Type::Vector(Unit::Millimetre),
        "Distance along x, y and z after which the noise repeats, 0 for never; `size` is made to fit a whole number \
         of times, and refused if that takes more than 1 %. Needs a whole `lacunarity`.",
    )
    .default("(0, 0, 0)")
    .range(0.0, 1e6),
    Input::new(
        "seed",
        Type::Whole,
        "Another number gives other noise; so does the recipe's seed.",
    )
    .default("0"),
    Input::number(
        "variant",
        Unit::One,
        "Where it has another value there is other noise: let it be a `cell_value` for noise of its own in each cell.",
    )
    .per_point()
    .of(domain)
    .default("0"),
    ]
}

/// The outputs of the noise kinds, on one domain.
pub(super) const fn outputs(domain: Domain) -> [Output; 2] {
    [
        Output::field(
            "value",
            Type::Number(Unit::One),
            "`fbm`: -1 to 1 with the mean 0, one octave deviates by 0.27; `ridged`: 0 to 1; `billow`: 0 to 1 with the mean 0.22.",
        )
        .on(domain),
        Output::field(
            "vector",
            Type::Vector(Unit::One),
            "Three values as `value`, that have nothing to do with each other, nor with it.",
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
) -> Result<Vec<Value>, Failure> {
    check_fineness(inputs)?;
    let cells = period::cells(inputs)?;
    let mut random = Random::new(build.seed, kind, inputs.whole("seed"));
    let variant = match inputs.field("variant") {
        field if field.as_constant() == Some(&[0.0]) => vec![],
        field => vec![field],
    };
    let mut columns = |count| {
        let kernel = kernel(inputs, cells, &mut random, count);
        let position = Field::position(domain);
        Value::Field(build.kernel(kernel, [vec![position], variant.clone()].concat()))
    };
    Ok(vec![columns(1), columns(3)])
}

/// Positions are not exact enough for octaves that are still finer.
const FINEST: f64 = 65_536.0;

fn check_fineness(inputs: &Inputs<'_>) -> Result<(), Failure> {
    let (octaves, lacunarity) = (inputs.whole("octaves"), inputs.number("lacunarity"));
    let finest = lacunarity.powi(octaves as i32 - 1);
    if finest <= FINEST {
        return Ok(());
    }
    Err(Failure::of_input(
        "octaves",
        format!("the last octave is {finest:.0} times finer than the first, expected at most {FINEST} times"),
    )
    .with_hint("take fewer octaves, or a smaller lacunarity"))
}

/// The kernel with 1 or 3 columns that the inputs describe, given the first octave's cells in a period.
fn kernel(
    inputs: &Inputs<'_>,
    cells: [f64; 3],
    random: &mut Random,
    columns: usize,
) -> NoiseKernel {
    let (size, period) = (inputs.vector("size"), inputs.vector("period"));
    let form = Form::named(inputs.choice("form"));
    let scale = [0, 1, 2].map(|axis| match cells[axis] {
        0.0 => (1.0 / size[axis]) as f32,
        cells => (cells / period[axis]) as f32,
    });
    NoiseKernel {
        scale,
        period: period.to_array().map(|period| period as f32),
        octaves: octaves(inputs, form, cells, random),
        form,
        columns,
    }
}

fn octaves(inputs: &Inputs<'_>, form: Form, cells: [f64; 3], random: &mut Random) -> Vec<Octave> {
    let count = inputs.whole("octaves").unsigned_abs() as usize;
    let powers =
        |base: f64| std::iter::successors(Some(1.0), move |power| Some(power * base)).take(count);
    let (gain, lacunarity) = (inputs.number("gain"), inputs.number("lacunarity"));
    let total: f64 = powers(gain).sum();
    let octave = |(fineness, strength): (f64, f64)| Octave {
        fineness: fineness as f32,
        strength: (strength / total) as f32,
        offset: [random.share(), random.share(), random.share()],
        repeat: cells.map(|cells| (cells * fineness) as f32),
        seed: random.bits(),
        steps: form.steps(strength / total),
    };
    powers(lacunarity).zip(powers(gain)).map(octave).collect()
}
