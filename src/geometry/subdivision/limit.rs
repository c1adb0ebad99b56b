//! The surface that Loop subdivision approaches: where its points come to lie, and its normals there.
//!
//! ```text
//! place    (3/(8 b) of the point + 1 of each neighbour) / (3/(8 b) + n);  at a border (1, 4, 1)/6
//! tangents sum of cos(2 pi i/n) and of sin(2 pi i/n) of the neighbours i in their order
//! ```
//!
//! (Hoppe et al. 1994, also for the tangents at borders.)

use super::{Blend, NONE, Topology, share};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

impl Topology {
    /// Where the values at the points come to lie after infinitely many steps.
    pub(crate) fn limit<T: Blend>(&self, values: &[T]) -> Vec<T> {
        self.moved(values, [4.0 / 6.0, 1.0 / 6.0], |edges| {
            let own = 3.0 / (8.0 * share(edges));
            let whole = own + f64::from(edges);
            [own / whole, 1.0 / whole]
        })
    }

    /// The two tangents of the limit surface at each point; of no length where it has none.
    pub(crate) fn tangents<T: Blend>(&self, values: &[T]) -> Vec<[T; 2]> {
        let fans = self.fans();
        let tangents = |(point, fan): (usize, &Fan)| match fan {
            Fan::Closed(around) => closed(values, around),
            Fan::Open(around) => open(values, point, around),
            Fan::Torn => [T::default(); 2],
        };
        fans.iter().enumerate().map(tangents).collect()
    }

    /// The neighbours around every point, in their order.
    fn fans(&self) -> Vec<Fan> {
        let mut steps: Vec<Vec<[u32; 2]>> = vec![vec![]; self.points.len()];
        for corners in &self.triangles {
            for corner in 0..3 {
                let next = [corners[(corner + 1) % 3], corners[(corner + 2) % 3]];
                steps[corners[corner] as usize].push(next);
            }
        }
        let counted = steps.iter().zip(&self.points);
        counted
            .map(|(steps, point)| Fan::of(steps, point.borders))
            .collect()
    }
}

/// The neighbours of a point, counterclockwise.
enum Fan {
    Closed(Vec<u32>),
    /// From one border to the other.
    Open(Vec<u32>),
    /// The triangles do not lie around the point as on a surface.
    Torn,
}

impl Fan {
    /// The fan of triangles that lead from one neighbour to the next.
    fn of(steps: &[[u32; 2]], borders: u32) -> Fan {
        let follows = |from: u32| {
            let mut found = steps.iter().filter(|step| step[0] == from);
            match (found.next(), found.next()) {
                (Some(step), None) => step[1],
                _ => NONE,
            }
        };
        let leads_to = |point: u32| steps.iter().any(|step| step[1] == point);
        let first = match borders {
            0 => steps.first(),
            2 => steps.iter().find(|step| !leads_to(step[0])),
            _ => None,
        };
        let Some([first, _]) = first else {
            return Fan::Torn;
        };
        let mut around = vec![*first];
        for _ in 0..steps.len() {
            let last = around[around.len() - 1];
            around.push(follows(last));
            if follows(last) == NONE {
                return Fan::Torn;
            }
        }
        match borders {
            0 if around.pop() == Some(*first) => Fan::Closed(around),
            2 => Fan::Open(around),
            _ => Fan::Torn,
        }
    }
}

fn closed<T: Blend>(values: &[T], around: &[u32]) -> [T; 2] {
    let mut sums = [T::default(); 2];
    for (index, point) in around.iter().enumerate() {
        let angle = TAU * index as f64 / around.len() as f64;
        let value = values[*point as usize];
        sums[0] = sums[0] + value * libm::cos(angle);
        sums[1] = sums[1] + value * libm::sin(angle);
    }
    sums
}

/// Along the border, and across it into the surface.
fn open<T: Blend>(values: &[T], point: usize, around: &[u32]) -> [T; 2] {
    let value = |index: usize| values[around[index] as usize];
    let (own, last) = (values[point], around.len() - 1);
    let along = value(0) + value(last) * -1.0;
    let across = match around.len() {
        2 => value(0) + value(1) + own * -2.0,
        3 => value(1) + own * -1.0,
        count => {
            let angle = PI / (count as f64 - 1.0);
            let ends = (value(0) + value(last)) * -libm::sin(angle);
            let weight =
                |index: usize| (2.0 - 2.0 * libm::cos(angle)) * libm::sin(index as f64 * angle);
            (1..last).fold(ends, |sum, index| sum + value(index) * weight(index))
        }
    };
    [along, across]
}

/// The unit normals of the limit surface, with the triangles counterclockwise seen from outside; `None` where it has
/// none.
pub(crate) fn normals(topology: &Topology, points: &[DVec3]) -> Vec<Option<DVec3>> {
    let tangents = topology.tangents(points);
    let normal = |[along, across]: &[DVec3; 2]| along.cross(*across).try_normalize();
    tangents.iter().map(normal).collect()
}
