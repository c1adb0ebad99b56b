//! `mix`: a colour between two colours, in linear light.
//!
//! A mode puts another colour in the place of `b`: the product of both, the lighter of both and so on.
//!
//! The inputs arrive averaged over the pixel, and what is mixed are the averages: exact where only the
//! colours or only the amount change within a pixel. Amounts beyond 0 to 1 are clamped; where noise in the amount is
//! finer than a pixel, it is the mean of clamped amounts that counts. Where the amount bends within a pixel, as at the
//! rim of a knot, the mix is supersampled; so are all pixels that vary where the mode is not linear. With `pixels: means`
//! no pixel is divided because of the amount, but those are in which the amount itself is, as in small pictures of stones:
//! with the amount all that is mixed changes there.

use crate::field::{Block, Field, InputColumn, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};
use fearless_simd_macros::simd;

/// Mixes two colours.
pub static KIND: Kind = Kind {
    name: "mix",
    version: 2,
    about: "Mixes two colours in linear light: `a` where the amount is 0, `b` where it is 1. Amounts beyond \
            are clamped.",
    source: "own construction: linear interpolation",
    inputs: &[
        Input::new("a", Type::Colour, "Colour where the amount is 0.").per_point(),
        Input::new("b", Type::Colour, "Colour where the amount is 1.").per_point(),
        Input::number("amount", Unit::One, "Share of `b`.")
            .per_point()
            .range(0.0, 1.0),
        Input::new(
            "mode",
            Type::Choice(MODES),
            "What `b` does to `a`, part by part and in linear light.",
        )
        .default("normal"),
        Input::new(
            "pixels",
            Type::Choice(&["divided", "means"]),
            "divided: pixels in which the amount bends are looked at more closely; means: what is mixed are means, \
             which is quick, and right for masks that are filtered and for colours that do not follow the amount; only where \
             stones are small in pixels these are looked at more closely.",
        )
        .default("divided"),
    ],
    outputs: &[Output::field("colour", Type::Colour, "The mixed colour.")],
    example: r##"(nodes: {
        "grain": solid_noise(size: (2, 2, 60)),
        "example": mix(a: "#e8c79a", b: "#5b3a1e", amount: "= 0.25 + 0.2 * grain.value"),
    })"##,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let mode = inputs.choice("mode");
    let within = match inputs.choice("pixels") {
        "means" => Within::Means,
        _ => Within::Straight,
    };
    let fields = ["a", "b", "amount"].map(|name| inputs.field(name));
    Ok(vec![Value::Field(mixed(build, mode, within, fields))])
}

/// The mix of two fields by an amount.
pub(super) fn mixed(
    build: &Build<'_>,
    mode: &'static str,
    within: Within,
    [a, b, amount]: [Field; 3],
) -> Field {
    let (width, lost) = (a.width(), amount.lost().cloned());
    let widest = match within {
        Within::Means => amount.widest(),
        _ => [&amount, &a, &b].into_iter().find_map(Field::widest),
    };
    let (place, widest) = widest.cloned().unzip();
    let kernel = Mix {
        mode,
        width,
        within,
        is_lost: lost.is_some(),
        widest,
    };
    let inputs = [a, b, amount].into_iter().chain(lost).chain(place);
    build.kernel(kernel, inputs.collect())
}

/// What `b` can do; [`Mix::evaluate`] has the arithmetic of each.
const MODES: &[&str] = &[
    "normal",
    "multiply",
    "screen",
    "overlay",
    "soft_light",
    "add",
    "subtract",
    "difference",
    "divide",
    "darken",
    "lighten",
];

/// Columns in: `width` of `a`, `width` of `b`, amount; if something is lost of the amount, its variance within pixels; if
/// wide pixels hold more than is filtered, a part of the position.
#[derive(Debug)]
struct Mix {
    /// What `b` does to `a`.
    mode: &'static str,
    /// Columns of the values that are mixed.
    width: usize,
    /// What is known of a pixel.
    within: Within,
    /// Whether something is lost of the amount.
    is_lost: bool,
    /// How wide pixels may be in mm before they hold more than is filtered, if that is known.
    widest: Option<f32>,
}

/// When the mean of a mix is taken for the mix of the means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Within {
    /// Where the amount is straight.
    Straight,
    /// Where the amount is even: the values change where it does, as they do when materials are blended.
    Even,
    /// Everywhere but where pixels of the amount are divided.
    Means,
}

impl Kernel for Mix {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("mix")
            .whole(i64::from(KIND.version))
            .text(self.mode)
            .whole(self.within as i64)
            .whole(i64::from(self.is_lost))
            .number(self.widest.map_or(-1.0, f64::from));
    }

    fn width(&self) -> usize {
        self.width
    }

    fn sampling(&self) -> Sampling {
        if !["normal", "add"].contains(&self.mode) {
            return Sampling::Supersampled;
        }
        let column = 2 * self.width;
        match self.within {
            Within::Straight => Sampling::FilteredWhereStraight {
                column,
                absolute: 0.08,
                relative: 0.0,
            },
            Within::Even => Sampling::FilteredWhereEven {
                column,
                absolute: 0.05,
            },
            Within::Means => match self.widest {
                Some(absolute) => Sampling::FilteredWhereEven {
                    column: self.place(),
                    absolute,
                },
                None => Sampling::Filtered,
            },
        }
    }

    fn widest(&self) -> Option<(usize, f32)> {
        self.widest.map(|widest| (self.place(), widest))
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        match self.mode {
            "multiply" => self.mix(block, |a, b| a * b),
            "screen" => self.mix(block, |a, b| 1.0 - (1.0 - a) * (1.0 - b)),
            "overlay" => self.mix(block, |a, b| {
                if a < 0.5 {
                    2.0 * a * b
                } else {
                    1.0 - 2.0 * (1.0 - a) * (1.0 - b)
                }
            }),
            // Pegtop's formula: no kink at 1/2.
            "soft_light" => self.mix(block, |a, b| (1.0 - 2.0 * b) * a * a + 2.0 * b * a),
            "add" => self.mix(block, |a, b| a + b),
            "subtract" => self.mix(block, |a, b| (a - b).max(0.0)),
            "difference" => self.mix(block, |a, b| (a - b).abs()),
            // Nothing is lighter than white divided by itself.
            "divide" => self.mix(block, |a, b| if b <= a || b <= 0.0 { 1.0 } else { a / b }),
            "darken" => self.mix(block, f32::min),
            "lighten" => self.mix(block, f32::max),
            _ => self.mix(block, |_, b| b),
        }
    }
}

impl Mix {
    /// Mixes `a` with what the mode makes of one part of `a` and `b`; each mode has a loop of its own.
    fn mix(&self, block: &mut Block<'_>, blended: impl Fn(f32, f32) -> f32) {
        let amounts = self.amounts(block.inputs, block.level);
        for (part, output) in block.outputs.iter_mut().enumerate() {
            let colours = block.inputs[part]
                .values
                .iter()
                .zip(block.inputs[self.width + part].values);
            for ((output, (a, b)), amount) in output.iter_mut().zip(colours).zip(&amounts) {
                // Exact at both ends, which a + (b - a) * amount is not.
                *output = a * (1.0 - amount) + blended(*a, *b) * amount;
            }
        }
    }

    /// The column with a part of the position, if pixels must not be wide.
    fn place(&self) -> usize {
        2 * self.width + 1 + usize::from(self.is_lost)
    }

    /// The amounts from 0 to 1.
    fn amounts(&self, inputs: &[InputColumn<'_>], level: Level) -> Vec<f32> {
        let amounts = inputs[2 * self.width].values;
        match inputs.get(2 * self.width + 1) {
            Some(lost) if self.is_lost => {
                let mut means = vec![0.0; amounts.len()];
                dispatch!(level, simd => write_clamped(simd, amounts, lost.values, &mut means));
                means
            }
            _ => amounts.iter().map(|mean| mean.clamp(0.0, 1.0)).collect(),
        }
    }
}

/// Numbers that lie nearer to their mean are all taken for it.
const NARROW: f32 = 1e-3;

/// Writes means of numbers that are evenly spread, each clamped to 0 to 1, given means and variances without the clamp.
#[simd]
fn write_clamped<S: Simd>(simd: S, means: &[f32], variances: &[f32], out: &mut [f32]) {
    for start in (0..means.len()).step_by(S::f32s::LEN) {
        let range = start..start + S::f32s::LEN;
        let mean = S::f32s::from_slice(simd, &means[range.clone()]);
        let reach = (S::f32s::from_slice(simd, &variances[range.clone()]) * 3.0).sqrt();
        let sum = integral::<S>(mean + reach) - integral::<S>(mean - reach);
        let spread = sum * 0.5 / reach.max_precise(NARROW);
        let held = mean.max_precise(0.0).min_precise(1.0);
        let is_narrow = reach.simd_lt(NARROW);
        is_narrow.select(held, spread).store_slice(&mut out[range]);
    }
}

/// The integral from 0 to `end` of a number that is clamped to 0 to 1.
#[inline(always)]
fn integral<S: Simd>(end: S::f32s) -> S::f32s {
    let within = end.max_precise(0.0).min_precise(1.0);
    within * (end - within * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamped_means_are_those_of_many() {
        let cases = [
            (0.4, 0.01),
            (-0.2, 0.1),
            (0.9, 0.2),
            (0.5, 4.0),
            (1.2, 0.0),
            (0.3, 0.0),
        ];
        for (mean, variance) in cases {
            let reach = (3.0f32 * variance).sqrt();
            let values = (0..1000).map(|i| mean + reach * ((i as f32 + 0.5) / 500.0 - 1.0));
            let expected = values.map(|value| value.clamp(0.0, 1.0)).sum::<f32>() / 1000.0;
            let (means, variances, mut found) = ([mean; 16], [variance; 16], [0.0; 16]);
            dispatch!(Level::new(), simd => write_clamped(simd, &means, &variances, &mut found));
            let is_near = |found: &f32| (found - expected).abs() < 1e-3;
            assert!(
                found.iter().all(is_near),
                "{mean} {variance}: {found:?}, not {expected}"
            );
        }
    }
}
