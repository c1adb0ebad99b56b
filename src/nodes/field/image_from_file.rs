//! `image_from_file`: a picture as fields of a flat piece.
//!
//! The picture's lower left corner lies at `origin`, its rows run along u, its upper side points to v. Between the
//! centres of its pixels it is interpolated, beyond its sides it goes on as `wrap` says, and what a pixel of an output
//! covers is averaged: exactly where the picture stands upright on it, by samples of a smaller copy where it is
//! turned. Translucent pixels count by their opacity. Orientation notes and colour profiles are not applied.

mod footprint;
mod near;
mod pyramid;
mod source;
mod weights;
mod window;

use crate::colour::luminance;
use crate::field::{Block, Field, Kernel, Sampling};
use crate::key::{Key, KeyHasher};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::picture::Format;
use crate::value::{Domain, Type, Unit, Value};
use footprint::Sampler;
use pyramid::Pyramid;
use weights::{Interpolation, Wrap};

/// A picture as fields.
pub static KIND: Kind = Kind {
    name: "image_from_file",
    version: 2,
    about: "Shows a picture on a flat piece, at its size in mm and averaged over each pixel.",
    source: "own construction: box filter over the reconstruction filters of Keys 1981, on reduced copies after \
             Williams 1983",
    inputs: &[
        Input::new("file", Type::File, "The picture: PNG, JPEG, BMP or OpenEXR."),
        Input::new(
            "colour_space",
            Type::Choice(&["srgb", "linear", "raw"]),
            "srgb: encoded colours; linear: light as it is; raw: numbers, which opacity does not weigh. Without it \
             linear for OpenEXR and srgb for the others.",
        )
        .optional(),
        Input::new(
            "size",
            Type::Pair(Unit::Millimetre),
            "Width and height of the picture; without it by `pixels_per_mm`.",
        )
        .optional()
        .range(1e-3, 1e6),
        Input::number(
            "pixels_per_mm",
            Unit::PixelPerMillimetre,
            "Resolution, instead of `size`; without both what a PNG states.",
        )
        .optional()
        .range(1e-4, 1e6),
        Input::new(
            "origin",
            Type::Pair(Unit::Millimetre),
            "Where the picture's lower left corner is.",
        )
        .default("(0, 0)")
        .range(-1e6, 1e6),
        Input::new(
            "wrap",
            Type::Choice(Wrap::NAMES),
            "Beyond the picture: again, again mirrored, its outermost pixels, or nothing.",
        )
        .default("repeat"),
        Input::new(
            "interpolation",
            Type::Choice(Interpolation::NAMES),
            "Between the pixels' centres, where it is enlarged: none, straight, or smooth with a little overshoot.",
        )
        .default("linear"),
    ],
    outputs: &[
        Output::field("colour", Type::Colour, "The colour; black where nothing is.").on(Domain::Plane),
        Output::field(
            "value",
            Type::Number(Unit::One),
            "Luminance of the colour, or the number of a grey picture.",
        )
        .on(Domain::Plane),
        Output::field("alpha", Type::Number(Unit::One), "Opacity: 1 where the file has none.").on(Domain::Plane),
    ],
    example: r#"(nodes: { "example": image_from_file(file: "spruce_bar/spruce_bar.png", size: (300, 12)) })"#,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let file = inputs.file("file");
    let Some(format) = Format::of(&file.bytes) else {
        let message = "expected a PNG, JPEG, BMP or OpenEXR picture, found another kind of file";
        return Err(Failure::of_input("file", message).with_hint("convert it to PNG or OpenEXR"));
    };
    if let Some(warning) = format.contradiction(&file.path) {
        inputs.warn(warning);
    }
    let space = inputs
        .get("colour_space")
        .map(|_| inputs.choice("colour_space"));
    if (format, space) == (Format::Exr, Some("srgb")) {
        let failure = Failure::of_input(
            "colour_space",
            "an OpenEXR picture holds light as it is, not sRGB",
        );
        return Err(failure.with_hint("write `colour_space: linear`, or leave it out"));
    }
    let base = source::read(inputs, file, format, space)?;
    let [width, height] = base.size.map(f64::from);
    let size = size(inputs, [width, height], &file.bytes)?;
    let sampler = Sampler {
        texels_per_mm: [width / size[0], height / size[1]],
        origin: inputs.pair("origin"),
        wrap: Wrap::from_name(inputs.choice("wrap")),
        interpolation: Interpolation::from_name(inputs.choice("interpolation")),
        pyramid: Pyramid::new(base, build)?,
    };
    let kernel = Picture {
        key: key(inputs, &sampler),
        is_raw: space == Some("raw"),
        sampler,
    };
    let columns = build.kernel(kernel, vec![Field::position(Domain::Plane)]);
    let part = |first, width| Value::Field(columns.part(first, width));
    Ok(vec![part(0, 3), part(3, 1), part(4, 1)])
}

/// Width and height in mm.
fn size(inputs: &Inputs<'_>, pixels: [f64; 2], bytes: &[u8]) -> Result<[f64; 2], Failure> {
    let stated = |name: &str| inputs.get(name).is_some();
    match (stated("size"), stated("pixels_per_mm")) {
        (true, true) => {
            let failure =
                Failure::of_input("pixels_per_mm", "both `size` and `pixels_per_mm` are set");
            Err(failure.with_hint("remove one of them"))
        }
        (true, false) => Ok(inputs.pair("size")),
        (false, true) => Ok(pixels.map(|side| side / inputs.number("pixels_per_mm"))),
        (false, false) => match crate::nodes::picture::pixels_per_mm(bytes) {
            Some([across, along]) => Ok([pixels[0] / across, pixels[1] / along]),
            None => Err(
                Failure::new("the picture does not say how large it is").with_hint(format!(
                    "it has {} x {} pixels: set `size` in mm, or `pixels_per_mm`",
                    pixels[0], pixels[1]
                )),
            ),
        },
    }
}

fn key(inputs: &Inputs<'_>, sampler: &Sampler) -> Key {
    let mut key = KeyHasher::new("image_from_file", KIND.version);
    key.bytes(&inputs.file("file").bytes);
    let space = inputs
        .get("colour_space")
        .map(|_| inputs.choice("colour_space"));
    key.text(space.unwrap_or_default());
    key.text(inputs.choice("wrap"))
        .text(inputs.choice("interpolation"));
    sampler
        .texels_per_mm
        .iter()
        .chain(&sampler.origin)
        .for_each(|part| {
            key.number(*part);
        });
    key.finish()
}

/// Columns out: three of the colour, value, alpha.
#[derive(Debug)]
struct Picture {
    key: Key,
    is_raw: bool,
    sampler: Sampler,
}

impl Kernel for Picture {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("image_from_file").key(self.key);
    }

    fn width(&self) -> usize {
        5
    }

    fn reads_spread(&self, column: usize) -> bool {
        column < 2
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereStraight {
            column: 0,
            absolute: (0.25 / self.sampler.texels_per_mm[0]) as f32,
            relative: 0.05,
        }
    }

    fn nanoseconds(&self) -> f32 {
        60.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let mut scratch = self.sampler.scratch();
        let [u, v] = [block.inputs[0], block.inputs[1]];
        for index in 0..u.values.len() {
            let at = |column: &[f32]| f64::from(column[index]);
            let point = [at(u.values), at(v.values)];
            let [across, along] = [u.spread, v.spread];
            let spread = [[at(across[0]), at(across[1])], [at(along[0]), at(along[1])]];
            let [r, g, b, alpha] = self.sampler.mean(&mut scratch, point, spread);
            // Colours come multiplied by the opacity.
            let scale = match self.is_raw {
                true => 1.0,
                false if alpha == 1.0 => 1.0,
                false if alpha > 0.0 => 1.0 / alpha,
                false => 0.0,
            };
            let [r, g, b] = [r, g, b].map(|part| part * scale);
            for (output, value) in
                block
                    .outputs
                    .iter_mut()
                    .zip([r, g, b, luminance([r, g, b]), alpha])
            {
                output[index] = value;
            }
        }
    }
}
