//! Drawn polygons become a region, and the recipe's author hears what had to be mended.

use crate::geometry::polygon::{Fault, Nothing, Wrong, doubled_area, mend};
use crate::node::{Failure, Inputs};
use crate::value::{Polygon, Region};
use glam::DVec2;

/// The largest coordinate in mm.
pub(super) const LARGEST: f64 = 1e9;

/// Warnings of one node, at most; what is left is counted.
const MOST: usize = 12;

/// The region of polygons that somebody has drawn. Rings are called by `name`.
///
/// # Errors
/// No polygons, coordinates that are not finite or too large, rings that enclose nothing: the fault of input `input`.
pub(super) fn mended(
    inputs: &Inputs<'_>,
    input: &'static str,
    drawn: &[Polygon],
    name: &dyn Fn(usize, Option<usize>) -> String,
) -> Result<Region, Failure> {
    if drawn.is_empty() {
        return Err(Failure::of_input(input, "there are no outlines"));
    }
    for (number, polygon) in drawn.iter().enumerate() {
        let rings = polygon
            .rings()
            .zip(std::iter::once(None).chain((0..).map(Some)));
        for (ring, hole) in rings {
            if let Some(corner) = ring.iter().find(|corner| is_too_far(**corner)) {
                let message = format!(
                    "{} has a corner at {}; the farthest is {LARGEST} mm off",
                    name(number, hole),
                    shown(*corner)
                );
                return Err(Failure::of_input(input, message).at_item(number));
            }
        }
    }
    let (region, faults) = mend(drawn).map_err(|((number, hole), nothing)| {
        let ring = name(number, hole);
        let message = match nothing {
            Nothing::Corners(found) => {
                format!("expected at least 3 different corners of {ring}, found {found}")
            }
            Nothing::Area if hole.is_none() && is_only_in_holes(&drawn[number]) => {
                format!("the holes of {ring} leave nothing of it")
            }
            Nothing::Area => format!("{ring} encloses no area"),
        };
        Failure::of_input(input, message).at_item(number)
    })?;
    warn(inputs, &faults, name);
    Ok(region)
}

/// Whether it is holes that leave nothing of a polygon.
fn is_only_in_holes(polygon: &Polygon) -> bool {
    !polygon.holes.is_empty() && doubled_area(&polygon.outline) != 0.0
}

fn is_too_far(corner: DVec2) -> bool {
    !corner.is_finite() || corner.abs().max_element() > LARGEST
}

/// A point in a message.
pub(super) fn shown(point: DVec2) -> String {
    let [x, y] = [point.x, point.y].map(|part| (part * 1e4).round() / 1e4 + 0.0);
    format!("({x}, {y}) mm")
}

/// Warns of faults, those of one kind in one ring together.
fn warn(inputs: &Inputs<'_>, faults: &[Fault], name: &dyn Fn(usize, Option<usize>) -> String) {
    let mut groups: Vec<(&Fault, usize)> = vec![];
    for fault in faults {
        let same = |group: &&mut (&Fault, usize)| {
            (group.0.ring, group.0.wrong) == (fault.ring, fault.wrong)
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.1 += 1,
            None => groups.push((fault, 1)),
        }
    }
    for (fault, count) in groups.iter().take(MOST) {
        let ring = name(fault.ring.0, fault.ring.1);
        inputs.warn(said(&ring, fault, *count));
    }
    if groups.len() > MOST {
        inputs.warn(format!(
            "{} more mistakes in outlines were mended",
            groups.len() - MOST
        ));
    }
}

fn said(ring: &str, fault: &Fault, count: usize) -> String {
    let at = shown(fault.at);
    match fault.wrong {
        Wrong::Repeated if count > 1 => {
            format!("{ring} has {count} repeated corners, the first at {at}; they are taken out")
        }
        Wrong::Repeated => format!("{ring} has a repeated corner at {at}; it is taken out"),
        Wrong::Spike => format!("{ring} turns back on itself at {at}; the spike is taken out"),
        Wrong::Clockwise => format!("{ring} runs clockwise; it is turned"),
        Wrong::Crosses => {
            format!("{ring} crosses or touches itself at {at}; it encloses what it winds around")
        }
        Wrong::Outside => format!("{ring} lies outside its outline; it is left out"),
        Wrong::Beyond => {
            format!("{ring} reaches beyond its outline at {at}; what is beyond is left out")
        }
        Wrong::Touches => format!("{ring} touches another ring at {at}; they are joined"),
        Wrong::Overlaps => format!("{ring} overlaps another at {at}; they are joined"),
        Wrong::Sliver => {
            format!(
                "{ring} has a part at {at} that is thinner than a billionth of the whole; it is left out"
            )
        }
    }
}
