//! Weights of power cells that have stated areas.
//!
//! How the areas change with the weights is known: where the border between two cells has the length l and their seeds the distance d,
//!
//! ```text
//! dA_i / dw_j = -l / 2d
//! ```
//!
//! so the areas are the gradient of a concave function (Aurenhammer, Hoffmann & Aronov 1998), whose maximum Newton's method finds
//! from the Voronoi cells on, with steps so short that no cell vanishes (Kitagawa, Merigot & Thibert 2019, algorithm 1; de Goes,
//! Breeden, Ostromoukhov & Desbrun 2012 for the use).

use super::super::division::{Plot, assembled};
use super::{bounds, pieces};
use crate::geometry::voronoi::{Link, potentials, power_cells};
use crate::node::{Build, Failure};
use crate::value::Partition;
use glam::DVec2;
use std::collections::BTreeMap;

/// Steps of Newton's method, at most.
const STEPS: usize = 60;

/// The shortest share of a step.
const SHORTEST: f64 = 1e-4;

/// Weights, and by how much the worst area is off, as a share of what it should be.
pub(super) struct Weights {
    pub(super) weights: Vec<f64>,
    pub(super) off: f64,
}

/// Seeds that have cells in a plot, and what each of them should have of it.
struct Wanted<'a> {
    plot: &'a Plot,
    build: &'a Build<'a>,
    places: Vec<DVec2>,
    areas: Vec<f64>,
}

/// What power cells have.
struct State {
    weights: Vec<f64>,
    areas: Vec<f64>,
    links: Vec<Link>,
}

/// The weights in mm² with which the areas of the cells in a plot are in the ratio of `shares`, of which each seed has one, up to
/// `tolerance`. Seeds without a Voronoi cell in the plot have none with these weights either.
///
/// # Errors
/// If the run was cancelled.
pub(super) fn weights(
    plot: &Plot,
    places: &[DVec2],
    shares: &[f64],
    tolerance: f64,
    build: &Build<'_>,
) -> Result<Weights, Failure> {
    let mut wanted = Wanted {
        plot,
        build,
        places: places.to_vec(),
        areas: vec![],
    };
    let areas = wanted.state(vec![0.0; places.len()])?.areas;
    let with: Vec<usize> = (0..places.len())
        .filter(|seed| areas[*seed] > 0.0)
        .collect();
    let sum_of = |list: &[f64]| with.iter().map(|seed| list[*seed]).sum::<f64>();
    let each = sum_of(&areas) / sum_of(shares);
    wanted.places = with.iter().map(|seed| places[*seed]).collect();
    wanted.areas = with.iter().map(|seed| each * shares[*seed]).collect();
    let found = wanted.solve(tolerance)?;
    // Others are so light that seeds with cells leave them nothing.
    let [low, high] = plot.bounds();
    let least = found.weights.iter().copied().fold(0.0, f64::min);
    let mut weights = vec![least - 16.0 * (high - low).length_squared(); places.len()];
    for (seed, weight) in with.iter().zip(&found.weights) {
        weights[*seed] = *weight;
    }
    let off = wanted.off(&found);
    Ok(Weights { weights, off })
}

impl Wanted<'_> {
    fn solve(&self, tolerance: f64) -> Result<State, Failure> {
        let mut state = self.state(vec![0.0; self.places.len()])?;
        let smallest = |areas: &[f64]| areas.iter().copied().fold(f64::INFINITY, f64::min);
        let least = 0.5 * smallest(&self.areas).min(smallest(&state.areas));
        for _ in 0..STEPS {
            if self.off(&state) <= tolerance {
                break;
            }
            let Some(next) = self.step(&state, least)? else {
                break;
            };
            state = next;
        }
        Ok(state)
    }

    /// A step of Newton's method, halved until all cells have at least an area and are nearer to what they should be.
    fn step(&self, state: &State, least: f64) -> Result<Option<State>, Failure> {
        let missing = self.missing(state);
        let full = potentials(&state.links, &missing, &mut || self.build.go_on())?;
        let mut share = 1.0;
        while share >= SHORTEST {
            let weights = state.weights.iter().zip(&full);
            let next = self.state(
                weights
                    .map(|(weight, more)| weight + share * more)
                    .collect(),
            )?;
            let is_nearer = length(&self.missing(&next)) <= (1.0 - 0.5 * share) * length(&missing);
            if is_nearer && next.areas.iter().all(|area| *area >= least) {
                return Ok(Some(next));
            }
            share *= 0.5;
        }
        Ok(None)
    }

    fn missing(&self, state: &State) -> Vec<f64> {
        let pairs = self.areas.iter().zip(&state.areas);
        pairs.map(|(wanted, area)| wanted - area).collect()
    }

    /// By how much the worst area is off.
    fn off(&self, state: &State) -> f64 {
        let missing = self.missing(state);
        let shares = missing.iter().zip(&self.areas);
        shares
            .map(|(missing, wanted)| missing.abs() / wanted)
            .fold(0.0, f64::max)
    }

    /// The cells with some weights.
    fn state(&self, weights: Vec<f64>) -> Result<State, Failure> {
        let mut go_on = || self.build.go_on();
        let cells = power_cells(&self.places, &weights, bounds(self.plot), &mut go_on)?;
        let mut cells = pieces(cells);
        let seeds = cells.pieces.iter().map(|piece| f64::from(piece.id));
        cells.values = BTreeMap::from([("seed", seeds.collect())]);
        let (period, tolerance) = (self.plot.period, self.plot.tolerance());
        let cells = self.plot.clip(cells, self.build)?;
        let cells = assembled(cells, period, tolerance, self.build)?;
        let seeds = &cells.attributes["seed"];
        let mut areas = vec![0.0; weights.len()];
        for (seed, area) in seeds.iter().zip(&cells.areas) {
            areas[*seed as usize] += area;
        }
        let links = self.links(&cells, seeds);
        Ok(State {
            weights,
            areas,
            links,
        })
    }

    /// How the areas of neighbours change with their weights.
    fn links(&self, cells: &Partition, seeds: &[f64]) -> Vec<Link> {
        let mut links = vec![];
        for cell in 0..cells.len() {
            for ring in cells.rings_of(cell) {
                for corner in ring.clone() {
                    let next = if corner + 1 == ring.end {
                        ring.start
                    } else {
                        corner + 1
                    };
                    let Some(other) = seeds.get(cells.neighbours[corner] as usize) else {
                        continue;
                    };
                    let (own, other) = (seeds[cell] as u32, *other as u32);
                    let edge = cells.corners[next] - cells.corners[corner];
                    if own < other {
                        let apart = self.apart(own, other, edge);
                        links.push((own, other, 0.5 * edge.length() / apart));
                    }
                }
            }
        }
        links
    }

    /// How far apart two seeds are across an edge between their cells; of seeds that repeat those that the edge is upright to.
    fn apart(&self, own: u32, other: u32, edge: DVec2) -> f64 {
        let between = self.places[other as usize] - self.places[own as usize];
        let Some(period) = self.plot.period else {
            return between.length();
        };
        let outward = -edge.perp().normalize_or_zero();
        let between = between - (between / period).round() * period;
        let steps = [-1.0, 0.0, 1.0];
        let all = steps.map(|y| steps.map(|x| between + DVec2::new(x, y) * period));
        let aside =
            |between: &DVec2| between.perp_dot(outward).abs() + (-between.dot(outward)).max(0.0);
        let upright = all.as_flattened().iter().copied();
        let upright = upright.min_by(|a, b| aside(a).total_cmp(&aside(b)));
        upright.unwrap_or(between).length()
    }
}

fn length(of: &[f64]) -> f64 {
    of.iter().map(|part| part * part).sum::<f64>().sqrt()
}
