//! What generators of cells share: what is divided, one ground or each cell of a partition, and how the pieces become cells.

use super::ground::Ground;
use crate::geometry::assemble::{Piece, assemble, clip_from, merge_slivers, pieces_of};
use crate::geometry::polygon::{Edges, chorded};
use crate::node::{Build, Failure, Input, Inputs, counted};
use crate::value::{Partition, Polygon, Region, Type, Unit};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// The partition whose cells are divided.
pub(super) const WITHIN: Input = Input::new(
    "within",
    Type::Partition,
    "Each cell of this partition is divided for itself, and its border stays; instead of a `region`, a `size` or a \
     `period`. Cells get an attribute `parent`, the id of the cell they are in. Of arcs the border is chords, no farther off than \
     1/10000 of the arc's length and the same from both sides.",
)
.optional();

/// Below which share of the mean area a cell is joined to a neighbour.
pub(super) const MERGE_BELOW: Input = Input::number(
    "merge_below",
    Unit::One,
    "Cells with less than this share of the mean area are joined to the neighbour they have the longest border with: for \
     slivers along an outline.",
)
.range(0.0, 1.0);

/// Corners nearer than this share of the extent become one.
const TOLERANCE: f64 = 1e-8;

/// How far from an arc the chords may be along which a cell is divided, as a share of the arc's length: parts of neighbours can
/// meet in a T on a chord, but not on an arc.
const CHORD: f64 = 1e-4;

/// Something that is divided for itself.
pub(super) struct Plot {
    pub(super) region: Region,
    pub(super) period: Option<DVec2>,
    /// Where the pattern begins, and the direction of its first axis.
    pub(super) origin: DVec2,
    pub(super) frame: DVec2,
    /// The id of the cell that it is.
    pub(super) parent: Option<u32>,
}

/// Pieces that cover a plot or more.
#[derive(Default)]
pub(super) struct Pieces {
    pub(super) pieces: Vec<Piece>,
    /// Attributes: of each a number for each piece.
    pub(super) values: BTreeMap<&'static str, Vec<f64>>,
    /// Whether they end where the plot ends.
    pub(super) fit: bool,
}

impl Plot {
    /// What the inputs state: a region, a rectangle, a rectangle that repeats, or the cells of a partition.
    ///
    /// # Errors
    /// Unless exactly one is stated.
    pub(super) fn all(inputs: &Inputs<'_>) -> Result<Vec<Plot>, Failure> {
        if inputs.get("within").is_none() {
            let ground = Ground::read(inputs)?;
            return Ok(vec![Plot {
                origin: bounds(&ground.region)[0],
                region: Region::clone(&ground.region),
                period: ground.period,
                frame: DVec2::X,
                parent: None,
            }]);
        }
        if let Some(other) = ["region", "size", "period"]
            .into_iter()
            .find(|name| inputs.get(name).is_some())
        {
            let message = format!("`within` and `{other}` both say what is divided");
            return Err(Failure::of_input("within", message).with_hint("keep one of them"));
        }
        let cells = inputs.partition("within");
        Ok((0..cells.len())
            .map(|cell| Plot::of_cell(cells, cell))
            .collect())
    }

    fn of_cell(cells: &Partition, cell: usize) -> Plot {
        let flat = |ring: Range<usize>| {
            let bulges = cells.bulges.get(ring.clone()).unwrap_or_default();
            chorded(&cells.corners[ring], bulges, CHORD)
        };
        let mut rings = cells.rings_of(cell).map(flat);
        let polygon = Polygon {
            outline: rings.next().unwrap_or_default(),
            holes: rings.collect(),
        };
        Plot {
            region: Region {
                polygons: vec![polygon],
            },
            period: None,
            origin: cells.centres[cell],
            frame: cells.frames[cell],
            parent: Some(cells.ids[cell]),
        }
    }

    /// The lowest and highest corner.
    pub(super) fn bounds(&self) -> [DVec2; 2] {
        bounds(&self.region)
    }

    /// Whether it is the whole rectangle that it lies in.
    pub(super) fn is_rectangle(&self) -> bool {
        let [low, high] = self.bounds();
        let is_corner =
            |at: &DVec2| (at.x == low.x || at.x == high.x) && (at.y == low.y || at.y == high.y);
        match &self.region.polygons[..] {
            [polygon] => {
                polygon.holes.is_empty()
                    && polygon.outline.len() == 4
                    && polygon.outline.iter().all(is_corner)
            }
            _ => false,
        }
    }

    /// Its area in mm².
    pub(super) fn area(&self) -> f64 {
        let rings = self.region.rings();
        rings
            .map(|ring| 0.5 * crate::geometry::polygon::doubled_area(ring))
            .sum()
    }

    /// Its edges, to ask what lies inside.
    pub(super) fn edges(&self) -> Edges {
        Edges::new(self.region.rings())
    }

    /// How far apart corners may be that become one, in mm.
    pub(super) fn tolerance(&self) -> f64 {
        let [low, high] = self.bounds();
        TOLERANCE * (high - low).max_element()
    }

    /// Cuts off what of the pieces lies outside.
    ///
    /// # Errors
    /// If the run was cancelled.
    pub(super) fn clip(&self, pieces: Pieces, build: &Build<'_>) -> Result<Pieces, Failure> {
        if pieces.fit || self.period.is_some() {
            return Ok(pieces);
        }
        let (parts, origins) = clip_from(pieces.pieces, &self.region, &mut || build.go_on())?;
        let values = pieces.values.into_iter().map(|(name, values)| {
            let of_parts = origins.iter().map(|origin| values[*origin]).collect();
            (name, of_parts)
        });
        Ok(Pieces {
            values: values.collect(),
            pieces: parts,
            fit: true,
        })
    }
}

/// Divides all plots and makes one partition of the cells. `divide` gives the pieces of a plot; of a ground their ids stay.
///
/// # Errors
/// Those of `divide`, or if no cell is left.
pub(super) fn divided(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    plots: &[Plot],
    divide: &(dyn Fn(&Plot) -> Result<Pieces, Failure> + Sync),
) -> Result<Partition, Failure> {
    if let [ground] = plots
        && ground.parent.is_none()
    {
        return covered(inputs, build, ground, divide(ground)?);
    }
    let share = inputs.number("merge_below");
    let parts = plots.par_iter().map(|plot| {
        build.go_on()?;
        let pieces = plot.clip(divide(plot)?, build)?;
        Ok(as_pieces(cells(pieces, plot, share, build)?.0))
    });
    let parts: Vec<Pieces> = parts.collect::<Result<_, Failure>>()?;
    build.go_on()?;
    some(united(parts, plots, build)?)
}

/// The cells of a ground that pieces cover.
///
/// # Errors
/// If no cell is left, or the run was cancelled.
pub(super) fn covered(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    ground: &Plot,
    pieces: Pieces,
) -> Result<Partition, Failure> {
    let pieces = ground.clip(pieces, build)?;
    let (partition, joined) = cells(pieces, ground, inputs.number("merge_below"), build)?;
    warn_of_joined(inputs, joined);
    some(partition)
}

fn some(partition: Partition) -> Result<Partition, Failure> {
    match partition.is_empty() {
        false => Ok(partition),
        true => Err(Failure::new("no cell is left")
            .with_hint("divide a larger area, or into smaller cells")),
    }
}

/// Says how many cells were joined to others.
pub(super) fn warn_of_joined(inputs: &Inputs<'_>, joined: usize) {
    if joined > 0 {
        inputs.warn(counted(
            joined,
            "sliver was joined to its neighbour",
            "slivers were joined to their neighbours",
        ));
    }
}

/// The cells of one plot, small ones joined, and how many that were.
fn cells(
    pieces: Pieces,
    plot: &Plot,
    share: f64,
    build: &Build<'_>,
) -> Result<(Partition, usize), Failure> {
    let partition = assembled(pieces, plot.period, plot.tolerance(), build)?;
    join_slivers(partition, share, build)
}

/// The cells that pieces become, with their values as attributes.
///
/// # Errors
/// If the run was cancelled.
pub(super) fn assembled(
    pieces: Pieces,
    period: Option<DVec2>,
    tolerance: f64,
    build: &Build<'_>,
) -> Result<Partition, Failure> {
    let ids: Vec<u32> = pieces.pieces.iter().map(|piece| piece.id).collect();
    let mut partition = assemble(pieces.pieces, period, tolerance, &mut || build.go_on())?;
    name_values(&mut partition, &ids, pieces.values);
    Ok(partition)
}

/// Joins cells with less than a share of the mean area to neighbours.
///
/// # Errors
/// If the run was cancelled.
pub(super) fn join_slivers(
    partition: Partition,
    share: f64,
    build: &Build<'_>,
) -> Result<(Partition, usize), Failure> {
    if share == 0.0 || partition.is_empty() {
        return Ok((partition, 0));
    }
    let mean = partition.areas.iter().sum::<f64>() / partition.len() as f64;
    merge_slivers(&partition, |_| share * mean, &mut || build.go_on())
}

/// Gives cells the values of the pieces with the same ids.
fn name_values(partition: &mut Partition, ids: &[u32], values: BTreeMap<&'static str, Vec<f64>>) {
    let mut places: Vec<(u32, usize)> = ids.iter().copied().zip(0..).collect();
    places.sort_unstable();
    let place = |id: &u32| {
        let found = places.binary_search_by_key(id, |place| place.0);
        places[found.expect("cells have the ids of pieces")].1
    };
    let places_of_cells: Vec<usize> = partition.ids.iter().map(place).collect();
    for (name, values) in values {
        let of_cells = places_of_cells.iter().map(|place| values[*place]);
        partition
            .attributes
            .insert(name.to_owned(), of_cells.collect());
    }
}

fn as_pieces(partition: Partition) -> Pieces {
    let mut values = BTreeMap::new();
    for (name, of_cells) in &partition.attributes {
        let name = NAMES.iter().find(|known| *known == name);
        values.extend(name.map(|name| (*name, of_cells.clone())));
    }
    Pieces {
        pieces: pieces_of(&partition),
        values,
        fit: true,
    }
}

/// The attributes that generators give.
const NAMES: [&str; 5] = ["row", "column", "course", "length", "depth"];

/// The cells of all plots, numbered anew.
fn united(parts: Vec<Pieces>, plots: &[Plot], build: &Build<'_>) -> Result<Partition, Failure> {
    let mut all = Pieces::default();
    for (part, plot) in parts.into_iter().zip(plots) {
        let first = all.pieces.len();
        let parents = all.values.entry("parent").or_default();
        parents.resize(
            first + part.pieces.len(),
            f64::from(plot.parent.unwrap_or_default()),
        );
        for (name, values) in part.values {
            let list = all.values.entry(name).or_default();
            list.resize(first, 0.0);
            list.extend(values);
        }
        all.pieces.extend(part.pieces);
    }
    for (id, piece) in (0..).zip(&mut all.pieces) {
        piece.id = id;
    }
    let count = all.pieces.len();
    all.values
        .values_mut()
        .for_each(|list| list.resize(count, 0.0));
    let corners = plots.iter().flat_map(Plot::bounds);
    let [low, high] = around(corners);
    let tolerance = TOLERANCE * (high - low).max_element();
    assembled(all, None, tolerance, build)
}

fn bounds(region: &Region) -> [DVec2; 2] {
    around(region.rings().flatten().copied())
}

/// The lowest and highest coordinates.
fn around(points: impl Iterator<Item = DVec2>) -> [DVec2; 2] {
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    points.fold(none, |[low, high], at| [low.min(at), high.max(at)])
}
