//! The parts of pieces that lie in a region.

use super::{Piece, Ring};
use crate::geometry::polygon::{Edges, Lattice, Operation, cut_to_box, doubled_area};
use crate::value::{Polygon, Region};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Fields along a side of the region, in each of which its edges are looked for once.
const FIELDS: f64 = 24.0;

/// The parts of the pieces inside the region, in their order. Pieces wholly inside stay as they are bit by bit; each connected part
/// becomes a piece of its own: the largest keeps the id, the others get new ids behind the highest. Edges must be
/// straight. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn clip<E>(
    pieces: Vec<Piece>,
    region: &Region,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Vec<Piece>, E> {
    Ok(clip_from(pieces, region, go_on)?.0)
}

/// [`clip`], and which piece each part was cut from.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn clip_from<E>(
    pieces: Vec<Piece>,
    region: &Region,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(Vec<Piece>, Vec<usize>), E> {
    let clipper = Clipper::new(region);
    let place = |piece: &Piece| clipper.place(piece);
    let places: Vec<Place> = pieces.par_iter().map(place).collect();
    go_on()?;
    let parts = clipper.parts(&pieces, &places, go_on)?;
    let ids = pieces.iter().map(|piece| piece.id);
    let highest = ids.max().unwrap_or_default();
    let mut clipped = vec![];
    let mut more = vec![];
    for (number, ((piece, place), parts)) in pieces.into_iter().zip(places).zip(parts).enumerate() {
        match (place, parts) {
            (_, Some(parts)) => {
                let mut parts = parts.into_iter().map(|part| (part, number));
                clipped.extend(parts.next());
                more.extend(parts);
            }
            (Place::Inside, None) => clipped.push((piece, number)),
            _ => {}
        }
    }
    let ids = highest.saturating_add(1)..;
    more.iter_mut()
        .zip(ids)
        .for_each(|((part, _), id)| part.id = id);
    clipped.extend(more);
    Ok(clipped.into_iter().unzip())
}

/// Where a piece lies.
enum Place {
    Inside,
    Outside,
    /// Edges of the region come near; the piece is in this field.
    Border([i64; 2]),
}

/// Pieces that are cut between two questions whether to go on; those of one field are cut together.
const AT_ONCE: usize = 512;

struct Clipper<'a> {
    region: &'a Region,
    edges: Edges,
    lattice: Lattice,
    low: DVec2,
    high: DVec2,
}

impl<'a> Clipper<'a> {
    fn new(region: &'a Region) -> Clipper<'a> {
        let corners = region.rings().flatten().copied();
        let [low, high] = bounds(corners);
        Clipper {
            region,
            edges: Edges::new(region.rings()),
            lattice: Lattice::around([low, high]),
            low,
            high,
        }
    }

    fn place(&self, piece: &Piece) -> Place {
        let [low, high] = bounds(
            piece
                .rings
                .iter()
                .flat_map(|ring| ring.corners.iter().copied()),
        );
        let margin = self.margin();
        if low.cmpgt(self.high + margin).any() || high.cmplt(self.low - margin).any() {
            return Place::Outside;
        }
        if !self.edges.come_near([low - margin, high + margin]) {
            let is_inside = self.edges.enclose(0.5 * (low + high));
            return if is_inside {
                Place::Inside
            } else {
                Place::Outside
            };
        }
        let middle = 0.5 * (low + high).clamp(2.0 * self.low, 2.0 * self.high);
        let field = ((middle - self.low) / (self.high - self.low) * FIELDS).floor();
        Place::Border(field.as_i64vec2().to_array())
    }

    /// The parts of the pieces at the border, by the pieces.
    fn parts<E>(
        &self,
        pieces: &[Piece],
        places: &[Place],
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Vec<Option<Vec<Piece>>>, E> {
        let mut fields: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
        for (number, place) in places.iter().enumerate() {
            if let Place::Border(field) = place {
                fields.entry(*field).or_default().push(number);
            }
        }
        let mut parts: Vec<Option<Vec<Piece>>> = pieces.iter().map(|_| None).collect();
        let mut fields: Vec<Vec<usize>> = fields.into_values().collect();
        while !fields.is_empty() {
            go_on()?;
            let mut count = 0;
            let mut is_next = |field: &[usize]| {
                count += field.len();
                count <= AT_ONCE
            };
            let next = fields
                .iter()
                .take_while(|field| is_next(field))
                .count()
                .max(1);
            let next: Vec<Vec<usize>> = fields.drain(..next).collect();
            let cut = next.par_iter();
            let cut = cut.flat_map_iter(|numbers| self.clip_all(pieces, numbers));
            for (number, of_piece) in cut.collect::<Vec<_>>() {
                parts[number] = Some(of_piece);
            }
        }
        Ok(parts)
    }

    /// Some steps of the lattice.
    fn margin(&self) -> f64 {
        64.0 * self.lattice.step()
    }

    /// The parts of some pieces that are close together.
    fn clip_all(&self, pieces: &[Piece], numbers: &[usize]) -> Vec<(usize, Vec<Piece>)> {
        let rings = numbers.iter().flat_map(|number| &pieces[*number].rings);
        let around = self.window(bounds(rings.flat_map(|ring| ring.corners.iter().copied())));
        let near: Vec<_> = self
            .region
            .rings()
            .map(|ring| cut_to_box(ring, around))
            .collect();
        let clip = |number: &usize| (*number, self.clip_one(&pieces[*number], &near));
        numbers.iter().map(clip).collect()
    }

    /// A box with some space around it, but not much larger than the region.
    fn window(&self, [low, high]: [DVec2; 2]) -> [DVec2; 2] {
        let extent = self.high - self.low;
        let space = 0.25 * (high - low) + self.margin();
        let low = (low - space).max(self.low - 0.5 * extent - self.margin());
        [
            low,
            (high + space).min(self.high + 0.5 * extent + self.margin()),
        ]
    }

    fn clip_one(&self, piece: &Piece, near: &[Vec<DVec2>]) -> Vec<Piece> {
        let corners = piece
            .rings
            .iter()
            .flat_map(|ring| ring.corners.iter().copied());
        let around = self.window(bounds(corners));
        let cut = |ring: &[DVec2]| cut_to_box(ring, around);
        let region: Vec<_> = near
            .iter()
            .map(|ring| cut(ring))
            .filter(|ring| !ring.is_empty())
            .collect();
        let drawn: Vec<_> = piece.rings.iter().map(|ring| cut(&ring.corners)).collect();
        let [first, second] =
            [&drawn, &region].map(|rings| rings.iter().map(|ring| &ring[..]).collect::<Vec<_>>());
        let polygons = self
            .lattice
            .overlay(Operation::Intersection, &first, &second);
        let mut parts: Vec<(f64, Polygon)> = polygons
            .into_iter()
            .map(|polygon| (polygon.rings().map(doubled_area).sum::<f64>(), polygon))
            .collect();
        let whole: f64 = piece
            .rings
            .iter()
            .map(|ring| doubled_area(&ring.corners))
            .sum();
        let length: f64 = first.iter().map(|ring| perimeter(ring)).sum();
        let unsure = 16.0 * self.lattice.step() * length;
        if parts.len() == 1 && (whole - parts[0].0).abs() <= unsure {
            return vec![piece.clone()];
        }
        parts.retain(|(area, _)| *area > unsure);
        parts.sort_by(|a, b| b.0.total_cmp(&a.0));
        parts
            .into_iter()
            .map(|(_, polygon)| part_of(piece, polygon))
            .collect()
    }
}

/// A part of a piece: the middle stays where it is if it is within the part.
fn part_of(piece: &Piece, polygon: Polygon) -> Piece {
    let has = |centre: &DVec2| Edges::new(polygon.rings()).enclose(*centre);
    let centre = piece.centre.filter(has);
    let rings = std::iter::once(polygon.outline).chain(polygon.holes);
    Piece {
        rings: rings.map(Ring::straight).collect(),
        centre,
        ..*piece
    }
}

fn perimeter(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
}

/// The lowest and highest coordinates of points.
fn bounds(points: impl Iterator<Item = DVec2>) -> [DVec2; 2] {
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    points.fold(none, |[low, high], point| [low.min(point), high.max(point)])
}
