//! `square_packing`: stones of one kind packed into a region, along a direction field.

use super::ground::{self, Ground};
use crate::field::Field;
use crate::geometry::packing::direction::{Directions, power};
use crate::geometry::packing::{Guide, Law, Method, Plan, Start, area_share, bounds, pack};
use crate::geometry::polygon::doubled_area;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::random::Random;
use crate::value::{Domain, Partition, Type, Unit, Value};
use glam::DVec2;
use rayon::prelude::*;
use std::sync::Arc;

/// Packs stones.
pub static KIND: Kind = Kind {
    name: "square_packing",
    version: 4,
    about: "Packs stones into a region: squares, oblong stones, pentagons or hexagons that follow the border or a direction \
            field, without gaps, and fitted to the outline.",
    source: "Miyata, Itoh & Shimada, section 3 (particles); Jakob, Tarini, Panozzo & Sorkine-Hornung 2015 (position_field)",
    inputs: &[
        ground::REGION,
        ground::SIZE,
        ground::PERIOD,
        Input::number(
            "stone",
            Unit::Millimetre,
            "Width of a stone with its joint; of pentagons and hexagons the distance to the next.",
        )
        .range(1e-3, 1e6),
        Input::number("aspect", Unit::One, "Length of a stone over its width.")
            .default("1")
            .range(1.0, 8.0),
        Input::new("corners", Type::Whole, "Corners of a stone: 4, 5 or 6.")
            .default("4")
            .range(4.0, 6.0),
        Input::new(
            "spread",
            Type::Pair(Unit::One),
            "Smallest and largest random factor to the size of each stone.",
        )
        .default("(0.8, 1.2)")
        .range(0.3, 3.0),
        Input::number(
            "scale",
            Unit::One,
            "Factor to the size of stones at each place.",
        )
        .per_point()
        .of(Domain::Plane)
        .default("1")
        .range(LEAST, LARGEST),
        Input::new(
            "direction",
            Type::Vector(Unit::One),
            "The direction that stones follow, as `direction_field` gives it; left out, that of the border, or the x axis where \
             the cells repeat.",
        )
        .per_point()
        .of(Domain::Plane)
        .optional(),
        Input::new(
            "method",
            Type::Choice(&["position_field", "particles"]),
            "position_field: rows that follow the direction, the fewest faults; particles: settling squares, with the faults \
             that they leave.",
        )
        .default("position_field"),
        Input::number(
            "bond",
            Unit::One,
            "How far each row is moved against the one before, in stones: 0.5 is a running bond. For `position_field` and 4 \
             corners.",
        )
        .default("0")
        .range(0.0, 0.5),
        Input::new(
            "force",
            Type::Choice(&["radial", "five_sources"]),
            "For `particles`: the cubics added up along the line between two stones, or each along its own.",
        )
        .default("radial"),
        Input::new(
            "start",
            Type::Choice(&["lattice", "random"]),
            "Where `particles` begin: near the places of a lattice, which follows the direction unless stones are square, or anywhere.",
        )
        .default("lattice"),
        Input::new("steps", Type::Whole, "Most steps that `particles` take.")
            .default("600")
            .range(0.0, 100_000.0),
        Input::new(
            "mend",
            Type::Toggle,
            "Fills empty places and thins out crowded ones; left out, it is done for `position_field` and for oblong stones. \
             Places that no stone reached are filled in any case.",
        )
        .optional(),
        Input::new("seed", Type::Whole, "Another seed gives other stones.").default("0"),
    ],
    outputs: &[Output::new(
        "cells",
        Type::Partition,
        "A cell for each stone, with the attributes `size` (mm), `aspect`, `corners` and `bond`.",
    )],
    example: r#"(nodes: { "example": square_packing(size: (2000, 1500), stone: 100) })"#,
    build,
};

/// Range of the size factor.
const LEAST: f64 = 0.05;
const LARGEST: f64 = 20.0;

/// Most stones.
const MOST: f64 = 4e6;

/// Least area of a region, in stones.
const ROOM: f64 = 0.25;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let ground = Ground::read(inputs)?;
    let shape = Shape::read(inputs)?;
    let spread = spread(inputs)?;
    let method = method(inputs);
    let mends = match inputs.get("mend") {
        Some(_) => inputs.toggle("mend"),
        None => method == Method::PositionField || shape.stone.x > shape.stone.y,
    };
    unused(inputs, method)?;
    let mean = 0.5 * (spread[0] + spread[1]);
    let area = mean * mean * shape.area();
    if let Some(scale) = constant(inputs) {
        few_enough("stone", extent(&ground) / (area * scale * scale))?;
    }
    let guide = guide(inputs, build, &ground, &shape)?;
    limits(&ground, &guide, area)?;
    let plan = Plan {
        region: &ground.region,
        period: ground.period,
        stone: shape.stone,
        corners: shape.corners,
        spread,
        bond: inputs.number("bond"),
        method,
        mends,
        guide: &guide,
        symmetry: shape.symmetry,
    };
    let mut random = Random::new(build.seed, KIND.name, inputs.whole("seed"));
    let mut share = || f64::from(random.share());
    let partition = pack(&plan, &mut share, &mut |fraction| {
        inputs.progress(fraction);
        build.go_on()
    })?;
    checked(partition)
}

/// The range of the sizes.
fn spread(inputs: &Inputs<'_>) -> Result<[f64; 2], Failure> {
    let [low, high] = inputs.pair("spread");
    match low <= high {
        true => Ok([low, high]),
        false => {
            let message = format!("expected the smaller number first, found ({low}, {high})");
            Err(Failure::of_input("spread", message))
        }
    }
}

fn checked(partition: Partition) -> Result<Vec<Value>, Failure> {
    if partition.is_empty() {
        return Err(no_room());
    }
    Ok(vec![Value::Partition(Arc::new(partition))])
}

fn no_room() -> Failure {
    let failure = Failure::of_input("stone", "no stone has room in the region");
    failure.with_hint("take smaller stones, or a larger region")
}

fn method(inputs: &Inputs<'_>) -> Method {
    if inputs.choice("method") != "particles" {
        return Method::PositionField;
    }
    Method::Particles {
        law: match inputs.choice("force") {
            "five_sources" => Law::Sources,
            _ => Law::Radial,
        },
        start: match inputs.choice("start") {
            "random" => Start::Random,
            _ => Start::Lattice,
        },
        steps: usize::try_from(inputs.whole("steps")).unwrap_or_default(),
    }
}

/// Refuses inputs that the method does not look at, unless they say what they say by themselves.
fn unused(inputs: &Inputs<'_>, method: Method) -> Result<(), Failure> {
    let stated = [
        ("force", inputs.choice("force") != "radial"),
        ("start", inputs.choice("start") != "lattice"),
        ("steps", inputs.whole("steps") != 600),
    ];
    let found = match method {
        Method::Particles { .. } if inputs.number("bond") != 0.0 => {
            Some(("bond", "position_field"))
        }
        Method::Particles { .. } => None,
        Method::PositionField => stated
            .iter()
            .find(|stated| stated.1)
            .map(|stated| (stated.0, "particles")),
    };
    match found {
        None => Ok(()),
        Some((input, method)) => {
            let message = format!("there is a `{input}`, but the method is not `{method}`");
            let hint = format!("leave it out, or choose `{method}`");
            Err(Failure::of_input(input, message).with_hint(hint))
        }
    }
}

/// The size factor, if it is one for all places.
fn constant(inputs: &Inputs<'_>) -> Option<f64> {
    let field = inputs.field("scale");
    let scale = f64::from(*field.as_constant()?.first()?);
    Some(scale.clamp(LEAST, LARGEST))
}

/// Refuses more stones than there may be.
fn few_enough(input: &'static str, count: f64) -> Result<(), Failure> {
    if count <= MOST {
        return Ok(());
    }
    let message = format!("expected at most {MOST} stones, found about {count:.0}");
    Err(Failure::of_input(input, message).with_hint("take larger stones, or a smaller region"))
}

/// Refuses more stones than there may be, also of the smallest if these were everywhere, for work is divided as finely; and
/// regions without room for one. `area` is that of a stone of size 1, in mm².
fn limits(ground: &Ground, guide: &Guide, area: f64) -> Result<(), Failure> {
    few_enough("stone", extent(ground) * guide.density() / area)?;
    let least = guide.least();
    few_enough("scale", extent(ground) / (area * least * least))?;
    let doubled: f64 = ground.region.rings().map(doubled_area).sum();
    if 0.5 * doubled * guide.density() < ROOM * area {
        return Err(no_room());
    }
    Ok(())
}

/// Area of the rectangle around the ground, in mm².
fn extent(ground: &Ground) -> f64 {
    let [low, high] = bounds(&ground.region);
    (high - low).element_product()
}

/// What a stone is like.
struct Shape {
    stone: DVec2,
    corners: u32,
    /// In how many parts of a turn it looks the same.
    symmetry: u32,
}

impl Shape {
    fn read(inputs: &Inputs<'_>) -> Result<Shape, Failure> {
        let (width, aspect) = (inputs.number("stone"), inputs.number("aspect"));
        let corners = inputs.whole("corners") as u32;
        if corners != 4 && aspect != 1.0 {
            let failure = Failure::of_input("aspect", "only stones with 4 corners can be oblong");
            return Err(failure.with_hint("leave out `aspect` or `corners`"));
        }
        if corners != 4 && inputs.number("bond") != 0.0 {
            let failure = Failure::of_input("bond", "only stones with 4 corners have a bond");
            return Err(failure.with_hint("leave out `bond` or `corners`"));
        }
        let is_oblong = aspect != 1.0 || inputs.number("bond") != 0.0;
        Ok(Shape {
            stone: DVec2::new(aspect * width, width),
            corners,
            symmetry: match corners {
                6 => 6,
                4 if is_oblong => 2,
                _ => 4,
            },
        })
    }
}

impl Shape {
    /// Area of a stone of size 1, in mm².
    fn area(&self) -> f64 {
        self.stone.element_product() * area_share(self.corners)
    }
}

/// Direction and size at every place.
fn guide(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    ground: &Ground,
    shape: &Shape,
) -> Result<Guide, Failure> {
    let bounds = bounds(&ground.region);
    let (points, columns) = Guide::points(bounds, shape.stone.y);
    let turned = turned(inputs, build, ground, shape.symmetry, &points)?;
    let scales = inputs.sample("scale", build, &points)?;
    let scales: Vec<f64> = scales[0].iter().map(|scale| f64::from(*scale)).collect();
    if scales.iter().all(|scale| *scale <= 0.0) {
        return Err(Failure::of_input(
            "scale",
            "stones would have no size: the factor is nowhere above 0",
        ));
    }
    let scales: Vec<f64> = scales
        .into_iter()
        .map(|scale| scale.clamp(LEAST, LARGEST))
        .collect();
    Ok(Guide::new(
        bounds,
        columns,
        shape.symmetry,
        &turned,
        &scales,
    ))
}

/// The directions at points, turned as often as the symmetry says.
fn turned(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    ground: &Ground,
    symmetry: u32,
    points: &[DVec2],
) -> Result<Vec<DVec2>, Failure> {
    let field: Option<Field> = inputs.optional_field("direction");
    match (field, ground.period) {
        (Some(field), _) => {
            let columns = build.sample_finite("direction", &field, points)?;
            if columns[..2].iter().flatten().all(|part| *part == 0.0) {
                let message = "the direction has no length in the plane anywhere";
                return Err(Failure::of_input("direction", message)
                    .with_hint("state x and y, such as `(1, 0, 0)`, or link a `direction_field`"));
            }
            let parts = columns[0].par_iter().zip(&columns[1]);
            let turned = parts.map(|(x, y)| {
                let vector = DVec2::new(f64::from(*x), f64::from(*y));
                power(vector.try_normalize().unwrap_or(DVec2::X), symmetry)
            });
            Ok(turned.collect())
        }
        (None, Some(_)) => Ok(vec![DVec2::X; points.len()]),
        (None, None) => {
            let directions = Directions::of_border(&ground.region, symmetry);
            let rows = points.par_chunks(1024).map(|points| {
                build.go_on()?;
                Ok(points
                    .iter()
                    .map(|point| directions.at(*point).sum)
                    .collect())
            });
            let rows: Result<Vec<Vec<DVec2>>, Failure> = rows.collect();
            rows.map(|rows| rows.concat())
        }
    }
}
