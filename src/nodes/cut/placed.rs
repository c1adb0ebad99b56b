//! What all cuts have in common: where they are placed in the solid, and how a piece is made of positions.

use crate::field::Field;
use crate::node::{Failure, Input, Inputs};
use crate::nodes::field::placement::{MOVE, PIVOT, Placement, SCALE, TURN};
use crate::value::{Domain, Material, Type, Value};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Where the whole cut is put.
pub(super) const PLACED: Input = Input::new(
    "placed",
    Type::Record(PARTS),
    "Moves, turns and scales the whole cut in the solid; parts that are left out change nothing.",
)
.optional();

const PARTS: &[Input] = &[as_part(MOVE), as_part(TURN), as_part(SCALE), as_part(PIVOT)];

const fn as_part(input: Input) -> Input {
    input.optional()
}

/// Where the points of the cut are in the solid.
///
/// # Errors
/// Factors near 0.
pub(super) fn placed(inputs: &Inputs<'_>) -> Result<DAffine3, Failure> {
    let Some(Value::Record(parts)) = inputs.get("placed") else {
        return Ok(DAffine3::IDENTITY);
    };
    let part = |name: &str, otherwise: DVec3| {
        let found = parts.iter().find(|(part, _)| *part == name);
        match found {
            Some((_, Value::Vector(vector))) => *vector,
            _ => otherwise,
        }
    };
    let none = DVec3::ZERO;
    let parts = [
        part("move", none),
        part("turn", none),
        part("scale", DVec3::ONE),
        part("pivot", none),
    ];
    let placement = Placement::of(parts, Domain::Solid);
    Ok(placement
        .map_err(|failure| Failure {
            input: Some("placed"),
            ..failure
        })?
        .affine())
}

/// Two directions of length 1 at right angles in the plane that `across` and `along` span; `blamed` is the input at fault if
/// they span none.
///
/// # Errors
/// If `across` has no length, or both point the same way.
pub(in crate::nodes) fn spanned(
    across: DVec3,
    along: DVec3,
    blamed: &'static str,
) -> Result<[DVec3; 2], Failure> {
    let Some(across) = across.try_normalize() else {
        let message = "the direction `across` has no length";
        return Err(Failure::of_input("across", message));
    };
    let rejected = along - across * across.dot(along);
    if rejected.length() <= 1e-6 * along.length() {
        let message = "`along` points the same way as `across`, so they span no plane";
        return Err(Failure::of_input(blamed, message)
            .with_hint("choose `along` at a right angle to `across`"));
    }
    Ok([across, rejected.normalize()])
}

/// The piece that shows the solid at `position`, `size` mm large.
pub(super) fn piece(solid: &Material, position: &Field, size: [f64; 2]) -> Value {
    let channels = solid.channels.iter();
    let channels = channels.map(|(name, field)| (name.clone(), field.at(position)));
    Value::Material(Arc::new(Material {
        domain: Domain::Plane,
        channels: channels.collect(),
        size: Some(size),
        surface: None,
    }))
}
