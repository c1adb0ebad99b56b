//! The table of optical properties, of which each stone gets one record by chance.
//!
//! A Phong lobe cos^e around the mirrored direction is about a Blinn lobe cos^(4 e) around the half vector (Lafortune &
//! Willems 1994), which is about a microfacet distribution of width alpha with alpha^2 = 2 / (4 e + 2) (Walter et al. 2007).
//! The roughness of today's renderers is the root of alpha (Burley 2012).

use crate::node::{Failure, Input, Inputs};
use crate::value::{Type, Unit, Value};

/// A record of the table.
pub(super) const OPTICS: &[Input] = &[
    Input::new("colour", Type::Colour, "Diffuse colour of the stone."),
    Input::number("specular", Unit::One, "Strength of Phong's highlight.")
        .default("0.1")
        .range(0.0, 1.0),
    Input::number(
        "exponent",
        Unit::One,
        "Phong's exponent: 1 is dull, 1000 polished.",
    )
    .default("4")
    .range(0.0, 1e6),
    Input::number(
        "roughness",
        Unit::One,
        "Roughness for today's renderers; without it the one that goes with the exponent.",
    )
    .optional()
    .range(0.0, 1.0),
    Input::number(
        "weight",
        Unit::One,
        "How often stones are like this, relative to the others.",
    )
    .default("1")
    .range(0.0, 1e6),
];

/// What a stone looks like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Optics {
    pub(super) colour: [f64; 3],
    pub(super) roughness: f64,
    pub(super) specular: f64,
    pub(super) exponent: f64,
    /// The weights of this record and of those before it.
    up_to: f64,
}

/// The roughness that goes with an exponent of Phong's.
pub(super) fn roughness_of(exponent: f64) -> f64 {
    (2.0 / (4.0 * exponent + 2.0)).sqrt().sqrt()
}

/// The table that input `optics` states.
///
/// # Errors
/// If there is no record, or none with a weight.
pub(super) fn read(inputs: &Inputs<'_>) -> Result<Vec<Optics>, Failure> {
    let mut table = vec![];
    let mut up_to = 0.0;
    for record in inputs.list("optics") {
        let number = |name: &str| record.part(name).and_then(Value::as_number);
        let Some(Value::Colour(colour)) = record.part("colour") else {
            continue;
        };
        let exponent = number("exponent").unwrap_or_default();
        up_to += number("weight").unwrap_or_default();
        table.push(Optics {
            colour: *colour,
            roughness: number("roughness").unwrap_or_else(|| roughness_of(exponent)),
            specular: number("specular").unwrap_or_default(),
            exponent,
            up_to,
        });
    }
    match up_to > 0.0 {
        true => Ok(table),
        false => {
            let failure = Failure::of_input("optics", "no record has a weight");
            Err(failure.with_hint("state at least one, such as `(colour: \"#919691\")`"))
        }
    }
}

/// The record for a share from 0 to 1.
pub(super) fn pick(table: &[Optics], share: f64) -> usize {
    let all = table.last().map_or(0.0, |last| last.up_to);
    let index = table.partition_point(|record| record.up_to <= share * all);
    index.min(table.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dull_and_polished_stones_have_the_roughness_of_their_highlights() {
        assert_eq!(roughness_of(0.0), 1.0);
        // alpha = sqrt(2 / 18) = 1/3.
        assert!((roughness_of(4.0) - (1.0f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!(roughness_of(1000.0) < 0.16);
    }

    #[test]
    fn records_are_picked_by_weight() {
        let record = |up_to| Optics {
            colour: [0.0; 3],
            roughness: 0.5,
            specular: 0.0,
            exponent: 1.0,
            up_to,
        };
        let table = [record(1.0), record(1.0), record(4.0)];
        let picked = [0.0, 0.24, 0.25, 0.999, 1.0].map(|share| pick(&table, share));
        assert_eq!(picked, [0, 0, 2, 2, 2]);
    }
}
