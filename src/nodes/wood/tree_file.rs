//! Measured trees as CSV: what `skeleton_from_file` reads from its input `tree`.
//!
//! Two layouts, told apart by the header; columns may stand in any order, others are not read:
//!
//! - nodes: `id, parent, x, y, z, radius`; the root's parent is empty, or a number that is no id, 0 or -1;
//! - cylinders, as TreeQSM writes them: `radius, length, start_x, start_y, start_z, axis_x, axis_y, axis_z, parent`,
//!   and `extension` if it is there; cylinders are counted from 1, and 0 is none.
//!
//! Lines that begin with `#` are remarks; `# unit: m` among them states the unit. The root is moved to the origin.
//!
//! The trunk begins at the root and goes on, at every fork, with the extension, or with the thickest part. Trunks have
//! to rise: points that are less than a millimetre higher than the highest before them are left out. Branches are
//! straight and begin on the trunk: each is the chord from the trunk's curve, at the height of its start, to the end
//! of its first part, and has the thickness that it has there. Branches of branches are left out, and so are
//! branches that begin beyond the ends of the trunk or have no length or thickness. What is left out is told.

mod segments;

pub(super) use crate::nodes::cells::{Fault, LengthUnit};

use crate::geometry::spline::TrunkCurve;
use crate::node::{Build, counted};
use crate::nodes::cells;
use crate::value::{Branch, Skeleton, Tangents, Thickness};
use glam::DVec3;
use segments::Segment;

/// Least rise from one point of a trunk to the next, in mm.
const LEAST_RISE: f64 = 1.0;

/// The skeleton of a measured tree, and what was left out of it.
///
/// # Errors
/// Everything that the file has wrong, by line and column, or that the run was cancelled.
pub(super) fn skeleton(
    bytes: &[u8],
    unit: Option<LengthUnit>,
    tangents: Tangents,
    every: usize,
    build: &Build<'_>,
) -> Result<(Skeleton, Vec<String>), Fault> {
    let table = cells::read(bytes, build)?;
    let segments = segments::read(&table, table.millimetres(unit)?)?;
    let next_of = continuations(&segments);
    let chain = trunk_chain(&segments, &next_of);
    let mut warnings = vec![];
    let trunk = rising(&segments, &chain, every, &mut warnings);
    let curve = TrunkCurve::through(&trunk, tangents)
        .map_err(|error| Fault::whole(format!("the trunk: {error}")))?;
    let branches = branches(&segments, &next_of, &chain, &curve, &mut warnings, build)?;
    let skeleton = Skeleton {
        trunk,
        tangents,
        branches,
    };
    Ok((skeleton, warnings))
}

/// The segments of the trunk, from the root up.
fn trunk_chain(segments: &[Segment], next_of: &[Option<usize>]) -> Vec<usize> {
    let roots = (0..segments.len()).filter(|index| segments[*index].parent.is_none());
    let thickest = roots.reduce(
        |best, next| match segments[next].radius > segments[best].radius {
            true => next,
            false => best,
        },
    );
    // Parents lead to a root, so no segment comes twice.
    std::iter::successors(thickest, |index| next_of[*index]).collect()
}

/// What goes on from each segment: its extension, or the thickest, the earlier of equal ones.
fn continuations(segments: &[Segment]) -> Vec<Option<usize>> {
    let mut next_of: Vec<Option<usize>> = segments.iter().map(|it| it.extension).collect();
    for (index, segment) in segments.iter().enumerate() {
        let Some(parent) = segment.parent else {
            continue;
        };
        let is_thicker = |next: usize| segment.radius > segments[next].radius;
        if segments[parent].extension.is_none() && next_of[parent].is_none_or(is_thicker) {
            next_of[parent] = Some(index);
        }
    }
    next_of
}

/// The points of the trunk that rise, of those every n-th and the last.
fn rising(
    segments: &[Segment],
    chain: &[usize],
    every: usize,
    warnings: &mut Vec<String>,
) -> Vec<DVec3> {
    let start = chain.first().map(|first| segments[*first].start);
    let ends = chain
        .iter()
        .map(|index| (segments[*index].line, segments[*index].end));
    let mut points: Vec<DVec3> = start.into_iter().collect();
    let mut left_out = vec![];
    for (line, point) in ends {
        match points.last() {
            Some(highest) if point.z < highest.z + LEAST_RISE => left_out.push(line),
            _ => points.push(point),
        }
    }
    if let Some(first) = left_out.first() {
        warnings.push(format!(
            "{} of {} points of the trunk do not rise by {LEAST_RISE} mm above those before them and are left out, \
             the first in line {first}",
            left_out.len(),
            chain.len() + 1,
        ));
    }
    let last = points.len().saturating_sub(1);
    let kept = |(index, point)| (index % every == 0 || index == last).then_some(point);
    points.into_iter().enumerate().filter_map(kept).collect()
}

/// The branches that begin on the trunk.
fn branches(
    segments: &[Segment],
    next_of: &[Option<usize>],
    chain: &[usize],
    curve: &TrunkCurve,
    warnings: &mut Vec<String>,
    build: &Build<'_>,
) -> Result<Vec<Branch>, Fault> {
    let mut on_trunk = vec![false; segments.len()];
    chain.iter().for_each(|index| on_trunk[*index] = true);
    let (mut branches, mut beyond, mut thin, mut twigs) = (vec![], vec![], vec![], vec![]);
    let [lowest, highest] = curve.heights();
    for (index, segment) in segments
        .iter()
        .enumerate()
        .filter(|(index, _)| !on_trunk[*index])
    {
        cells::go_on(build)?;
        if let Some(parent) = segment.parent.filter(|parent| !on_trunk[*parent]) {
            // What goes on from a branch is told with it.
            if next_of[parent] != Some(index) {
                twigs.push(segment.line);
            }
        } else if !(lowest..=highest).contains(&segment.start.z) {
            beyond.push(segment.line);
        } else if let Some(branch) = branch(segment, curve) {
            branches.push(branch);
        } else {
            thin.push(segment.line);
        }
    }
    let reasons = [
        (
            twigs,
            "branch of a branch is left out",
            "branches of branches are left out",
            ": a branch is straight and begins on the trunk",
        ),
        (
            beyond,
            "branch begins below or above the trunk and is left out",
            "branches begin below or above the trunk and are left out",
            "",
        ),
        (
            thin,
            "branch has no length or thickness and is left out",
            "branches have no length or thickness and are left out",
            "",
        ),
    ];
    for (lines, one, many, reason) in reasons {
        if let Some(first) = lines.first() {
            let left_out = counted(lines.len(), one, many);
            warnings.push(format!("{left_out}{reason}; the first is in line {first}"));
        }
    }
    Ok(branches)
}

fn branch(segment: &Segment, curve: &TrunkCurve) -> Option<Branch> {
    let chord = segment.end - curve.at(segment.start.z);
    let thickness = Thickness::HalfWidth {
        distance: chord.length(),
        half_width: segment.radius,
    };
    (segment.radius > 0.0).then_some(Branch {
        height: segment.start.z,
        direction: chord.try_normalize()?,
        thickness,
        length: Some(chord.length()),
    })
}
