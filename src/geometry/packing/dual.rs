//! Cells around stones: what is nearer to one stone than to the others, with straight borders between corners.
//!
//! Each stone is stood for by a small grid of sites in its own frame, so that what is nearest to them is a square or a
//! rectangle of its size and direction rather than a Voronoi cell of its middle. What the sites of a stone have in common
//! becomes one cell, and what two stones have in common one straight edge.

use super::simple::is_simple;
use glam::DVec2;
use rayon::prelude::*;
use spade::handles::{DirectedEdgeHandle, FixedFaceHandle, InnerTag};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// Belongs to no stone: what is outside.
pub(crate) const OUTSIDE: u32 = u32::MAX;

/// A point that stands for a part of a stone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site {
    pub(crate) point: DVec2,
    /// The stone, or [`OUTSIDE`].
    pub(crate) owner: u32,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.point.x, self.point.y)
    }
}

/// Corners that cells share, and the cell of each stone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mosaic {
    /// Where three or more cells meet, in mm.
    pub(crate) points: Vec<DVec2>,
    /// Of each stone its corners, counterclockwise; none if it is too much in the way of others to have a cell.
    pub(crate) rings: Vec<Vec<u32>>,
}

/// How often rings are looked at until all are sound.
const ROUNDS: usize = 8;

type Triangles = DelaunayTriangulation<Site>;
type Edge<'a> = DirectedEdgeHandle<'a, Site, (), (), ()>;

/// The cells of `count` stones. Sites must be finite, and those of the outside all around. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn mosaic<E>(
    sites: Vec<Site>,
    count: usize,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Mosaic, E> {
    let Ok(triangles) = Triangles::bulk_load(sites) else {
        return Ok(Mosaic::default());
    };
    go_on()?;
    let mut owners: Vec<u32> = triangles
        .vertices()
        .map(|vertex| vertex.data().owner)
        .collect();
    hang_together(&triangles, &mut owners, count);
    let mut is_bent = vec![false; count];
    for _ in 0..ROUNDS {
        go_on()?;
        let rings = rings(&triangles, &owners, &is_bent);
        // A stone with fewer than three corners gives its place to a neighbour, whose corners change with that.
        let too_few: Vec<u32> = (0..count as u32)
            .filter(|stone| (1..3).contains(&rings[*stone as usize].len()))
            .collect();
        let mosaic = numbered(&triangles, rings);
        let crossed = mosaic.crossed();
        if too_few.is_empty() && crossed.is_empty() {
            return Ok(mosaic);
        }
        for stone in too_few {
            give_away(&triangles, &mut owners, |owner| owner == stone);
        }
        // The borders of what would cross itself keep their bends.
        crossed.into_iter().for_each(|stone| is_bent[stone] = true);
    }
    let rings = rings(&triangles, &owners, &is_bent);
    Ok(numbered(&triangles, rings))
}

impl Mosaic {
    /// The stones whose rings cross themselves.
    fn crossed(&self) -> Vec<usize> {
        let crosses = |stone: &usize| {
            let corners = self.rings[*stone].iter();
            let corners: Vec<DVec2> = corners
                .map(|corner| self.points[*corner as usize])
                .collect();
            corners.len() > 3 && !is_simple(&corners)
        };
        (0..self.rings.len())
            .into_par_iter()
            .filter(crosses)
            .collect()
    }
}

/// Leaves to each stone the largest set of its sites that hang together, and gives the others to neighbours.
fn hang_together(triangles: &Triangles, owners: &mut [u32], count: usize) {
    let mut groups: Vec<u32> = (0..owners.len() as u32).collect();
    for edge in triangles.undirected_edges() {
        let [a, b] = edge.vertices().map(|vertex| vertex.fix().index());
        if owners[a] == owners[b] {
            let (a, b) = (root(&mut groups, a as u32), root(&mut groups, b as u32));
            groups[a.max(b) as usize] = a.min(b);
        }
    }
    let mut sizes = vec![0_u32; owners.len()];
    for index in 0..owners.len() {
        sizes[root(&mut groups, index as u32) as usize] += 1;
    }
    let mut largest = vec![(0, u32::MAX); count];
    for (index, owner) in owners.iter().enumerate() {
        if *owner != OUTSIDE && groups[index] == index as u32 {
            let best = &mut largest[*owner as usize];
            if sizes[index] > best.0 {
                *best = (sizes[index], index as u32);
            }
        }
    }
    let mut is_apart = vec![false; owners.len()];
    for index in 0..owners.len() {
        let group = root(&mut groups, index as u32);
        is_apart[index] = owners[index] != OUTSIDE && largest[owners[index] as usize].1 != group;
    }
    if is_apart.contains(&true) {
        for _ in 0..4 {
            let before = owners.to_vec();
            for vertex in triangles.vertices() {
                let index = vertex.fix().index();
                if is_apart[index] {
                    let near = vertex
                        .out_edges()
                        .map(|edge| before[edge.to().fix().index()]);
                    owners[index] =
                        most(near.filter(|owner| *owner != before[index])).unwrap_or(before[index]);
                }
            }
            is_apart
                .iter_mut()
                .zip(owners.iter().zip(&before))
                .for_each(|(apart, (a, b))| *apart &= a == b);
        }
    }
}

/// Gives the sites of some owners to the neighbour that each has most edges with.
fn give_away(triangles: &Triangles, owners: &mut [u32], is_given: impl Fn(u32) -> bool) {
    let mine = triangles
        .vertices()
        .filter(|vertex| is_given(owners[vertex.fix().index()]));
    let mine: Vec<usize> = mine.map(|vertex| vertex.fix().index()).collect();
    let near = mine.iter().flat_map(|index| {
        let vertex = triangles.vertex(spade::handles::FixedVertexHandle::from_index(*index));
        vertex
            .out_edges()
            .map(|edge| owners[edge.to().fix().index()])
            .collect::<Vec<u32>>()
    });
    let taker = most(near.filter(|owner| !is_given(*owner))).unwrap_or(OUTSIDE);
    mine.into_iter().for_each(|index| owners[index] = taker);
}

/// The owner that comes most often, the lowest of equally frequent ones.
fn most(owners: impl Iterator<Item = u32>) -> Option<u32> {
    let mut owners: Vec<u32> = owners.collect();
    owners.sort_unstable();
    let runs = owners.chunk_by(|a, b| a == b);
    runs.rev().max_by_key(|run| run.len()).map(|run| run[0])
}

fn root(groups: &mut [u32], index: u32) -> u32 {
    let mut index = index;
    while groups[index as usize] != index {
        groups[index as usize] = groups[groups[index as usize] as usize];
        index = groups[index as usize];
    }
    index
}

/// Of each owner the triangles in which it meets two others, in their order around it.
fn rings(
    triangles: &Triangles,
    owners: &[u32],
    is_bent: &[bool],
) -> Vec<Vec<FixedFaceHandle<InnerTag>>> {
    let mut walk = Walk {
        owners,
        is_bent,
        is_passed: vec![false; triangles.num_directed_edges()],
    };
    let mut rings: Vec<(f64, Vec<FixedFaceHandle<InnerTag>>)> = vec![(0.0, vec![]); is_bent.len()];
    for edge in triangles.directed_edges() {
        let [stone, beyond] = [edge.from(), edge.to()].map(|end| owners[end.fix().index()]);
        if stone != OUTSIDE && stone != beyond && !walk.is_passed[edge.fix().index()] {
            let (area, ring) = walk.around(edge, stone);
            // Of several loops the largest is the outline.
            if area > rings[stone as usize].0 {
                rings[stone as usize] = (area, ring);
            }
        }
    }
    rings.into_iter().map(|(_, ring)| ring).collect()
}

/// A walk around stones.
struct Walk<'a> {
    owners: &'a [u32],
    is_bent: &'a [bool],
    /// The edges that it has passed.
    is_passed: Vec<bool>,
}

impl Walk<'_> {
    /// Goes around a stone from an edge on that leads out of it: twice what lies within, and the triangles that are corners.
    fn around(&mut self, edge: Edge<'_>, stone: u32) -> (f64, Vec<FixedFaceHandle<InnerTag>>) {
        let (mut ring, mut area) = (vec![], 0.0);
        let (mut at, mut before): (Edge<'_>, Option<DVec2>) = (edge, None);
        let mut first = None;
        while !std::mem::replace(&mut self.is_passed[at.fix().index()], true) {
            let Some(face) = at.face().as_inner() else {
                break;
            };
            let third = self.owners[at.next().to().fix().index()];
            let centre = face.circumcenter();
            let centre = DVec2::new(centre.x, centre.y);
            let base = *first.get_or_insert(centre);
            area += before.map_or(0.0, |before| (before - base).perp_dot(centre - base));
            before = Some(centre);
            let beyond = self.owners[at.to().fix().index()];
            // Where the outside is beyond, bends stay: the cell is cut off along the border afterwards.
            let is_kept =
                beyond == OUTSIDE || self.is_bent[stone as usize] || self.is_bent[beyond as usize];
            if is_kept || (third != stone && third != beyond) {
                ring.push(face.fix());
            }
            at = match third == stone {
                true => at.next().rev(),
                false => at.prev().rev(),
            };
        }
        (area, ring)
    }
}

/// Numbers the triangles that rings pass as corners.
fn numbered(triangles: &Triangles, rings: Vec<Vec<FixedFaceHandle<InnerTag>>>) -> Mosaic {
    let mut numbers = vec![u32::MAX; triangles.num_all_faces()];
    let mut corners = vec![];
    for face in rings.iter().flatten() {
        let number = &mut numbers[face.index()];
        if *number == u32::MAX {
            *number = corners.len() as u32;
            corners.push(*face);
        }
    }
    let place = |face: &FixedFaceHandle<InnerTag>| {
        let centre = triangles.face(*face).circumcenter();
        DVec2::new(centre.x, centre.y)
    };
    let number = |ring: Vec<FixedFaceHandle<InnerTag>>| {
        ring.iter().map(|face| numbers[face.index()]).collect()
    };
    Mosaic {
        points: corners.par_iter().map(place).collect(),
        rings: rings.into_iter().map(number).collect(),
    }
}
