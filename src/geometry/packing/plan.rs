//! From what is asked for to cells: the order of the steps.

use super::Stone;
use super::cells::{Bed, cells};
use super::force::{Force, Law};
use super::guide::Guide;
use super::lattice::{CAIRO, CAIRO_SIDE, CAIRO_TURNS, Lattice, area_share};
use super::mend::{mend, reach};
use super::position::{Field, stones};
use super::relax::Relaxation;
use super::settle::Dynamics;
use super::start::{Ground, Start};
use super::walls::Walls;
use crate::geometry::polygon::doubled_area;
use crate::value::{Partition, Region};
use glam::DVec2;

/// How stones find their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// Particles that push and pull each other.
    Particles {
        /// How the cubics act.
        law: Law,
        /// Where particles begin.
        start: Start,
        /// Largest number of steps.
        steps: usize,
    },
    /// Lattice points that a field agrees on.
    PositionField,
}

/// What is to be packed.
pub(crate) struct Plan<'a> {
    pub(crate) region: &'a Region,
    /// Width and height of a bed that repeats; the region is that rectangle then.
    pub(crate) period: Option<DVec2>,
    /// Length and width of a stone of size 1, in mm: of pentagons and hexagons the distance to their neighbours.
    pub(crate) stone: DVec2,
    /// 4, 5 or 6.
    pub(crate) corners: u32,
    /// Smallest and largest random size.
    pub(crate) spread: [f64; 2],
    /// How far each row is moved against the one before, in stones.
    pub(crate) bond: f64,
    pub(crate) method: Method,
    /// Whether empty places are filled and crowded ones thinned out.
    pub(crate) mends: bool,
    /// Direction and size at every place.
    pub(crate) guide: &'a Guide,
    /// In how many parts of a turn a stone looks the same.
    pub(crate) symmetry: u32,
}

/// Rounds of mending that leave no fewer faults than there were.
const MENDED: usize = 3;

/// How much of a region may be left out.
const COVERED: f64 = 1e-9;

/// Rounds of filling what no stone reached.
const REACHED: usize = 4;

/// The cells of packed stones, with the attributes `size` (mm), `aspect`, `corners` and `bond`. `random` gives numbers from 0 to
/// less than 1; `go_on` hears the share that is done.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn pack<E>(
    plan: &Plan<'_>,
    random: &mut dyn FnMut() -> f64,
    go_on: &mut dyn FnMut(f64) -> Result<(), E>,
) -> Result<Partition, E> {
    let least = plan.guide.least();
    let largest = plan.guide.largest() * plan.spread[1];
    let walls = Walls::new(plan.region, 2.0 * largest * plan.stone.max_element());
    let [low, high] = walls.bounds();
    let ground = Ground {
        region: plan.region,
        walls: &walls,
        guide: plan.guide,
        stone: plan.stone,
        spread: plan.spread,
        least,
        area: plan.stone.x * plan.stone.y * area_share(plan.corners),
    };
    let bed = Bed {
        region: plan.region,
        walls: plan.period.is_none().then_some(&walls),
        bounds: [low, high - low],
        period: plan.period,
        stone: plan.stone,
        corners: plan.corners,
        guide: plan.guide,
    };
    let mut packed: Vec<Stone> = match plan.method {
        Method::Particles { .. } => plan.particles(&ground, &bed, random, go_on)?,
        Method::PositionField => plan.lattice_points(&ground, &bed, random, go_on)?,
    };
    let relaxation = plan.relaxation(&bed);
    if plan.method == Method::PositionField && plan.corners != 5 {
        relaxation.relax(&mut packed, &mut |share| go_on(0.5 + 0.2 * share))?;
    }
    let mut partition = cells(&bed, &packed, &mut || go_on(0.75))?;
    for _ in 0..REACHED {
        if plan.mends || reach(&ground, &partition, &mut packed, random) == 0 {
            break;
        }
        go_on(0.8)?;
        partition = cells(&bed, &packed, &mut || go_on(0.8))?;
    }
    let (mut fewest, mut vain) = (usize::MAX, 0);
    let (mut next, mut stones) = (None, packed.clone());
    while plan.mends && vain < MENDED {
        let before = stones.clone();
        let found = next.as_ref().unwrap_or(&partition);
        // Cells that do not cover the region are worse than any that do.
        let uncovered = if is_covered(plan.region, found) {
            0
        } else {
            found.len()
        };
        let changes = uncovered + mend(&ground, found, &mut stones, random);
        vain += 1;
        if changes < fewest {
            (fewest, vain) = (changes, 0);
            partition = next.take().unwrap_or(partition);
            packed = before;
        }
        if changes == 0 {
            break;
        }
        go_on(0.8)?;
        if plan.corners != 5 {
            relaxation.relax(&mut stones, &mut |_| go_on(0.8))?;
        }
        next = Some(cells(&bed, &stones, &mut || go_on(0.9))?);
    }
    plan.describe(&mut partition, &packed);
    Ok(partition)
}

/// Whether cells cover a region, and once.
fn is_covered(region: &Region, partition: &Partition) -> bool {
    let whole: f64 = 0.5 * region.rings().map(doubled_area).sum::<f64>();
    let covered: f64 = partition.areas.iter().sum();
    (covered - whole).abs() < COVERED * whole
}

impl Plan<'_> {
    /// Particles on the border and inside, settled.
    fn particles<E>(
        &self,
        ground: &Ground<'_>,
        bed: &Bed<'_>,
        random: &mut dyn FnMut() -> f64,
        go_on: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<Vec<Stone>, E> {
        let Method::Particles { law, start, steps } = self.method else {
            return Ok(vec![]);
        };
        let border = match self.period {
            None => ground.border(random),
            Some(_) => vec![],
        };
        let is_square = self.corners == 4 && self.stone.x == self.stone.y;
        let inside = if start == Start::Lattice && !is_square {
            let places = self.lattice_places(ground, bed, &mut |share| go_on(0.1 * share))?;
            let turns = if self.corners == 5 {
                &CAIRO_TURNS[..]
            } else {
                &[(1.0, 0.0)]
            };
            ground.beside(&border, &places, turns, random, &mut || go_on(0.1))?
        } else {
            ground.inside(&border, start, random, &mut || go_on(0.0))?
        };
        let mut stones = [border, inside].concat();
        let dynamics = Dynamics {
            force: Force::new(self.corners, law),
            stone: self.stone,
            guide: self.guide,
            symmetry: self.symmetry,
            period: self.period,
            steps,
        };
        dynamics.settle(&mut stones, &mut |share| go_on(0.8 * share))?;
        if self.period.is_none() {
            stones.retain(|stone| stone.is_fixed || ground.walls.contains(stone.point));
        }
        Ok(stones)
    }

    /// The points of a lattice that follows the guide. `go_on` hears the share that is done.
    fn lattice_places<E>(
        &self,
        ground: &Ground<'_>,
        bed: &Bed<'_>,
        go_on: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<Vec<DVec2>, E> {
        let field = Field {
            lattice: self.lattice(),
            guide: self.guide,
            walls: bed.walls,
            bounds: bed.bounds,
            period: self.period,
            least: ground.least,
            first: 0.5 * self.stone.y,
            symmetry: self.symmetry,
        };
        let mut round = 0.0;
        let level = field.solve(&mut || {
            round += 1.0;
            go_on(round / (round + 20.0))
        })?;
        let mut points: Vec<DVec2> = stones(&field, &level)
            .into_iter()
            .map(|stone| stone.0)
            .collect();
        if self.corners == 5 {
            points = self.pentagons(&points);
        }
        Ok(points)
    }

    /// Stones at the points of a lattice that follows the guide.
    fn lattice_points<E>(
        &self,
        ground: &Ground<'_>,
        bed: &Bed<'_>,
        random: &mut dyn FnMut() -> f64,
        go_on: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<Vec<Stone>, E> {
        let mut points = self.lattice_places(ground, bed, &mut |share| go_on(0.5 * share))?;
        let is_free = |point: &DVec2| {
            let width = self.stone.min_element() * self.guide.at(*point).scale;
            let nearest = ground.walls.nearest(*point);
            ground.walls.contains(*point) && nearest.is_none_or(|foot| foot.distance > 0.22 * width)
        };
        if self.period.is_none() {
            points.retain(is_free);
        }
        let stones = points
            .into_iter()
            .map(|point| ground.stone_at(point, random()));
        Ok(ground.apart(stones.collect(), 0.55))
    }

    /// The lattice that stones of this shape lie on; in a bed that repeats it fits its sides.
    fn lattice(&self) -> Lattice {
        let mean = 0.5 * (self.spread[0] + self.spread[1]);
        let (step, shift) = match self.corners {
            5 => (DVec2::splat(CAIRO_SIDE) * self.stone, 0.0),
            6 => (self.stone * DVec2::new(1.0, 0.75_f64.sqrt()), 0.5),
            _ => (self.stone, self.bond),
        };
        let step = mean * step;
        let Some(period) = self.period else {
            return Lattice { step, shift };
        };
        let every = DVec2::new(1.0, if shift == 0.0 { 1.0 } else { 2.0 });
        let count = (period / (step * every)).round().max(DVec2::ONE) * every;
        Lattice {
            step: period / count,
            shift,
        }
    }

    /// The stones of a Cairo tiling around the corners of its squares.
    fn pentagons(&self, corners: &[DVec2]) -> Vec<DVec2> {
        let side = self.lattice().step;
        let places = [
            (CAIRO - 0.5, CAIRO),
            (0.5 - CAIRO, -CAIRO),
            (-CAIRO, CAIRO - 0.5),
            (CAIRO, 0.5 - CAIRO),
        ];
        let around = |corner: &DVec2| {
            let wish = self.guide.at(*corner);
            let corner = *corner;
            places.map(move |place| {
                corner + wish.frame.rotate(DVec2::from(place) * side * wish.scale)
            })
        };
        corners.iter().flat_map(around).collect()
    }

    fn relaxation<'b>(&'b self, bed: &Bed<'b>) -> Relaxation<'b> {
        Relaxation {
            guide: self.guide,
            walls: bed.walls,
            symmetry: self.symmetry,
            period: self.period,
            stone: self.stone,
            sides: self.corners,
            is_aligned: self.corners == 4 && self.bond == 0.0,
        }
    }

    /// Turns the frames of cells to the cells themselves, and says how large their stones are meant to be.
    fn describe(&self, partition: &mut Partition, stones: &[Stone]) {
        let edges = if self.corners == 6 { 6 } else { 4 };
        let axes: Vec<DVec2> = (0..partition.len())
            .map(|cell| {
                let wished = partition.frames[cell];
                let own = super::statistics::axis(partition.outline(cell), edges);
                own.map_or(wished, |own| super::guide::nearest_turn(own, wished, edges))
            })
            .collect();
        partition.frames = axes;
        let width = self.stone.min_element();
        let mean = 0.5 * (self.spread[0] + self.spread[1]);
        let size = |cell: usize| {
            let stone = stones.get(partition.ids[cell] as usize);
            let usual = || mean * self.guide.scale(partition.centres[cell]);
            width * stone.map_or_else(usual, |stone| stone.scale)
        };
        let sizes = (0..partition.len()).map(size).collect();
        let count = partition.len();
        let mut set =
            |name: &str, numbers: Vec<f64>| partition.attributes.insert(name.to_owned(), numbers);
        set("size", sizes);
        set("aspect", vec![self.stone.x / self.stone.y; count]);
        set("corners", vec![f64::from(self.corners); count]);
        set("bond", vec![self.bond; count]);
    }
}
