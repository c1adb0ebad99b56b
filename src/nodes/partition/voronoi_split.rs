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
//! makes cells alike in size and round.

mod seeds;

use super::division::{MERGE_BELOW, Pieces, Plot, WITHIN, divided, join_slivers, warn_of_joined};
use super::ground::{PERIOD, REGION, SIZE};
use crate::geometry::assemble::{Piece, assemble, pieces_of};
use crate::geometry::voronoi::{Bounds, power_cells, voronoi};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::random::Random;
use crate::value::{Partition, Type, Unit, Value};
use seeds::{Layout, Seeds};
use std::sync::Arc;

/// Cells around seeds.
pub static KIND: Kind = Kind {
    name: "voronoi_split",
    version: 1,
    about: "Divides a region, a rectangle, a plane that repeats, or each cell of a partition into the cells of seeds: each \
            holds what is nearest to its seed.",
    source: "Voronoi cells from the Delaunay triangulation; power cells: Aurenhammer 1987; relaxation: Lloyd 1982",
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
}

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let layout = Layout::read(inputs)?;
    let plots = Plot::all(inputs)?;
    let random = Random::new(build.seed, KIND.name, inputs.whole("seed"));
    let mut cells = match &plots[..] {
        [ground] if ground.parent.is_none() => {
            let seeds = layout.seeds(ground, random.of_item(0))?;
            warn_of_size(inputs, &seeds);
            let split = split(ground, seeds, &layout, build)?;
            warn_of_lost(inputs, split.lost);
            if ground.is_rectangle() && !split.cells.is_empty() {
                let (cells, joined) = join_slivers(split.cells, inputs.number("merge_below"));
                warn_of_joined(inputs, joined);
                cells
            } else {
                divided(inputs, build, &plots, &|_| Ok(pieces(&split.cells)))?
            }
        }
        _ => divided(inputs, build, &plots, &|plot| {
            let stream = random.of_item(plot.parent.unwrap_or_default());
            let split = split(plot, layout.seeds(plot, stream)?, &layout, build)?;
            Ok(pieces(&split.cells))
        })?,
    };
    let sizes = cells.areas.iter().map(|area| area.sqrt()).collect();
    cells.attributes.insert("size".to_owned(), sizes);
    Ok(vec![Value::Partition(Arc::new(cells))])
}

/// The cells as pieces, whose centres are to be those of what is left of them.
fn pieces(cells: &Partition) -> Pieces {
    let mut pieces = pieces_of(cells);
    pieces.iter_mut().for_each(|piece| piece.centre = None);
    Pieces {
        pieces,
        ..Pieces::default()
    }
}

/// The cells of seeds in the rectangle around a plot, after relaxation.
fn split(plot: &Plot, seeds: Seeds, layout: &Layout, build: &Build<'_>) -> Result<Split, Failure> {
    let mut seeds = seeds;
    for _ in 0..layout.relax {
        let split = cells_of(plot, &seeds, build)?;
        let last = split.cells.ids.last().copied().unwrap_or_default();
        let inside = match plot.is_rectangle() {
            true => split.cells,
            false => {
                let clipped = plot.clip(pieces(&split.cells));
                assemble(clipped.pieces, plot.period, plot.tolerance())
            }
        };
        // Parts that were cut off have ids behind those of the seeds with cells.
        for (id, centre) in inside.ids.iter().zip(&inside.centres) {
            if *id <= last {
                seeds.places[*id as usize] = *centre;
            }
        }
    }
    cells_of(plot, &seeds, build)
}

/// The cells of seeds in the rectangle around a plot.
fn cells_of(plot: &Plot, seeds: &Seeds, build: &Build<'_>) -> Result<Split, Failure> {
    let [low, high] = plot.bounds();
    let bounds = Bounds {
        low,
        high,
        repeats: plot.period.is_some(),
    };
    let mut go_on = || build.go_on();
    if seeds.weights.is_empty() {
        let found = voronoi(&seeds.places, bounds, &mut go_on)?;
        return Ok(match found {
            Some(found) => Split {
                lost: [found.equal, found.outside, 0],
                cells: found.partition,
            },
            None => Split {
                cells: Partition::default(),
                lost: [0, seeds.places.len(), 0],
            },
        });
    }
    let pieces: Vec<Piece> = power_cells(&seeds.places, &seeds.weights, bounds, &mut go_on)?;
    let hidden = seeds.places.len() - pieces.len();
    let cells = assemble(pieces, plot.period, plot.tolerance());
    Ok(Split {
        cells,
        lost: [0, 0, hidden],
    })
}

/// Says by how much the lattice was stretched.
fn warn_of_size(inputs: &Inputs<'_>, seeds: &Seeds) {
    let [x, y] = seeds.stretch.to_array();
    if (x - 1.0).abs().max((y - 1.0).abs()) > 0.01 {
        inputs.warn(format!(
            "the lattice was made {:.1} % wider and {:.1} % higher, so that it closes",
            100.0 * (x - 1.0),
            100.0 * (y - 1.0)
        ));
    }
}

/// Says how many seeds have no cell, and why.
fn warn_of_lost(inputs: &Inputs<'_>, [equal, outside, hidden]: [usize; 3]) {
    if equal > 0 {
        inputs.warn(format!(
            "{equal} seeds lie where others do: of equal ones the first has the cell"
        ));
    }
    if outside > 0 && inputs.get("points").is_some() {
        inputs.warn(format!(
            "{outside} seeds lie so far outside that they have no cell"
        ));
    }
    if hidden > 0 && inputs.get("points").is_some() {
        inputs.warn(format!("{hidden} seeds have no cell beside heavier ones"));
    }
}
