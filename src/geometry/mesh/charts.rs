//! Charts: triangles that lie side by side on the square as they do in space.

use super::{Placed, Soup};
use std::collections::HashMap;

/// The places that a file states, with the charts that they form.
///
/// Two triangles are of one chart if they share an edge whose ends have the same places for both.
pub(super) fn of_file(soup: &Soup) -> Placed {
    let corners = soup.triangles.iter();
    let corners: Vec<[u32; 3]> = corners
        .map(|it| it.coordinates.unwrap_or_default())
        .collect();
    let mut sets = Sets::new(soup.triangles.len());
    let mut edges: HashMap<[(u32, u32); 2], u32> = HashMap::new();
    for (number, (triangle, places)) in (0..).zip(soup.triangles.iter().zip(&corners)) {
        for side in 0..3 {
            let end = |corner: usize| (triangle.points[corner % 3], places[corner % 3]);
            let (from, to) = (end(side), end(side + 1));
            let neighbour = *edges.entry([from.min(to), from.max(to)]).or_insert(number);
            sets.join(number, neighbour);
        }
    }
    Placed {
        coordinates: soup.coordinates.clone(),
        charts: sets.numbers(),
        corners,
    }
}

/// Disjoint sets of numbers.
struct Sets {
    parents: Vec<u32>,
}

impl Sets {
    fn new(count: usize) -> Sets {
        Sets {
            parents: (0..count as u32).collect(),
        }
    }

    fn root(&mut self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            let above = self.parents[number as usize];
            self.parents[number as usize] = self.parents[above as usize];
            number = above;
        }
        number
    }

    /// The lower root stays one, so that sets are numbered by their first member.
    fn join(&mut self, one: u32, other: u32) {
        let (one, other) = (self.root(one), self.root(other));
        self.parents[one.max(other) as usize] = one.min(other);
    }

    /// For every member the number of its set, counted in the order of first members.
    fn numbers(&mut self) -> Vec<u32> {
        let count = self.parents.len() as u32;
        let roots: Vec<u32> = (0..count).map(|member| self.root(member)).collect();
        super::numbered(roots.into_iter(), &mut HashMap::new())
    }
}
