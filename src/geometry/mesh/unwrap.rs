//! Box unwrap: each triangle is projected along the axis that it faces most.
//!
//! A chart grows from its first triangle over edges to neighbours that face the same side of the box, as long as they
//! cover nothing that the chart covers already, so no two triangles share a place. All charts are packed at one scale.

use super::overlap::Covered;
use super::packing;
use super::{Placed, Soup, face_normal};
use glam::{DVec2, DVec3};
use std::collections::{HashMap, VecDeque};

/// Gives every triangle a place on the square.
pub(super) fn unwrap<E>(
    soup: &Soup,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Placed, E> {
    let sides: Vec<usize> = soup
        .triangles
        .iter()
        .map(|it| side(face_normal(&soup.points, it.points).unwrap_or(DVec3::Z)))
        .collect();
    let flat = |triangle: u32| flattened(soup, triangle, sides[triangle as usize]);
    let charts = grow(soup, &sides, &flat, go_on)?;
    let boxes: Vec<[DVec2; 2]> = charts
        .iter()
        .map(|members| bounds(members.iter().flat_map(|it| flat(*it))))
        .collect();
    let packed = packing::pack(&boxes);
    let mut placed = Placed {
        coordinates: vec![],
        corners: vec![[0; 3]; sides.len()],
        charts: vec![0; sides.len()],
    };
    for (chart, members) in charts.iter().enumerate() {
        // A point is in one place only in each chart: it is projected along one axis.
        let mut place_of: HashMap<u32, u32> = HashMap::new();
        for triangle in members {
            let points = soup.triangles[*triangle as usize].points;
            placed.charts[*triangle as usize] = chart as u32;
            for ((corner, point), place) in points.iter().enumerate().zip(flat(*triangle)) {
                let index = *place_of.entry(*point).or_insert_with(|| {
                    let moved = (place - boxes[chart][0]) * packed.scale + packed.corners[chart];
                    placed.coordinates.push(moved);
                    placed.coordinates.len() as u32 - 1
                });
                placed.corners[*triangle as usize][corner] = index;
            }
        }
    }
    Ok(placed)
}

/// The side of the box that a normal points to: +x, -x, +y, -y, +z, -z; the first of equal ones.
fn side(normal: DVec3) -> usize {
    let parts = normal.to_array();
    let mut largest = 0;
    for axis in 1..3 {
        if parts[axis].abs() > parts[largest].abs() {
            largest = axis;
        }
    }
    2 * largest + usize::from(parts[largest] < 0.0)
}

/// The corners of a triangle, seen from a side of the box: u to the right; v up, which is z or, from above and below, y.
fn flattened(soup: &Soup, triangle: u32, side: usize) -> [DVec2; 3] {
    let points = soup.triangles[triangle as usize].points;
    points.map(|index| {
        let point = soup.points[index as usize];
        match side {
            0 => DVec2::new(point.y, point.z),
            1 => DVec2::new(-point.y, point.z),
            2 => DVec2::new(-point.x, point.z),
            3 => DVec2::new(point.x, point.z),
            4 => DVec2::new(point.x, point.y),
            _ => DVec2::new(-point.x, point.y),
        }
    })
}

/// The triangles of every chart.
fn grow<E>(
    soup: &Soup,
    sides: &[usize],
    flat: &dyn Fn(u32) -> [DVec2; 3],
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Vec<Vec<u32>>, E> {
    let around = around_edges(soup);
    let cell = CellSize::new(sides, flat);
    let mut is_taken = vec![false; sides.len()];
    let mut charts = vec![];
    for first in 0..sides.len() as u32 {
        if is_taken[first as usize] {
            continue;
        }
        let mut covered = Covered::new(cell.of(sides[first as usize]));
        let (mut members, mut pending) = (vec![], VecDeque::from([first]));
        while let Some(triangle) = pending.pop_front() {
            if is_taken[triangle as usize] || !covered.add(flat(triangle)) {
                continue;
            }
            go_on()?;
            is_taken[triangle as usize] = true;
            members.push(triangle);
            let points = soup.triangles[triangle as usize].points;
            let neighbours = (0..3).flat_map(|side| &around[&edge(points, side)]);
            let of_this_side = |it: &&u32| sides[**it as usize] == sides[first as usize];
            pending.extend(neighbours.filter(of_this_side));
        }
        charts.push(members);
    }
    Ok(charts)
}

fn edge(points: [u32; 3], side: usize) -> [u32; 2] {
    let (from, to) = (points[side], points[(side + 1) % 3]);
    [from.min(to), from.max(to)]
}

/// The triangles at each edge; where many meet, the first of them, so that the work stays in proportion.
fn around_edges(soup: &Soup) -> HashMap<[u32; 2], Vec<u32>> {
    const MOST: usize = 16;
    let mut around: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    for (number, triangle) in (0..).zip(&soup.triangles) {
        for side in 0..3 {
            let there = around.entry(edge(triangle.points, side)).or_default();
            if there.len() < MOST {
                there.push(number);
            }
        }
    }
    around
}

/// How large cells are in which a chart looks for what it covers: some triangles wide, and not too many.
struct CellSize {
    of_side: [f64; 6],
}

impl CellSize {
    fn new(sides: &[usize], flat: &dyn Fn(u32) -> [DVec2; 3]) -> CellSize {
        let (mut sums, mut counts) = ([0.0; 6], [0.0f64; 6]);
        let mut all: [Option<[DVec2; 2]>; 6] = [None; 6];
        for (triangle, side) in (0..).zip(sides) {
            let [low, high] = bounds(flat(triangle));
            sums[*side] += (high - low).max_element();
            counts[*side] += 1.0;
            let [lowest, highest] = all[*side].unwrap_or([low, high]);
            all[*side] = Some([lowest.min(low), highest.max(high)]);
        }
        let size = |side: usize| {
            let whole = all[side].map_or(1.0, |[low, high]| (high - low).max_element());
            (2.0 * sums[side] / counts[side].max(1.0)).max(whole / 256.0)
        };
        CellSize {
            of_side: std::array::from_fn(size),
        }
    }

    fn of(&self, side: usize) -> f64 {
        self.of_side[side]
    }
}

/// The lowest and the highest corner of points, at least one.
pub(super) fn bounds(points: impl IntoIterator<Item = DVec2>) -> [DVec2; 2] {
    let start = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    let widen = |[low, high]: [DVec2; 2], point: DVec2| [low.min(point), high.max(point)];
    points.into_iter().fold(start, widen)
}
