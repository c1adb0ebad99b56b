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
mod scene;
mod shade;

use self::camera::{CAMERA, Camera};
use self::light::{Disc, LIGHT, Light, SKY, Sky, Turn};
use self::picture::{Smooth, Tone};
use self::rays::{Illumination, Sight, Stage, seen};
use self::record::Record;
use self::scene::{Cut, MOST_CUTS, Point, Scene, Thing};
use self::shade::Shade;
use crate::field::{Block, Field, Kernel};
use crate::geometry::mesh::{Open, check_closed};
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
    version: 2,
    about: "Draws a shaded picture of a mesh and its material, cut open by planes if you like; stands in `outputs`.",
    source: "own construction; shading after Walter and others 2007, Karis 2013, Fdez-Agüera 2019",
    inputs: &[
        Input::new(
            "of",
            Type::Material,
            "What it is made of: an uncut material, or a flat piece laid out by the mesh's coordinates.",
        ),
        Input::new("on", Type::Mesh, "Its shape."),
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
            "Where it is seen from; left out, from before the cut faces, a little from above.",
        )
        .optional(),
        Input::new(
            "lights",
            Type::List(&Type::Record(LIGHT)),
            "Up to eight lights; empty is one of a studio, from the left behind the camera.",
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

/// Most lights.
const MOST_LIGHTS: usize = 8;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let pixels = inputs.pair("pixels").map(f64::round);
    let stage = Arc::new(stage(inputs, pixels)?);
    let position = || vec![Field::position(Domain::Plane)];
    let sight = build.kernel(Sight(Arc::clone(&stage)), position());
    let light = build.kernel(Illumination(Arc::clone(&stage)), position());
    let mut columns = vec![Field::position(Domain::Plane), sight.clone(), light];
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
    let straight_up = Point::on_plane(DVec3::ZERO, DVec3::Z, 0.0);
    let shade = Shade {
        has_bark: bark.is_some(),
        has_relief,
        background: inputs.colour("background").map(|part| part as f32),
        open_sky: stage
            .sky
            .light(None, &straight_up, &Turn::at(0.0, 0.0))
            .colour
            .map(|part| part as f32),
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

/// Everything but the materials.
fn stage(inputs: &Inputs<'_>, size: [f64; 2]) -> Result<Stage, Failure> {
    let cuts = inputs.list("cuts").iter().enumerate();
    let cuts = cuts
        .map(|(index, item)| cut(index, item))
        .collect::<Result<Vec<_>, _>>()?;
    if cuts.len() > MOST_CUTS {
        let message = format!("expected at most {MOST_CUTS} cuts, found {}", cuts.len());
        return Err(Failure::of_input("cuts", message));
    }
    if !cuts.is_empty() {
        check_closed(inputs.mesh("on")).map_err(not_closed)?;
    }
    let side = side(&cuts);
    let is_notch = inputs.choice("remove") == "common";
    let thing = Thing::new(Arc::clone(inputs.mesh("on")), cuts, is_notch);
    let points = thing.outline();
    if points.is_empty() {
        return Err(Failure::of_input("cuts", "the cuts leave nothing to see")
            .with_hint("a `normal` points towards what is removed: turn one round"));
    }
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let reach = (high - low).length();
    let camera = Camera::new(&Record::of(inputs.get("camera")), size, &points, side)?;
    let lights = inputs.list("lights");
    if lights.len() > MOST_LIGHTS {
        let message = format!(
            "expected at most {MOST_LIGHTS} lights, found {}",
            lights.len()
        );
        return Err(Failure::of_input("lights", message));
    }
    let lights = lights.iter().enumerate();
    let lights = lights.map(|(index, item)| Light::read(item, index, (low + high) * 0.5));
    let mut lights = lights.collect::<Result<Vec<_>, _>>()?;
    if lights.is_empty() {
        lights.push(studio(&camera));
    }
    let count = usize::try_from(inputs.whole("samples")).unwrap_or(1);
    Ok(Stage {
        sky: Sky::read(&Record::of(inputs.get("sky")), count, reach),
        scene: Scene {
            things: vec![thing],
            ground: inputs.toggle("ground").then_some(low.z),
            margin: 1e-6 * reach.max(high.abs().max(low.abs()).max_element()),
        },
        camera,
        lights,
        disc: Disc::new(),
    })
}

/// Why a mesh cannot be cut.
fn not_closed(open: Open) -> Failure {
    match open {
        Open::Edges { count, place } => {
            let [x, y, z] = place.to_array();
            let message = format!(
                "the mesh is not closed, so it has no inside that cuts could show: {count} of its edges lie open, \
                 one at ({x:.3}, {y:.3}, {z:.3})"
            );
            Failure::of_input("on", message)
                .with_hint("close the mesh where it is made, or remove the `cuts`")
        }
        Open::InsideOut => Failure::of_input(
            "on",
            "the mesh is inside out: its triangles run clockwise seen from outside",
        )
        .with_hint("turn its triangles round where it is made"),
    }
}

/// One wide light from the left, above and behind the camera.
fn studio(camera: &Camera) -> Light {
    let level = DVec3::new(camera.back().x, camera.back().y, 0.0);
    let direction = level.normalize_or_zero() * 0.7 - camera.right() * 0.75 + DVec3::Z * 0.95;
    let direction = direction.try_normalize().unwrap_or(DVec3::Z);
    Light::distant(direction, 14.0, [0.78, 0.76, 0.73])
}

fn cut(index: usize, item: &Value) -> Result<Cut, Failure> {
    let stated = Record::of(Some(item));
    let vector = |name: &str| stated.vector(name).unwrap_or_default();
    let Some(normal) = vector("normal").try_normalize() else {
        let message = format!("the `normal` of cut {} has no length", index + 1);
        return Err(Failure::of_input("cuts", message).at_item(index));
    };
    Ok(Cut {
        point: vector("point"),
        normal,
    })
}

/// The side from which most is seen of the cut faces; from the front where there are none.
fn side(cuts: &[Cut]) -> DVec3 {
    let before: DVec3 = cuts.iter().map(|cut| cut.normal).sum();
    let level = DVec3::new(before.x, before.y, 0.0);
    let front = match level.try_normalize() {
        Some(front) if level.length() > 0.2 * before.length() => front,
        _ => DVec3::NEG_Y,
    };
    // A little from the right, and from above.
    let right = DVec3::Z.cross(front);
    (front + right * 0.45 + DVec3::Z * (0.45 + 0.5 * before.normalize_or_zero().z.max(0.0)))
        .normalize()
}

/// Where the material of the mesh is evaluated.
fn place(
    inputs: &Inputs<'_>,
    material: &Material,
    sight: &Field,
    build: &Build<'_>,
) -> Result<Field, Failure> {
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
    let stated = inputs.get("size").map(|_| inputs.pair("size"));
    let size = material.size.or(stated).ok_or_else(|| {
        Failure::of_input("of", "the material is not a cut piece, so it has no size")
            .with_hint("state its `size: (200, 100)`")
    })?;
    Ok(build.kernel(OnSquare { size }, vec![sight.part(seen::COORDINATES, 3)]))
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
