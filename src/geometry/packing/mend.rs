//! Fills empty places and thins out crowded ones.

use super::Stone;
use super::start::Ground;
use crate::value::Partition;
use glam::DVec2;

/// A cell with more than this many times the area of its stone has room for two.
const EMPTY: f64 = 1.55;

/// A cell with less than this share of its stone's area is no stone.
const CROWDED: f64 = 0.45;

/// Puts a second stone into cells that are too large, and takes the stones of those away that are too small; whether
/// there was anything to do.
pub(super) fn mend(
    ground: &Ground<'_>,
    partition: &Partition,
    stones: &mut Vec<Stone>,
    random: &mut dyn FnMut() -> f64,
) -> bool {
    let mean = 0.5 * (ground.spread[0] + ground.spread[1]);
    let [least, largest] = ground.spread.map(|size| size / mean);
    let nominal = mean * mean * ground.stone.x * ground.stone.y;
    let mut is_kept = vec![false; stones.len()];
    let mut added = vec![];
    for cell in 0..partition.len() {
        let Some(stone) = stones.get(partition.ids[cell] as usize).copied() else {
            continue;
        };
        let scale = ground.guide.at(stone.point).scale;
        let share = partition.areas[cell] / (nominal * scale * scale);
        let id = partition.ids[cell] as usize;
        is_kept[id] = share > CROWDED * least * least || stone.is_fixed;
        if share > EMPTY * largest {
            let off = halves(partition.outline(cell), partition.centres[cell]);
            if !stone.is_fixed {
                stones[id].point = partition.centres[cell] - off;
            }
            added.push(ground.stone_at(partition.centres[cell] + off, random()));
        }
    }
    let count = stones.len();
    let mut kept = is_kept.into_iter();
    stones.retain(|_| kept.next().unwrap_or(true));
    let is_changed = stones.len() < count || !added.is_empty();
    stones.extend(added);
    is_changed
}

/// From the middle of an outline to the middle of one of its halves: a quarter of its length along its longer axis.
fn halves(outline: &[DVec2], centre: DVec2) -> DVec2 {
    let mut turned = DVec2::ZERO;
    let mut square = 0.0;
    for corner in outline {
        let arm = *corner - centre;
        turned += DVec2::new(arm.x * arm.x - arm.y * arm.y, 2.0 * arm.x * arm.y);
        square += arm.length_squared();
    }
    let along = super::direction::unturned(turned, 2);
    0.35 * (square / outline.len() as f64).sqrt() * along
}
