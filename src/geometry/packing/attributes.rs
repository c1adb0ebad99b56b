//! What the attributes of a packing's cells say of its stones.

use super::guide::nearest_turn;
use super::statistics::axis;
use crate::value::Partition;
use glam::DVec2;

/// What all stones have of an attribute.
fn common(partition: &Partition, name: &str) -> Option<f64> {
    let numbers = partition.attributes.get(name)?;
    numbers.first().copied()
}

/// Corners of a stone.
pub(super) fn corners(partition: &Partition) -> u32 {
    common(partition, "corners").map_or(4, |corners| corners as u32)
}

/// Length of a stone over its width.
pub(super) fn aspect(partition: &Partition) -> f64 {
    common(partition, "aspect").unwrap_or(1.0)
}

/// How far each row is moved against the one before, in stones.
pub(super) fn bond(partition: &Partition) -> f64 {
    common(partition, "bond").unwrap_or(0.0)
}

/// After one turn in how many parts a packing looks the same.
pub(crate) fn symmetry(partition: &Partition) -> u32 {
    match corners(partition) {
        6 => 6,
        4 if aspect(partition) != 1.0 || bond(partition) != 0.0 => 2,
        _ => 4,
    }
}

/// The axis of a stone as its outline says: of an oblong one that of its length, of others the one nearest to its frame.
pub(super) fn own_axis(partition: &Partition, cell: usize) -> DVec2 {
    let outline = partition.outline(cell);
    let edges = if corners(partition) == 6 { 6 } else { 4 };
    let frame = if aspect(partition) == 1.0 {
        partition.frames[cell]
    } else {
        // Half a turn later edges are what normals are.
        axis(outline, 2).map_or(partition.frames[cell], DVec2::perp)
    };
    axis(outline, edges).map_or(frame, |own| nearest_turn(own, frame, edges))
}
