//! Whether an inlay has room: what a gap leaves of it, and whether the piece that is let in reaches far enough.

use crate::field::Field;
use crate::geometry::inset::{Contour, inset};
use crate::node::Inputs;
use crate::value::Partition;
use glam::DVec2;
use rayon::prelude::*;

/// By how much an outline may leave a piece, as a share of the piece.
const ROUNDING: f64 = 1e-6;

/// A width in a message has this many significant digits, rounded down.
const DIGITS: i32 = 3;

/// Warns of cells of which the gap leaves nothing, and of a piece that ends within them.
pub(super) fn warn_of_room(inputs: &Inputs<'_>, cells: &Partition) {
    warn_of_gap(inputs, cells);
    warn_of_end(inputs, cells);
}

fn warn_of_gap(inputs: &Inputs<'_>, cells: &Partition) {
    let gap = inputs.number("gap");
    if gap <= 0.0 {
        return warn_of_chamfer(inputs, cells);
    }
    let all = cells.len();
    let gone: Vec<usize> = (0..all)
        .into_par_iter()
        .filter(|cell| !leaves_any(cells, *cell, 0.5 * gap))
        .collect();
    if gone.is_empty() {
        return warn_of_chamfer(inputs, cells);
    }
    let widest = |narrowest: f64, cell: &usize| match leaves_any(cells, *cell, 0.5 * narrowest) {
        true => narrowest,
        false => widest_gap(cells, *cell, narrowest),
    };
    let fitting = rounded_down(gone.iter().fold(gap, widest));
    let lost = match gone.len() == all {
        true => "nothing of the inlay is left".to_owned(),
        false => format!("nothing is left of {} of {all} cells", gone.len()),
    };
    let reason = format!("the gap of {gap} mm takes {} mm off every side", 0.5 * gap);
    let whole = if all == 1 { "it" } else { "every cell" };
    inputs.warn(format!(
        "{lost}: {reason}; {whole} has room for a `gap` below {fitting} mm"
    ));
}

/// Warns if chamfers leave nothing of any face.
fn warn_of_chamfer(inputs: &Inputs<'_>, cells: &Partition) {
    let chamfer = inputs.number("chamfer");
    let off = 0.5 * inputs.number("gap") + chamfer;
    let mut all = 0..cells.len();
    if chamfer > 0.0 && !cells.is_empty() && !all.any(|cell| leaves_any(cells, cell, off)) {
        inputs.warn(format!(
            "the chamfer of {chamfer} mm leaves nothing of the face of what is let in: it stays below its level; make the \
             chamfer narrower"
        ));
    }
}

/// Whether something of a cell is left if its edges move inwards.
fn leaves_any(cells: &Partition, cell: usize, off: f64) -> bool {
    let rings: Vec<Contour<'_>> = cells
        .rings_of(cell)
        .map(|ring| Contour {
            bulges: cells.bulges.get(ring.clone()).unwrap_or_default(),
            corners: &cells.corners[ring],
        })
        .collect();
    // Straight edges take no more than a strip along each and a disc at each corner; most cells are far from that.
    let corners: usize = rings.iter().map(|ring| ring.corners.len()).sum();
    let around: f64 = rings.iter().map(|ring| perimeter(ring.corners)).sum();
    let taken = off * around + std::f64::consts::PI * off * off * corners as f64;
    if cells.bulges.is_empty() && taken < cells.areas[cell] {
        return true;
    }
    !inset(&rings, &vec![off; corners], 0.0).rings.is_empty()
}

fn perimeter(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter()
        .zip(next)
        .map(|(from, to)| from.distance(*to))
        .sum()
}

/// The widest gap that leaves something of a cell, to a ten-thousandth; `above` leaves nothing.
fn widest_gap(cells: &Partition, cell: usize, above: f64) -> f64 {
    let [mut fits, mut gone] = [0.0, above];
    for _ in 0..64 {
        if gone - fits < 1e-4 * gone {
            break;
        }
        let middle = 0.5 * (fits + gone);
        match leaves_any(cells, cell, 0.5 * middle) {
            true => fits = middle,
            false => gone = middle,
        }
    }
    gone
}

fn rounded_down(length: f64) -> f64 {
    let step = libm::pow(
        10.0,
        libm::floor(libm::log10(length)) + f64::from(1 - DIGITS),
    );
    // Steps below 1 are inverted, so that the product has no digits of chance.
    match step < 1.0 {
        true => (length * (1.0 / step).round() + 1e-9).floor() / (1.0 / step).round(),
        false => (length / step).floor() * step,
    }
}

/// Warns of outlines that reach beyond the piece that is let in, where the ground is.
fn warn_of_end(inputs: &Inputs<'_>, cells: &Partition) {
    let Some([width, height]) = inputs.material("of").size else {
        return;
    };
    let repeats = |field: &Field| !field.periods().is_empty();
    if cells.period.is_some() || inputs.material("of").channels.values().any(repeats) {
        return;
    }
    let [low, high] = box_of_all(cells);
    let ground = inputs.material("ground").size.map(DVec2::from);
    let [low, high] = [
        low.max(DVec2::ZERO),
        ground.map_or(high, |ground| high.min(ground)),
    ];
    let piece = DVec2::new(width, height);
    let beyond = high - piece;
    if beyond.max_element() <= ROUNDING * piece.max_element() || low.cmpge(high).any() {
        return;
    }
    let [x, y] = high.to_array();
    let far = rounded_down(beyond.max_element());
    inputs.warn(format!(
        "the piece that is let in ends {far} mm before its outline does: it is {width} x {height} mm, and the outline reaches \
         ({x:.1}, {y:.1}) mm; cut a larger piece, or move the outline"
    ));
}

fn box_of_all(cells: &Partition) -> [DVec2; 2] {
    let boxes = (0..cells.len()).map(|cell| cells.box_of(cell));
    boxes
        .reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
        .unwrap_or([DVec2::ZERO; 2])
}
