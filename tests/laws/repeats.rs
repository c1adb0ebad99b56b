//! The law of kinds that repeat on request: those with an input `period`.

use super::*;

/// Whole millimetres, so that points a period further are exact; examples have sizes that fit.
const PERIOD: f64 = 100.0;

/// The literal of an input `period` that asks for [`PERIOD`] along every axis.
fn literal(kind: &Kind) -> Option<String> {
    let (_, input) = kind.input("period")?;
    Some(match input.value_type {
        Type::Vector(_) => format!("({PERIOD}, {PERIOD}, {PERIOD})"),
        Type::Pair(_) => format!("({PERIOD}, {PERIOD})"),
        Type::Number(_) => format!("{PERIOD}"),
        other => panic!("`{}`: a period is a length, not {other}", kind.name),
    })
}

/// The example with a period.
fn with_period(kind: &Kind, literal: &str) -> String {
    let head = format!("\"example\": {}(", kind.name);
    assert!(kind.example.contains(&head), "no `{head}` in its example");
    kind.example
        .replace(&head, &format!("{head}period: {literal}, "))
}

#[test]
fn what_has_a_period_repeats_to_the_bit() {
    let workshop = workshop();
    let mut found = 0;
    for kind in KINDS
        .iter()
        .filter(|kind| kind.repeats() && !kind.is_structure())
    {
        let literal = literal(kind).unwrap();
        let plain = fields(&workshop, kind, &loaded(kind, kind.example));
        let repeating = fields(&workshop, kind, &loaded(kind, &with_period(kind, &literal)));
        // Eighths of a millimetre stay what they are when periods are added.
        let points: Vec<[f64; 3]> = points(&repeating)
            .into_iter()
            .map(|point| point.map(|part| (8.0 * part).round() / 8.0))
            .collect();
        let values = |fields: &[SampledField], axis: usize, shift: f64| {
            let shifted = points.iter().map(|point| {
                let mut point = *point;
                point[axis] += shift;
                point
            });
            bits(&workshop.engine.sample(fields, &shifted.collect::<Vec<_>>()))
        };
        let axes = match common_domain(repeating.iter().map(|sampled| &sampled.field)) {
            Domain::Plane => 2,
            _ => 3,
        };
        for axis in 0..axes {
            let here = values(&repeating, axis, 0.0);
            for shift in [PERIOD, -3.0 * PERIOD] {
                assert!(
                    values(&repeating, axis, shift) == here,
                    "`{}` along axis {axis}",
                    kind.name
                );
            }
            assert!(
                values(&repeating, axis, 0.5 * PERIOD) != here,
                "`{}` repeats too soon",
                kind.name
            );
            assert!(
                values(&plain, axis, PERIOD) != values(&plain, axis, 0.0),
                "`{}` repeats unasked",
                kind.name
            );
        }
        found += 1;
    }
    assert!(found >= 2);
}
