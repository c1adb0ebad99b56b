//! `split_cells`: boards, bricks, setts and hexagons in the patterns that they are laid in.
//!
//! Each pattern is laid over more than what is divided, in its own coordinates with the first axis along the
//! boards, and then cut off at the outline. In a plane that repeats it is stretched so that whole cells close.

mod fan;
mod ground;
mod hexagons;
mod recursive;
mod rows;
mod woven;

use super::division::{MERGE_BELOW, Pieces, Plot, WITHIN, covered, divided};
use super::ground::{PERIOD, REGION, SIZE};
use crate::geometry::assemble::{Piece, Ring};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, stretched};
use crate::nodes::random::Random;
use crate::value::{Type, Unit, Value};
use glam::DVec2;
use ground::{Axes, Laid, Tile, Window};
use std::sync::Arc;

/// Cells in patterns.
pub static KIND: Kind = Kind {
    name: "split_cells",
    version: 2,
    about: "Divides a region, a rectangle, a plane that repeats, or each cell of a partition as boards, bricks and setts are \
            laid: in rows, as herringbone, basket, chevron or fan, in hexagons, or again and again in two.",
    source: "own construction after the patterns of pavers and floor layers; `recursive`: hierarchical splits with \
             T-junctions, after Bohn, Pauchard & Couder 2005",
    inputs: &[
        REGION,
        SIZE,
        PERIOD,
        WITHIN,
        Input::new("pattern", Type::Choice(&PATTERNS), "How the cells are laid."),
        Input::number(
            "length",
            Unit::Millimetre,
            "Length of a board, along the first axis; of a sett along its arc; of `hexagons` and `recursive` nothing.",
        )
        .optional()
        .range(1e-4, 1e8),
        Input::number(
            "width",
            Unit::Millimetre,
            "Width of a board; of a hexagon from flat to flat; of `recursive` the side of a square as large as a mean cell.",
        )
        .range(1e-4, 1e8),
        Input::new(
            "lengths",
            Type::Pair(Unit::One),
            "In `rows`, the length of each board is drawn from this range of shares of `length`.",
        )
        .default("(1, 1)")
        .range(0.05, 20.0),
        Input::new(
            "widths",
            Type::Pair(Unit::One),
            "In `rows`, the width of each row is drawn from this range of shares of `width`.",
        )
        .default("(1, 1)")
        .range(0.05, 20.0),
        Input::new(
            "bond",
            Type::Choice(&rows::BONDS),
            "In `rows`, how each is moved against the last: by half a board, by a third, not at all, or at random.",
        )
        .default("running"),
        Input::number("slope", Unit::Degree, "In `chevron`, the angle of the boards with the first axis.")
            .default("45")
            .range(10.0, 80.0),
        Input::number("lane", Unit::Millimetre, "In `fan`, how far apart the ends of an arc are; without it, twelve setts.")
            .optional()
            .range(1e-4, 1e8),
        Input::number("rise", Unit::One, "In `fan`, how high the arcs are, as a share of `lane`.")
            .default("0.2")
            .range(0.01, 0.4),
        Input::new(
            "position",
            Type::Pair(Unit::One),
            "In `recursive`, the range in which a cell is split across, as a share of its extent.",
        )
        .default("(0.35, 0.65)")
        .range(0.05, 0.95),
        Input::number("turn", Unit::Degree, "In `recursive`, how far a split is turned at random to either side.")
            .default("0")
            .range(0.0, 40.0),
        Input::number("angle", Unit::Degree, "Turns the pattern; in a plane that repeats by whole right angles.")
            .default("0")
            .range(-360.0, 360.0),
        Input::new("offset", Type::Pair(Unit::Millimetre), "Moves the pattern along its own axes.")
            .default("(0, 0)")
            .range(-1e8, 1e8),
        MERGE_BELOW.default("0.02"),
        Input::new("seed", Type::Whole, "Other random lengths and splits.").default("0"),
    ],
    outputs: &[Output::new(
        "cells",
        Type::Partition,
        "The cells, whose own first axis is that of the board. Attributes: `length` of the board before it is cut; `row` and \
         `column`, where in the pattern it is; of `recursive` `depth`, how many splits it comes from.",
    )],
    example: "(nodes: { \"example\": split_cells(size: (400, 300), pattern: \"herringbone\", length: 60, width: 15, angle: 45) })",
    build,
};

const PATTERNS: [&str; 9] = [
    "rows",
    "grid",
    "herringbone",
    "double_herringbone",
    "basket",
    "chevron",
    "fan",
    "hexagons",
    "recursive",
];

/// Most cells.
const MOST: f64 = 4e6;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let plots = Plot::all(inputs)?;
    check_count(inputs, &plots)?;
    let random = Random::new(build.seed, KIND.name, inputs.whole("seed"));
    let laid = |plot: &Plot| {
        let stream = random.of_item(plot.parent.unwrap_or_default());
        let axes = axes(inputs, plot)?;
        let window = Window::new(plot, &axes);
        let laid = lay(inputs, plot, &window, stream, &mut || build.go_on())?;
        Ok((laid.stretch, placed(laid, &axes)))
    };
    let cells = match &plots[..] {
        [ground] if ground.parent.is_none() => {
            let (stretch, pieces) = laid(ground)?;
            let cells = covered(inputs, build, ground, pieces)?;
            warn_of_stretch(inputs, stretch);
            cells
        }
        _ => divided(inputs, build, &plots, &|plot| Ok(laid(plot)?.1))?,
    };
    Ok(vec![Value::Partition(Arc::new(cells))])
}

/// Says by how much the pattern was stretched.
fn warn_of_stretch(inputs: &Inputs<'_>, stretch: DVec2) {
    let factors = [
        (stretch.x, ["longer", "shorter"]),
        (stretch.y, ["wider", "narrower"]),
    ];
    let said = stretched(&factors, 2);
    if !said.is_empty() {
        inputs.warn(format!("the pattern was made {said}, so that it closes"));
    }
}

/// Where the pattern begins and how it is turned.
fn axes(inputs: &Inputs<'_>, plot: &Plot) -> Result<Axes, Failure> {
    let angle = inputs.number("angle");
    let quarters = angle / 90.0;
    let along = if quarters == quarters.round() {
        [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y][(quarters as i64).rem_euclid(4) as usize]
    } else if plot.period.is_some() {
        let message = format!("a pattern turned by {angle} degrees does not repeat");
        return Err(
            Failure::of_input("angle", message).with_hint("turn it by 0, 90, 180 or 270 degrees")
        );
    } else {
        let angle = angle.to_radians();
        DVec2::new(libm::cos(angle), libm::sin(angle))
    };
    let along = plot.frame.rotate(along);
    let offset = DVec2::from_array(inputs.pair("offset"));
    Ok(Axes {
        origin: plot.origin + along * offset.x + along.perp() * offset.y,
        along,
    })
}

/// Length and width of a board.
///
/// # Errors
/// If the pattern needs a length, or there would be too many boards in the window.
fn board(inputs: &Inputs<'_>, window: &Window) -> Result<DVec2, Failure> {
    let pattern = inputs.choice("pattern");
    let width = inputs.number("width");
    let is_square = matches!(pattern, "hexagons" | "recursive");
    let length = match inputs.get("length") {
        Some(_) => inputs.number("length"),
        None if is_square => width,
        None => {
            return Err(Failure::new(format!("`{pattern}` needs a `length`"))
                .with_hint("state the `length` of a board"));
        }
    };
    let size = window.high - window.low;
    if size.x * size.y / (length * width) > MOST {
        let message = format!("expected at most {MOST} cells, found more");
        return Err(Failure::of_input("width", message).with_hint("choose larger cells"));
    }
    Ok(DVec2::new(length, width))
}

/// Refuses more boards than one partition may have, over all plots.
fn check_count(inputs: &Inputs<'_>, plots: &[Plot]) -> Result<(), Failure> {
    let width = inputs.number("width");
    let length = inputs
        .get("length")
        .map_or(width, |_| inputs.number("length"));
    let area: f64 = plots.iter().map(Plot::area).sum();
    let count = area / (length * width);
    if count <= MOST {
        return Ok(());
    }
    let message = format!("expected at most {MOST} cells, found about {count:.0}");
    Err(Failure::of_input("width", message).with_hint("choose larger cells"))
}

/// Lays the pattern over a window.
fn lay(
    inputs: &Inputs<'_>,
    plot: &Plot,
    window: &Window,
    random: Random,
    go_on: &mut dyn FnMut() -> Result<(), Failure>,
) -> Result<Laid, Failure> {
    let board = board(inputs, window)?;
    match inputs.choice("pattern") {
        "rows" => rows::lay(window, board, rows::Rows::read(inputs)?, random, go_on),
        "grid" => rows::lay(window, board, rows::Rows::grid(), random, go_on),
        "herringbone" => woven::herringbone(window, board, 1),
        "double_herringbone" => woven::herringbone(window, board, 2),
        "basket" => woven::basket(window, board),
        "chevron" => {
            let slope = inputs.number("slope").to_radians();
            Ok(woven::chevron(window, board, slope))
        }
        "fan" => {
            let lane = inputs.get("lane");
            let lane = lane.map_or(12.0 * board.x, |_| inputs.number("lane"));
            fan::lay(window, board, lane, inputs.number("rise"), plot)
        }
        "hexagons" => Ok(hexagons::lay(window, board.y)),
        _ => {
            let splits = recursive::Splits::read(inputs)?;
            recursive::lay(plot, window, splits, random, go_on)
        }
    }
}

/// The tiles in the plane.
fn placed(laid: Laid, axes: &Axes) -> Pieces {
    let mut pieces = Pieces::default();
    for (id, tile) in (0..).zip(laid.tiles) {
        let Tile {
            corners,
            bulges,
            along,
            values,
        } = tile;
        let corners = corners.into_iter().map(|at| axes.place(at)).collect();
        pieces.pieces.push(Piece {
            rings: vec![Ring { corners, bulges }],
            id,
            frame: axes.along.rotate(along),
            centre: None,
        });
        for (name, value) in values {
            pieces.values.entry(name).or_default().push(value);
        }
    }
    pieces.fit = laid.fit;
    pieces
}
