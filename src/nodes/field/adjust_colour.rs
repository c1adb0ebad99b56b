//! `adjust_colour`: hue, saturation, brightness and contrast.
//!
//! Brightness multiplies the linear light. Hue turns and saturation scales the plane of a and b of Oklab, and
//! contrast scales the distance of its lightness from that of middle grey, so none of them changes what the eye
//! takes for another. Parts that fall below 0, because no such colour is in Rec. 709, become 0.

use crate::field::{Block, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Type, Unit, Value};

/// Changes hue, saturation, brightness and contrast.
pub static KIND: Kind = Kind {
    name: "adjust_colour",
    version: 2,
    about: "Changes hue, saturation, brightness and contrast of a colour, each without the others.",
    source: "Ottosson 2020 (Oklab); middle grey of linear 0.18",
    inputs: &[
        Input::new("colour", Type::Colour, "The colour to change.").per_point(),
        Input::number("hue", Unit::Degree, "Turn around the circle of hues.")
            .per_point()
            .default("0")
            .range(-360.0, 360.0),
        factor("saturation", "Factor of the saturation: 0 is grey."),
        factor("brightness", "Factor of the linear light: 0 is black."),
        factor(
            "contrast",
            "Factor of the distance from middle grey: 0 is even.",
        ),
    ],
    outputs: &[Output::field("colour", Type::Colour, "The changed colour.")],
    example: r##"(nodes: {
    "clouds": solid_noise(size: (40, 40, 200)),
    "wood": mix(a: "#e8c79a", b: "#a9763f", amount: "= 0.5 + 0.4 * clouds"),
    "example": adjust_colour(colour: "wood", hue: -8, saturation: 1.2, brightness: 0.8),
})"##,
    build,
};

const fn factor(name: &'static str, about: &'static str) -> Input {
    Input::number(name, Unit::One, about)
        .per_point()
        .default("1")
        .range(0.0, 100.0)
}

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let names = ["colour", "hue", "saturation", "brightness", "contrast"];
    let fields = names.map(|name| inputs.field(name));
    Ok(vec![Value::Field(build.kernel(Adjust, fields.into()))])
}

/// Columns in: three of the colour, hue in degrees, saturation, brightness, contrast.
#[derive(Debug)]
struct Adjust;

impl Kernel for Adjust {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("adjust_colour").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn nanoseconds(&self) -> f32 {
        80.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let mut turn = Turn::by(0.0);
        for index in 0..block.inputs[0].values.len() {
            let input: [f64; 7] =
                std::array::from_fn(|column| f64::from(block.inputs[column].values[index]));
            // Hardly any hue changes from sample to sample.
            if turn.hue != input[3] {
                turn = Turn::by(input[3]);
            }
            for (output, part) in block.outputs.iter_mut().zip(adjusted(input, &turn)) {
                output[index] = part as f32;
            }
        }
    }
}

/// A turn around the circle of hues, in degrees, and its sine and cosine.
struct Turn {
    hue: f64,
    sine: f64,
    cosine: f64,
}

impl Turn {
    fn by(hue: f64) -> Turn {
        let (sine, cosine) = (libm::sin(hue.to_radians()), libm::cos(hue.to_radians()));
        Turn { hue, sine, cosine }
    }
}

/// Lightness of middle grey: the cube root of 0.18.
const MIDDLE: f64 = 0.564_621_617_328_617;

fn adjusted(input: [f64; 7], turn: &Turn) -> [f64; 3] {
    let [r, g, b, hue, saturation, brightness, contrast] = input;
    let bright = [r, g, b].map(|part| part * brightness);
    // Untouched colours keep their bits.
    if (hue, saturation, contrast) == (0.0, 1.0, 1.0) {
        return bright;
    }
    let [lightness, a, b] = to_oklab(bright);
    let turned = [
        MIDDLE + contrast * (lightness - MIDDLE),
        saturation * (a * turn.cosine - b * turn.sine),
        saturation * (a * turn.sine + b * turn.cosine),
    ];
    from_oklab(turned).map(|part| part.max(0.0))
}

/// Oklab of a linear Rec. 709 colour, with the matrices of Ottosson 2020.
fn to_oklab([r, g, b]: [f64; 3]) -> [f64; 3] {
    // As exact as the columns are.
    let root = |part: f64| f64::from(libm::cbrtf(part as f32));
    let l = root(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
    let m = root(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
    let s = root(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}

fn from_oklab([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let cube = |part: f64| part * part * part;
    let l = cube(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m = cube(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s = cube(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}
