//! `cell_attribute`: says something of every cell: a number, a random one, one of a choice, or what a field is there.

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::random::Random;
use crate::value::{Domain, Partition, Type, Unit, Value};
use std::sync::Arc;

/// Says something of every cell.
pub static KIND: Kind = Kind {
    name: "cell_attribute",
    version: 1,
    about: "Gives every cell a number under a name: the same for all, a random one of a range, one of a choice with weights, or \
            what a field is at the cell's centre.",
    source: "own construction",
    inputs: &[
        Input::new("of", Type::Partition, "The cells."),
        Input::new("name", Type::Text, "The name of the number; one that is there is replaced."),
        Input::number("value", Unit::One, "The number, or a field that is asked at the centres.")
            .per_point()
            .of(Domain::Plane)
            .optional(),
        Input::new("random", Type::Pair(Unit::One), "A random number between these, instead of a `value`.").optional(),
        Input::new("choice", Type::List(&Type::Record(PARTS)), "One of these numbers, instead of a `value`.").optional(),
        Input::new("seed", Type::Whole, "Another number gives other random ones.").default("0"),
    ],
    outputs: &[Output::new("cells", Type::Partition, "The cells with the number.")],
    example: "(nodes: {
        \"plain\": voronoi_split(size: (200, 200), cell_size: 40),
        \"example\": cell_attribute(of: \"plain\", name: \"stone\", choice: [(value: 0, weight: 3), (value: 1)], seed: 4),
    })",
    build,
};

const PARTS: &[Input] = &[
    Input::number("value", Unit::One, "The number."),
    Input::number(
        "weight",
        Unit::One,
        "How often it is taken, compared with the others; 1 if not stated.",
    )
    .optional()
    .range(0.0, 1e9),
];

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let name = inputs.text("name");
    check(name)?;
    let mut cells = Partition::clone(inputs.partition("of"));
    let numbers = numbers(inputs, build, &cells)?;
    cells.attributes.insert(name.to_owned(), numbers);
    Ok(vec![Value::Partition(Arc::new(cells))])
}

/// What materials and tables know of cells under these names.
const TAKEN: [&str; 10] = [
    "id",
    "random",
    "area",
    "centre",
    "extent",
    "x_mm",
    "y_mm",
    "area_mm2",
    "corners",
    "axis_degree",
];

fn check(name: &str) -> Result<(), Failure> {
    let refuse = |message: String| Failure::of_input("name", message);
    if name.is_empty() {
        return Err(refuse("the name is empty".to_owned()));
    }
    if name.chars().any(char::is_control) {
        return Err(refuse(format!(
            "expected a name in one line, found {name:?}"
        )));
    }
    if TAKEN.contains(&name) {
        let failure = refuse(format!("cells have a `{name}` already"));
        return Err(failure.with_hint("give the number another name"));
    }
    Ok(())
}

fn numbers(inputs: &Inputs<'_>, build: &Build<'_>, cells: &Partition) -> Result<Vec<f64>, Failure> {
    let random = Random::new(build.seed, "cell_attribute", inputs.whole("seed"));
    let of_cells = || cells.ids.iter().map(|id| random.of_item(*id));
    let stated = ["value", "random", "choice"].map(|name| inputs.get(name).is_some());
    match stated {
        [true, false, false] => {
            let values = inputs.sample("value", build, &cells.centres)?;
            Ok(values[0].iter().map(|value| f64::from(*value)).collect())
        }
        [false, true, false] => {
            let range = inputs.pair("random");
            Ok(of_cells().map(|mut random| random.between(range)).collect())
        }
        [false, false, true] => {
            let choice = choice(inputs)?;
            let total: f64 = choice.iter().map(|(_, weight)| weight).sum();
            Ok(of_cells()
                .map(|mut random| taken(&choice, random.between([0.0, total])))
                .collect())
        }
        [false, false, false] => {
            let failure = Failure::new("nothing says what the number is");
            Err(failure.with_hint("state a `value`, a range `random`, or a `choice`"))
        }
        [is_value, is_random, _] => {
            let input = match (is_value, is_random) {
                (true, true) => "random",
                _ => "choice",
            };
            let message = "more than one of `value`, `random` and `choice` is stated";
            Err(Failure::of_input(input, message).with_hint("keep one of them"))
        }
    }
}

/// Numbers with their weights.
fn choice(inputs: &Inputs<'_>) -> Result<Vec<(f64, f64)>, Failure> {
    let mut choice = vec![];
    for item in inputs.list("choice") {
        let Value::Record(parts) = item else { continue };
        let number = |name: &str| {
            parts.iter().find_map(|(part, value)| match value {
                Value::Number(number) if *part == name => Some(*number),
                _ => None,
            })
        };
        if let Some(value) = number("value") {
            choice.push((value, number("weight").unwrap_or(1.0)));
        }
    }
    if choice.iter().all(|(_, weight)| *weight <= 0.0) {
        let message = "there is nothing to choose from";
        return Err(
            Failure::of_input("choice", message).with_hint("state numbers with weights above 0")
        );
    }
    Ok(choice)
}

/// The number at a place of the weights in a row.
fn taken(choice: &[(f64, f64)], mut at: f64) -> f64 {
    let mut last = 0.0;
    for (value, weight) in choice.iter().filter(|(_, weight)| *weight > 0.0) {
        last = *value;
        if at < *weight {
            break;
        }
        at -= weight;
    }
    last
}
