//! How stones are laid: from cells to outlines, prisms and places in the ground, each by its own random numbers.

use super::KIND;
use super::bed::{At, Bed};
use super::cage::{Cage, Cut};
use super::depth::{Outline, Outlines};
use super::grid::Grid;
use super::ground::{FORMS, Ground, Stone};
use super::kernels::{OPEN, WIDE};
use super::manner::Manner;
use super::optics::{Optics, pick};
use super::outline;
use super::shape::{plane, swell};
use crate::node::{Build, Failure, Inputs};
use crate::nodes::random::Random;
use crate::value::Partition;
use glam::{DVec2, DVec3, Vec2};
use std::collections::BTreeMap;

/// All stones, and lists of what else is known of each.
pub(super) struct Laid {
    pub(super) ground: Ground,
    /// The record of the table.
    pub(super) records: Vec<usize>,
    /// The id of the cell.
    pub(super) ids: Vec<u32>,
    /// Width in mm that pixels may have without being divided.
    pub(super) widest: f64,
    /// A random number from 0 to 1.
    pub(super) shares: Vec<f64>,
    /// How far the top leans, in degrees.
    pub(super) tilts: Vec<f64>,
}

/// The share of its height above which a rounded stone goes on to all sides.
const ROUNDED: f64 = 0.75;

/// No stone leans by more along x or y, in radians: 45 degrees.
const STEEPEST: f64 = std::f64::consts::FRAC_PI_4;

/// Stones between two questions whether to go on.
const AT_ONCE: usize = 4096;

/// Pixels may be so wide, as a share of a stone, for joints and rims to be straight in them.
const WIDEST: f64 = 0.06;

/// Lays the stones.
///
/// # Errors
/// If the joints leave nothing of any cell, or the run was cancelled.
pub(super) fn lay(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    table: &[Optics],
) -> Result<Laid, Failure> {
    let partition = inputs.partition("cells");
    let manner = Manner::read(inputs);
    let bed = Bed::sample(inputs, build, partition)?;
    let seed = stream(build.seed, inputs.whole("seed"));
    let mut laying = Laying {
        manner,
        cages: BTreeMap::new(),
        stones: vec![],
        outlines: Outlines::default(),
        corners: vec![],
    };
    let (mut records, mut ids, mut shares, mut tilts) = (vec![], vec![], vec![], vec![]);
    for cell in 0..partition.len() {
        if cell % AT_ONCE == 0 {
            build.go_on()?;
        }
        let mut random = Random::new(seed, "stone", i64::from(partition.ids[cell]));
        let [share, record] = [(); 2].map(|()| f64::from(random.share()));
        let at = bed.of_cell(cell);
        if laying.add(partition, cell, &at, &mut random) {
            records.push(pick(table, record));
            ids.push(partition.ids[cell]);
            shares.push(share);
            tilts.push(laying.tilt_of_last());
        }
    }
    if laying.stones.is_empty() {
        let failure = Failure::of_input("joint", "the joints leave nothing of any cell");
        return Err(failure.with_hint("make them narrower"));
    }
    if records.len() < partition.len() {
        let count = partition.len() - records.len();
        let have = if count == 1 { "has" } else { "have" };
        inputs.warn(format!(
            "{count} of {} cells {have} no room for a stone between their joints",
            partition.len()
        ));
    }
    let area: f64 = partition.areas.iter().map(|area| area.abs()).sum();
    let widest = WIDEST * (area / records.len() as f64).sqrt();
    Ok(Laid {
        widest,
        ground: laying.finish(partition.period, widest),
        records,
        ids,
        shares,
        tilts,
    })
}

/// The seed of the stones' own streams.
fn stream(recipe_seed: u64, node_seed: i64) -> u64 {
    let mut random = Random::new(recipe_seed, KIND.name, node_seed);
    let [high, low] = [(); 2].map(|()| u64::from(random.bits()));
    high << 32 | low
}

/// Stones while they are laid.
struct Laying {
    manner: Manner,
    cages: BTreeMap<usize, Cage>,
    stones: Vec<Stone>,
    outlines: Outlines,
    corners: Vec<DVec3>,
}

impl Laying {
    /// Lays the stone of a cell; says whether there is room for one.
    fn add(&mut self, partition: &Partition, cell: usize, at: &At, random: &mut Random) -> bool {
        let manner = &self.manner;
        let mut by =
            || 0.5 * manner.joint * (1.0 + manner.joint_variation * normal(random)).max(0.1);
        let Some(base) = outline::inset(&outline::of_cell(partition, cell), &mut by) else {
            return false;
        };
        let top = at.settled + manner.height + manner.unevenness * normal(random);
        let lean =
            [(); 2].map(|()| libm::tan((manner.tilt * normal(random)).clamp(-STEEPEST, STEEPEST)));
        let moved: Vec<DVec3> = base
            .iter()
            .map(|_| {
                DVec3::from_array(
                    [(); 3].map(|()| manner.deformation * (2.0 * f64::from(random.share()) - 1.0)),
                )
            })
            .collect();
        let mut stone = Stone {
            centre: partition.centres[cell],
            low: Vec2::ZERO,
            high: Vec2::ZERO,
            outline: Outline::Any(0..0),
            corners: 0..0,
            top: top as f32,
            slope: (at.slope + DVec2::from_array(lean)).as_vec2(),
            rim: 0.0,
            crown: 0.0,
            half: 0.0,
            moved: 0.0,
            flat: f32::NEG_INFINITY,
            worn: None,
        };
        match self.manner.cut {
            None => self.dress(&mut stone, &base, &moved, at, random),
            Some(cut) => self.cut(&mut stone, &base, &moved, at, cut),
        }
        self.stones.push(stone);
        true
    }

    /// Makes it a sett.
    fn dress(
        &mut self,
        stone: &mut Stone,
        base: &[DVec2],
        moved: &[DVec3],
        at: &At,
        random: &mut Random,
    ) {
        let manner = &self.manner;
        let corners: Vec<DVec2> = base
            .iter()
            .zip(moved)
            .map(|(corner, by)| *corner + by.truncate())
            .collect();
        stone.slope += plane(base, moved).as_vec2();
        let by_chance = 0.7 + 0.6 * f64::from(random.share());
        stone.rim = (manner.rounding * by_chance * (1.0 + at.wear)) as f32;
        stone.crown = (manner.crown * (1.0 - at.wear)) as f32;
        let radius = corners
            .iter()
            .map(|corner| corner.length_squared())
            .fold(0.0, f64::max);
        stone.half = (1.0 / radius.max(1e-12)) as f32;
        let radius = manner.corner_radius * by_chance;
        self.outline(stone, &corners, radius);
        // A rim that is wider than the stone would leave nothing of its height.
        stone.rim = stone.rim.min(0.5 * (stone.high - stone.low).min_element());
    }

    /// Makes it a prism, or what is cut of one.
    fn cut(&mut self, stone: &mut Stone, base: &[DVec2], moved: &[DVec3], at: &At, cut: Cut) {
        let top = f64::from(stone.top);
        let below = base.iter().map(|corner| corner.extend(0.0));
        let above = base
            .iter()
            .zip(moved)
            .map(|(corner, by)| corner.extend(top) + *by);
        let mut corners: Vec<DVec3> = below.chain(above).collect();
        let cage = self
            .cages
            .entry(base.len())
            .or_insert_with(|| Cage::new(base.len(), cut));
        if cut != Cut::Prism && self.manner.swell > 0.0 {
            swell(cage, &mut corners, base, self.manner.swell);
        }
        if at.wear > 0.0 {
            let highest = cage.highest(&corners);
            let depth = 0.1 * top.abs() * at.wear;
            stone.worn = Some([(highest - depth) as f32, depth as f32]);
        }
        stone.moved = (1.5 * self.manner.deformation) as f32;
        if cut != Cut::Prism {
            // Rounded stones are widest at about half of their height.
            stone.flat = (ROUNDED * cage.highest(&corners)) as f32;
        }
        let first = self.corners.len() as u32;
        self.corners.extend(corners.iter().copied());
        stone.corners = first..self.corners.len() as u32;
        self.outline(stone, base, 0.0);
        for corner in corners {
            stone.low = stone.low.min(corner.truncate().as_vec2());
            stone.high = stone.high.max(corner.truncate().as_vec2());
        }
    }

    /// Gives the stone its outline, and the box around it.
    fn outline(&mut self, stone: &mut Stone, corners: &[DVec2], radius: f64) {
        stone.outline = self.outlines.add(corners, radius);
        let flat = || corners.iter().map(|corner| corner.as_vec2());
        stone.low = flat().fold(Vec2::INFINITY, Vec2::min);
        stone.high = flat().fold(Vec2::NEG_INFINITY, Vec2::max);
    }

    fn tilt_of_last(&self) -> f64 {
        let slope = self.stones.last().map_or(0.0, |stone| stone.slope.length());
        libm::atan(f64::from(slope)).to_degrees()
    }

    fn finish(self, period: Option<DVec2>, widest: f64) -> Ground {
        let reach = f64::from(WIDE) * self.manner.joint + f64::from(OPEN);
        let kept = self.stones.len().min(FORMS);
        Ground {
            // A pixel that is as wide as it may be sees half of its width more.
            grid: Grid::new(&self.stones, reach + widest, period),
            reach: reach as f32,
            forms: std::iter::repeat_with(Default::default)
                .take(kept)
                .collect(),
            stones: self.stones,
            outlines: self.outlines,
            corners: self.corners,
            cages: self.cages,
        }
    }
}

/// A normal deviate of at most 3 (Box & Muller 1958).
fn normal(random: &mut Random) -> f64 {
    let [one, other] = [(); 2].map(|()| f64::from(random.share()));
    let size = (-2.0 * libm::log(1.0 - one)).sqrt();
    (size * libm::cos(std::f64::consts::TAU * other)).clamp(-3.0, 3.0)
}
