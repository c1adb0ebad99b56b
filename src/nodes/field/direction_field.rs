//! `direction_field`: a direction at every point of the plane, along borders, curves and what the user draws.
//!
//! With K ways in which a stone looks the same (4 for squares, 2 for oblong stones, 6 for hexagons), the sum over all border
//! segments s with angle α at distance d is, as a complex number,
//!
//! ```text
//! z = Σ |s| e^{iKα} / d²        direction = arg z / K        coherence = |z| / Σ |s| / d²
//! ```

use crate::field::{Block, Field, Kernel};
use crate::geometry::packing::direction::{Directions, power};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Domain, Type, Unit, Value};
use glam::DVec2;

/// A direction at every point.
pub static KIND: Kind = Kind {
    name: "direction_field",
    version: 2,
    about: "A direction at every point: along the border of a region, along curves, or as a field says; for stones, \
            boards and strokes to follow.",
    source: "Miyata, Itoh & Shimada, eq. (1), with angles multiplied by the symmetry: as printed, opposite sides cancel",
    inputs: &[
        Input::new(
            "region",
            Type::Region,
            "Its borders, holes too, give the direction around them.",
        )
        .optional(),
        Input::new(
            "symmetry",
            Type::Whole,
            "After one turn in how many parts the direction means the same: 4 for squares, 2 for oblong stones, 6 for hexagons.",
        )
        .default("4")
        .range(1.0, 12.0),
        Input::new(
            "guides",
            Type::List(&Type::Record(GUIDE)),
            "Curves that give the direction around them.",
        )
        .default("[]"),
        Input::new(
            "along",
            Type::Vector(Unit::One),
            "A direction of one's own, mixed in by `amount`; of length 0 it says nothing.",
        )
        .per_point()
        .of(Domain::Plane)
        .optional(),
        Input::number(
            "angle",
            Unit::Degree,
            "The same as an angle, counterclockwise from the x axis; instead of `along`.",
        )
        .per_point()
        .of(Domain::Plane)
        .optional(),
        Input::number(
            "amount",
            Unit::One,
            "Weight of `along` or `angle`; that of borders and curves is 1 where they agree, and less where they do not.",
        )
        .per_point()
        .of(Domain::Plane)
        .default("1")
        .range(0.0, 1e6),
    ],
    outputs: &[
        Output::field("direction", Type::Vector(Unit::One), "The direction, of length 1; of those that mean the same the one nearest to the x axis.")
            .on(Domain::Plane),
        Output::field("coherence", Type::Number(Unit::One), "How far all that was summed agrees: 0 to 1.").on(Domain::Plane),
    ],
    example: "(nodes: {
        \"lane\": direction_field(guides: [(points: [(0, 0), (40, 10), (90, 60)], weight: 2)]),
        \"example\": direction_field(guides: [(points: [(0, 50), (100, 50)])], along: \"lane\", amount: 0.5),
    })",
    build,
};

/// The parts of a guide.
const GUIDE: &[Input] = &[
    Input::new(
        "points",
        Type::List(&Type::Pair(Unit::Millimetre)),
        "Two or more points that the curve runs through, straight from one to the next.",
    )
    .range(-1e9, 1e9),
    Input::number("weight", Unit::One, "Its weight; that of the border is 1.")
        .default("1")
        .range(0.0, 1e6),
    Input::number(
        "reach",
        Unit::Millimetre,
        "How far it is felt; everywhere if left out.",
    )
    .optional()
    .range(1e-3, 1e9),
];

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let symmetry = inputs.whole("symmetry") as u32;
    let mut directions = match inputs.get("region") {
        Some(_) => Directions::of_border(inputs.region("region"), symmetry),
        None => Directions::new(symmetry),
    };
    for (index, guide) in inputs.list("guides").iter().enumerate() {
        add(guide, &mut directions).map_err(|failure| failure.at_item(index))?;
    }
    let drawn = drawn(inputs, build)?;
    if directions.is_empty() && drawn.is_none() {
        let failure = Failure::new("nothing says where the direction comes from");
        let hint = "link a `region`, list `guides` of some length, or give `along` or `angle`";
        return Err(failure.with_hint(hint));
    }
    let amount = match drawn {
        Some(_) => inputs.field("amount"),
        None => Field::constant(0.0),
    };
    let drawn = drawn.unwrap_or_else(|| Field::constants(&[0.0; 3]));
    let place = Field::position(Domain::Plane);
    let columns = build.kernel(Around { directions }, vec![place, drawn, amount]);
    Ok(vec![
        Value::Field(columns.part(0, 3)),
        Value::Field(columns.part(3, 1)),
    ])
}

/// Adds a curve.
fn add(guide: &Value, directions: &mut Directions) -> Result<(), Failure> {
    let points: Vec<DVec2> = match guide.part("points") {
        Some(Value::List(points)) => points.iter().filter_map(as_point).collect(),
        _ => vec![],
    };
    if points.len() < 2 {
        let message = format!(
            "expected at least 2 points of a curve, found {}",
            points.len()
        );
        return Err(Failure::of_input("guides", message));
    }
    let number = |name: &str| guide.part(name).and_then(Value::as_number);
    let (weight, reach) = (
        number("weight").unwrap_or(1.0),
        number("reach").unwrap_or(0.0),
    );
    for pair in points.windows(2) {
        directions.add([pair[0], pair[1]], weight, reach);
    }
    Ok(())
}

fn as_point(value: &Value) -> Option<DVec2> {
    match value {
        Value::Pair(pair) => Some(DVec2::from_array(*pair)),
        _ => None,
    }
}

/// What the user draws, as a vector.
fn drawn(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Option<Field>, Failure> {
    match (
        inputs.optional_field("along"),
        inputs.optional_field("angle"),
    ) {
        (Some(_), Some(_)) => {
            let failure = Failure::of_input("angle", "both `along` and `angle` are set");
            Err(failure.with_hint("remove one of them"))
        }
        (Some(along), None) => Ok(Some(along)),
        (None, Some(angle)) => Ok(Some(build.kernel(Pointed, vec![angle]))),
        (None, None) => Ok(None),
    }
}

/// From an angle to the vector that points there.
#[derive(Debug)]
struct Pointed;

impl Kernel for Pointed {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("pointed").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn nanoseconds(&self) -> f32 {
        20.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (index, angle) in block.inputs[0].values.iter().enumerate() {
            let (sine, cosine) = libm::sincos(f64::from(*angle).to_radians());
            block.outputs[0][index] = cosine as f32;
            block.outputs[1][index] = sine as f32;
            block.outputs[2][index] = 0.0;
        }
    }
}

/// Columns in: the place, what is drawn, its amount. Columns out: the direction and its coherence.
#[derive(Debug)]
struct Around {
    directions: Directions,
}

impl Kernel for Around {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text(KIND.name).whole(i64::from(KIND.version));
        self.directions.numbers().for_each(|number| {
            key.number(number);
        });
    }

    fn width(&self) -> usize {
        4
    }

    fn nanoseconds(&self) -> f32 {
        50.0 + 4.0 * self.directions.len() as f32
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let symmetry = self.directions.symmetry();
        let column = |column: usize, index: usize| f64::from(block.inputs[column].values[index]);
        for index in 0..block.outputs[0].len() {
            let pair = |first: usize| DVec2::new(column(first, index), column(first + 1, index));
            let mut around = self.directions.at(pair(0)).of_one();
            if let Some(drawn) = pair(DRAWN).try_normalize() {
                around = around.with(power(drawn, symmetry), column(DRAWN + 3, index));
            }
            let (direction, coherence) = (around.direction(symmetry), around.coherence());
            let columns = [direction.x, direction.y, 0.0, coherence];
            for (output, value) in block.outputs.iter_mut().zip(columns) {
                output[index] = value as f32;
            }
        }
    }
}

/// The column behind those of the place.
const DRAWN: usize = 3;
