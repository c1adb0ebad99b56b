//! `view`: a shaded picture of a mesh and what it is made of, with a camera, lights and shadows.
//!
//! It is made of fields, as everything is: a kernel sends a ray through every point of the picture and gives what it
//! meets and how that is lit, the materials' fields are evaluated there, and another kernel shades. Colours stay
//! linear until the mean over a pixel is taken; then a tone curve shows light up to 0.8 as it is and draws what is
//! brighter towards white.

mod camera;
mod light;
mod outline;
mod picture;
mod rays;
mod record;
mod relief;
mod scene;
mod shade;
mod stage;

use self::camera::CAMERA;
use self::light::{LIGHT, SKY, Turn};
use self::picture::{Smooth, Tone};
use self::rays::{Illumination, Sight, Stage, seen};
use self::relief::{Lighting, Relief, SmoothLight};
use self::scene::Point;
use self::shade::Shade;
use self::stage::stage;
use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::surface::material::default_of;
use crate::value::{Domain, MapFormat, Maps, Material, Surface, Type, Unit, Value};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The channel of the picture.
const CHANNEL: &str = "view";

/// Shaded pictures.
pub static KIND: Kind = Kind {
    name: "view",
    version: 3,
    about: "Draws a shaded picture of a mesh and its material, cut open by planes if you like, or of a flat piece with its relief \
            as it lies on the ground; stands in `outputs`.",
    source: "own construction; shading after Walter and others 2007, Karis 2013, Fdez-Agüera 2019",
    inputs: &[
        Input::new(
            "of",
            Type::Material,
            "What it is made of: an uncut material, or a flat piece laid out by the mesh's coordinates.",
        ),
        Input::new(
            "on",
            Type::Mesh,
            "Its shape; left out, a flat piece lies on the ground with its relief.",
        )
        .optional(),
        Input::new(
            "bark",
            Type::Material,
            "What the mesh's own surface is made of instead, so that `of` is seen on cut faces only.",
        )
        .of(Domain::Solid)
        .optional(),
        Input::new(
            "size",
            Type::Pair(Unit::Millimetre),
            "Width and height of a flat piece that has none of its own.",
        )
        .optional()
        .range(1e-3, 1e7),
        Input::number(
            "relief",
            Unit::One,
            "What the heights of a flat piece on the ground are multiplied by; left out, 1. They are sampled as finely as the \
             picture shows them, in at most 8,388,608 cells.",
        )
        .optional()
        .range(0.0, 1000.0),
        Input::number(
            "thickness",
            Unit::Millimetre,
            "From the lowest point of a flat piece down to the ground; left out, 0.03 of its mean side.",
        )
        .optional()
        .range(0.0, 1e7),
        Input::new(
            "cuts",
            Type::List(&Type::Record(CUT)),
            "Planes that cut the mesh open; it has to be closed.",
        )
        .default("[]"),
        Input::new(
            "remove",
            Type::Choice(&["each", "common"]),
            "What the cuts remove: what lies before each of them, or only what lies before all of them, a notch.",
        )
        .default("each"),
        Input::new(
            "camera",
            Type::Record(CAMERA),
            "Where it is seen from; left out, from before the cut faces, or the lower edge of a flat piece, a little from above.",
        )
        .optional(),
        Input::new(
            "lights",
            Type::List(&Type::Record(LIGHT)),
            "Up to eight lights; empty is one of a studio, from the left behind the camera, or a low sun over relief.",
        )
        .default("[]"),
        Input::new("sky", Type::Record(SKY), "Light from all sides.").optional(),
        Input::new("ground", Type::Toggle, "Whether it stands on a ground that shows its shadow.")
            .default("true"),
        Input::new("background", Type::Colour, "What is behind everything.").default("\"#e8e7e5\""),
        Input::number("exposure", Unit::One, "Multiplies all light but the background's.")
            .default("1")
            .range(0.0, 1000.0),
        Input::new(
            "samples",
            Type::Whole,
            "Directions in which the sky is looked at: more make softer shadows smoother.",
        )
        .default("256")
        .range(8.0, 65_536.0),
        Input::new("pixels", Type::Pair(Unit::Pixel), "Size of the picture.")
            .default("(960, 640)")
            .range(1.0, 65_536.0),
        Input::new(
            "format",
            Type::Choice(&MapFormat::NAMES),
            "File format and samples, as for `maps`.",
        )
        .default("png8"),
    ],
    outputs: &[Output::new("picture", Type::Maps, "The picture.")],
    example: r##"(nodes: {
        "grain": solid_noise(size: (2, 2, 60)),
        "wood": material(base_color: "#c8a06e", roughness: "= 0.5 + 0.2 * grain.value"),
        "brick": block(size: (60, 30), thickness: 20),
    }, outputs: {
        "example": view(of: "wood", on: "brick", pixels: (48, 32), samples: 32),
    })"##,
    build,
};

const CUT: &[Input] = &[
    Input::new(
        "point",
        Type::Vector(Unit::Millimetre),
        "A point of the plane.",
    )
    .range(-1e7, 1e7),
    Input::new(
        "normal",
        Type::Vector(Unit::One),
        "Towards what is removed, at right angles to the plane.",
    ),
];

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let pixels = inputs.pair("pixels").map(f64::round);
    let stage = Arc::new(stage(inputs, build, pixels)?);
    let position = || vec![Field::position(Domain::Plane)];
    let sight = build.kernel(Sight(Arc::clone(&stage)), position());
    let mut columns = vec![Field::position(Domain::Plane), sight.part(seen::PLACE, 3)];
    columns.extend(lighting(&stage, &sight, build));
    let of = inputs.material("of");
    columns.extend(channels(of, &place(inputs, of, &sight, build)?));
    let bark = inputs.get("bark").map(|_| inputs.material("bark"));
    if let Some(bark) = bark {
        columns.extend(channels(bark, &sight.part(seen::PLACE, 3)));
    }
    let has_relief = [Some(of), bark].into_iter().flatten().any(|material| {
        let height = material.channels.get("height");
        height.is_some_and(|height| height.as_constant().is_none())
    });
    let shade = Shade {
        has_bark: bark.is_some(),
        // On the ground the relief is there itself.
        has_relief: has_relief && stage.scene.relief.is_none(),
        background: inputs.colour("background").map(|part| part as f32),
        open_sky: open_sky(&stage).map(|part| part as f32),
        stage,
        exposure: inputs.number("exposure") as f32,
    };
    let shaded = build.kernel(shade, columns);
    let picture = build.kernel(Tone, vec![build.kernel(Smooth, vec![shaded])]);
    let format = MapFormat::from_name(inputs.choice("format"))
        .expect("the format is one of the names that the input declares");
    let maps = Maps {
        material: Material {
            domain: Domain::Plane,
            channels: BTreeMap::from([(CHANNEL.to_owned(), picture)]),
            size: Some(pixels),
            // Materials see no neighbours beyond the edge of a surface.
            surface: Some(Surface {
                tangents: None,
                charts: vec![sight.part(seen::SURFACE, 1)],
            }),
        },
        pixels: pixels.map(|side| side as u32),
        size: pixels,
        is_view: true,
        channels: vec![CHANNEL.to_owned()],
        format,
        ranges: BTreeMap::new(),
    };
    Ok(vec![Value::Maps(Arc::new(maps))])
}

/// The normals and surfaces that are lit, and how.
fn lighting(stage: &Arc<Stage>, sight: &Field, build: &Build<'_>) -> [Field; 3] {
    let surface = sight.part(seen::SURFACE, 1);
    if stage.scene.relief.is_none() {
        let position = vec![Field::position(Domain::Plane)];
        let light = build.kernel(Illumination(Arc::clone(stage)), position);
        return [sight.part(seen::NORMAL, 3), surface, light];
    }
    let lighting = Lighting(Arc::clone(stage));
    let (normal, columns) = (lighting.normal(), lighting.width());
    let light = build.kernel(lighting, vec![sight.clone()]);
    let smooth = build.kernel(SmoothLight { columns }, vec![light]);
    [smooth.part(normal, 3), surface, smooth.part(0, normal)]
}

/// Where the material of the mesh is evaluated.
fn place(
    inputs: &Inputs<'_>,
    material: &Material,
    sight: &Field,
    build: &Build<'_>,
) -> Result<Field, Failure> {
    if inputs.get("on").is_none() {
        return Ok(sight.part(seen::COORDINATES, 3));
    }
    if material.domain != Domain::Plane {
        return Ok(sight.part(seen::PLACE, 3));
    }
    if inputs.mesh("on").coordinates.is_empty() {
        let message = "the mesh has no coordinates, so nothing says where a flat piece lies on it";
        return Err(Failure::of_input("of", message)
            .with_hint("link to the uncut material, or give the mesh coordinates"));
    }
    if !inputs.list("cuts").is_empty() {
        let message = "a flat piece has no inside that cuts could show";
        return Err(Failure::of_input("cuts", message).with_hint("link `of` to the uncut material"));
    }
    let size = size_of(inputs, material)?;
    Ok(build.kernel(OnSquare { size }, vec![sight.part(seen::COORDINATES, 3)]))
}

/// The size of a flat piece.
fn size_of(inputs: &Inputs<'_>, material: &Material) -> Result<[f64; 2], Failure> {
    let stated = inputs.get("size").map(|_| inputs.pair("size"));
    material.size.or(stated).ok_or_else(|| {
        Failure::of_input("of", "the material is not a cut piece, so it has no size")
            .with_hint("state its `size: (200, 100)`")
    })
}

/// How bright the sky makes level ground where nothing stands.
fn open_sky(stage: &Stage) -> [f64; 3] {
    let straight_up = Point::on_plane(DVec3::ZERO, DVec3::Z, 0.0);
    let light = match stage.scene.relief {
        Some(_) => Relief::open_sky(&stage.sky),
        None => stage.sky.light(None, &straight_up, &Turn::at(0.0, 0.0)),
    };
    light.colour
}

/// The columns of a material at a place, as the shading reads them.
fn channels(material: &Material, place: &Field) -> [Field; 5] {
    [
        ("base_color", 3),
        ("height", 1),
        ("roughness", 1),
        ("metalness", 1),
        ("occlusion", 1),
    ]
    .map(|(channel, width)| match material.channels.get(channel) {
        Some(field) => field.at(place),
        None => default_of(channel, width),
    })
}

/// Takes coordinates on the square of the maps to the flat piece that is laid on it.
#[derive(Debug)]
struct OnSquare {
    size: [f64; 2],
}

impl Kernel for OnSquare {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("view square").whole(i64::from(KIND.version));
        self.size.iter().for_each(|side| {
            key.number(*side);
        });
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let sides = [self.size[0] as f32, self.size[1] as f32, 0.0];
        for ((output, input), side) in block.outputs.iter_mut().zip(block.inputs).zip(sides) {
            for (output, value) in output.iter_mut().zip(input.values) {
                *output = value * side;
            }
        }
    }
}
