//! The corners of the cells: centres of the circles through the corners of triangles.
//!
//! A corner is computed once for each triangle, from its site with the lowest place, so that in a plane that repeats
//! it has the same bits wherever it is seen from. Where more than three sites lie on a circle, the triangles between
//! them have one corner in common.

use super::triangulation::{Dual, Edge, FAR};
use super::{SAME, Site};
use glam::DVec2;
use rayon::prelude::*;
use spade::Triangulation as _;
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};

/// The corners, one for each triangle.
pub(super) struct Corners {
    /// Where they are; without the outer face, which is the first.
    places: Vec<DVec2>,
    /// By how many periods each is to be moved; empty if nothing repeats.
    shifts: Vec<[i8; 2]>,
    /// The corner that stands for each, if some are at one place.
    stands_for: Option<Vec<u32>>,
    period: DVec2,
}

/// A place in the plane that repeats.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: DVec2,
    /// The periods to be added.
    shift: [i8; 2],
}

impl Corners {
    /// The corners of a triangulation.
    pub(super) fn new(dual: &Dual) -> Corners {
        let period = dual.period.unwrap_or_default();
        let faces: Vec<FixedFaceHandle<InnerTag>> = dual.triangles.fixed_inner_faces().collect();
        let place = |face: &FixedFaceHandle<InnerTag>| {
            let vertices = dual.triangles.face(*face).vertices();
            Place::of(&vertices.map(|vertex| *vertex.data()), period)
        };
        let (mut places, mut shifts) = (vec![], vec![]);
        if dual.period.is_some() {
            let both = faces.par_iter().map(|face| place(face).both());
            both.unzip_into_vecs(&mut places, &mut shifts);
        } else {
            let only = faces.par_iter().map(|face| place(face).at);
            only.collect_into_vec(&mut places);
        }
        Corners {
            places,
            shifts,
            stands_for: None,
            period,
        }
    }

    /// The corner that stands for the one of a triangle.
    pub(super) fn index(&self, face: usize) -> u32 {
        let index = face as u32 - 1;
        match &self.stands_for {
            Some(others) => others[index as usize],
            None => index,
        }
    }

    /// Where a corner is, moved by a number of periods.
    pub(super) fn at(&self, index: u32, shift: [i8; 2]) -> DVec2 {
        let at = self.places[index as usize];
        let Some(own) = self.shifts.get(index as usize) else {
            return at;
        };
        let sum = |axis: usize| f64::from(own[axis]) + f64::from(shift[axis]);
        at + DVec2::new(sum(0), sum(1)) * self.period
    }

    /// Joins corners at one place.
    pub(super) fn join(&mut self, dual: &Dual) {
        let pairs = self.pairs(dual);
        if pairs.is_empty() {
            return;
        }
        let mut parents: Vec<u32> = (0..self.places.len() as u32).collect();
        for Pair { corners, .. } in &pairs {
            let [a, b] = corners.map(|it| root(&mut parents, it));
            parents[a.max(b) as usize] = a.min(b);
        }
        let mut members: Vec<(u32, u32)> = (0..)
            .zip(&pairs)
            .map(|(number, pair)| (root(&mut parents, pair.corners[0]), number))
            .collect();
        members.par_sort_unstable();
        for group in members.chunk_by(|a, b| a.0 == b.0) {
            let first = group[0].0 as usize;
            let sites = group
                .iter()
                .flat_map(|(_, pair)| pairs[*pair as usize].sites);
            let place = Place::of_many(sites.collect(), self.period);
            self.places[first] = place.at;
            if let Some(shift) = self.shifts.get_mut(first) {
                *shift = place.shift;
            }
        }
        for index in 0..parents.len() as u32 {
            root(&mut parents, index);
        }
        self.stands_for = Some(parents);
    }

    /// Neighbouring triangles with corners at one place.
    fn pairs(&self, dual: &Dual) -> Vec<Pair> {
        let pairs_at = |vertex: usize| {
            let vertex = dual.triangles.vertex(FixedVertexHandle::from_index(vertex));
            let later = move |edge: &Edge<'_>| edge.to().index() > vertex.index();
            vertex
                .out_edges()
                .filter(later)
                .filter_map(|edge| self.pair(edge))
        };
        let vertices = (0..dual.triangles.num_vertices()).into_par_iter();
        vertices.flat_map_iter(pairs_at).collect()
    }

    fn pair(&self, edge: Edge<'_>) -> Option<Pair> {
        let faces = [edge.face(), edge.rev().face()];
        let [a, b] = faces.map(|face| face.fix().index() as u32);
        if a == 0 || b == 0 {
            return None;
        }
        let corners = [a - 1, b - 1];
        let [a, b] = corners.map(|index| self.at(index, [0; 2]));
        let others = [edge, edge.rev()].map(|edge| edge.next().to());
        let [c, d] = others;
        let sites = [edge.from(), edge.to(), c, d].map(|vertex| *vertex.data());
        ((a - b).abs().max_element() <= SAME).then_some(Pair { corners, sites })
    }
}

/// Two neighbouring corners at one place, with the sites around them.
struct Pair {
    corners: [u32; 2],
    sites: [Site; 4],
}

/// The first of those joined with it, with the ways there made shorter.
fn root(parents: &mut [u32], member: u32) -> u32 {
    let mut top = member;
    while parents[top as usize] != top {
        top = parents[top as usize];
    }
    let mut member = member;
    while member != top {
        member = std::mem::replace(&mut parents[member as usize], top);
    }
    top
}

impl Place {
    fn both(self) -> (DVec2, [i8; 2]) {
        (self.at, self.shift)
    }

    /// The centre of the circle through three sites.
    fn of(sites: &[Site; 3], period: DVec2) -> Place {
        let home = sites.map(|site| home(&site, period));
        let is_lower = |a: usize, b: usize| (home[a].x, home[a].y) < (home[b].x, home[b].y);
        let mut first = 0;
        for other in 1..3 {
            if is_lower(other, first) {
                first = other;
            }
        }
        let shift = sites[first].shift;
        let turned = [first, (first + 1) % 3, (first + 2) % 3];
        let [a, b, c] = turned.map(|index| {
            let steps = [0, 1].map(|axis| f64::from(sites[index].shift[axis] - shift[axis]));
            home[index] + DVec2::from_array(steps) * period
        });
        Place {
            at: centre(a, b, c),
            shift,
        }
    }

    /// The centre of a circle on which all of these lie: of the one through three that are far from each other.
    fn of_many(mut sites: Vec<Site>, period: DVec2) -> Place {
        let order = |site: &Site| {
            let home = home(site, period);
            (home, site.shift)
        };
        sites.retain(|site| site.seed != FAR);
        sites.sort_by(|a, b| {
            let ((a, first), (b, second)) = (order(a), order(b));
            let by_place = a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
            by_place.then(first.cmp(&second))
        });
        let first = sites[0];
        let farthest = |measure: &dyn Fn(&Site) -> f64| {
            let later = |best: Site, site: &Site| {
                if measure(site) > measure(&best) {
                    *site
                } else {
                    best
                }
            };
            sites.iter().fold(first, later)
        };
        let second = farthest(&|site| site.at.distance_squared(first.at));
        let along = second.at - first.at;
        let third = farthest(&|site| along.perp_dot(site.at - first.at).abs());
        Place::of(&[first, second, third], period)
    }
}

/// Where a site is before it is moved.
fn home(site: &Site, period: DVec2) -> DVec2 {
    if site.shift == [0; 2] {
        return site.at;
    }
    let steps = site.shift.map(f64::from);
    site.at - DVec2::from_array(steps) * period
}

/// The centre of the circle through three points.
fn centre(a: DVec2, b: DVec2, c: DVec2) -> DVec2 {
    let (b, c) = (b - a, c - a);
    let along = b.length_squared() * c - c.length_squared() * b;
    a - along.perp() * (0.5 / cross(b, c))
}

/// `a.x b.y - a.y b.x`, with what the products lose by rounding where little is left of them.
fn cross(a: DVec2, b: DVec2) -> f64 {
    let (first, second) = (a.x * b.y, a.y * b.x);
    let difference = first - second;
    if difference.abs() > 1e-4 * (first.abs() + second.abs()) {
        return difference;
    }
    difference + (lost(a.x, b.y, first) - lost(a.y, b.x, second))
}

/// What rounding took from a product (Dekker 1971).
fn lost(a: f64, b: f64, product: f64) -> f64 {
    let ([a, low_a], [b, low_b]) = (halves(a), halves(b));
    low_a * low_b - (((product - a * b) - low_a * b) - a * low_b)
}

/// A number as the sum of two with half of the digits each.
fn halves(number: f64) -> [f64; 2] {
    let scaled = number * 134_217_729.0;
    let high = scaled - (scaled - number);
    [high, number - high]
}
