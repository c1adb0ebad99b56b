//! Which particles are near each other: a grid of tiles, from which lists are made that last for some steps.

use glam::DVec2;
use rayon::prelude::*;

/// Particles that one task looks after.
pub(crate) const CHUNK: usize = 256;

/// Width of tiles as a share of the reach.
const TILE: f64 = 0.5;

/// Lists of the particles that are near each particle.
#[derive(Debug, Default)]
pub(crate) struct Neighbours {
    /// The particles themselves, and behind them their images in neighbouring periods: which particle, and by how much
    /// it is moved.
    pub(crate) sources: Vec<(u32, DVec2)>,
    /// For each chunk of particles where each particle's list ends, and the lists.
    chunks: Vec<(Vec<u32>, Vec<u32>)>,
}

impl Neighbours {
    /// Lists all sources for which `is_near(particle, source, offset)` holds, where no offset is longer than half of the
    /// reaches of both.
    pub(crate) fn new(
        points: &[DVec2],
        period: Option<DVec2>,
        reaches: &[f64],
        is_near: impl Fn(usize, usize, DVec2) -> bool + Sync,
    ) -> Neighbours {
        let farthest = reaches.iter().copied().fold(0.0, f64::max);
        let sources = sources(points, period, farthest);
        let places: Vec<DVec2> = sources
            .iter()
            .map(|(index, by)| points[*index as usize] + *by)
            .collect();
        let layers = layers(&sources, &places, reaches);
        let chunks = points.par_chunks(CHUNK).enumerate();
        let chunks = chunks.map(|(chunk, points)| {
            let (mut ends, mut list) = (vec![], vec![]);
            for (index, point) in points.iter().enumerate() {
                let index = chunk * CHUNK + index;
                for layer in &layers {
                    let reach = 0.5 * (reaches[index] + layer.reach);
                    layer.tiles.within(*point, reach, |item| {
                        let source = layer
                            .items
                            .as_ref()
                            .map_or(item, |items| items[item as usize]);
                        let offset = places[source as usize] - *point;
                        let other = sources[source as usize].0 as usize;
                        if source as usize != index
                            && offset.length_squared() < reach * reach
                            && is_near(index, other, offset)
                        {
                            list.push(source);
                        }
                    });
                }
                ends.push(list.len() as u32);
            }
            (ends, list)
        });
        Neighbours {
            chunks: chunks.collect(),
            sources,
        }
    }

    /// The sources near a particle.
    pub(crate) fn of(&self, index: usize) -> &[u32] {
        let (ends, list) = &self.chunks[index / CHUNK];
        let within = index % CHUNK;
        let from = if within == 0 { 0 } else { ends[within - 1] };
        &list[from as usize..ends[within] as usize]
    }
}

/// Sources of which none reaches twice as far as another.
struct Layer {
    /// How far they reach.
    reach: f64,
    /// Which sources; all if there is but one layer.
    items: Option<Vec<u32>>,
    tiles: Tiles,
}

/// Sources by how far they reach: each layer has tiles of its own size.
fn layers(sources: &[(u32, DVec2)], places: &[DVec2], reaches: &[f64]) -> Vec<Layer> {
    let farthest = reaches.iter().copied().fold(0.0, f64::max);
    let nearest = reaches.iter().copied().fold(farthest, f64::min);
    if nearest <= 0.0 || farthest < 2.0 * nearest {
        return vec![Layer {
            reach: farthest,
            items: None,
            tiles: Tiles::new(places, TILE * farthest),
        }];
    }
    let mut layers = vec![];
    let mut reach = farthest;
    while reach >= nearest {
        let is_here = |index: &u32| {
            let own = reaches[sources[*index as usize].0 as usize];
            own <= reach && own > 0.5 * reach
        };
        let items: Vec<u32> = (0..sources.len() as u32).filter(is_here).collect();
        let own: Vec<DVec2> = items.iter().map(|item| places[*item as usize]).collect();
        layers.push(Layer {
            reach,
            tiles: Tiles::new(&own, TILE * reach),
            items: Some(items),
        });
        reach *= 0.5;
    }
    layers
}

/// The points, and their images as far as `reach` beyond the period.
fn sources(points: &[DVec2], period: Option<DVec2>, reach: f64) -> Vec<(u32, DVec2)> {
    let mut sources: Vec<(u32, DVec2)> = (0..points.len() as u32)
        .map(|index| (index, DVec2::ZERO))
        .collect();
    let Some(period) = period else { return sources };
    let most = (reach / period).ceil().as_ivec2() + 1;
    for y in -most.y..=most.y {
        for x in (-most.x..=most.x).filter(|x| (*x, y) != (0, 0)) {
            let by = period * DVec2::new(f64::from(x), f64::from(y));
            for (index, point) in points.iter().enumerate() {
                let image = *point + by;
                if image.cmpgt(-DVec2::splat(reach)).all() && image.cmplt(period + reach).all() {
                    sources.push((index as u32, by));
                }
            }
        }
    }
    sources
}

/// Points sorted into square tiles.
#[derive(Debug)]
pub(crate) struct Tiles {
    low: DVec2,
    tile: f64,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Tiles {
    /// Sorts points into tiles of at least `tile` mm.
    pub(crate) fn new(points: &[DVec2], tile: f64) -> Tiles {
        let bounds = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = points.iter().fold(bounds, |(low, high), point| {
            (low.min(*point), high.max(*point))
        });
        let extent = if points.is_empty() {
            DVec2::ZERO
        } else {
            high - low
        };
        // No more tiles than points, about.
        let tile = tile.max((extent.x * extent.y / (2 * points.len() + 16) as f64).sqrt());
        let tile = tile.max(extent.max_element() / 30_000.0);
        let mut tiles = Tiles {
            low,
            tile,
            columns: (extent.x / tile) as usize + 1,
            rows: (extent.y / tile) as usize + 1,
            starts: vec![],
            items: vec![0; points.len()],
        };
        tiles.starts = vec![0; tiles.columns * tiles.rows + 1];
        let homes: Vec<usize> = points.iter().map(|point| tiles.home(*point)).collect();
        for home in &homes {
            tiles.starts[home + 1] += 1;
        }
        for index in 1..tiles.starts.len() {
            tiles.starts[index] += tiles.starts[index - 1];
        }
        let mut next = tiles.starts.clone();
        for (index, home) in homes.into_iter().enumerate() {
            tiles.items[next[home] as usize] = index as u32;
            next[home] += 1;
        }
        tiles
    }

    fn home(&self, point: DVec2) -> usize {
        let [x, y] = self.tile_of(point);
        y * self.columns + x
    }

    fn tile_of(&self, point: DVec2) -> [usize; 2] {
        let at = (point - self.low) / self.tile;
        [
            (at.x.max(0.0) as usize).min(self.columns - 1),
            (at.y.max(0.0) as usize).min(self.rows - 1),
        ]
    }

    /// Calls `take` with every point that is no farther than `reach` mm, and some that are.
    pub(crate) fn within(&self, point: DVec2, reach: f64, mut take: impl FnMut(u32)) {
        let ([left, bottom], [right, top]) =
            (self.tile_of(point - reach), self.tile_of(point + reach));
        let columns = left..=right;
        for row in bottom..=top {
            let first = row * self.columns;
            let from = self.starts[first + columns.start()] as usize;
            let to = self.starts[first + columns.end() + 1] as usize;
            self.items[from..to].iter().for_each(|item| take(*item));
        }
    }
}
