//! Corners that lie almost on each other become one.

use glam::DVec2;
use rayon::prelude::*;

/// How far before the origin the seam of periodic points lies, in tolerances: where no corner is likely to be.
pub(super) const SEAM: f64 = 7.310_585;

/// A corner that rings share, some whole periods away from its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Corner {
    pub(crate) point: u32,
    pub(crate) period: [i32; 2],
}

impl Corner {
    /// The corner whole periods further on.
    pub(crate) fn moved(self, by: [i32; 2]) -> Corner {
        let period = [0, 1].map(|axis| self.period[axis] + by[axis]);
        Corner { period, ..self }
    }
}

/// The places of shared corners, and which of them each point becomes: the first of those that are linked by steps of at
/// most `tolerance`. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn weld<E>(
    drawn: &[DVec2],
    period: Option<DVec2>,
    tolerance: f64,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(Vec<DVec2>, Vec<Corner>), E> {
    let within = |point: &DVec2| within_period(*point, period, tolerance);
    let places: Vec<(DVec2, [i32; 2])> = drawn.par_iter().map(within).collect();
    let mut groups: Vec<u32> = (0..drawn.len() as u32).collect();
    for shift in [0.0, 0.5] {
        go_on()?;
        link(&places, shift, tolerance, &mut groups);
    }
    go_on()?;
    let mut points = vec![];
    let mut numbers = vec![0; drawn.len()];
    let mut corners = Vec::with_capacity(drawn.len());
    for (index, (place, period)) in places.iter().enumerate() {
        let first = first_of(&mut groups, index as u32) as usize;
        if first == index {
            numbers[index] = points.len() as u32;
            points.push(*place);
        }
        corners.push(Corner {
            point: numbers[first],
            period: *period,
        });
    }
    Ok((points, corners))
}

/// A point moved into the first period, and by how many periods it was moved.
fn within_period(point: DVec2, period: Option<DVec2>, tolerance: f64) -> (DVec2, [i32; 2]) {
    let Some(period) = period else {
        return (point, [0; 2]);
    };
    let away = ((point + SEAM * tolerance) / period).floor();
    (point - away * period, [away.x as i32, away.y as i32])
}

/// Links points closer than the tolerance that fall into the same column, some tolerances wide. With columns moved by
/// half their width, each such pair has been in one column.
fn link(places: &[(DVec2, [i32; 2])], shift: f64, tolerance: f64, groups: &mut [u32]) {
    let column = |x: f64| (x / (4.0 * tolerance) + shift).floor() as i64;
    let mut order: Vec<(i64, f64, u32)> = (0..places.len())
        .into_par_iter()
        .map(|index| (column(places[index].0.x), places[index].0.y, index as u32))
        .collect();
    order.par_sort_unstable_by(|a, b| {
        let by_column = a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
        by_column.then(a.2.cmp(&b.2))
    });
    for (rank, (column, y, index)) in order.iter().enumerate() {
        let behind = order[rank + 1..].iter();
        for other in behind.take_while(|other| other.0 == *column && other.1 - y <= tolerance) {
            let [a, b] = [*index, other.2].map(|index| places[index as usize].0);
            if a.distance_squared(b) > tolerance * tolerance {
                continue;
            }
            join(groups, *index, other.2);
            // Those behind an equal point are found from there.
            if a == b {
                break;
            }
        }
    }
}

/// The first point of the group of a point.
fn first_of(groups: &mut [u32], mut point: u32) -> u32 {
    while groups[point as usize] != point {
        let above = groups[groups[point as usize] as usize];
        groups[point as usize] = above;
        point = above;
    }
    point
}

fn join(groups: &mut [u32], a: u32, b: u32) {
    let [a, b] = [a, b].map(|point| first_of(groups, point));
    groups[a.max(b) as usize] = a.min(b);
}
