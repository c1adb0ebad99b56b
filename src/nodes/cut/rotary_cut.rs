//! `rotary_cut`: peels a log on a lathe into one long strip of veneer.
//!
//! The log turns about the lathe's axis, and the knife comes nearer to the axis by `pitch` in every turn: it cuts along
//! the spiral of Archimedes r(phi) = r0 - p phi / 2 pi. A point (u, v) of the piece shows the point
//! origin + offset + r (cos phi, sin phi), v above the origin, where u is the length of the spiral from where the knife
//! began, so the strip is as long as true veneer. For half-rotary veneer the log is clamped beside its centre: `offset`
//! is from the centre, at `origin`, to the lathe's axis.
//!
//! From `from` to `from + length` the strip is cut off; parts of one strip fit together. Lengths run in double
//! precision: 400 m of veneer are as sharp as the first metre. Scaling by `placed` makes the strip longer by the mean
//! factor across the axis, and higher by the factor along it.

mod spiral;

use super::placed::{PLACED, piece, placed};
use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};
use glam::{DAffine3, DVec2, DVec3};
use spiral::Spiral;

/// Peels a log into a strip of veneer.
pub static KIND: Kind = Kind {
    name: "rotary_cut",
    version: 1,
    about: "Peels a log into a strip of veneer along a spiral, rotary or, beside the log's centre, half-rotary.",
    source: "Shibasaki & Aoyama, section on rotary cuts (figure 2); arc length of the spiral of Archimedes in closed form",
    inputs: &[
        Input::new("of", Type::Material, "The material to cut.").of(Domain::Solid),
        Input::new(
            "origin",
            Type::Vector(Unit::Millimetre),
            "Point of the log's centre at the lower edge of the strip; the axis stands upright.",
        )
        .default("(0, 0, 0)"),
        Input::new(
            "offset",
            Type::Pair(Unit::Millimetre),
            "From the log's centre to the lathe's axis, for half-rotary veneer.",
        )
        .default("(0, 0)")
        .range(-1e5, 1e5),
        Input::number(
            "radius",
            Unit::Millimetre,
            "Distance of the knife from the axis where the strip begins.",
        )
        .range(0.1, 1e4),
        Input::number(
            "core",
            Unit::Millimetre,
            "Distance of the knife from the axis where the strip ends.",
        )
        .default("0")
        .range(0.0, 1e4),
        Input::number(
            "pitch",
            Unit::Millimetre,
            "Thickness of the veneer: how much nearer the knife comes in a turn.",
        )
        .range(0.01, 1e3),
        Input::number(
            "height",
            Unit::Millimetre,
            "Height of the strip, along the axis.",
        )
        .range(0.001, 1e5),
        Input::number(
            "start",
            Unit::Degree,
            "Angle at which the strip begins, from x against the clock.",
        )
        .default("0")
        .range(-36_000.0, 36_000.0),
        Input::new(
            "direction",
            Type::Choice(&["against_the_clock", "with_the_clock"]),
            "Which way round the knife goes, seen from above.",
        )
        .default("against_the_clock"),
        Input::number(
            "from",
            Unit::Millimetre,
            "Length along the strip at which the piece begins.",
        )
        .default("0")
        .range(0.0, 1e9),
        Input::number(
            "length",
            Unit::Millimetre,
            "Length of the piece; without it, to the end of the strip.",
        )
        .optional()
        .range(0.001, 1e9),
        PLACED,
    ],
    outputs: &[Output::field("piece", Type::Material, "The veneer.").on(Domain::Plane)],
    example: r##"(nodes: {
        "grain": solid_noise(size: (2, 2, 60)),
        "wood": material(base_color: "#c8a06e", height: "= 0.05 * grain.value"),
        "example": rotary_cut(of: "wood", radius: 120, pitch: 2, height: 500, length: 800),
    })"##,
    build,
};

/// Longest strip in mm: the place of a pixel on it is known to a part of a micrometre.
const LONGEST: f64 = 1e9;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let spiral = Spiral {
        radius: inputs.number("radius"),
        pitch: inputs.number("pitch"),
        start: inputs.number("start").to_radians(),
        sense: match inputs.choice("direction") {
            "with_the_clock" => -1.0,
            _ => 1.0,
        },
    };
    let from = inputs.number("from");
    let length = length(inputs, &spiral, from)?;
    let place = placed(inputs)?;
    let offset = inputs.pair("offset");
    let axis = inputs.vector("origin") + DVec3::new(offset[0], offset[1], 0.0);
    let [across, along] = factors(&place);
    let peel = Peel {
        spiral,
        from,
        per_length: [1.0 / across, 1.0 / along],
        place: place * DAffine3::from_translation(axis),
    };
    let plane = [Field::position(Domain::Plane), Field::remainder()];
    let position = build.kernel(peel, plane.into());
    let size = [length * across, inputs.number("height") * along];
    Ok(vec![piece(inputs.material("of"), &position, size)])
}

/// The length of the piece: as stated, or to the end of the strip.
fn length(inputs: &Inputs<'_>, spiral: &Spiral, from: f64) -> Result<f64, Failure> {
    let (core, radius) = (inputs.number("core"), spiral.radius);
    if core >= radius {
        let message =
            format!("the strip would end {core} mm from the axis and begin at {radius} mm");
        return Err(
            Failure::of_input("core", message).with_hint("set `core` to less than `radius`")
        );
    }
    let whole = spiral.length_to(core);
    if whole > LONGEST {
        let message =
            format!("the strip would be {whole:.0} mm long; the longest has {LONGEST} mm");
        return Err(Failure::of_input("pitch", message).with_hint("choose a thicker veneer"));
    }
    let rest = whole - from;
    let Some(length) = inputs.get("length").map(|_| inputs.number("length")) else {
        let message = || format!("the strip ends at {whole:.1} mm");
        return match rest >= 0.001 {
            true => Ok(rest),
            false => Err(Failure::of_input("from", message())),
        };
    };
    // What `yosegi` prints of the length may be rounded up.
    if length > rest + 0.1 {
        let message = format!(
            "the strip ends at {whole:.1} mm, and the piece would at {:.1} mm",
            from + length
        );
        return Err(Failure::of_input("length", message)
            .with_hint("leave `length` out for all that is left, or choose a thinner veneer"));
    }
    Ok(length)
}

/// By how much the strip becomes longer and higher.
fn factors(place: &DAffine3) -> [f64; 2] {
    let lengths = [0, 1, 2].map(|axis| place.matrix3.col(axis).length());
    [(lengths[0] * lengths[1]).sqrt(), lengths[2]]
}

/// Sends (u, v) to the spiral. Columns in: position, what rounding took from u.
#[derive(Debug)]
struct Peel {
    spiral: Spiral,
    from: f64,
    /// Lengths of the strip for each length of the piece.
    per_length: [f64; 2],
    place: DAffine3,
}

impl Kernel for Peel {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("rotary_cut").whole(i64::from(KIND.version));
        let spiral = [self.spiral.radius, self.spiral.pitch, self.spiral.start];
        let place = self.place.to_cols_array();
        let all = spiral.iter().chain([&self.spiral.sense, &self.from]);
        all.chain(&self.per_length).chain(&place).for_each(|part| {
            key.number(*part);
        });
    }

    fn width(&self) -> usize {
        3
    }

    fn nanoseconds(&self) -> f32 {
        3.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [u, v, rest] = [0, 1, 3].map(|column| block.inputs[column].values);
        let same = |one: usize, other: usize| u[one] == u[other] && rest[one] == rest[other];
        // The rows of a picture have the same lengths: a point is found once for each column.
        let row = (1..u.len())
            .find(|index| same(*index, 0))
            .unwrap_or(u.len());
        let mut points: Vec<DVec2> = Vec::with_capacity(row);
        for index in 0..u.len() {
            let column = index % row;
            if index < row || !same(index, index - row) {
                let length = (f64::from(u[index]) + f64::from(rest[index])) * self.per_length[0];
                let point = self.spiral.at(self.from + length);
                match points.get_mut(column) {
                    Some(known) => *known = point,
                    None => points.push(point),
                }
            }
            let height = f64::from(v[index]) * self.per_length[1];
            let point = self.place.transform_point3(points[column].extend(height));
            for (output, part) in block.outputs.iter_mut().zip(point.to_array()) {
                output[index] = part as f32;
            }
        }
    }
}
