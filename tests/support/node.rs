//! One node alone, without a recipe around it.

use std::sync::Arc;
use yosegi::engine::Cancel;
use yosegi::node::{Build, Failure, Inputs, Kind};
use yosegi::value::Value;

/// The inputs of a node by name; of those that are given twice the last. What is left out is not stated, also where a recipe would
/// have a default.
pub(crate) fn inputs(kind: &Kind, given: &[(&str, Value)]) -> Vec<Option<Value>> {
    let mut values = vec![None; kind.inputs.len()];
    for (name, value) in given {
        let (index, _) = kind.input(name).expect("the kind has the input");
        values[index] = Some(value.clone());
    }
    values
}

/// What a node gives, in a recipe of a seed.
pub(crate) fn built(
    kind: &'static Kind,
    values: &[Option<Value>],
    seed: u64,
    cancel: Option<&Cancel>,
) -> Result<Vec<Value>, Failure> {
    let build = Build {
        node: &Arc::from("test"),
        seed,
        cancel,
    };
    (kind.build)(&Inputs::new(kind, values), &build)
}
