//! `voronoi_split`: cells around seeds, of which each holds what is nearest to its seed.
//!
//! With weights a point x belongs to the seed p with the least power
//!
//! ```text
//! |x - p|^2 - r^2
//! ```
//!
//! which is the square of the length of a tangent to the circle of radius r around the seed (Aurenhammer 1987): seeds with
//! larger circles have larger cells. Relaxation moves each seed to the centre of gravity of its cell (Lloyd 1982), which
//! makes cells alike in size and round; with a density, to the centre of gravity of the density's square, which keeps seeds as
//! dense as it says. With stated areas the weights are those with which each cell has its share.

mod capacity;
mod density;
mod seeds;

use super::division::{
    MERGE_BELOW, Pieces, Plot, WITHIN, assembled, covered, divided, join_slivers, warn_of_joined,
};
use super::ground::{PERIOD, REGION, SIZE};
use crate::geometry::assemble::{Piece, assemble, pieces_of};
use crate::geometry::voronoi::{Bounds, power_cells, voronoi};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output, counted, stretched};
use crate::nodes::random::Random;
use crate::value::{Domain, Partition, Type, Unit, Value};
use density::Density;
use seeds::{Layout, Seeds};
use std::sync::Arc;

/// Cells around seeds.
pub static KIND: Kind = Kind {
    name: "voronoi_split",
    version: 2,
    about: "Divides a region, a rectangle, a plane that repeats, or each cell of a partition into the cells of seeds: each \
            holds what is nearest to its seed.",
    source: "Voronoi cells from the Delaunay triangulation; power cells: Aurenhammer 1987; relaxation: Lloyd 1982; \
             stated areas: Kitagawa, Merigot & Thibert 2019",
    inputs: &[
        REGION,
        SIZE,
        PERIOD,
        WITHIN,
        Input::new(
            "seeds",
            Type::Choice(&seeds::NAMES),
            "Where the seeds are: anywhere; one anywhere in each square; on a lattice of hexagons or squares; or as given.",
        )
        .default("random"),
        Input::new("points", Type::List(&Type::Pair(Unit::Millimetre)), "The seeds, if they are given.")
            .optional()
            .range(-1e9, 1e9),
        Input::number(
            "cell_size",
            Unit::Millimetre,
            "The side of a square as large as a mean cell.",
        )
        .optional()
        .range(1e-6, 1e9),
        Input::new("count", Type::Whole, "Instead: about so many cells.")
            .optional()
            .range(1.0, 4e6),
        Input::number(
            "jitter",
            Unit::One,
            "How far seeds lie off their places. For `jittered`, the share of its square in which a seed may be: 1 if it is not \
             stated. On lattices the standard deviation as a share of a cell's side: 0 if it is not stated, and with 0.26 on \
             hexagons the scales of a lizard.",
        )
        .optional()
        .range(0.0, 1.0),
        Input::new("relax", Type::Whole, "How often each seed moves to the centre of its cell.")
            .default("0")
            .range(0.0, 1000.0),
        Input::new(
            "weights",
            Type::Pair(Unit::One),
            "Radii of circles around seeds, drawn from this range, in halves of `cell_size`: larger ones make larger cells.",
        )
        .optional()
        .range(0.0, 10.0),
        Input::new(
            "radii",
            Type::List(&Type::Number(Unit::Millimetre)),
            "The radius of the circle around each of the `points`, instead of `weights`.",
        )
        .optional()
        .range(0.0, 1e9),
        Input::new(
            "areas",
            Type::Pair(Unit::One),
            "Instead: areas of cells, drawn from this range, in areas of a mean cell. Each cell has its share of the whole.",
        )
        .optional()
        .range(0.01, 100.0),
        Input::number(
            "density",
            Unit::One,
            "How dense seeds are, in any unit: random ones are drawn like that, and relaxation keeps them so.",
        )
        .per_point()
        .of(Domain::Plane)
        .optional()
        .range(0.0, 1e6),
        MERGE_BELOW.default("0.1"),
        Input::new("seed", Type::Whole, "Other seeds, other cells.").default("0"),
    ],
    outputs: &[Output::new(
        "cells",
        Type::Partition,
        "The cells, with the attribute `size`: the side of a square as large.",
    )],
    example: "(nodes: { \"example\": voronoi_split(size: (400, 300), seeds: \"jittered\", cell_size: 50, relax: 2) })",
    build,
};

/// Where a ground's own cells need no cutting.
struct Split {
    cells: Partition,
    /// Seeds at places of others, beyond the ground, and hidden behind heavier ones.
    lost: [usize; 3],
    /// By how much the worst area is off.
    off: f64,
}

/// How far areas may be off, as a share, while seeds move and in the end; and before a warning says so.
const LOOSE: f64 = 0.01;
const CLOSE: f64 = 1e-7;
const OFF: f64 = 1e-4;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let layout = Layout::read(inputs)?;
    let plots = Plot::all(inputs)?;
    layout.check_count(&plots)?;
    let density = Density::read(inputs, build);
    let random = Random::new(build.seed, KIND.name, inputs.whole("seed"));
    let split = |plot: &Plot, seeds: Seeds| split(plot, seeds, &layout, &density, build);
    let mut cells = match &plots[..] {
        [ground] if ground.parent.is_none() => {
            let seeds = layout.seeds(ground, &density, random.of_item(0))?;
            warn_of_size(inputs, &seeds);
            let split = split(ground, seeds)?;
            warn_of_lost(inputs, split.lost);
            warn_of_areas(inputs, split.off);
            if ground.is_rectangle() && !split.cells.is_empty() {
                let share = inputs.number("merge_below");
                let (cells, joined) = join_slivers(split.cells, share, build)?;
                warn_of_joined(inputs, joined);
                cells
            } else {
                covered(inputs, build, ground, pieces(pieces_of(&split.cells)))?
            }
        }
        _ => divided(inputs, build, &plots, &|plot| {
            let stream = random.of_item(plot.parent.unwrap_or_default());
            let split = split(plot, layout.seeds(plot, &density, stream)?)?;
            Ok(pieces(pieces_of(&split.cells)))
        })?,
    };
    let sizes = cells.areas.iter().map(|area| area.sqrt()).collect();
    cells.attributes.insert("size".to_owned(), sizes);
    Ok(vec![Value::Partition(Arc::new(cells))])
}

/// The pieces, whose centres are to be those of what is left of them.
fn pieces(mut pieces: Vec<Piece>) -> Pieces {
    pieces.iter_mut().for_each(|piece| piece.centre = None);
    Pieces {
        pieces,
        ..Pieces::default()
    }
}

/// The cells of seeds in the rectangle around a plot, after relaxation.
fn split(
    plot: &Plot,
    mut seeds: Seeds,
    layout: &Layout,
    density: &Density<'_>,
    build: &Build<'_>,
) -> Result<Split, Failure> {
    for _ in 0..layout.relax {
        let split = cells_of(plot, &mut seeds, LOOSE, build)?;
        let last = split.cells.ids.last().copied().unwrap_or_default();
        let inside = match plot.is_rectangle() {
            true => split.cells,
            false => {
                let clipped = plot.clip(pieces(pieces_of(&split.cells)), build)?;
                assembled(clipped, plot.period, plot.tolerance(), build)?
            }
        };
        // Parts that were cut off have ids behind those of the seeds with cells.
        for (id, middle) in inside.ids.iter().zip(density.middles(&inside)?) {
            if *id <= last {
                seeds.places[*id as usize] = middle;
            }
        }
    }
    cells_of(plot, &mut seeds, CLOSE, build)
}

/// The rectangle around a plot.
fn bounds(plot: &Plot) -> Bounds {
    let [low, high] = plot.bounds();
    Bounds {
        low,
        high,
        repeats: plot.period.is_some(),
    }
}

/// The cells of seeds in the rectangle around a plot, with areas in the ratio of their shares up to `tolerance`.
fn cells_of(
    plot: &Plot,
    seeds: &mut Seeds,
    tolerance: f64,
    build: &Build<'_>,
) -> Result<Split, Failure> {
    let mut off = 0.0;
    if !seeds.shares.is_empty() {
        let found = capacity::weights(plot, &seeds.places, &seeds.shares, tolerance, build)?;
        (seeds.weights, off) = (found.weights, found.off);
    }
    let mut go_on = || build.go_on();
    if seeds.weights.is_empty() {
        let found = voronoi(&seeds.places, bounds(plot), &mut go_on)?;
        return Ok(match found {
            Some(found) => Split {
                lost: [found.equal, found.outside, 0],
                cells: found.partition,
                off,
            },
            None => Split {
                cells: Partition::default(),
                lost: [0, seeds.places.len(), 0],
                off,
            },
        });
    }
    let pieces = power_cells(&seeds.places, &seeds.weights, bounds(plot), &mut go_on)?;
    let hidden = seeds.places.len() - pieces.len();
    let cells = assemble(pieces, plot.period, plot.tolerance(), &mut go_on)?;
    Ok(Split {
        cells,
        lost: [0, 0, hidden],
        off,
    })
}

/// Says by how much the lattice was stretched.
fn warn_of_size(inputs: &Inputs<'_>, seeds: &Seeds) {
    let [x, y] = seeds.stretch.to_array();
    if (x - 1.0).abs().max((y - 1.0).abs()) > 0.01 {
        let said = stretched(&[(x, ["wider", "narrower"]), (y, ["higher", "lower"])], 1);
        inputs.warn(format!("the lattice was made {said}, so that it closes"));
    }
}

/// Says how many seeds have no cell, and why.
fn warn_of_lost(inputs: &Inputs<'_>, [equal, outside, hidden]: [usize; 3]) {
    if equal > 0 {
        let seeds = counted(equal, "seed lies", "seeds lie");
        inputs.warn(format!(
            "{seeds} where others do: of equal ones the first has the cell"
        ));
    }
    if outside > 0 && inputs.get("points").is_some() {
        let seeds = counted(outside, "seed lies", "seeds lie");
        inputs.warn(format!("{seeds} too far outside to have a cell"));
    }
    if hidden > 0 && inputs.get("points").is_some() {
        let seeds = counted(hidden, "seed has", "seeds have");
        inputs.warn(format!("{seeds} no cell beside heavier ones"));
    }
}

/// Says how far areas are off.
fn warn_of_areas(inputs: &Inputs<'_>, off: f64) {
    if off > OFF {
        let percent = 100.0 * off;
        inputs.warn(format!(
            "areas are up to {percent:.2} % off from what they should be"
        ));
    }
}
