//! Mends drawn polygons by rule, and says what was wrong with them.

mod clean;

use super::{Edges, Lattice, Operation, cut_to_box, doubled_area};
use crate::value::{Polygon, Region};
use clean::{clean, is_thin};
use glam::DVec2;

/// Narrower parts than this share of the extent are slivers: twice their area over their length.
const SLIVER: f64 = 1e-9;

/// What is wrong with a ring, and was mended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Wrong {
    /// A corner is where the one before it is: it is taken out.
    Repeated,
    /// The line turns back on itself: what has no area is taken out.
    Spike,
    /// An outline runs clockwise: it is turned.
    Clockwise,
    /// The line crosses or touches itself: it encloses what it winds around.
    Crosses,
    /// A hole lies outside its outline: it is left out.
    Outside,
    /// A hole reaches beyond its outline: what is beyond is left out.
    Beyond,
    /// A hole touches the outline, or shares corners or edges with another hole: they are joined.
    Touches,
    /// Outlines of two polygons overlap: they are joined.
    Overlaps,
    /// A part is thinner than a billionth of the whole: it is left out.
    Sliver,
}

/// Something that was mended: what, in which ring, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) wrong: Wrong,
    /// The polygon, and in it the hole; `None` is the outline.
    pub(crate) ring: (usize, Option<usize>),
    /// Where it is, in mm.
    pub(crate) at: DVec2,
}

/// Why a ring encloses nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Nothing {
    /// It has fewer than three different corners; so many.
    Corners(usize),
    /// All its corners lie on a line, or what it encloses is thinner than a billionth of the whole.
    Area,
}

/// Makes a region of polygons that anybody has drawn. A ring encloses what it winds around, whichever way it runs; what is
/// in several polygons counts once; holes are taken from their own polygon. Corners must be finite.
///
/// # Errors
/// The first ring that encloses nothing.
pub(crate) fn mend(drawn: &[Polygon]) -> Result<(Region, Vec<Fault>), (Number, Nothing)> {
    let corners = drawn.iter().flat_map(Polygon::rings).flatten();
    let [low, high] = corners.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| {
        [low.min(*at), high.max(*at)]
    });
    let mut mender = Mender {
        lattice: Lattice::around([low, high]),
        thin: SLIVER * (high - low).max_element(),
        faults: vec![],
    };
    let mut polygons = vec![];
    for (number, polygon) in drawn.iter().enumerate() {
        polygons.push(mender.polygon(number, polygon)?);
    }
    let polygons = mender.united(polygons);
    if polygons.is_empty() {
        return Err(((0, None), Nothing::Area));
    }
    Ok((Region { polygons }, mender.faults))
}

struct Mender {
    lattice: Lattice,
    /// Narrower parts are slivers, in mm.
    thin: f64,
    faults: Vec<Fault>,
}

/// The polygon, and in it the hole; `None` is the outline.
pub(crate) type Number = (usize, Option<usize>);

impl Mender {
    fn note(&mut self, wrong: Wrong, ring: Number, at: DVec2) {
        self.faults.push(Fault { wrong, ring, at });
    }

    /// A polygon without its holes.
    fn polygon(
        &mut self,
        number: usize,
        drawn: &Polygon,
    ) -> Result<Vec<Polygon>, (Number, Nothing)> {
        let outline = self.ring((number, None), &drawn.outline)?;
        if drawn.holes.is_empty() {
            return Ok(outline);
        }
        let edges = Edges::new(outline.iter().flat_map(Polygon::rings));
        let mut holes: Vec<Vec<Polygon>> = vec![];
        for (hole, corners) in drawn.holes.iter().enumerate() {
            let name = (number, Some(hole));
            let within = self.ring(name, corners)?;
            if self.lies_within(name, &within, &outline, &edges) {
                holes.push(within);
            }
        }
        self.compare(number, &holes);
        let outline = rings_of(&outline);
        let holes: Vec<&[DVec2]> = holes.iter().flat_map(|hole| rings_of(hole)).collect();
        let left = self
            .lattice
            .overlay(Operation::Difference, &outline, &holes);
        let left = self.without_slivers(number, left);
        if left.is_empty() {
            return Err(((number, None), Nothing::Area));
        }
        Ok(left)
    }

    /// What a ring winds around.
    fn ring(&mut self, name: Number, drawn: &[DVec2]) -> Result<Vec<Polygon>, (Number, Nothing)> {
        let mut ring = drawn.to_vec();
        // The last corner may be the first one, as in many files.
        if ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        for (wrong, at) in clean(&mut ring, self.lattice.step()) {
            self.note(wrong, name, at);
        }
        if ring.len() < 3 {
            let mut different: Vec<[u64; 2]> = drawn
                .iter()
                .map(|at| [(at.x + 0.0).to_bits(), (at.y + 0.0).to_bits()])
                .collect();
            different.sort_unstable();
            different.dedup();
            let nothing = match different.len() {
                few @ 0..3 => Nothing::Corners(few),
                _ => Nothing::Area,
            };
            return Err((name, nothing));
        }
        let around = self.lattice.overlay(Operation::Union, &[&ring], &[]);
        let signed = doubled_area(&ring);
        if let Some(at) = self.crossing(&ring, &around) {
            self.note(Wrong::Crosses, name, at);
        } else if signed < 0.0 && name.1.is_none() {
            self.note(Wrong::Clockwise, name, ring[0]);
        }
        let around = self.without_slivers(name.0, around);
        if around.is_empty() {
            return Err((name, Nothing::Area));
        }
        Ok(around)
    }

    /// Where a ring crosses or touches itself, if it does.
    fn crossing(&self, ring: &[DVec2], around: &[Polygon]) -> Option<DVec2> {
        let area: f64 = around
            .iter()
            .flat_map(Polygon::rings)
            .map(doubled_area)
            .sum();
        let drawn = doubled_area(ring).abs();
        let is_simple = matches!(around, [only] if only.holes.is_empty());
        let length: f64 = ring.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        if is_simple && (area - drawn).abs() <= 8.0 * self.lattice.step() * length {
            return None;
        }
        let mut corners = around.iter().flat_map(Polygon::rings).flatten();
        let new = corners.find(|corner| !ring.contains(corner));
        new.or(ring.first()).copied()
    }

    /// Whether a hole takes anything from the outline.
    fn lies_within(
        &mut self,
        name: Number,
        hole: &[Polygon],
        outline: &[Polygon],
        edges: &Edges,
    ) -> bool {
        let corners = || hole.iter().flat_map(|part| part.outline.iter().copied());
        let Some(first) = corners().next() else {
            return false;
        };
        let [low, high] = corners().fold([first; 2], |[low, high], at| [low.min(at), high.max(at)]);
        let margin = DVec2::splat(self.thin);
        let around = [low - margin, high + margin];
        if !edges.come_near(around) {
            let is_inside = edges.enclose(first);
            if !is_inside {
                self.note(Wrong::Outside, name, first);
            }
            return is_inside;
        }
        let near: Vec<Vec<DVec2>> = rings_of(outline)
            .iter()
            .map(|ring| cut_to_box(ring, around))
            .collect();
        let near: Vec<&[DVec2]> = near.iter().map(|ring| &ring[..]).collect();
        let common = self
            .lattice
            .overlay(Operation::Intersection, &rings_of(hole), &near);
        let [whole, common] = [hole, &common].map(area);
        let unsure = self.thin * (high - low).element_sum();
        if common <= unsure {
            self.note(Wrong::Outside, name, first);
            return false;
        }
        let wrong = if common < whole - unsure {
            Wrong::Beyond
        } else {
            Wrong::Touches
        };
        let off = corners().map(|corner| (edges.distance(corner), corner));
        let inside = |corner: DVec2| edges.enclose(corner);
        match wrong {
            Wrong::Beyond => {
                let beyond = corners().find(|corner| !inside(*corner));
                self.note(wrong, name, beyond.unwrap_or(first));
            }
            _ => {
                let touching = off.into_iter().find(|(distance, _)| *distance <= self.thin);
                touching
                    .into_iter()
                    .for_each(|(_, at)| self.note(wrong, name, at));
            }
        }
        true
    }

    /// Notes holes that share corners.
    fn compare(&mut self, number: usize, holes: &[Vec<Polygon>]) {
        let all: Vec<&[DVec2]> = holes.iter().flat_map(|hole| rings_of(hole)).collect();
        let joined = self.lattice.overlay(Operation::Union, &all, &[]);
        let lone: f64 = holes.iter().map(|hole| area(hole)).sum();
        let parts: usize = holes.iter().map(Vec::len).sum();
        let is_even = (lone - area(&joined)).abs() <= self.thin * lone.sqrt();
        if joined.len() == parts && is_even {
            return;
        }
        for (hole, polygons) in holes.iter().enumerate().skip(1) {
            let before: Vec<&[DVec2]> = holes[..hole]
                .iter()
                .flat_map(|hole| rings_of(hole))
                .collect();
            let edges = Edges::new(before.into_iter());
            let mut corners = polygons.iter().flat_map(|part| part.outline.iter());
            let is_near = |at: &&DVec2| edges.enclose(**at) || edges.distance(**at) <= self.thin;
            if let Some(at) = corners.find(is_near) {
                self.note(Wrong::Touches, (number, Some(hole)), *at);
            }
        }
    }

    /// All polygons as one drawing, each with its holes.
    fn united(&mut self, polygons: Vec<Vec<Polygon>>) -> Vec<Polygon> {
        if polygons.len() == 1 {
            return polygons.concat();
        }
        let rings: Vec<&[DVec2]> = polygons
            .iter()
            .flat_map(|polygon| rings_of(polygon))
            .collect();
        let united = self.lattice.overlay(Operation::Union, &rings, &[]);
        let sum: f64 = polygons.iter().map(|polygon| area(polygon)).sum();
        if sum - area(&united) > self.thin * sum.sqrt() {
            for (number, polygon) in polygons.iter().enumerate().skip(1) {
                let before: Vec<&[DVec2]> = polygons[..number]
                    .iter()
                    .flat_map(|polygon| rings_of(polygon))
                    .collect();
                let common =
                    self.lattice
                        .overlay(Operation::Intersection, &before, &rings_of(polygon));
                let common = common
                    .iter()
                    .find(|part| area(std::slice::from_ref(*part)) > 0.0);
                let corner = common.and_then(|part| part.outline.first());
                corner
                    .into_iter()
                    .for_each(|at| self.note(Wrong::Overlaps, (number, None), *at));
            }
        }
        self.without_slivers(0, united)
    }

    /// The polygons without those, and without holes, that are thinner than a sliver.
    fn without_slivers(&mut self, number: usize, polygons: Vec<Polygon>) -> Vec<Polygon> {
        let mut kept = vec![];
        for mut polygon in polygons {
            let rings = std::iter::once(&mut polygon.outline).chain(&mut polygon.holes);
            // Where lines cross, rounding leaves spikes as wide as a step.
            rings.for_each(|ring| drop(clean(ring, 4.0 * self.lattice.step())));
            if is_thin(&polygon.outline, self.thin) {
                self.note(
                    Wrong::Sliver,
                    (number, None),
                    polygon.outline.first().copied().unwrap_or_default(),
                );
                continue;
            }
            polygon.holes.retain(|hole| !is_thin(hole, self.thin));
            kept.push(polygon);
        }
        kept
    }
}

/// The rings of some polygons.
pub(crate) fn rings_of(polygons: &[Polygon]) -> Vec<&[DVec2]> {
    polygons.iter().flat_map(Polygon::rings).collect()
}

/// The area of polygons in the square of their unit.
pub(crate) fn area(polygons: &[Polygon]) -> f64 {
    polygons
        .iter()
        .flat_map(Polygon::rings)
        .map(doubled_area)
        .sum::<f64>()
        / 2.0
}
