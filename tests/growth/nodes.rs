//! The three kinds, built as the engine builds them.

use super::{grow_at, settings};
use glam::DVec3;
use std::sync::Arc;
use yosegi::field::{Program, RunContext, Samples, Scratch};
use yosegi::node::{Build, Failure, Inputs, Kind};
use yosegi::nodes::wood::{growth::GrowthModel, growth_field, skeleton, skeleton_from_file};
use yosegi::value::{Branch, Domain, FileContents, Skeleton, Tangents, Thickness, Value};

/// Builds a node of `kind` from the inputs given by name.
fn build(kind: &'static Kind, inputs: Vec<(&str, Value)>) -> Result<Vec<Value>, Failure> {
    let mut values = vec![None; kind.inputs.len()];
    for (name, value) in inputs {
        values[kind.input(name).unwrap().0] = Some(value);
    }
    let node = Arc::from("test");
    (kind.build)(
        &Inputs::new(kind, &values),
        &Build {
            node: &node,
            seed: 0,
            cancel: None,
        },
    )
}

fn skeleton_of(values: Vec<Value>) -> Arc<Skeleton> {
    match &values[..] {
        [Value::Skeleton(skeleton)] => Arc::clone(skeleton),
        other => panic!("expected a skeleton, found {other:?}"),
    }
}

pub(super) fn skeleton_from_file(
    pith: &[u8],
    knots: Option<&[u8]>,
    every: i64,
) -> Result<Arc<Skeleton>, Failure> {
    let file = |bytes: &[u8]| {
        Value::File(FileContents {
            path: "log.json".into(),
            bytes: bytes.into(),
        })
    };
    let mut inputs = vec![
        ("pith", file(pith)),
        ("tangents", Value::Choice("natural")),
        ("every", Value::Whole(every)),
    ];
    inputs.extend(knots.map(|knots| ("knots", file(knots))));
    Ok(skeleton_of(build(&skeleton_from_file::KIND, inputs)?))
}

fn branch(parts: &[(&'static str, f64)], direction: DVec3) -> Value {
    let numbers = parts
        .iter()
        .map(|(name, number)| (*name, Value::Number(*number)));
    Value::Record(
        numbers
            .chain([("direction", Value::Vector(direction))])
            .collect(),
    )
}

fn literal_skeleton(
    branches: Vec<Value>,
    tangents: &'static str,
) -> Result<Arc<Skeleton>, Failure> {
    let nodes = [(0.0, 0.0, 0.0), (12.0, 4.0, 900.0), (-6.0, 9.0, 2100.0)];
    let trunk = nodes.map(|node| Value::Vector(DVec3::from(node))).to_vec();
    let inputs = vec![
        ("trunk", Value::List(trunk)),
        ("branches", Value::List(branches)),
        ("tangents", Value::Choice(tangents)),
    ];
    Ok(skeleton_of(build(&skeleton::KIND, inputs)?))
}

#[test]
fn literals_become_a_skeleton() {
    let direction = DVec3::new(3.0, 0.0, 4.0);
    let branches = vec![
        branch(&[("at", 1200.0), ("thickening", 0.4)], direction),
        branch(
            &[("at", 1600.0), ("half_width", 9.0), ("at_distance", 150.0)],
            direction,
        ),
    ];
    let skeleton = literal_skeleton(branches, "local").unwrap();
    let half_width = Thickness::HalfWidth {
        distance: 150.0,
        half_width: 9.0,
    };
    let expected = |height, thickness| Branch {
        height,
        direction: DVec3::new(0.6, 0.0, 0.8),
        thickness,
        length: None,
    };
    assert_eq!(skeleton.trunk.len(), 3);
    assert_eq!(skeleton.tangents, Tangents::Local);
    assert_eq!(skeleton.branches[0].thickness, Thickness::Speed(0.4));
    assert_eq!(skeleton.branches[1].thickness, half_width);
    let difference = skeleton.branches[0].direction - expected(0.0, half_width).direction;
    assert!(difference.length() < 1e-15);
}

#[test]
fn wrong_branches_are_named_with_the_reason() {
    let good = || branch(&[("at", 1200.0), ("thickening", 0.4)], DVec3::X);
    let refused = |wrong: Value| {
        let failure = literal_skeleton(vec![good(), wrong], "natural").unwrap_err();
        assert_eq!(failure.input, Some("branches"));
        failure.message
    };
    let either = "branch 2: expected either `thickening` or `half_width` with `at_distance`";
    assert_eq!(refused(branch(&[("at", 1.0)], DVec3::X)), either);
    assert_eq!(
        refused(branch(&[("at", 1.0), ("half_width", 2.0)], DVec3::X)),
        either
    );
    let all = [
        ("at", 1.0),
        ("thickening", 0.4),
        ("half_width", 2.0),
        ("at_distance", 9.0),
    ];
    assert_eq!(refused(branch(&all, DVec3::X)), either);
    assert_eq!(
        refused(branch(&[("at", 2101.0), ("thickening", 0.4)], DVec3::X)),
        "branch 2: expected `at` between 0 and 2100 mm, found 2101"
    );
    assert_eq!(
        refused(branch(&[("at", 1.0), ("thickening", 0.4)], DVec3::ZERO)),
        "branch 2: expected a `direction`, found a vector of length 0"
    );
}

fn growth_field(skeleton: &Arc<Skeleton>) -> Result<Vec<Value>, Failure> {
    let inputs = vec![
        ("skeleton", Value::Skeleton(Arc::clone(skeleton))),
        ("elongation", Value::Number(420.0)),
        ("thickening", Value::Number(2.4)),
        ("sharpness", Value::Number(2.0)),
    ];
    build(&growth_field::KIND, inputs)
}

#[test]
fn the_fields_are_solid_and_share_one_kernel() {
    let skeleton = Arc::new(super::tree());
    let fields = growth_field(&skeleton).unwrap();
    let [
        Value::Field(time),
        Value::Field(share),
        Value::Field(inside),
    ] = &fields[..]
    else {
        panic!("expected three fields")
    };
    assert_eq!(inside.as_constant(), Some(&[1.0][..]), "no age, no bark");
    assert_eq!(
        (time.domain(), share.domain()),
        (Domain::Solid, Domain::Solid)
    );
    assert_eq!((time.width(), share.width()), (1, 1));
    let program = Program::compile(&[time.clone(), share.clone()]);
    assert_eq!(program.length(), 1);
    let points = [[50.0, 20.0, 800.0], [-30.0, 60.0, 1250.0]];
    let mut scratch = Scratch::default();
    let context = RunContext {
        level: fearless_simd::Level::new(),
        cache: None,
        filtering: true,
        cancel: None,
    };
    program.run(&Samples::Points(&points), &mut scratch, &context);
    let model = GrowthModel::new(&skeleton, settings(2.0)).unwrap();
    let expected = grow_at(&model, &points.map(DVec3::from));
    assert_eq!(program.output(&scratch, 0, 0)[..2], expected.time);
    assert_eq!(program.output(&scratch, 1, 0)[..2], expected.branch);
}

#[test]
fn a_thickness_that_cannot_be_reached_names_the_branch() {
    let mut skeleton = super::tree();
    // Straight up along the trunk: the wood of the trunk is always there first.
    skeleton.branches[1].direction = DVec3::Z;
    skeleton.branches[1].thickness = Thickness::HalfWidth {
        distance: 50.0,
        half_width: 3.0,
    };
    skeleton
        .trunk
        .iter_mut()
        .for_each(|node| (node.x, node.y) = (0.0, 0.0));
    let failure = growth_field(&Arc::new(skeleton)).unwrap_err();
    assert_eq!(failure.input, Some("skeleton"));
    assert!(
        failure
            .message
            .starts_with("branch 2: the trunk's wood is there"),
        "{}",
        failure.message
    );
}
