//! Fills empty places and thins out crowded ones.

use super::Stone;
use super::start::Ground;
use crate::value::Partition;
use glam::DVec2;

/// A cell with more than this many times the area of its stone has room for two.
const EMPTY: f64 = 1.55;

/// A cell with more than this many times the area of its stone is no fault of a packing but a place that it did not reach.
const UNREACHED: f64 = 2.0;

/// A cell with less than this share of its stone's area is no stone.
const CROWDED: f64 = 0.45;

/// Least share of a stone's area that stones in a narrow place have.
const NARROW: f64 = 0.55;

/// A strip narrower than this share of a stone takes none.
const THIN: f64 = 0.1;

/// Puts stones into cells that have none or are too large, and takes the stones of those away that are too small; how many
/// came and went.
pub(super) fn mend(
    ground: &Ground<'_>,
    partition: &Partition,
    stones: &mut Vec<Stone>,
    random: &mut dyn FnMut() -> f64,
) -> usize {
    let mean = 0.5 * (ground.spread[0] + ground.spread[1]);
    let [least, largest] = ground.spread.map(|size| size / mean);
    let mut is_kept = vec![false; stones.len()];
    for cell in 0..partition.len() {
        if let Some(stone) = stones.get(partition.ids[cell] as usize) {
            let share = ground.share(partition, cell, stone.point);
            is_kept[partition.ids[cell] as usize] =
                share > CROWDED * least * least || stone.is_fixed;
        }
    }
    let count = stones.len();
    let added = added(ground, partition, stones, EMPTY * largest, random);
    let mut kept = is_kept.into_iter();
    stones.retain(|_| kept.next().unwrap_or(true));
    let changes = count - stones.len() + added.len();
    stones.extend(added);
    changes
}

/// Puts stones where there are none for several of them; how many came.
pub(super) fn reach(
    ground: &Ground<'_>,
    partition: &Partition,
    stones: &mut Vec<Stone>,
    random: &mut dyn FnMut() -> f64,
) -> usize {
    let added = added(ground, partition, stones, UNREACHED, random);
    stones.extend(&added);
    added.len()
}

/// More stones for cells of more than `most` times their stone's area, and for cells without one; the stones that are in
/// such cells make room.
fn added(
    ground: &Ground<'_>,
    partition: &Partition,
    stones: &mut [Stone],
    most: f64,
    random: &mut dyn FnMut() -> f64,
) -> Vec<Stone> {
    let mut added = vec![];
    for cell in 0..partition.len() {
        let stone = stones.get_mut(partition.ids[cell] as usize);
        let centre = partition.centres[cell];
        let share = ground.share(
            partition,
            cell,
            stone.as_ref().map_or(centre, |stone| stone.point),
        );
        if share <= stone.as_ref().map_or(CROWDED, |_| most) {
            continue;
        }
        let mut places = ground.places(partition, cell, share);
        if let Some(stone) = stone {
            let distance = |at: &usize| places[*at].distance_squared(stone.point);
            let nearest = (0..places.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(place) = nearest.map(|nearest| places.remove(nearest))
                && !stone.is_fixed
            {
                stone.point = place;
            }
        }
        added.extend(
            places
                .into_iter()
                .map(|place| ground.stone_at(place, random())),
        );
    }
    added
}

impl Ground<'_> {
    /// The area of a cell over that of a usual stone at a point.
    fn share(&self, partition: &Partition, cell: usize, point: DVec2) -> f64 {
        let size = 0.5 * (self.spread[0] + self.spread[1]) * self.guide.scale(point);
        partition.areas[cell] / (size * size * self.area)
    }

    /// Where stones are to lie in a cell that has room for `share` of them.
    fn places(&self, partition: &Partition, cell: usize, share: f64) -> Vec<DVec2> {
        let centre = partition.centres[cell];
        if (1.0..2.5).contains(&share) {
            let off = halves(partition.outline(cell), centre);
            return vec![centre - off, centre + off];
        }
        let rings: Vec<&[DVec2]> = partition
            .rings_of(cell)
            .map(|ring| &partition.corners[ring])
            .collect();
        let wish = self.guide.at(centre);
        let mean = 0.5 * (self.spread[0] + self.spread[1]);
        let along = along(rings[0], wish.frame);
        let across = [along, along.perp()].map(|axis| {
            let within = DVec2::new(wish.frame.dot(axis), wish.frame.perp_dot(axis));
            within.abs().dot(self.stone)
        });
        let step = mean * wish.scale * DVec2::from(across);
        strips(&rings, along, step, (share / NARROW).floor().max(1.0))
    }
}

/// The direction that an outline is longest in, as its edges say; `other` if they do not.
fn along(outline: &[DVec2], other: DVec2) -> DVec2 {
    let next = outline.iter().cycle().skip(1);
    let edges = outline.iter().zip(next).map(|(from, to)| *to - *from);
    let turned = edges.map(|edge| {
        let length = edge.length().max(f64::MIN_POSITIVE);
        DVec2::new(edge.x * edge.x - edge.y * edge.y, 2.0 * edge.x * edge.y) / length
    });
    let turned: DVec2 = turned.sum();
    if turned == DVec2::ZERO {
        other
    } else {
        super::direction::unturned(turned, 2)
    }
}

/// Points in at most `most` strips across rings, as far apart as `step` says along and across, at least one in each strip.
fn strips(rings: &[&[DVec2]], along: DVec2, step: DVec2, most: f64) -> Vec<DVec2> {
    let turned = |ring: &&[DVec2]| -> Vec<DVec2> {
        ring.iter()
            .map(|corner| DVec2::new(along.dot(*corner), along.perp_dot(*corner)))
            .collect()
    };
    let rings: Vec<Vec<DVec2>> = rings.iter().map(turned).collect();
    let all = || rings.iter().flatten().map(|corner| corner.x);
    let (low, high) = (
        all().fold(f64::INFINITY, f64::min),
        all().fold(f64::NEG_INFINITY, f64::max),
    );
    let columns = ((high - low) / step.x).round().clamp(1.0, most);
    let mut places = vec![];
    for column in 0..columns as usize {
        let x = low + (column as f64 + 0.5) * (high - low) / columns;
        for [bottom, top] in within(&rings, x) {
            let height = top - bottom;
            let count = (height / step.y).round().max(1.0);
            if height > THIN * step.y {
                places.extend((0..count as usize).map(|row| {
                    let y = bottom + (row as f64 + 0.5) * height / count;
                    x * along + y * along.perp()
                }));
            }
        }
    }
    places
}

/// From where to where the line of points with this x lies inside rings.
fn within(rings: &[Vec<DVec2>], x: f64) -> Vec<[f64; 2]> {
    let mut crossings = vec![];
    for ring in rings {
        let next = ring.iter().cycle().skip(1);
        let crossed = ring
            .iter()
            .zip(next)
            .filter(|(a, b)| (a.x > x) != (b.x > x));
        crossings.extend(crossed.map(|(a, b)| a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y)));
    }
    crossings.sort_unstable_by(f64::total_cmp);
    crossings
        .chunks_exact(2)
        .map(|pair| [pair[0], pair[1]])
        .collect()
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
