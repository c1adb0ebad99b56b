//! The channels of two materials that are blended.

use crate::diagnostics::nearest;
use crate::field::{Block, Field, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Failure, Inputs, field_of};
use crate::nodes::surface::material::default_of;
use crate::value::Material;
use std::collections::{BTreeMap, BTreeSet};

/// The fields of every channel that one of the materials has, in `a` and in `b`, which `inputs_of` names.
///
/// # Errors
/// Channels that are numbers in one and colours in the other; values of `missing` for channels that neither has, that
/// both have, or of the wrong type.
pub(in crate::nodes::surface) fn pairs(
    a: &Material,
    b: &Material,
    inputs_of: [&str; 2],
    inputs: &Inputs<'_>,
) -> Result<BTreeMap<String, [Field; 2]>, Failure> {
    let names: BTreeSet<&String> = a.channels.keys().chain(b.channels.keys()).collect();
    let stated = stated(inputs, a, b, &names)?;
    let pair = |name: &&String| {
        let [of_a, of_b] = [a, b].map(|material| material.channels.get(*name));
        let width = of_a.or(of_b).map_or(1, Field::width);
        let or_default = |field: Option<&Field>| {
            let stated = field.or(stated.get(*name)).cloned();
            stated.unwrap_or_else(|| default_of(name, width))
        };
        let pair = [or_default(of_a), or_default(of_b)];
        if pair[0].width() != pair[1].width() {
            let [a, b] = [&pair[0], &pair[1]].map(described);
            let [of_a, of_b] = inputs_of;
            let message = format!("the channel `{name}` is {a} in `{of_a}` and {b} in `{of_b}`");
            let hint = "make both alike, or give one of them another name";
            return Err(Failure::new(message).with_hint(hint));
        }
        Ok(((*name).clone(), pair))
    };
    names.iter().map(pair).collect()
}

fn described(field: &Field) -> &'static str {
    match field.width() {
        1 => "a number",
        _ => "a colour",
    }
}

/// The values that the recipe states for what a material lacks.
fn stated(
    inputs: &Inputs<'_>,
    a: &Material,
    b: &Material,
    names: &BTreeSet<&String>,
) -> Result<BTreeMap<String, Field>, Failure> {
    let mut stated = BTreeMap::new();
    if inputs.get("missing").is_none() {
        return Ok(stated);
    }
    for (name, value) in inputs.channels("missing") {
        let refuse = |message: String| Failure::of_input("missing", message);
        if !names.contains(name) {
            let near = nearest(name, names.iter().map(|name| name.as_str()));
            let hint = match near.first() {
                Some(near) => format!("did you mean `{near}`?"),
                None => "remove it".to_owned(),
            };
            return Err(refuse(format!("neither material has a channel `{name}`")).with_hint(hint));
        }
        if [a, b]
            .iter()
            .all(|material| material.channels.contains_key(name))
        {
            let message = format!("both materials have the channel `{name}`");
            return Err(refuse(message).with_hint("remove it"));
        }
        let field = field_of(value).ok_or_else(|| refuse(format!("`{name}` has no value")))?;
        stated.insert(name.clone(), field);
    }
    Ok(stated)
}

/// Blends unit vectors without sign. Columns in: three of `a`, three of `b`, share of `b`.
#[derive(Debug)]
pub(in crate::nodes::surface) struct Axes;

impl Kernel for Axes {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("blend axes").whole(i64::from(super::KIND.version));
    }

    fn width(&self) -> usize {
        3
    }

    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for index in 0..block.inputs[0].values.len() {
            let columns: [f32; 7] =
                std::array::from_fn(|column| block.inputs[column].values[index]);
            for (output, part) in block.outputs.iter_mut().zip(between(columns)) {
                output[index] = part;
            }
        }
    }
}

/// The unit vector between two axes; that of `a` where nothing lies between.
fn between([ax, ay, az, bx, by, bz, share]: [f32; 7]) -> [f32; 3] {
    let (a, b) = ([ax, ay, az], [bx, by, bz]);
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let side = if dot(a, b) < 0.0 { -1.0 } else { 1.0 };
    let share = share.clamp(0.0, 1.0);
    let mixed = [0, 1, 2].map(|axis| a[axis] * (1.0 - share) + side * b[axis] * share);
    let length = dot(mixed, mixed).sqrt();
    match length > 0.0 {
        true => mixed.map(|part| part / length),
        false => a,
    }
}
