//! Closed cells from packed stones: they tile the region, and those at its border are fitted to it.

use super::Stone;
use super::collapse::{Collapse, collapse};
use super::dual::{OUTSIDE, Site, mosaic};
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
}

/// The cells of stones; ids are the numbers of the stones. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn cells<E>(
    bed: &Bed<'_>,
    stones: &[Stone],
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Partition, E> {
    let tolerance = 1e-9 * bed.bounds[1].max_element();
    let partition = bed.covered(bed.pieces(stones, go_on)?, tolerance, go_on)?;
    let mean = stones
        .iter()
        .map(|stone| stone.scale * stone.scale)
        .sum::<f64>()
        / stones.len() as f64;
    let least = SLIVER * mean * bed.stone.x * bed.stone.y;
    let (partition, _) = merge_slivers(&partition, least, go_on)?;
    let limits = Collapse {
        short: SHORT[usize::from(bed.corners != 4)] * bed.stone.min_element() * mean.sqrt(),
        tolerance,
    };
    collapse(&partition, &limits, go_on)
}

impl Bed<'_> {
    /// The partition of pieces, cut off at the border, and of what they leave free.
    fn covered<E>(
        &self,
        pieces: Vec<Piece>,
        tolerance: f64,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Partition, E> {
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
        let ids = pieces.iter().map(|piece| piece.id);
        let highest = ids.max().unwrap_or_default();
        let numbered = gaps.into_iter().zip(highest + 1..);
        pieces.extend(numbered.map(|(piece, id)| Piece { id, ..piece }));
        assemble(pieces, None, tolerance, go_on)
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
        let pattern = pattern(self.stone, self.corners);
        let of_stone = |(owner, stone): (usize, &Stone)| {
            let places = pattern
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

/// Where the sites of a stone of size 1 are, from its middle.
fn pattern(stone: DVec2, corners: u32) -> Vec<DVec2> {
    if corners == 5 {
        return vec![DVec2::ZERO];
    }
    if corners != 4 {
        let turn = std::f64::consts::TAU / f64::from(corners);
        let site = |index: u32| {
            let (sine, cosine) = libm::sincos(turn * f64::from(index));
            0.25 * DVec2::new(cosine, sine) * stone
        };
        return (0..corners).map(site).collect();
    }
    let short = stone.min_element();
    let count = (2.0 * stone / short)
        .round()
        .clamp(DVec2::splat(2.0), DVec2::splat(16.0));
    let step = stone / count;
    let (columns, rows) = (count.x as usize, count.y as usize);
    let site = |index: usize| {
        let at = DVec2::new((index % columns) as f64, (index / columns) as f64);
        (at + 0.5 - 0.5 * count) * step
    };
    (0..columns * rows).map(site).collect()
}
