//! `cell_value`: what `per_cell` says of the cell that a material is laid into.

use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, Varies};
use crate::value::{Type, Unit, Value};

/// Reads a value of the cell around.
pub static KIND: Kind = Kind {
    name: "cell_value",
    version: 1,
    about: "What `per_cell` says of the cell that a material is laid into, by name: what its `values` hold, an attribute \
            of the partition, or `random`, `id`, `area`. Elsewhere it is what is stated here.",
    source: "own construction: a variable with dynamic scope",
    inputs: &[
        Input::new("name", Type::Text, "The name of the value."),
        Input::number("value", Unit::One, "The number where no cell is around.").default("0"),
        Input::new(
            "colour",
            Type::Colour,
            "The colour where no cell is around.",
        )
        .default("(0, 0, 0)"),
        Input::new(
            "vector",
            Type::Vector(Unit::One),
            "The vector where no cell is around.",
        )
        .default("(0, 0, 0)"),
    ],
    outputs: &[
        of_cell("value", Type::Number(Unit::One), "The number."),
        of_cell("colour", Type::Colour, "The colour."),
        of_cell("vector", Type::Vector(Unit::One), "The vector."),
    ],
    example: r##"(nodes: {
        "example": cell_value(name: "random", value: 0.5),
        "shade": mix(a: "#c8a06e", b: "#8a6a42", amount: "example"),
        "wood": material(base_color: "shade"),
        "blocks": voronoi_split(size: (100, 100), cell_size: 20),
        "laid": per_cell(cells: "blocks", of: "wood"),
    }, outputs: { "floor": maps(of: "laid", pixels_per_mm: 1, channels: [base_color]) })"##,
    build,
};

/// A field that fits into a solid and onto a plane.
const fn of_cell(name: &'static str, value_type: Type, about: &'static str) -> Output {
    let mut output = Output::new(name, value_type, about);
    output.varies = Varies::PerPoint;
    output
}

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let name = inputs.text("name");
    if name.is_empty() {
        return Err(Failure::of_input("name", "the name is empty")
            .with_hint("write the name of a value, such as \"random\""));
    }
    let kept = ["value", "colour", "vector"].map(|output| {
        // A colour and a vector of one name are one: both have three columns.
        Field::given(name, &inputs.field(output))
    });
    Ok(kept.map(Value::Field).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::value::Domain;

    #[test]
    fn its_outputs_fit_everywhere() {
        for output in KIND.outputs {
            assert_eq!(output.domain, Some(Domain::Everywhere));
            assert_eq!(output.varies, Varies::PerPoint);
        }
    }
}
