//! Closed cells from packed stones: they tile the region, and those at its border are fitted to it.

use super::Stone;
use super::collapse::{Collapse, collapse};
use super::dual::{OUTSIDE, Site, mosaic};
use super::guide::Guide;
use super::walls::Walls;
use crate::geometry::assemble::{Piece, Ring, assemble, clip, merge_slivers};
use crate::geometry::polygon::{Edges, Lattice, Operation, doubled_area};
use crate::value::{Partition, Polygon, Region};
use glam::DVec2;
use rayon::prelude::*;

/// How far beyond the border cells reach before they are cut off, as a share of a stone's width.
const BEYOND: f64 = 0.25;

/// Cells smaller than this share of their stone become parts of their neighbours.
const SLIVER: f64 = 0.25;

/// Corners nearer than this share of a stone become one where stones have four corners, and where they have more.
const SHORT: [f64; 2] = [0.36, 0.12];

/// Sizes that differ by less than this factor are alike.
const UNLIKE: f64 = 1.5;

/// Most parts of a side.
const MOST_PARTS: f64 = 32.0;

/// The corners of a square, and the middles of its sides.
const AROUND: [(f64, f64); 8] = [
    (1.0, 0.0),
    (1.0, 1.0),
    (0.0, 1.0),
    (-1.0, 1.0),
    (-1.0, 0.0),
    (-1.0, -1.0),
    (0.0, -1.0),
    (1.0, -1.0),
];

/// How much of a region may be left out.
const LEFT_OUT: f64 = 1e-12;

/// What cells are made in.
pub(crate) struct Bed<'a> {
    pub(crate) region: &'a Region,
    /// The border; none in a periodic bed.
    pub(crate) walls: Option<&'a Walls>,
    /// From the lowest corner on, width and height.
    pub(crate) bounds: [DVec2; 2],
    pub(crate) period: Option<DVec2>,
    /// Length and width of a stone of size 1, in mm.
    pub(crate) stone: DVec2,
    pub(crate) corners: u32,
    pub(crate) guide: &'a Guide,
}

/// The cells of stones; ids are the numbers of the stones, and of what no stone reached higher ones. `go_on` is asked now
/// and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn cells<E>(
    bed: &Bed<'_>,
    stones: &[Stone],
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Partition, E> {
    let tolerance = 1e-9 * bed.bounds[1].max_element();
    let partition = bed.covered(stones, tolerance, go_on)?;
    let least = SLIVER * bed.stone.x * bed.stone.y;
    let sizes = bed.sizes(&partition, stones);
    let (partition, _) =
        merge_slivers(&partition, |cell| least * sizes[cell] * sizes[cell], go_on)?;
    let short = SHORT[usize::from(bed.corners != 4)] * bed.stone.min_element();
    let sizes = bed.sizes(&partition, stones);
    let limits = Collapse {
        short: sizes.into_iter().map(|size| short * size).collect(),
        tolerance,
    };
    collapse(&partition, &limits, go_on)
}

impl Bed<'_> {
    /// The partition of the stones' pieces, cut off at the border, and of what they leave free.
    fn covered<E>(
        &self,
        stones: &[Stone],
        tolerance: f64,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Partition, E> {
        let pieces = self.pieces(stones, go_on)?;
        if self.period.is_some() {
            return assemble(pieces, self.period, tolerance, go_on);
        }
        let mut pieces = clip(pieces, self.region, go_on)?;
        let partition = assemble(pieces.clone(), None, tolerance, go_on)?;
        let gaps = self.gaps(&partition);
        go_on()?;
        if gaps.is_empty() {
            return Ok(partition);
        }
        let numbered = gaps.into_iter().zip(stones.len() as u32..);
        pieces.extend(numbered.map(|(piece, id)| Piece { id, ..piece }));
        assemble(pieces, None, tolerance, go_on)
    }

    /// The usual size factor of stones where each cell is: that of the place times the random ones' quadratic mean.
    fn sizes(&self, partition: &Partition, stones: &[Stone]) -> Vec<f64> {
        let random = |stone: &Stone| stone.scale / self.guide.scale(stone.point);
        let squares = stones.iter().map(|stone| random(stone) * random(stone));
        let mean = squares.sum::<f64>() / stones.len().max(1) as f64;
        let usual = if stones.is_empty() { 1.0 } else { mean.sqrt() };
        let size = |cell: usize| {
            let stone = stones.get(partition.ids[cell] as usize);
            usual
                * self
                    .guide
                    .scale(stone.map_or(partition.centres[cell], |stone| stone.point))
        };
        (0..partition.len()).map(size).collect()
    }

    /// What of the region lies in no cell: slips of land behind corners that turn into it.
    fn gaps(&self, partition: &Partition) -> Vec<Piece> {
        let whole: f64 = self.region.rings().map(doubled_area).sum();
        let covered: f64 = partition.areas.iter().sum();
        if 0.5 * whole - covered < LEFT_OUT * whole {
            return vec![];
        }
        let is_outer = |cell: &usize| {
            let mut edges = partition.rings_of(*cell).flatten();
            edges.any(|edge| partition.neighbours[edge] == Partition::NONE)
        };
        let (outer, inner): (Vec<usize>, Vec<usize>) = (0..partition.len()).partition(is_outer);
        let rings: Vec<&[DVec2]> = outer
            .iter()
            .flat_map(|cell| {
                partition
                    .rings_of(*cell)
                    .map(|ring| &partition.corners[ring])
            })
            .collect();
        let region: Vec<&[DVec2]> = self.region.rings().collect();
        let [low, extent] = self.bounds;
        let lattice = Lattice::around([low, low + extent]);
        let left = lattice.overlay(Operation::Difference, &region, &rings);
        // What the inner cells cover is left as well.
        let is_gap = |polygon: &Polygon| {
            let edges = Edges::new(polygon.rings());
            !inner
                .iter()
                .any(|cell| edges.enclose(partition.centres[*cell]))
        };
        let gaps = left.into_iter().filter(is_gap);
        let piece = |polygon: Polygon| Piece {
            rings: std::iter::once(polygon.outline)
                .chain(polygon.holes)
                .map(Ring::straight)
                .collect(),
            id: 0,
            frame: DVec2::X,
            centre: None,
        };
        gaps.map(piece).collect()
    }

    /// The cell of each stone, which may reach beyond the border.
    fn pieces<E>(
        &self,
        stones: &[Stone],
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Vec<Piece>, E> {
        let all = self.with_images(stones);
        let usual = pattern(self.stone, self.corners, 1);
        let is_even = self.guide.largest() < UNLIKE * self.guide.least();
        let of_stone = |(owner, stone): (usize, &Stone)| {
            let parts = if is_even { 1 } else { self.parts(stone) };
            let finer = (parts > 1).then(|| pattern(self.stone, self.corners, parts));
            let places = finer
                .as_ref()
                .unwrap_or(&usual)
                .iter()
                .map(|at| stone.point + stone.frame.rotate(*at * stone.scale));
            let sites = places.map(|point| Site {
                point,
                owner: owner as u32,
            });
            let mut sites: Vec<Site> = sites.collect();
            let outside = self.outside(stone, &sites);
            sites.extend(outside);
            sites
        };
        let mut sites: Vec<Site> = all.par_iter().enumerate().flat_map_iter(of_stone).collect();
        sites.extend(self.guards());
        go_on()?;
        let mosaic = mosaic(sites, all.len(), go_on)?;
        let ring = |ring: &Vec<u32>| {
            ring.iter()
                .map(|corner| mosaic.points[*corner as usize])
                .collect()
        };
        let rings = mosaic
            .rings
            .iter()
            .take(stones.len())
            .zip(stones)
            .enumerate();
        let pieces = rings.filter(|(_, (corners, _))| corners.len() >= 3);
        let piece = |(id, (corners, stone)): (usize, (&Vec<u32>, &Stone))| Piece {
            rings: vec![Ring::straight(ring(corners))],
            id: id as u32,
            frame: stone.frame,
            centre: None,
        };
        Ok(pieces.map(piece).collect())
    }

    /// How many of the stones beside a stone its side is as long as, where they are smaller.
    fn parts(&self, stone: &Stone) -> u32 {
        let own = self.guide.scale(stone.point);
        let (half, wide) = (0.5 * stone.scale * self.stone, self.stone.y);
        let places = AROUND.map(|at| {
            let beyond = DVec2::from(at) * (half + wide);
            self.guide.scale(stone.point + stone.frame.rotate(beyond))
        });
        let least = places.into_iter().fold(own, f64::min);
        if own < UNLIKE * least {
            return 1;
        }
        (own / least).round().min(MOST_PARTS) as u32
    }

    /// The stones, and behind them their images around the period.
    fn with_images(&self, stones: &[Stone]) -> Vec<Stone> {
        let mut all = stones.to_vec();
        let Some(period) = self.period else {
            return all;
        };
        let largest = stones.iter().map(|stone| stone.scale).fold(0.0, f64::max);
        let margin = 3.0 * largest * self.stone.max_element();
        let most = (margin / period).ceil().as_ivec2();
        for y in -most.y..=most.y {
            for x in (-most.x..=most.x).filter(|x| (*x, y) != (0, 0)) {
                let by = period * DVec2::new(f64::from(x), f64::from(y));
                let images = stones.iter().map(|stone| Stone {
                    point: stone.point + by,
                    ..*stone
                });
                all.extend(images.filter(|image| {
                    image.point.cmpgt(-DVec2::splat(margin)).all()
                        && image.point.cmplt(period + margin).all()
                }));
            }
        }
        all
    }

    /// Images of a stone's sites beyond the borders nearby, so that its cell ends a little outside.
    fn outside(&self, stone: &Stone, sites: &[Site]) -> Vec<Site> {
        let Some(walls) = self.walls else {
            return vec![];
        };
        let size = stone.scale * self.stone.max_element();
        let beyond = BEYOND * stone.scale * self.stone.min_element();
        let mut outside = vec![];
        for foot in walls.feet(stone.point) {
            let height = foot.height(stone.point);
            if foot.distance > 1.2 * size || height < 0.5 * foot.distance {
                continue;
            }
            for site in sites {
                let height = (site.point - foot.point).dot(foot.inward).max(0.0);
                let point = site.point - 2.0 * (height + beyond) * foot.inward;
                if !walls.contains(point) {
                    outside.push(Site {
                        point,
                        owner: OUTSIDE,
                    });
                }
            }
        }
        outside
    }

    /// Sites far away, so that all cells end somewhere.
    fn guards(&self) -> impl Iterator<Item = Site> {
        let [low, extent] = self.bounds;
        let middle = low + 0.5 * extent;
        let far = 4.0 * (extent.max_element() + self.stone.max_element());
        [
            (1.0, 0.1),
            (0.7, 0.72),
            (0.1, 1.0),
            (-0.7, 0.7),
            (-1.0, 0.1),
            (-0.72, -0.7),
            (-0.1, -1.0),
            (0.7, -0.71),
        ]
        .into_iter()
        .map(move |at| Site {
            point: middle + far * DVec2::from(at),
            owner: OUTSIDE,
        })
    }
}

/// Where the sites of a stone of size 1 are, from its middle: near its sides, each of which is divided into `parts`, as
/// near as those of stones as long as a part.
fn pattern(stone: DVec2, corners: u32, parts: u32) -> Vec<DVec2> {
    if corners == 5 {
        return vec![DVec2::ZERO];
    }
    let share = 1.0 / f64::from(parts);
    if corners != 4 {
        let turn = std::f64::consts::TAU / f64::from(corners);
        let depth = 0.5 - 0.25 * share;
        let length = 2.0 * depth * libm::tan(0.5 * turn);
        let site = |index: u32| {
            let (sine, cosine) = libm::sincos(turn * f64::from(index / parts));
            let normal = DVec2::new(cosine, sine);
            let aside = length * ((f64::from(index % parts) + 0.5) * share - 0.5);
            (depth * normal + aside * normal.perp()) * stone
        };
        return (0..corners * parts).map(site).collect();
    }
    let short = stone.min_element();
    let count = (2.0 * stone / short)
        .round()
        .clamp(DVec2::splat(2.0), DVec2::splat(16.0))
        * f64::from(parts);
    let step = stone / count;
    let (columns, rows) = (count.x as usize, count.y as usize);
    let is_outer = |index: &usize| {
        let (column, row) = (index % columns, index / columns);
        column == 0 || row == 0 || column + 1 == columns || row + 1 == rows
    };
    let site = |index: usize| {
        let at = DVec2::new((index % columns) as f64, (index / columns) as f64);
        (at + 0.5 - 0.5 * count) * step
    };
    let sites = (0..columns * rows).filter(|index| parts == 1 || is_outer(index));
    sites.map(site).collect()
}
