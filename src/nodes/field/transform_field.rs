//! `transform_field`: moves, turns and scales numbers, colours and vectors.

use super::placement::{MOVE, PIVOT, Placement, SCALE, TURN};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, common_domain};
use crate::value::{Type, Unit, Value};

/// Moves, turns and scales fields.
pub static KIND: Kind = Kind {
    name: "transform_field",
    version: 1,
    about: "Moves, turns and scales numbers, colours and vectors that differ from point to point; all alike. \
            What is the same everywhere stays.",
    source: "own construction: affine maps of the domain; normals by the inverse transpose",
    inputs: &[
        Input::number(
            "value",
            Unit::One,
            "A number; of another unit by division: `\"= node.time / 1 year\"`.",
        )
        .per_point()
        .default("0"),
        Input::new("colour", Type::Colour, "A colour.")
            .per_point()
            .default("(0, 0, 0)"),
        Input::new("vector", Type::Vector(Unit::One), "A vector.")
            .per_point()
            .default("(0, 0, 0)"),
        MOVE,
        TURN,
        SCALE,
        PIVOT,
        Input::new(
            "vectors",
            Type::Choice(&["directions", "normals", "values"]),
            "What vectors are: directions that turn along, directions at right angles to surfaces, or three \
             numbers that stay.",
        )
        .default("directions"),
    ],
    outputs: &[
        Output::field("value", Type::Number(Unit::One), "The number in its new place."),
        Output::field("colour", Type::Colour, "The colour in its new place."),
        Output::field("vector", Type::Vector(Unit::One), "The vector in its new place."),
    ],
    example: r#"(nodes: {
    "waves": solid_noise(size: (60, 60, 400)),
    "example": transform_field(value: "waves.value", vector: "waves.vector", turn: (0, 0, 30)),
})"#,
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let fields = ["value", "colour", "vector"].map(|name| inputs.field(name));
    let placement = Placement::read(inputs, common_domain(&fields))?;
    let position = placement.position(build);
    let [value, colour, vector] = fields.map(|field| field.at(&position));
    let vector = match inputs.choice("vectors") {
        "normals" => placement.normals(build, vector),
        "directions" => placement.directions(build, vector),
        _ => vector,
    };
    Ok([value, colour, vector].map(Value::Field).into())
}
