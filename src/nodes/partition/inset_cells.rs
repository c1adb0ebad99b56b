//! `inset_cells`: cells with joints between them, and rounded corners.
//!
//! Each edge moves inwards by half of the joint, so stones never overlap. A joint has one width as seen from both sides,
//! unless it differs by the cell. Edges of a cell that lie in one line move together, by the largest of their distances, and in
//! cells with arcs all edges that run on smoothly; an arc keeps its centre, and its radius changes. Cells keep ids, frames,
//! attributes and the neighbours beyond the joint. Of a cell that falls apart the largest part is kept, and a warning
//! counts such cells.

use crate::geometry::inset::{Contour, Left, Remains, inset};
use crate::geometry::polygon::{Measure, measure};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::random::Random;
use crate::value::{Domain, Partition, Type, Unit, Value};
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Cells with joints between them.
pub static KIND: Kind = Kind {
    name: "inset_cells",
    version: 2,
    about: "Makes cells smaller, so that joints are between them, and rounds their corners by exact arcs. Joints may vary at \
            random, by edge or by cell, or along a field.",
    source: "own construction: convex cells cut by the moved edges (Sutherland & Hodgman 1974), others by boolean operations; \
             of cells with arcs these only say what is left, and where it ends follows from the moved lines and circles",
    inputs: &[
        Input::new("of", Type::Partition, "The cells."),
        Input::number("joint", Unit::Millimetre, "Width of the joint, asked for in the middle of each edge.")
            .per_point()
            .of(Domain::Plane)
            .default("5")
            .range(0.0, 1e6),
        Input::new("vary", Type::Pair(Unit::One), "Between which factors the joint varies at random.")
            .default("(1, 1)")
            .range(0.0, 100.0),
        Input::new(
            "each",
            Type::Choice(&["edge", "cell"]),
            "What has a random factor of its own: each joint between two cells, or each cell on its side of the joints.",
        )
        .default("edge"),
        Input::number("border", Unit::Millimetre, "Gap where there is no cell beyond; half of the joint if not stated.")
            .optional()
            .range(0.0, 1e6),
        Input::number("round", Unit::Millimetre, "Radius of the corners; no arc takes more than half of a side.")
            .default("0")
            .range(0.0, 1e6),
        Input::new("round_vary", Type::Pair(Unit::One), "Between which factors the radius varies from cell to cell.")
            .default("(1, 1)")
            .range(0.0, 100.0),
        Input::number("least", Unit::One, "Cells of which less than this share is left are left out.")
            .default("0")
            .range(0.0, 1.0),
        Input::new("seed", Type::Whole, "Another number gives other widths.").default("0"),
    ],
    outputs: &[Output::new("cells", Type::Partition, "What is left of the cells.")],
    example: "(nodes: {
        \"plain\": voronoi_split(size: (200, 200), cell_size: 40),
        \"example\": inset_cells(of: \"plain\", joint: 6, vary: (0.6, 1.4), round: 5, seed: 1),
    })",
    build,
};

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let cells = inputs.partition("of");
    check_ranges(inputs)?;
    let offs = offs(inputs, build, cells)?;
    let random = Random::new(build.seed, "inset_cells radius", inputs.whole("seed"));
    let (round, vary) = (inputs.number("round"), inputs.pair("round_vary"));
    let least = inputs.number("least");
    let rest: Vec<Option<Rest>> = (0..cells.len())
        .into_par_iter()
        .map(|cell| {
            let radius = round * random.of_item(cells.ids[cell]).between(vary);
            build.go_on().ok()?;
            let left = left_of(cells, cell, &offs, radius);
            left.filter(|rest| {
                rest.whole.area > 0.0 && rest.whole.area >= least * cells.areas[cell]
            })
        })
        .collect();
    build.go_on()?;
    warn_of_rest(inputs, &rest)?;
    Ok(vec![Value::Partition(Arc::new(collected(cells, rest)))])
}

/// Refuses ranges that are none.
fn check_ranges(inputs: &Inputs<'_>) -> Result<(), Failure> {
    for name in ["vary", "round_vary"] {
        let [low, high] = inputs.pair(name);
        if low > high {
            let message = format!("`{name}` goes from {low} to {high}");
            return Err(
                Failure::of_input(name, message).with_hint("state the smaller factor first")
            );
        }
    }
    Ok(())
}

/// Says how many cells vanish or fall apart, and refuses that all vanish.
fn warn_of_rest(inputs: &Inputs<'_>, rest: &[Option<Rest>]) -> Result<(), Failure> {
    let vanished = rest.iter().filter(|rest| rest.is_none()).count();
    let apart = rest.iter().flatten().filter(|rest| rest.parts > 1).count();
    let all = rest.len();
    if vanished == all {
        let failure = Failure::of_input("joint", "nothing is left of any cell");
        let hint = match inputs.number("least") {
            0.0 => "make the joints narrower",
            _ => "make the joints narrower, or lower `least`",
        };
        return Err(failure.with_hint(hint));
    }
    let of_all = |count, does, do_all| {
        let verb = if count == 1 { does } else { do_all };
        format!("{count} of {all} cells {verb} between their joints")
    };
    if vanished > 0 {
        inputs.warn(of_all(vanished, "vanishes", "vanish"));
    }
    if apart > 0 {
        let said = of_all(apart, "falls apart", "fall apart");
        inputs.warn(format!("{said}: the largest part of each is kept"));
    }
    Ok(())
}

/// Says at how many sides of cells the joint would have less than no width, but for those along a stated border.
fn warn_of_negative(inputs: &Inputs<'_>, cells: &Partition, widths: &[f32]) {
    let has_border = inputs.get("border").is_some();
    let counts = |corner: usize| !has_border || cells.neighbours[corner] != Partition::NONE;
    let sides = edges(cells).zip(widths);
    let joints = sides.filter(|((_, corner, _), _)| counts(*corner));
    let widths: Vec<f32> = joints.map(|(_, width)| *width).collect();
    let below = || widths.iter().filter(|width| **width < 0.0);
    if let Some(least) = below().copied().reduce(f32::min) {
        inputs.warn(format!(
            "the joint is below 0 at {} of {} sides of cells, down to {least} mm: cells do not move there",
            below().count(),
            widths.len()
        ));
    }
}

/// How far each edge moves inwards.
fn offs(inputs: &Inputs<'_>, build: &Build<'_>, cells: &Partition) -> Result<Vec<f64>, Failure> {
    let middles = edges(cells).map(|(_, corner, next)| {
        let [from, to] = [corner, next].map(|end| cells.corners[end]);
        let aside = (from - to).perp() * (0.5 * cells.bulge(corner));
        let middle = 0.5 * (from + to) + aside;
        // Both sides of an edge that repeats are asked at one place.
        cells
            .period
            .map_or(middle, |period| middle - (middle / period).floor() * period)
    });
    let widths = inputs.sample("joint", build, &middles.collect::<Vec<_>>())?;
    warn_of_negative(inputs, cells, &widths[0]);
    let random = Random::new(build.seed, "inset_cells joint", inputs.whole("seed"));
    let (vary, by_cell) = (inputs.pair("vary"), inputs.choice("each") == "cell");
    let border = inputs.get("border").map(|_| inputs.number("border"));
    let off = |((cell, corner, _), width): ((usize, usize, usize), &f32)| {
        let beyond = cells.neighbours[corner];
        let id = cells.ids[cell];
        let other = cells.ids.get(beyond as usize).copied();
        let of_item = match other {
            _ if by_cell => random.of_item(id),
            None => random.of_item(id).of_item(Partition::NONE),
            Some(other) => random.of_item(id.min(other)).of_item(id.max(other)),
        };
        match (border, other) {
            (Some(border), None) => border,
            _ => 0.5 * f64::from(width.max(0.0)) * { of_item }.between(vary),
        }
    };
    Ok(edges(cells).zip(&widths[0]).map(off).collect())
}

/// All edges in the order of their corners: the cell, the corner they begin at, and the one they end at.
fn edges(cells: &Partition) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..cells.len()).flat_map(move |cell| {
        cells.rings_of(cell).flat_map(move |ring| {
            let next = move |corner: usize| {
                if corner + 1 == ring.end {
                    ring.start
                } else {
                    corner + 1
                }
            };
            ring.clone().map(move |corner| (cell, corner, next(corner)))
        })
    })
}

/// What is left of a cell.
struct Rest {
    rings: Vec<Left>,
    parts: usize,
    whole: Measure,
    centre: DVec2,
}

fn left_of(cells: &Partition, cell: usize, offs: &[f64], radius: f64) -> Option<Rest> {
    let contour = |ring: Range<usize>| Contour {
        bulges: cells.bulges.get(ring.clone()).unwrap_or_default(),
        corners: &cells.corners[ring],
    };
    let rings: Vec<Contour<'_>> = cells.rings_of(cell).map(contour).collect();
    let first = cells.rings_of(cell).next()?.start;
    let last = cells.rings_of(cell).last()?.end;
    let Remains {
        rings: mut left,
        parts,
    } = inset(&rings, &offs[first..last], radius);
    let measured = |rings: &mut dyn Iterator<Item = Measure>| {
        rings.fold(Measure::default(), |sum, ring| sum + ring)
    };
    let before = measured(&mut rings.iter().map(|ring| measure(ring.corners, ring.bulges)));
    let whole = measured(&mut left.iter().map(|ring| measure(&ring.corners, &ring.bulges)));
    left.iter_mut()
        .flat_map(|ring| &mut ring.edges)
        .for_each(|edge| *edge += first);
    let middle = cells.centres[cell];
    let is_own = middle.distance(before.centre()) > 1e-9 * before.area.abs().sqrt();
    left.first()?;
    Some(Rest {
        centre: if is_own { middle } else { whole.centre() },
        rings: left,
        parts,
        whole,
    })
}

/// The cells of which something is left.
fn collected(cells: &Partition, rest: Vec<Option<Rest>>) -> Partition {
    let kept: Vec<usize> = (0..cells.len())
        .filter(|cell| rest[*cell].is_some())
        .collect();
    let mut numbers = vec![Partition::NONE; cells.len()];
    kept.iter()
        .zip(0..)
        .for_each(|(cell, number)| numbers[*cell] = number);
    let mut left = Partition {
        rings: vec![0],
        cells: vec![0],
        period: cells.period,
        ids: kept.iter().map(|cell| cells.ids[*cell]).collect(),
        frames: kept.iter().map(|cell| cells.frames[*cell]).collect(),
        ..Partition::default()
    };
    for (name, of_cells) in &cells.attributes {
        let of_kept = kept.iter().map(|cell| of_cells[*cell]).collect();
        left.attributes.insert(name.clone(), of_kept);
    }
    for rest in rest.into_iter().flatten() {
        for ring in rest.rings {
            let beyond = ring.edges.iter().map(|edge| {
                let beyond = cells.neighbours[*edge] as usize;
                numbers.get(beyond).copied().unwrap_or(Partition::NONE)
            });
            left.neighbours.extend(beyond);
            left.corners.extend(ring.corners);
            left.bulges.extend(ring.bulges);
            left.rings.push(left.corners.len() as u32);
        }
        left.cells.push(left.rings.len() as u32 - 1);
        left.centres.push(rest.centre);
        left.areas.push(rest.whole.area);
    }
    if left.bulges.iter().all(|bulge| *bulge == 0.0) {
        left.bulges.clear();
    }
    left
}
