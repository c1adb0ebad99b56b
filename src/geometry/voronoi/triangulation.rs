//! The Delaunay triangulation of the seeds, with four far away that close the outermost cells.
//!
//! Sites are inserted one by one in the order of `order`, each beside the last: `bulk_load` takes quadratic time where
//! the seeds nearest to the middle lie on one line.

use super::{SAME, Site, order};
use glam::DVec2;
use spade::handles::{DirectedEdgeHandle, FixedVertexHandle};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

/// Sites inserted between two questions whether to go on.
const AT_ONCE: usize = 4096;

/// Stands for no seed: the far ones.
pub(super) const FAR: u32 = u32::MAX;

/// How far away these are. The border between them and a seed lies outside of the ground.
const DISTANCE: f64 = 32.0;

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.at.x, self.at.y)
    }
}

/// The triangulation of `spade`.
pub(super) type Triangles = DelaunayTriangulation<Site>;

/// An edge from a site to a neighbour.
pub(super) type Edge<'a> = DirectedEdgeHandle<'a, Site, (), (), ()>;

/// The triangulation whose dual are the cells.
pub(super) struct Dual {
    pub(super) triangles: Triangles,
    /// Sites left out since they lie where others do.
    pub(super) equal: usize,
    /// The period of the sites.
    pub(super) period: Option<DVec2>,
}

impl Dual {
    /// Triangulates the sites; those that lie nearer to each other than can be told apart count as one.
    pub(super) fn new<E>(
        sites: &[Site],
        period: Option<DVec2>,
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Dual, E> {
        let mut sorted = order::sort(sites);
        sorted.dedup_by(|next, kept| next.at == kept.at);
        loop {
            let triangles = triangulate(&sorted, go_on)?;
            let doubled = doubled(&triangles);
            if doubled.is_empty() {
                return Ok(Dual {
                    triangles,
                    equal: sites.len() - sorted.len(),
                    period,
                });
            }
            sorted.retain(|site| doubled.binary_search(&site.seed).is_err());
        }
    }

    /// The vertex of each seed that is in its own place, of so many seeds.
    pub(super) fn vertices(&self, seeds: usize) -> Vec<Option<FixedVertexHandle>> {
        let mut vertices = vec![None; seeds];
        for vertex in self.triangles.vertices() {
            let site = vertex.data();
            if site.seed != FAR && site.shift == [0; 2] {
                vertices[site.seed as usize] = Some(vertex.fix());
            }
        }
        vertices
    }
}

fn triangulate<E>(
    sites: &[Site],
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Triangles, E> {
    let count = sites.len() + 4;
    let mut triangles = Triangles::with_capacity(count, 3 * count, 2 * count);
    let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let far = signs.map(|(x, y)| Site {
        at: DVec2::new(x, y) * DISTANCE,
        seed: FAR,
        shift: [0; 2],
    });
    let mut last = FixedVertexHandle::from_index(0);
    for (index, site) in far.iter().chain(sites).enumerate() {
        if index.is_multiple_of(AT_ONCE) {
            go_on()?;
        }
        let inserted = if index == 0 {
            triangles.insert(*site)
        } else {
            triangles.insert_with_hint(*site, last)
        };
        last = inserted.expect("coordinates are finite and on a grid");
    }
    Ok(triangles)
}

/// The seeds too near to one with a lower number, sorted.
fn doubled(triangles: &Triangles) -> Vec<u32> {
    let pairs = triangles.undirected_edges().filter_map(|edge| {
        let [a, b] = edge.vertices().map(|vertex| *vertex.data());
        ((a.at - b.at).abs().max_element() < SAME).then(|| a.seed.max(b.seed))
    });
    let mut doubled: Vec<_> = pairs.collect();
    doubled.sort_unstable();
    doubled
}
